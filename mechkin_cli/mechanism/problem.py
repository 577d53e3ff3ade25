"""Everything that one mechanism file asks for, in SI and checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.expressions.definitions import Definitions
from mechkin_cli.mechanism.bearing_loads import bearing_catalogue
from mechkin_cli.mechanism.coefficient_quantities import coefficient_catalogue
from mechkin_cli.mechanism.derived_quantities import (
    derived_catalogue,
    hint_in_plane,
    hint_of,
    ledger_catalogue,
)
from mechkin_cli.mechanism.drives import without_effort
from mechkin_cli.mechanism.held import Held
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.mechanism.motion import Assembly, Motion
from mechkin_cli.mechanism.quantities import Wanted, catalogue, response_quantities

if TYPE_CHECKING:
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.mechanism.load_laws import Laws, LoadLaw
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.units import UnitSystem


@dataclass(frozen=True)
class Problem:
    """A mechanism, how it moves, how it is assembled, and the units of its file.

    Mechanism, motion and laws are those of the sweep; `responses` are the file's other runs, and
    `response` is the one whose first moment this is (`mechanism.response.response_problem`).
    """

    mechanism: Mechanism
    motion: Motion
    assembly: Assembly
    units: UnitSystem
    parameters: Mapping[str, Quantity] = field(default_factory=dict)
    definitions: Definitions = field(default_factory=Definitions)
    diagnostics: tuple[Diagnostic, ...] = ()
    load_laws: tuple[LoadLaw, ...] = ()
    hold_idle: bool = False
    held: tuple[Held, ...] = ()
    follow: tuple[str, ...] | None = None
    responses: Mapping[str, Response] = field(default_factory=dict)
    response: Response | None = None

    @property
    def driven(self) -> list[tuple[str, str]]:
        """The inputs (joint, coordinate), then the coordinates at which idle freedoms are held."""
        return [*self.motion.driven, *self.held_at]

    @property
    def acting(self) -> Sequence[tuple[str, str]]:
        """Where efforts act (joint, coordinate): at actuators, else at the inputs."""
        drives = self.mechanism.drives
        return self.motion.driven if drives is None else drives.acting

    @cached_property
    def held_at(self) -> dict[tuple[str, str], float]:
        """Where the held coordinates stand (rad, m): as drawn, or where `near` puts them."""
        near = self.assembly.near
        held = [one for one in self.held if one.coordinate is not None]
        return {one.coordinate: near.get(one.name, 0.0) for one in held if one.coordinate}

    @cached_property
    def laid_mechanism(self) -> Mechanism:
        """The mechanism with the pairs that hold idle freedoms."""
        stops = {one.stop.name: one.stop for one in self.held if one.stop is not None}
        if not stops:
            return self.mechanism
        return replace(self.mechanism, joints={**self.mechanism.joints, **stops})

    @cached_property
    def solved_mechanism(self) -> Mechanism:
        """The same with the balls that hold idle freedoms told as three turns."""
        told = {one.told.name: one.told for one in self.held if one.told is not None}
        if not told:
            return self.laid_mechanism
        return replace(self.laid_mechanism, joints={**self.laid_mechanism.joints, **told})

    @property
    def laws(self) -> Laws | None:
        """The laws of the loads that vary, with what their names stand for; None without any."""
        watched = () if self.response is None else self.response.watched
        if not self.load_laws and not watched:
            return None
        from mechkin_cli.mechanism.load_laws import Laws

        return Laws(self.load_laws, self.parameters, self.quantities(), watched)

    def moved(self, motion: Motion) -> Problem:
        """The problem with another motion; those of a response have the same quantities."""
        other = replace(self, motion=motion)
        if self.response is not None:
            other.__dict__["_quantities"] = self._quantities
        return other

    def quantities(self) -> Mapping[str, Wanted]:
        """The quantities that the mechanism has, by name."""
        return self._quantities

    def why_not(self, name: str) -> str | None:
        """Why there is no quantity of a name, and what there is; None where that is not known."""
        response = self.response is not None
        passive = without_effort(name, self._quantities, self.mechanism.drives, response=response)
        held = hint_in_plane(name) if self.mechanism.plane else None
        return passive or held or hint_of(name)

    @cached_property
    def _quantities(self) -> Mapping[str, Wanted]:
        mechanism, motion = self.mechanism, self.motion
        if self.response is not None:
            efforts = self.response.efforts_of
            found = catalogue(mechanism, efforts, timed=True, held=self.held)
            # the rates of forces, and with them jerks, are not known; nor is what steps leave of
            # errors
            found = {
                name: known
                for name, known in found.items()
                if known.order < 3 and known.kind != "error_bound"
            }
            # efforts are given here, and linear in nothing
            linear = {name: known for name, known in found.items() if known.kind != "effort"}
            moving = [*self.response.independent, *self.response.driven_at]
            if moving:
                found |= coefficient_catalogue(linear, moving, moving[0])
            found |= response_quantities() | bearing_catalogue(mechanism)
            return found | derived_catalogue(mechanism, (), None)
        leading = motion.leading and (motion.leading.joint, motion.leading.coordinate)
        found = catalogue(mechanism, self.acting, timed=motion.time is not None, held=self.held)
        if leading is not None:
            found |= coefficient_catalogue(found, motion.driven, leading)
        if motion.time is not None and leading is not None:
            found |= ledger_catalogue()
        found |= bearing_catalogue(mechanism)
        return found | derived_catalogue(mechanism, motion.driven, leading)
