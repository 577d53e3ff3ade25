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
from mechkin_cli.mechanism import eliminated
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.search import pose_keys, pose_number
from mechkin_cli.session import input_number, input_text, turn_of
from mechkin_cli.statics.forces import summed
from mechkin_cli.statics.newton import search, slopes
from mechkin_cli.statics.places import Place, eigen

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.statics.forces import FreePlace
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


@dataclass
class BalancedMotion:
    """A motion of several freedoms along which the loads balance.

    Attributes:
        balancing: of the mechanism.
        first: coordinates (freedoms,) of the equilibrium from which it was followed.
        places: poses along it, as keys (keys,), and coordinates (freedoms,) there: of a motion of
            one freedom along the whole of it, of several those that were found.
        freedoms: how many it has itself.
    """

    balancing: Balancing
    first: Floats
    places: list[tuple[Floats, Floats]]
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
        """The motion through an equilibrium; one of one freedom is followed in both directions to
        the ends of the window or around."""
        own = pose_keys(balancing.chosen.layout, one.place.state[:, None])[:, 0]
        motion = cls(balancing, values, [(own, values)], len(directions))
        if motion.freedoms == 1 and not motion._follow(one, directions[0], ends):
            motion._follow(one, -directions[0], ends)
        return motion

    def _follow(self, one: Search, direction: Floats, ends: tuple[Floats, Floats]) -> bool:
        """Follows a motion of one freedom in a direction; whether it comes back."""
        # rounding at an end of the window is no way out of it
        slack = tolerances.SAME_EQUILIBRIUM
        place, low, high = one.place, ends[0] - slack, ends[1] + slack
        for number in range(tolerances.MOST_MOTION_STEPS):
            found = self._moved(place, direction * tolerances.MOTION_STEP)
            if found is None:
                return False
            (onward,) = without_stiffness(self.balancing, found)
            way = summed(place.tangents * direction[:, None])
            turned = summed((found.place.tangents * way).T)
            direction = onward if float(summed(turned * onward)) > 0.0 else -onward
            place = found.place
            key, now = self._known(place)
            self.places.append((key, now))
            if (now < low).any() or (now > high).any():
                return False
            off = np.abs(key - self.places[0][0]).max()
            if number > 2 and off < 0.5 * tolerances.MOTION_STEP:
                return True
        return False

    def has(self, one: Search, values: Floats, directions: Floats) -> bool:
        """Whether an equilibrium without stiffness in some directions lies on it."""
        if len(directions) != self.freedoms:
            return False
        key = pose_keys(self.balancing.chosen.layout, one.place.state[:, None])[:, 0]
        if self.freedoms > 1:
            return self._leads_to(one, key, values, directions)
        return any(
            np.abs(key - there).max() < tolerances.MOTION_STEP
            and not np.rint((values - at) / (2.0 * np.pi)).any()
            for there, at in self.places
        )

    def _leads_to(self, one: Search, key: Floats, values: Floats, directions: Floats) -> bool:
        """Whether a motion of several freedoms leads from an equilibrium to the nearest known place
        of this one, by steps along which the loads balance."""
        there, goal = min(self.places, key=lambda known: float(np.abs(known[0] - key).max()))
        place, begin = one.place, (key, values)
        for _ in range(tolerances.MOST_SURFACE_STEPS):
            now, rates = self.balancing.named(place)
            off = goal - now
            off = off - np.where(self._cyclic, np.rint(off / (2.0 * np.pi)), 0.0) * (2.0 * np.pi)
            step = _towards(rates, directions, off)
            if step is None:
                return False
            length = float(np.sqrt(summed(step * step)))
            if length < tolerances.SAME_EQUILIBRIUM:
                same = bool(np.abs(self._known(place)[0] - there).max() < tolerances.MOTION_STEP)
                if same:
                    self.places.append(begin)
                return same
            reach = min(1.0, tolerances.EQUILIBRIUM_REACH / length)
            found = self._moved(place, step * reach)
            if found is None:
                return False
            place, directions = found.place, without_stiffness(self.balancing, found)
        return False

    def _moved(self, place: FreePlace, step: Floats) -> Search | None:
        """The equilibrium a step away, if it has as many freedoms without stiffness."""
        beside = self.balancing.forces.at(place, step[:, None])
        if not beside.good[0]:
            return None
        try:
            found = search(self.balancing, self.balancing.forces.moved(place, beside))
        except ValueError:
            return None
        same = found.found and len(without_stiffness(self.balancing, found)) == self.freedoms
        return found if same else None

    def _known(self, place: FreePlace) -> tuple[Floats, Floats]:
        key = pose_keys(self.balancing.chosen.layout, place.state[:, None])[:, 0]
        return key, self.balancing.named(place)[0]

    @property
    def _cyclic(self) -> Bools:
        problem = self.balancing.chosen.problem
        items = problem.motion.inputs[: self.first.size]
        return np.array([turn_of(problem, item) is not None for item in items])

    def words(self) -> str:
        """Through which place it goes."""
        session = self.balancing.chosen

        def at(number: int, value: float) -> str:
            value = value if abs(value) > tolerances.EQUILIBRIUM_STEP else 0.0
            return input_text(input_number(session.problem, session.layout, number, value))

        place = ", ".join(at(k, float(value)) for k, value in enumerate(self.first))
        if self.freedoms > 1:
            return f"motions of {self.freedoms} freedoms through {place}"
        return f"a motion through {place}"


def _towards(rates: Floats, directions: Floats, off: Floats) -> Floats | None:
    """The step (freedoms,) of a chart, in some of its `directions`, by which named coordinates come
    nearest to where they are `off`; None where the directions do not move them independently."""
    moved = np.array([summed((rates * each).T) for each in directions])  # (directions, coordinates)
    normal = [[float(summed(a * b)) for b in moved] for a in moved]
    right = [float(summed(a * off)) for a in moved]
    solved = eliminated(normal, right, tolerances.RANK_ZERO)
    if solved is None:
        return None
    return summed(directions * np.array(solved)[:, None])
