"""What ends a response: a value that passes another, dead centres, turns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mechkin_cli.building.coordinates import CODE, without
from mechkin_cli.building.load_laws import LoadLaws
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.response import Crossing, DeadCentre, Stop, Turns
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.schema import responses as written

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields, Path
    from mechkin_cli.mechanism.model import Joint
    from mechkin_cli.mechanism.quantities import Wanted

_WAYS = {"up": " upwards", "down": " downwards", "any": ""}


class StopBuilder:
    """Builds the stops of one run; what is wrong is noted in `fields`."""

    def __init__(
        self,
        fields: Fields,
        joints: Mapping[str, Joint],
        run: str,
        quantities: Mapping[str, Wanted],
    ) -> None:
        self.fields = fields
        self.joints = joints
        self.laws = LoadLaws(fields, {run: quantities}, reader="a stop")

    def build(self, path: Path, sections: Sequence[written.Stop]) -> tuple[Stop, ...]:
        """The stops of the response at `path`."""
        found = [self._stop((*path, "stop", i), section) for i, section in enumerate(sections)]
        return tuple(stop for stop in found if stop is not None)

    def _stop(self, path: Path, section: written.Stop) -> Stop | None:
        if isinstance(section, written.Crossing):
            return self._crossing(path, section)
        place, count = self.fields.document.place(path), section.count
        if isinstance(section, written.DeadCentre):
            name = section.dead_centre
            words = f"dead centre {count} of {name}" if count > 1 else f"dead centre of {name}"
            if not self._is_known((*path, "dead_centre"), name):
                return None
            joint, _, coordinate = name.rpartition(".")
            return DeadCentre(words, place, joint, coordinate, count)
        name = section.turns
        if not self._is_known((*path, "turns"), name):
            return None
        joint, _, coordinate = name.rpartition(".")
        if not is_angle(coordinate):
            text, hint = f"{name} is a slide and does not turn", "write value: and at: for a slide"
            self.fields.error("no-angle", (*path, "turns"), text, hint)
            return None
        words = f"{count} turn{'s' * (count > 1)} of {name}"
        return Turns(words, place, joint, coordinate, count)

    def _crossing(self, path: Path, section: written.Crossing) -> Crossing | None:
        found = self.laws.watched((*path, "value"), section.value)
        if found is None:
            return None
        law, dimension = found
        at = self.fields.number((*path, "at"), section.at, dimension)
        in_file = float(self.fields.units.from_si(at, dimension)) + 0.0  # no -0
        amount = f"{in_file:.12g} {self.fields.units.label(dimension)}".rstrip()
        words = f"{section.value.strip()} = {amount}{_WAYS[section.direction]}"
        return Crossing(words, law.place, law, dimension, at, section.direction)

    def _is_known(self, path: Path, name: str) -> bool:
        """Whether the value at `path` names a coordinate; if not, that is noted."""
        owner, _, coordinate = name.rpartition(".")
        joint = self.joints.get(owner)
        if joint is not None and coordinate in joint.type.coordinates:
            return True
        if joint is not None:
            self.fields.error(CODE, path, *without(joint, coordinate))
        elif not self.fields.is_refused(owner):
            known = [c for one in self.joints.values() for c in one.coordinates]
            text = f"{name} is no coordinate"
            self.fields.error(CODE, path, text, nearest_hint(name, known))
        return False
