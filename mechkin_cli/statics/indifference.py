"""Motions along which the loads balance: each is one row of a window.

A window of one coordinate is looked through in parts, and a motion may turn back at a dead centre
and come again a turn later. Parts that share a place belong to one motion (`Motions`).

Of several freedoms a motion is followed from the first equilibrium that is found on it
(`BalancedMotion`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.record import NamedTuple
from mechkin_cli.search import pose_keys, pose_number, same_poses
from mechkin_cli.session import input_number, input_text
from mechkin_cli.statics.forces import summed
from mechkin_cli.statics.newton import search, slopes
from mechkin_cli.statics.places import Place, eigen

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.show import Floats
    from mechkin_cli.statics.newton import Balancing, Search
    from mechkin_cli.statics.places import Statics


class Part(NamedTuple):
    """Neighbouring places of a branch at all of which the loads balance: values of the coordinate
    (places,), states and turns; the least and the largest value at which they do; and the state of
    the dead centre that it ends at."""

    values: Floats
    states: Floats
    turns: Floats
    low: float
    high: float
    dead_centre: Floats | None


class Motions:
    """The motions along which the loads balance.

    Args:
        statics: of one free coordinate.
        inputs: (inputs, places) at values of it.
    """

    def __init__(self, statics: Statics, inputs: Callable[[Floats], Floats]) -> None:
        self.statics, self._inputs = statics, inputs
        self._parts: list[Part] = []
        self._motion: list[int] = []
        self._starts: dict[int, Place] = {}
        self._spans: list[tuple[float, float]] = []

    def add(self, part: Part, start: Place) -> None:
        """Takes a part, which belongs to a motion that is known or begins another; `start` is a
        place of it."""
        self._spans.append((part.low, part.high))
        first = self._holding(self._place(part, 0))
        last = self._holding(self._place(part, part.values.size - 1))
        meeting = [
            k
            for k, other in enumerate(self._parts)
            if self._same_dead_centre(part.dead_centre, other.dead_centre)
        ]
        meets = {self._motion[k] for k in (*first, *last, *meeting)}
        for number, other in enumerate(self._parts):
            if self._motion[number] in meets:
                continue
            ends = (self._place(other, 0), self._place(other, other.values.size - 1))
            if any(self._lies_in(part, end) for end in ends):
                meets.add(self._motion[number])
        motion = min(meets, default=len(self._motion))
        self._motion = [motion if one in meets else one for one in self._motion]
        free = self.statics.free[0]
        for one in [self._starts.pop(k) for k in meets if k in self._starts]:
            if one.inputs[free] < start.inputs[free]:
                start = one
        self._starts[motion] = start
        # a part that lies on others adds nothing to them
        if not first or not (last or meeting):
            self._parts.append(part)
            self._motion.append(motion)

    @property
    def starts(self) -> list[Place]:
        """A place of each motion."""
        return [self._starts[motion] for motion in sorted(self._starts)]

    def has(self, place: Place) -> bool:
        """Whether a place lies on one of the motions."""
        return bool(self._holding(place)) or any(
            self._same_dead_centre(one.dead_centre, place.state) for one in self._parts
        )

    def spans(self, low: float, high: float) -> list[tuple[float, float]]:
        """The values, between two, at which the loads balance along a motion."""
        found: list[tuple[float, float]] = []
        for first, last in sorted(self._spans):
            first, last = max(first, low), min(last, high)
            if last < first:
                continue
            if found and first <= found[-1][1] + tolerances.SAME_EQUILIBRIUM:
                found[-1] = found[-1][0], max(found[-1][1], last)
            else:
                found.append((first, last))
        return found

    def _holding(self, place: Place) -> list[int]:
        """The parts that have a place."""
        return [k for k, part in enumerate(self._parts) if self._lies_in(part, place)]

    def _place(self, part: Part, k: int) -> Place:
        inputs = self._inputs(part.values[k : k + 1])[:, 0]
        return Place(inputs, part.states[:, k], part.turns[:, k])

    def _lies_in(self, part: Part, place: Place) -> bool:
        """Whether a place, or one that is whole turns off, lies between those of a part."""
        free, slack = self.statics.free[0], tolerances.SAME_EQUILIBRIUM
        value = float(place.inputs[free])
        least, most = float(part.values.min()), float(part.values.max())
        if self.statics.cyclic[free]:
            value += 2.0 * np.pi * float(np.ceil((least - slack - value) / (2.0 * np.pi)))
        if not least - slack <= value <= most + slack:
            return False
        near = self._place(part, int(np.argmin(np.abs(part.values - value))))
        at = min(max(value, least), most)
        way = self.statics.way(self._inputs(np.array([near.inputs[free], at])), near)
        if way.reached < 2:
            return False
        layout, limit = self.statics.session.layout, tolerances.SAME_DEAD_CENTRE
        return pose_number(layout, way.states[:, 1:], place.state, limit) is not None

    def _same_dead_centre(self, one: Floats | None, other: Floats | None) -> bool:
        if one is None or other is None:
            return False
        layout, limit = self.statics.session.layout, tolerances.SAME_DEAD_CENTRE
        return pose_number(layout, one[:, None], other, limit) is not None


def without_stiffness(balancing: Balancing, one: Search) -> Floats:
    """Directions (directions, freedoms) of the chart about an equilibrium in which it has no
    stiffness, as far as differences tell."""
    count = balancing.forces.freedoms
    found = slopes(balancing.forces, one.place)
    if found is None:
        return np.zeros((0, count))
    matrix = found[1]
    values, vectors = eigen(0.5 * (matrix + matrix.T))
    size = max(float(np.max(np.abs(values))), one.largest)
    return vectors.T[np.abs(values) <= tolerances.NO_STIFFNESS * size]


class BalancedMotion(NamedTuple):
    """A motion of several freedoms along which the loads balance.

    Attributes:
        first: the equilibrium from which it was followed, with its coordinates.
        keys: (keys, places) of poses along it.
        values: (freedoms, places) of the coordinates there.
        freedoms: how many it has itself; of several only one place is known.
    """

    first: Floats
    keys: Floats
    values: Floats
    freedoms: int

    @classmethod
    def along(
        cls,
        balancing: Balancing,
        one: Search,
        values: Floats,
        directions: Floats,
        ends: tuple[Floats, Floats],
    ) -> BalancedMotion:
        """The motion through an equilibrium, in both directions to the ends of the window or
        around."""
        layout = balancing.chosen.layout
        own = pose_keys(layout, one.place.state[:, None])
        keys, at = [own], [values]
        for sign in (1.0, -1.0) if len(directions) == 1 else ():
            place, direction = one.place, sign * directions[0]
            closed = False
            for number in range(tolerances.MOST_MOTION_STEPS):
                beside = balancing.forces.at(place, direction[:, None] * tolerances.MOTION_STEP)
                if not beside.good[0]:
                    break
                found = search(balancing, balancing.forces.moved(place, beside))
                if not found.found:
                    break
                onward = without_stiffness(balancing, found)
                if len(onward) != 1:
                    break
                way = summed(place.tangents * direction[:, None])
                turned = summed((found.place.tangents * way).T)
                direction = onward[0] if float(summed(turned * onward[0])) > 0.0 else -onward[0]
                place = found.place
                now = balancing.named(place)[0]
                keys.append(pose_keys(layout, place.state[:, None]))
                at.append(now)
                low, high = ends
                if (now < low).any() or (now > high).any():
                    break
                again = same_poses(own, keys[-1], 0.5 * tolerances.MOTION_STEP)[0, 0]
                closed = bool(number > 2 and again)
                if closed:
                    break
            if closed:
                break
        return cls(values, np.concatenate(keys, axis=1), np.stack(at, axis=1), len(directions))

    def has(self, balancing: Balancing, one: Search, values: Floats) -> bool:
        """Whether an equilibrium without stiffness in some direction lies on it."""
        if self.freedoms > 1:
            return True
        key = pose_keys(balancing.chosen.layout, one.place.state[:, None])
        same = same_poses(self.keys, key, tolerances.MOTION_STEP)[:, 0]
        turns = np.rint((self.values - values[:, None]) / (2.0 * np.pi)).any(axis=0)
        return bool((same & ~turns).any())

    def words(self, balancing: Balancing) -> str:
        """Through which place it goes, and how far."""
        session = balancing.chosen

        def at(number: int, value: float) -> str:
            value = value if abs(value) > tolerances.EQUILIBRIUM_STEP else 0.0
            return input_text(input_number(session.problem, session.layout, number, value))

        place = ", ".join(at(k, float(value)) for k, value in enumerate(self.first))
        if self.freedoms > 1:
            return f"motions of {self.freedoms} freedoms through {place}"
        return f"a motion through {place}"
