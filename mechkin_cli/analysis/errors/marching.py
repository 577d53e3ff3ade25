"""A free motion over a time in double-double, by collocation at Gauss's points.

In every step the rates of all states and columns are polynomials through their values at the nodes
(`legendre`), found by Picard's iteration: their integrals give places, these close along a chart
and answer with rates. A step is taken where the last coefficients are below a tolerance that is
orders of magnitude below the rounding of doubles. Nothing of this is shared with the integrator
whose rows are measured by it (kernel/src/integrator.hpp). Where forces have a kink the coefficients
do not fall, and steps are cut until what is missed there is below the tolerance, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.errors.free_motion import (
    FreeMotion,
    Places,
    Response,
    is_damper,
    is_working,
)
from mechkin_cli.analysis.errors.legendre import (
    Collocation,
    collocation,
    integrals_to,
    sum_of_products,
    values_at,
)
from mechkin_cli.analysis.errors.reasons import NOT_RESOLVED
from mechkin_cli.kernel.functions import power
from mechkin_cli.tape.double_doubles import DoubleDoubles, joined

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout


class Fineness(NamedTuple):
    """How finely a motion is repeated: nodes of a step, and what its last coefficients may be in
    parts of the way and of the rates so far."""

    nodes: int
    tolerance: float


FINE = Fineness(24, tolerances.REPEATED_STEP)
ROUGH = Fineness(20, tolerances.ROUGHLY_REPEATED_STEP)


@dataclass(frozen=True)
class Step:
    """One step: from where, how long (s), Legendre coefficients of all rates (states and columns,
    nodes), and of the powers of what does work and of what dissipates (2, nodes), kernel units."""

    begin: Places
    length: DoubleDoubles
    rates: DoubleDoubles
    powers: DoubleDoubles

    def at(self, times: DoubleDoubles, turned: Floats) -> tuple[Places, DoubleDoubles]:
        """Places at some moments (places,), not closed, and work put in and lost since the begin
        (2, places)."""
        count = self.rates.shape[1]
        where = (times - self.begin.time) / self.length
        ways = self.length * sum_of_products(integrals_to(where, count), self.rates).T
        states, columns = len(self.begin.states), len(self.begin.rates)
        moved = self.begin.states + ways[:states], self.begin.rates + ways[states:]
        last = values_at(where, self.rates)
        work = self.length * sum_of_products(integrals_to(where, count), self.powers).T
        return Places(times, *moved, last[states : states + columns], turned), work


class March(NamedTuple):
    """A motion: its steps, the time (s) up to which they lead, and why not farther; "" at the
    end."""

    steps: list[Step]
    end: float
    why: str


class Marching:
    """Marches a motion.

    Args:
        motion: what moves.
        layout: of its states and columns.
        turned_at: whole turns (slots, places) that laws and springs go by, at moments (places,) in
            s.
        fineness: of the steps.
    """

    def __init__(
        self,
        motion: FreeMotion,
        layout: Layout,
        turned_at: Callable[[Floats], Floats],
        fineness: Fineness,
    ) -> None:
        self.motion, self.layout, self.turned_at = motion, layout, turned_at
        self.fineness = fineness
        self.gauss: Collocation = collocation(fineness.nodes)
        self.sums = sum_of_products(self.gauss.integrals, self.gauss.coefficients.T)
        self.working = (motion.without(is_working), motion.without(is_damper))
        self.way, self.level = 0.0, 0.0

    def march(self, begin: Places, directions: Floats, end: DoubleDoubles) -> March:
        """From one place with a chart of `directions` (freedoms, columns, 1) to a moment."""
        steps: list[Step] = []
        duration = float((end - begin.time).high[0])
        length = duration * tolerances.FIRST_REPEATED_STEP
        here = self._closed(begin, directions)
        for _ in range(tolerances.MOST_REPEATED_STEPS):
            if here is None:
                break
            rest = end - here.time
            last = float(rest.high[0]) <= length
            size = rest if last else DoubleDoubles(np.array([length]))
            found = self._step(here, size, directions, steps[-1] if steps else None)
            length = float(size.high[0]) * found.factor
            if found.step is None or found.end is None:
                continue
            after = self._closed(found.end, directions)
            if after is None:
                length = 0.5 * float(size.high[0])
                continue
            steps.append(found.step)
            here = after
            if last:
                return March(steps, float(end.high[0]), "")
            directions = orthonormal(self.motion.tangents(here, directions))
        reached = float(steps[-1].begin.time.high[0]) if steps else float(begin.time.high[0])
        return March(steps, reached, NOT_RESOLVED)

    def _closed(self, place: Places, directions: Floats) -> Places | None:
        """One place on the motion, with the accelerations there."""
        found, good = self.motion.settled(place, directions)
        return found if good.all() else None

    def _step(
        self, here: Places, size: DoubleDoubles, directions: Floats, before: Step | None
    ) -> _Tried:
        count, h = self.fineness.nodes, float(size.high[0])
        times = here.time + size * self.gauss.nodes
        turned = self.turned_at(times.high)
        start = joined([here.states, here.rates])
        states = len(here.states)
        rates = self._guess(here, times, before)
        kept = None
        for sweep in range(tolerances.MOST_SWEEPS):
            moved = start + size * sum_of_products(self.sums, rates).T
            places = Places(
                times, moved[:states, :count], moved[states:, :count], rates[states:], turned
            )
            found = self.motion.found(places, directions)
            if not found.good.all():
                return _Tried(None, None, 0.4)
            if sweep in (0, 3):
                kept = self.motion.response(places, directions)
            assert kept is not None
            accelerations, missing = self.motion.corrected(found, kept)
            if not np.isfinite(missing).all():
                return _Tried(None, None, 0.4)
            both = [self.state_rates(found.states, found.rates), accelerations]
            new = joined(both)
            change = self._measured(np.abs((new - rates).high), new.high, states, h)
            rates = new
            if change <= self.fineness.tolerance * tolerances.SWEPT:
                break
        else:
            return _Tried(None, None, 0.5)
        coefficients = sum_of_products(self.gauss.coefficients, rates).T
        sizes = np.abs(coefficients.high)
        tail = (sizes[:, -1] + sizes[:, -2])[:, None]
        missed = self._measured(tail, rates.high, states, h)
        # the last coefficients go as the step to the number of nodes
        ratio = LONGER
        if missed > 0.0:
            ratio = min(LONGER, float(power(self.fineness.tolerance / missed, 1.0 / count)))
        if missed > self.fineness.tolerance:
            return _Tried(None, None, min(0.9 * ratio, 0.7))
        powers = sum_of_products(self.gauss.coefficients, self._powers(places, directions)).T
        step = Step(here, size, coefficients, powers)
        if self._off_between(step, directions, kept) > self.fineness.tolerance:
            return _Tried(None, None, 0.5)
        self.way += h * float(np.abs(rates.high[:states]).max())
        self.level = max(self.level, float(np.abs(moved.high[states:]).max()))
        end = here.time + size
        after, _ = step.at(end, self.turned_at(end.high))
        return _Tried(step, after, 0.9 * ratio)

    def _off_between(self, step: Step, directions: Floats, response: Response) -> float:
        """By how much the forces between the nodes and at both ends ask for other accelerations, in
        parts of the rates so far: a kink that no node sees."""
        nodes = self.gauss.nodes.high
        between = np.concatenate([[0.0], 0.5 * (nodes[1:] + nodes[:-1]), [1.0]])
        times = step.begin.time + step.length * between
        places, _ = step.at(times, self.turned_at(times.high))
        found = self.motion.found(places, directions)
        if not found.good.all():
            return np.inf
        number = np.arange(between.size).clip(max=nodes.size - 1)
        near = Response(response.inertia[number], response.tangents[:, :, number])
        accelerations, _ = self.motion.corrected(found, near)
        off = np.abs((accelerations - places.accelerations).high)
        h = float(step.length.high[0])
        level = max(self.level, h * float(np.abs(places.accelerations.high).max()))
        return h * float(off.max()) / level if level > 0.0 else 0.0

    def _guess(self, here: Places, times: DoubleDoubles, before: Step | None) -> DoubleDoubles:
        """All rates at the nodes as the last step would go on, or as they are."""
        if before is None:
            rates = [self.state_rates(here.states, here.rates), here.accelerations]
            found = joined(rates)
            return DoubleDoubles(np.repeat(found.high, times.size, axis=1))
        where = (times - before.begin.time) / before.length
        return values_at(where, before.rates)

    def _measured(self, off: Floats, rates: Floats, states: int, h: float) -> float:
        """What rates are off by, in parts of the way and of the columns' rates so far."""
        way = max(self.way, h * float(np.abs(rates[:states]).max()))
        level = max(self.level, h * float(np.abs(rates[states:]).max()))
        parts = [
            h * float(np.max(part)) / size
            for part, size in ((off[:states], way), (off[states:], level))
            if size > 0.0
        ]
        return max(parts, default=0.0)

    def state_rates(self, states: DoubleDoubles, rates: DoubleDoubles) -> DoubleDoubles:
        """Derivatives of the states by the rates of the columns: of an orientation (0, w) q/2."""
        found = DoubleDoubles(np.zeros(states.shape))
        for carrier in self.layout.carriers:
            kind, s, c = carrier.part.type, carrier.state, carrier.column
            freedoms = len(kind.freedoms)
            if kind.states == freedoms:
                found[s : s + freedoms] = rates[c : c + freedoms]
                continue
            w, (a, x, y, z) = rates[c : c + 3], states[s : s + 4]
            found[s] = -0.5 * (w[0] * x + w[1] * y + w[2] * z)
            found[s + 1] = 0.5 * (w[0] * a + w[1] * z - w[2] * y)
            found[s + 2] = 0.5 * (w[1] * a + w[2] * x - w[0] * z)
            found[s + 3] = 0.5 * (w[2] * a + w[0] * y - w[1] * x)
        return found

    def _powers(self, places: Places, directions: Floats) -> DoubleDoubles:
        """Powers (2, places) of what has no potential, and of what dampers take."""
        found = DoubleDoubles(np.zeros((2, places.time.size)))
        for number, (fewer, sign) in enumerate(zip(self.working, (1.0, -1.0), strict=True)):
            if fewer is None:
                continue
            forces = fewer.found(places, directions).forces
            moved = fewer.along(directions, places.rates)
            total = forces[0] * moved[0]
            for k in range(1, len(forces)):
                total = total + forces[k] * moved[k]
            found[number] = sign * total
        return found


LONGER = 4.0
"""What the next step may be longer by at most."""


class _Tried(NamedTuple):
    """A step with the place at its end, None where it is refused, and how much longer the next one
    may be."""

    step: Step | None
    end: Places | None
    factor: float


def orthonormal(rows: Floats) -> Floats:
    """Gram and Schmidt's basis of the same space (freedoms, columns, 1)."""
    found: list[Floats] = []
    for row in rows:
        rest = row / sqrt(_product(row, row))
        for other in found:
            rest = rest - _product(rest, other) * other
        found.append(rest / sqrt(_product(rest, rest)))
    return np.array(found)


def _product(one: Floats, other: Floats) -> float:
    """The inner product of two rows (columns, 1), in order."""
    total = 0.0
    for x, y in zip(one[:, 0].tolist(), other[:, 0].tolist(), strict=True):
        total += x * y
    return total
