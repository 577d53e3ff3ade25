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
from mechkin_cli.statics.forces import FreePlace, determinant
from mechkin_cli.statics.indifference import BalancedMotion, without_stiffness
from mechkin_cli.statics.newton import Balancing, Search, slopes
from mechkin_cli.statics.stability import is_indifferent

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.show import Floats


@dataclass
class Known:
    """The equilibria that are known, each once, within a window."""

    balancing: Balancing
    window: tuple[Limit, ...]
    found: list[Search] = field(default_factory=list)
    is_folded: bool = False
    motions: list[BalancedMotion] = field(default_factory=list)
    _values: list[Floats] = field(default_factory=list)
    _keys: list[Floats] = field(default_factory=list)
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
        return self.add_all([one])[0]

    def add_all(self, several: Sequence[Search]) -> list[bool]:
        """Takes equilibria one after the other; which of them are new."""
        if not several:
            return []
        values = self.balancing.named_each(FreePlace.many([one.place for one in several]))[0]
        return [self._add(one, at) for one, at in zip(several, values.T, strict=True)]

    def _add(self, one: Search, values: Floats) -> bool:
        if self._is_known(one, values):
            return False
        inside = self._within(one, values)
        # turned into the window it may be known
        if inside is None or self._is_known(inside[0], inside[1]):
            return False
        if self.balancing.forces.freedoms > 1 and self._lies_on_motion(*inside):
            return False
        self.found.append(inside[0])
        self._values.append(inside[1])
        return True

    def _is_known(self, one: Search, values: Floats) -> bool:
        """Whether an equilibrium with some values of the coordinates is known."""
        if not self.found:
            return False
        layout, limit = self.balancing.chosen.layout, tolerances.SAME_EQUILIBRIUM
        key = pose_keys(layout, one.place.state[:, None])
        for other in self.found[len(self._keys) :]:
            self._keys.append(pose_keys(layout, other.place.state[:, None])[:, 0])
        same = same_poses(np.stack(self._keys, axis=1), key, limit)[:, 0]
        # the same pose some turns further, where other loads balance, is another equilibrium
        return any(
            not np.rint((self._values[k] - values) / (2.0 * np.pi)).any()
            for k in np.flatnonzero(same)
        )

    def _lies_on_motion(self, one: Search, values: Floats) -> bool:
        """Whether an equilibrium lies on a motion that is known, along which the loads balance; a
        motion on which it is the first is followed."""
        directions = without_stiffness(self.balancing, one)
        if not len(directions):
            return False
        if any(motion.has(one, values, directions) for motion in self.motions):
            return True
        if is_indifferent(self.balancing, one.place, directions[0]):
            self.motions.append(
                BalancedMotion.along(self.balancing, one, values, directions, self.ends)
            )
        return False

    def leave_out(self, lies_on_motion: Callable[[Search], bool]) -> None:
        """Forgets some equilibria."""
        kept = [k for k, one in enumerate(self.found) if not lies_on_motion(one)]
        self.found = [self.found[k] for k in kept]
        self._values = [self._values[k] for k in kept]
        self._keys = []

    def _within(self, one: Search, values: Floats) -> tuple[Search, Floats] | None:
        """An equilibrium, and its values, whose angles are turned down to the least values in the
        window, as far as the loads and their slopes are the same there; None outside."""
        session, (low, high) = self.balancing.chosen, self.ends
        values, slack = values.copy(), tolerances.SAME_EQUILIBRIUM
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
        return one._replace(place=place), values

    def repeats(self, one: Search) -> bool:
        """Whether the loads are the same at a place and a turn further in each of the window's
        angles: no spring counts their turns."""
        here = slopes(self.balancing.forces, one.place)
        for k in range(len(self.window)):
            there = slopes(self.balancing.forces, self._turned(one.place, k, 1.0))
            if here is None or there is None or not _are_same(here, there, one.largest):
                return False
        return True

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
        """That whole turns were left out, and motions are one row each."""
        notes = []
        if self.motions:
            some = [one.words() for one in self.motions[: tolerances.MOST_TOLD]]
            more = len(self.motions) - len(some)
            some += [f"along {more} more motions"] if more else []
            text = f"the loads balance all along {', and '.join(some)}; each motion is one row"
            notes.append(Diagnostic("indifferent", "note", text, response.place))
        if not self.is_folded:
            return notes
        text = (
            "equilibria that whole turns alone tell apart, at which the loads are the same, are "
            "one row, at the least angle in the window"
        )
        return [*notes, Diagnostic("window-turns", "note", text, response.place)]


def _are_same(one: tuple[Floats, Floats], other: tuple[Floats, Floats], largest: float) -> bool:
    """Whether forces and their slopes are the same at two places."""
    forces = float(np.max(np.abs(one[0] - other[0])))
    matrices = float(np.max(np.abs(one[1] - other[1])))
    size = max(largest, float(np.max(np.abs(one[1]))))
    return max(forces, matrices) <= tolerances.TURNED_BALANCE * size
