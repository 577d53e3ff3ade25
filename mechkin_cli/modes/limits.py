"""Limits of coordinates among assemblies and along branches: which modes stand beyond one, and
where one ends a range.

An angle of an assembly has no whole turns of its own: it has those with which it is within its
limits, if there are any.
"""

from __future__ import annotations

from math import ceil, isfinite, ldexp, pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import is_cyclic
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import dimension_of
from mechkin_cli.plan import Demand
from mechkin_cli.session import Ask, RowInputs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.mechanism import Limit, Problem
    from mechkin_cli.modes.circuits import Passage, Walker
    from mechkin_cli.show import Floats


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


class LimitedWalk:
    """A limited coordinate along branches: where it comes to its limit."""

    def __init__(self, walker: Walker, limit: Limit) -> None:
        self.walker, self.limit, self.session = walker, limit, walker.session
        known = self.session.problem.quantities()
        orders = [known[limit.name], known[f"{limit.name}_dot"]]
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
        first, state = start
        before = self.begin(start)
        if before is None or first == end or not isfinite(end):
            return None
        count = tolerances.RANGE_SAMPLES * turns
        parts = np.linspace(0.0, 1.0, count + 1)[:-1]
        # towards a dead centre the coordinate may go as the root of the distance
        near = [1.0 - ldexp(1.0, -2 * k) / count for k in range(1, NEAR_END)]
        steps = first + (end - first) * np.concatenate([parts, near])
        followed = self.walker.follow(steps, state)
        reached = followed.reached
        values = self._read(steps[:reached], followed.guess[:, :reached])[0]
        for k, value in enumerate(values):
            now = self._beside(float(value), before)
            off = float(self.limit.beyond(np.array([now]), self.session.layout.length)[0])
            if off != 0.0:
                at = self.limit.high if off > 0.0 else self.limit.low
                here = max(k - 1, 0)
                return self._refined(followed.guess[:, here], steps[here], steps[k], before, at)
            before = now
        return None

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

    def _refined(self, guess: Floats, first: float, last: float, before: float, at: float) -> float:
        """Newton within a bracket, by bisection where it would leave it."""
        near, far = first, last
        rising = at == self.limit.high
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
