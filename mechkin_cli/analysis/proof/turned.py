"""How far coordinates go along a way, with the whole turns that its ends do not show."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from mechkin_cli.analysis.proof.distance import FULL_TURN

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Self

    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.follow import Followed
    from mechkin_cli.solver.session import Session


@dataclass(frozen=True, slots=True, eq=False)
class Turned:
    """How far coordinates went, rad and lengths of the kernel.

    Attributes:
        tree: the states (states,); those of orientations say nothing.
        closing: the angles of closing joints by (closing joint, freedom).
    """

    tree: Floats
    closing: Mapping[tuple[int, int], float]

    @classmethod
    def along(cls, session: Session, found: Followed) -> Self:
        """From the first place of a way to the last, that was followed with its turns."""
        assert found.turns is not None
        slots, turns = session.turn_slots, found.turns[:, -1] - found.turns[:, 0]
        tree = found.guess[:, -1] - found.guess[:, 0]
        for state, slot in slots.tree.items():
            tree[state] += FULL_TURN * turns[slot]
        return cls(tree, {angle: float(turns[slot]) for angle, slot in slots.closing.items()})

    def and_on(self, other: Turned) -> Turned:
        """Along this way and another one behind it, of the same tree."""
        both = {angle: way + other.closing[angle] for angle, way in self.closing.items()}
        return Turned(self.tree + other.tree, both)

    def of_angle(self, session: Session, wanted: Wanted) -> float:
        """How far a joint's angle went, rad."""
        layout = session.layout
        reference = layout.joint_reference[wanted.owner]
        freedom = layout.mechanism.joints[wanted.owner].type.freedom_of[wanted.coordinate]
        if reference < 0:
            return self.closing[-1 - reference, freedom]
        return float(self.tree[layout.state(layout.edge_number[wanted.owner], freedom)])
