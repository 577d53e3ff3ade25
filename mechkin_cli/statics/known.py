"""The equilibria of a window that are known, each once, and which of them whole turns alone tell
apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import Limit
from mechkin_cli.record import dataclass, field
from mechkin_cli.search import pose_keys, same_poses
from mechkin_cli.session import input_unit, turn_of
from mechkin_cli.statics.forces import determinant
from mechkin_cli.statics.newton import Balancing, Search, slopes

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.show import Floats
    from mechkin_cli.statics.forces import FreePlace


@dataclass
class Known:
    """The equilibria that are known, each once, within a window."""

    balancing: Balancing
    window: tuple[Limit, ...]
    found: list[Search] = field(default_factory=list)
    is_folded: bool = False
    _counted: int = 0
    _excess: int = 0

    @property
    def excess(self) -> int:
        """How many more of the equilibria have an even number of unstable directions than an odd
        one."""
        for one in self.found[self._counted :]:
            known = slopes(self.balancing.forces, one.place)
            self._excess += 0 if known is None else int(np.sign(determinant(known[1])))
        self._counted = len(self.found)
        return self._excess

    @property
    def ends(self) -> tuple[Floats, Floats]:
        """Least and largest values (free,) of the window, in kernel units."""
        session = self.balancing.chosen
        inputs = session.problem.motion.inputs[: len(self.window)]
        units = np.array([input_unit(session.layout, item) for item in inputs])
        low = np.array([one.low for one in self.window]) / units
        return low, np.array([one.high for one in self.window]) / units

    def add(self, one: Search) -> bool:
        """Takes an equilibrium, if it lies in the window and is not known; whether it is new."""
        inside = self._within(one)
        if inside is None:
            return False
        if self.found:
            layout, limit = self.balancing.chosen.layout, tolerances.SAME_EQUILIBRIUM
            poses = np.stack([other.place.state for other in self.found], axis=1)
            same = same_poses(
                pose_keys(layout, poses), pose_keys(layout, inside.place.state[:, None]), limit
            )[:, 0]
            # the same pose some turns further, where other loads balance, is another equilibrium
            at = self._values(inside)
            for k in np.flatnonzero(same):
                if not np.rint((self._values(self.found[k]) - at) / (2.0 * np.pi)).any():
                    return False
        self.found.append(inside)
        return True

    def _values(self, one: Search) -> Floats:
        return self.balancing.named(one.place)[0]

    def _within(self, one: Search) -> Search | None:
        """An equilibrium whose angles are turned down to the least values in the window, as far as
        the loads and their slopes are the same there; None outside."""
        session, (low, high) = self.balancing.chosen, self.ends
        values, slack = self._values(one).copy(), tolerances.SAME_EQUILIBRIUM
        place, here = one.place, None
        for k, item in enumerate(session.problem.motion.inputs[: values.size]):
            turns = float(np.ceil((low[k] - slack - values[k]) / (2.0 * np.pi)))
            if turns == 0.0 or turn_of(session.problem, item) is None:
                continue
            if here is None:
                here = slopes(self.balancing.forces, place)
            moved = self._turned(place, k, turns)
            there = slopes(self.balancing.forces, moved)
            # a spring on an angle counts its turns: a turn further loads may not balance
            if here is None or there is None or not _are_same(here, there, one.largest):
                continue
            if values[k] <= high[k] + slack and values[k] >= low[k] - slack:
                wide = high[k] - low[k] > 2.0 * np.pi + slack
                self.is_folded = self.is_folded or bool(wide)
            place = moved
            values[k] += 2.0 * np.pi * turns
        if not ((values >= low - slack) & (values <= high + slack)).all():
            return None
        return one._replace(place=place)

    def _turned(self, place: FreePlace, number: int, turns: float) -> FreePlace:
        """A place with one of the window's angles some whole turns further."""
        session = self.balancing.chosen
        item, (edge, freedom) = session.problem.motion.inputs[number], session.graph.inputs[number]
        state, slots = place.state.copy(), place.turns.copy()
        if session.layout.joint_reference[item.joint] >= 0:
            state[session.layout.state(edge, freedom)] += 2.0 * np.pi * turns
        else:
            slot = session.structure.turn_slot(session.problem.quantities()[item.name])
            if slot is not None:
                slots[slot] += 2.0 * np.pi * turns
        return place._replace(state=state, turns=slots)

    def notes(self, response: ResponseProblem) -> list[Diagnostic]:
        """That whole turns were left out."""
        if not self.is_folded:
            return []
        text = (
            "equilibria that whole turns alone tell apart, at which the loads are the same, are "
            "one row, at the least angle in the window"
        )
        return [Diagnostic("window-turns", "note", text, response.place)]


def _are_same(one: tuple[Floats, Floats], other: tuple[Floats, Floats], largest: float) -> bool:
    """Whether forces and their slopes are the same at two places."""
    forces = float(np.max(np.abs(one[0] - other[0])))
    matrices = float(np.max(np.abs(one[1] - other[1])))
    size = max(largest, float(np.max(np.abs(one[1]))))
    return max(forces, matrices) <= tolerances.TURNED_BALANCE * size
