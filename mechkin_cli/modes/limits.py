"""Limits of coordinates among assemblies and along branches: which modes stand beyond one, and
where one ends a range.

An angle of an assembly has no whole turns of its own: it has those with which it is within its
limits, if there are any.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil, inf, isfinite, ldexp, nan, pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import is_cyclic
from mechkin_cli.diagnostics import Diagnostic, Number, Place
from mechkin_cli.mechanism import dimension_of
from mechkin_cli.modes.circuits import End, Stationary
from mechkin_cli.plan import Demand, TrackEnd
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, RowInputs

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from mechkin_cli.mechanism import Limit, Problem
    from mechkin_cli.modes.circuits import Passage, Walker
    from mechkin_cli.show import Floats


BELOW, ABOVE, BEYOND, NOWHERE = "below", "above", "beyond", "nowhere"
"""Where a range ends at a limit, that a mode stands beyond one, and that its branch is nowhere
within all."""


class LimitsMet:
    """The limits that ranges of modes meet."""

    def __init__(self) -> None:
        self._met: dict[tuple[str, Place], dict[str, list[str]]] = {}

    def add(self, limit: Limit, side: str, mode: str) -> None:
        """A mode's range ends at a limit `BELOW` or `ABOVE`, or the mode stands `BEYOND` it, where
        its branch may be `NOWHERE` within all limits."""
        self._met.setdefault((limit.name, limit.place), {}).setdefault(mode, []).append(side)

    def notes(self, order: list[str]) -> list[Diagnostic]:
        """A note for each limit and all modes that meet it alike, in the order of their names."""
        found: dict[tuple[str, Place, tuple[str, ...]], list[str]] = {}
        for (name, place), modes in self._met.items():
            for mode in sorted(modes, key=order.index):
                sides = tuple(s for s in (BELOW, ABOVE, BEYOND, NOWHERE) if s in modes[mode])
                found.setdefault((name, place, sides), []).append(mode)
        return [
            Diagnostic("range-at-limit", "note", _met_words(name, sides, modes), place)
            for (name, place, sides), modes in found.items()
        ]


def _met_words(name: str, sides: tuple[str, ...], modes: list[str]) -> str:
    several = len(modes) > 1
    known = f"modes {', '.join(modes[:-1])} and {modes[-1]}" if several else f"mode {modes[0]}"
    stand = "stand" if several else "stands"
    if NOWHERE in sides:
        whose = "their whole branches" if several else "its whole branch"
        return f"a limit of {name}: {known} {stand} beyond it, {whose} beyond some limit"
    if BEYOND in sides:
        ranges = "their ranges are the nearest" if several else "its range is the nearest one"
        return f"a limit of {name}: {known} {stand} beyond it, {ranges} within all limits"
    return f"a limit of {name} ends the range{'s' * several} of {known} {' and '.join(sides)}"


def admitted(problem: Problem, limit: Limit, value: float, length: float) -> float | None:
    """The value (rad, m) of a limited coordinate in the turn in which its limits admit it; None
    where they do not."""
    if is_cyclic(problem.mechanism, limit.name):
        turn = 2.0 * pi
        if isfinite(limit.low):
            value += turn * ceil((limit.low - value) / turn - tolerances.AT_LIMIT)
        elif value > limit.high:
            value -= turn * ceil((value - limit.high) / turn - tolerances.AT_LIMIT)
    off = float(limit.beyond(np.array([value]), length)[0])
    return value if off == 0.0 else None


def beyond_notes(
    problem: Problem, names: list[str], coordinates: dict[str, Floats], length: float
) -> list[Diagnostic]:
    """The modes that stand beyond limits, by their coordinates (rad, m)."""
    notes = []
    for limit in problem.limits:
        values = coordinates.get(limit.name)
        for name, value in zip(names, () if values is None else values.tolist(), strict=False):
            if admitted(problem, limit, value, length) is not None:
                continue
            units, dimension = problem.units, dimension_of(limit.coordinate)
            told = float(units.from_si(value, dimension))
            ends = [units.text(end, dimension) for end in (limit.low, limit.high) if isfinite(end)]
            notes.append(
                Diagnostic(
                    "mode-beyond-limit",
                    "note",
                    f"mode {name} stands beyond a limit of {limit.name}",
                    limit.place,
                    units.text(value, dimension),
                    " to ".join(ends),
                    numbers=(Number(limit.name, told, units.label(dimension)),),
                )
            )
    return notes


class _Course(NamedTuple):
    """A coordinate at places along a branch, and at its extremes between them: the input (places,)
    in kernel units, the coordinate (places,) in SI without jumps of whole turns, and the states
    (states, places)."""

    inputs: Floats
    values: Floats
    states: Floats


class LimitedWalk:
    """A limited coordinate along branches: where it comes to its limit, and where it comes back."""

    def __init__(self, walker: Walker, limit: Limit) -> None:
        self.walker, self.limit, self.session = walker, limit, walker.session
        known = self.session.problem.quantities()
        orders = [known[limit.name], known[f"{limit.name}_dot"]]
        self.stationary = Stationary(walker, known[limit.name])
        self.readout = self.session.readout(orders)
        self.slots = [self.readout.slots[quantity.name].start for quantity in orders]
        self.turn = 2.0 * pi if is_cyclic(self.session.problem.mechanism, limit.name) else None

    def begin(self, start: Passage) -> float | None:
        """The coordinate at a place, as `admitted`."""
        value = float(self._read(np.array([start[0]]), start[1][:, None])[0, 0])
        return admitted(self.session.problem, self.limit, value, self.session.layout.length)

    def reached(self, start: Passage, end: float, turns: int = 1) -> float | None:
        """The input at the first place on the way to an end, from one within the limits, at which
        the coordinate comes to a limit and goes beyond. The way may be some full turns."""
        before = self.begin(start)
        if before is None or start[0] == end or not isfinite(end):
            return None
        course = self._course(start, end, before, turns)
        off = self.limit.beyond(course.values, self.session.layout.length)
        beyond = np.flatnonzero(off)
        if not beyond.size:
            return None
        k = int(beyond[0])
        return self._passed(course, k, self.limit.high if off[k] > 0.0 else self.limit.low)

    def passed(self, start: Passage, end: float) -> list[float]:
        """The inputs on the way to an end at which the coordinate passes one of its limits, of an
        angle in any turn; in their order."""
        if start[0] == end or not isfinite(end):
            return []
        first = float(self._read(np.array([start[0]]), start[1][:, None])[0, 0])
        course = self._course(start, end, first)
        places: list[float] = []
        for k in range(1, course.values.size):
            one, other = course.values[k - 1 : k + 1].tolist()
            levels = self._levels(min(one, other), max(one, other))
            own = [self._passed(course, k, at) for at in levels if at != one]
            places += sorted(own, reverse=end < start[0])
        return places

    def _course(self, start: Passage, end: float, value: float, turns: int = 1) -> _Course:
        """The coordinate from a place, where it has a value, on the way to an end."""
        first, state = start
        count = tolerances.RANGE_SAMPLES * turns
        parts = np.linspace(0.0, 1.0, count + 1)[:-1]
        # towards a dead centre the coordinate may go as the root of the distance
        near = [1.0 - ldexp(1.0, -2 * k) / count for k in range(1, NEAR_END)]
        steps = first + (end - first) * np.concatenate([parts, near])
        followed = self.walker.follow(steps, state)
        steps, states = steps[: followed.reached], followed.guess[:, : followed.reached]
        found, rates = self._read(steps, states)
        values: list[float] = []
        for now in found.tolist():
            value = self._beside(now, value)
            values.append(value)
        inner = list(self._extremes(steps, np.array(values), rates, states))
        places = [k for k, _, _, _ in inner]
        return _Course(
            np.insert(steps, places, [at for _, at, _, _ in inner]),
            np.insert(values, places, [extreme for _, _, extreme, _ in inner]),
            np.insert(states, places, np.array([one for *_, one in inner]).T, axis=1)
            if inner
            else states,
        )

    def _extremes(
        self, steps: Floats, values: Floats, rates: Floats, states: Floats
    ) -> Iterator[tuple[int, float, float, Floats]]:
        """Extremes of the coordinate between places that might lie beyond a limit: the number of
        the place behind each, its input, the coordinate and the state (states,)."""
        far = np.abs(np.diff(steps)) * np.maximum(np.abs(rates[:-1]), np.abs(rates[1:]))
        for k in np.flatnonzero(rates[:-1] * rates[1:] < 0.0).tolist():
            low, high = sorted(values[k : k + 2].tolist())
            if not self._levels(low - far[k], high + far[k]):
                continue
            place = self.stationary.between(states[:, k], steps[k], steps[k + 1])
            if place is not None:
                state = self.walker.follow(np.array([steps[k], place[0]]), states[:, k]).state
                yield k + 1, place[0], self._beside(place[1], float(values[k])), state

    def _levels(self, low: float, high: float) -> list[float]:
        """The limits between two values, of an angle in all turns."""
        ends = [end for end in (self.limit.low, self.limit.high) if isfinite(end)]
        if self.turn is not None:
            ends = [
                end + self.turn * k
                for end in ends
                for k in range(ceil((low - end) / self.turn), ceil((high - end) / self.turn) + 1)
            ]
        return [end for end in ends if low <= end <= high]

    def _passed(self, course: _Course, k: int, at: float) -> float:
        """The input at which the coordinate is `at`, between the place before a number and it."""
        before = max(k - 1, 0)
        one, other = course.inputs[before], course.inputs[k]
        value = float(course.values[before])
        rising = bool(course.values[k] > at)
        return self._refined(course.states[:, before], one, other, value, at, rising)

    def reached_later(self, start: Passage, end: float) -> float | None:
        """The same beyond a full turn of the input, which leads to `end`: where a coordinate that
        goes on with every turn comes to its limit; None where it comes back, or has no limit
        there."""
        before, turned = self.begin(start), end - start[0]
        if before is None or not isfinite(turned):
            return None
        steps = start[0] + turned * np.linspace(0.0, 1.0, tolerances.RANGE_SAMPLES + 1)
        followed = self.walker.follow(steps, start[1])
        if followed.reached < steps.size:
            return None
        last = before
        for value in self._read(steps, followed.guess)[0]:
            last = self._beside(float(value), last)
        advance = last - before
        limit = self.limit.high if advance > 0.0 else self.limit.low
        if abs(advance) <= tolerances.AT_LIMIT or not isfinite(limit):
            return None
        turns = min(ceil((limit - before) / advance) + 1, tolerances.MOST_COUPLED_TURNS)
        return self.reached(start, start[0] + turns * turned, turns)

    def _beside(self, value: float, before: float) -> float:
        """The angle in the turn in which it is next to the one before."""
        if self.turn is None:
            return value
        return value + self.turn * float(np.rint((before - value) / self.turn))

    def _read(self, values: Floats, guess: Floats) -> Floats:
        """The coordinate and its derivative by the input, (2, places)."""
        inputs, rates, _ = np.ascontiguousarray(self.walker.at(values))
        batch = self.session.run(
            RowInputs(inputs, guess, rates), Ask(Demand.VELOCITY, self.readout)
        )
        assert batch.outputs is not None
        return batch.outputs[self.slots]

    def _refined(
        self,
        guess: Floats,
        first: float,
        last: float,
        before: float,
        at: float,
        rising: bool,
    ) -> float:
        """Newton within a bracket, by bisection where it would leave it."""
        near, far = first, last
        value = 0.5 * (first + last)
        for _ in range(tolerances.DEAD_CENTRE_ITERATIONS):
            state = self.walker.follow(np.array([first, value]), guess).state
            found, rate = self._read(np.array([value]), state[:, None])[:, 0].tolist()
            off = self._beside(found, before) - at
            is_beyond = off > 0.0 if rising else off < 0.0
            near, far = (near, value) if is_beyond else (value, far)
            following = value - off / rate if rate != 0.0 else np.inf
            if not min(near, far) < following < max(near, far):
                following = 0.5 * (near + far)
            if abs(following - value) <= tolerances.DEAD_CENTRE_STEP:
                return float(following)
            value = following
        return value


def limited_ends(
    name: str,
    walks: Sequence[LimitedWalk],
    start: Passage,
    ends: tuple[End, End],
    met: LimitsMet,
) -> tuple[End, End]:
    """Where limits of coordinates end a branch, else its own ends: about a place or, of one beyond
    a limit, about the nearest place within all limits.

    Args:
        name: of the mode that stands at the place.
        walks: all limited coordinates.
        start: the place.
        ends: the branch's, below and above.
        met: takes the limits that are met.
    """
    left = [walk.limit for walk in walks if walk.begin(start) is None]
    inner = _nearest_within(walks, start, [end.value for end in ends]) if left else start
    for limit in left:
        met.add(limit, NOWHERE if inner is None else BEYOND, name)
    if inner is None:
        nowhere = End("nowhere", nan)
        return nowhere, nowhere
    found: list[End] = []
    for end, side in zip(ends, (BELOW, ABOVE), strict=True):
        first = first_limit(walks, inner, end.value, goes_on=end.kind == "far")
        if first is not None:
            at, walk = first
            end = End("limit", at)
            if walk.limit not in left:
                met.add(walk.limit, side, name)
        found.append(end)
    return found[0], found[1]


def _nearest_within(
    walks: Sequence[LimitedWalk], start: Passage, ends: Sequence[float]
) -> Passage | None:
    """The middle of the stretch of a branch in which all limits hold that is nearest to a place, on
    the ways from there to some ends; of two as near that of the last end. None where there is
    none."""
    nearest, found = inf, None
    for end in reversed(ends):
        passed = {at for walk in walks for at in walk.passed(start, end)}
        places = sorted((start[0], *passed, end), key=lambda at: abs(at - start[0]))
        for one, other in pairwise(places):
            middle = 0.5 * (one + other)
            followed = walks[0].walker.follow(np.array([start[0], middle]), start[1])
            place = middle, followed.state
            if followed.end != TrackEnd.FINISHED:
                break
            if all(walk.begin(place) is not None for walk in walks):
                away = abs(one - start[0])
                if away < nearest - tolerances.DEAD_CENTRE_STEP:
                    nearest, found = away, place
                break
    return found


NEAR_END = 13
"""Places beside the last sample that come nearer to an end by quarters."""


def first_limit(
    walks: Sequence[LimitedWalk], start: Passage, end: float, *, goes_on: bool
) -> tuple[float, LimitedWalk] | None:
    """The input at the first limit on the way to an end, and what comes to it; where the way goes
    on, as behind a full turn, also beyond the end. None where there is none."""
    found = [(at, walk) for walk in walks if (at := walk.reached(start, end)) is not None]
    if not found and goes_on:
        later = [(walk.reached_later(start, end), walk) for walk in walks]
        found = [(at, walk) for at, walk in later if at is not None]
    return min(found, key=lambda one: abs(one[0] - start[0]), default=None)
