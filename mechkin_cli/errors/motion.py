"""A free motion in double-double: at some moments, and over a time by Gauss's collocation.

At given moments and places (`ForcedMotion`) the kernel closes a guess along a chart through it and
gives what would have to act along the chart for the supposed accelerations; the true ones leave
nothing (docs/numerics.md, Free motion).

Over a time (`Marching`) the rates of all states and columns are in every step polynomials through
their values at Gauss's nodes, by Picard's iteration: their integrals give places, these
close along a chart and give new rates. A step is taken where the last coefficients are below a
tolerance that is orders of magnitude below the rounding of doubles. Nothing of this is shared with
the integrator whose rows are measured by it (kernel/core/integrator). Where forces have a kink the
coefficients do not fall, and steps are cut until what is missed there is below the tolerance,
too.

A function on [0, 1] is taken for the polynomial sum of a_k P_k(2 c - 1) through its values at the
nodes (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.7). How fast the
a_k fall tells how well.
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from functools import cache
from math import pi, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.errors.rows import NOT_RESOLVED, as_number, as_parts
from mechkin_cli.kernel.functions import cos, power
from mechkin_cli.mechanism import Load
from mechkin_cli.plan import Demand, Layout
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.response import with_loads
from mechkin_cli.session import Ask, Chart, Precise, PreciseConstants, RowInputs, Session
from mechkin_cli.tape import DoubleDoubles, eliminate, joined, stacked

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from mechkin_cli.show import Bools, Floats


DIGITS = 50
"""Of the decimals that nodes are computed in; double-double has 32."""


@cache
def collocation(count: int) -> tuple[DoubleDoubles, DoubleDoubles, DoubleDoubles]:
    """Of a number of nodes: these (nodes,) in (0, 1); the matrix (nodes, nodes) from values there
    to Legendre coefficients; that (nodes + 1, nodes) from coefficients to the integrals from 0 to
    each node and to 1."""
    with localcontext() as context:
        context.prec = DIGITS
        roots = [_root(count, k) for k in range(count)]
        values = [_legendre(count + 1, x) for x in roots]
        # Gauss's weights on [-1, 1]
        weights = [
            2 / ((1 - x * x) * (count * (x * v[count] - v[count - 1]) / (x * x - 1)) ** 2)
            for x, v in zip(roots, values, strict=True)
        ]
        coefficients = [
            [(2 * k + 1) * w * v[k] / 2 for w, v in zip(weights, values, strict=True)]
            for k in range(count)
        ]
        ends = [*values, [Decimal(1)] * (count + 2)]
        integrals = [[_integral(k, v) for k in range(count)] for v in ends]
        nodes = [(x + 1) / 2 for x in roots]
    return _double_doubles(nodes), _double_doubles(coefficients), _double_doubles(integrals)


def integrals_to(places: DoubleDoubles, count: int) -> DoubleDoubles:
    """From `count` coefficients to the integrals from 0 to some places (places, count), which may
    lie outside [0, 1]."""
    p = _polynomials(places, count + 1)
    integrals = [places + 0.0]
    integrals += [(p[k + 1] - p[k - 1]) / (2.0 * (2.0 * k + 1.0)) for k in range(1, count)]
    return stacked(integrals, axis=1)


def values_at(places: DoubleDoubles, coefficients: DoubleDoubles) -> DoubleDoubles:
    """Polynomials of coefficients (polynomials, count) at some places (polynomials, places)."""
    p = _polynomials(places, coefficients.shape[1])
    return sum_of_products(stacked(p, axis=1), coefficients).T


def _polynomials(places: DoubleDoubles, count: int) -> list[DoubleDoubles]:
    """P_0 to P_(count - 1) of 2 c - 1 at some places."""
    x = 2.0 * places - 1.0
    p = [DoubleDoubles(np.ones(places.shape)), x]
    for k in range(1, count - 1):
        p.append(((2.0 * k + 1.0) * x * p[k] - float(k) * p[k - 1]) / float(k + 1))
    return p


def sum_of_products(matrix: DoubleDoubles, columns: DoubleDoubles) -> DoubleDoubles:
    """The products (rows, columns) of a matrix (rows, terms) with columns (columns, terms), summed
    in pairs."""
    terms = matrix[:, None, :] * columns[None, :, :]
    while terms.shape[2] > 1:
        half = terms.shape[2] // 2
        paired = terms[:, :, :half] + terms[:, :, half : 2 * half]
        terms = joined([paired, terms[:, :, 2 * half :]], axis=2)
    return terms[:, :, 0]


def _root(count: int, number: int) -> Decimal:
    """A root of P_count by Newton's method, in rising order."""
    x = Decimal(-float(cos(pi * (number + 0.75) / (count + 0.5))))
    for _ in range(8):
        p = _legendre(count, x)
        slope = count * (x * p[count] - p[count - 1]) / (x * x - 1)
        x -= p[count] / slope
    return x


def _legendre(highest: int, x: Decimal) -> list[Decimal]:
    """P_0 to P_highest."""
    p = [Decimal(1), x]
    for k in range(1, highest):
        p.append(((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1))
    return p


def _integral(degree: int, p: Sequence[Decimal]) -> Decimal:
    """The integral of P_degree(2 c - 1) from c = 0 to where the polynomials are p."""
    if degree == 0:
        return (p[1] + 1) / 2
    return (p[degree + 1] - p[degree - 1]) / (2 * (2 * degree + 1))


def _double_doubles(numbers: Sequence[Sequence[Decimal]] | Sequence[Decimal]) -> DoubleDoubles:
    decimals = np.array(numbers, dtype=object)
    high = decimals.astype(np.float64)
    with localcontext() as context:
        context.prec = DIGITS
        rest = np.vectorize(lambda x, h: float(x - Decimal(h)), otypes=[np.float64])
        return DoubleDoubles(high, rest(decimals, high))


MOVING = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES

CORRECTIONS = 3
"""Of accelerations by a reduced inertia in doubles: each leaves 1e-15 of the one before."""


class MotionPlaces(NamedTuple):
    """What a motion is supposed to be at some moments: states (states, places), rates and
    accelerations (columns, places) in kernel units, time (places,) in s; what whole turns go by
    (turn slots, places) is of doubles."""

    time: DoubleDoubles
    states: DoubleDoubles
    rates: DoubleDoubles
    accelerations: DoubleDoubles
    turned: Floats

    def at(self, chosen: Any) -> MotionPlaces:
        """Some of the places."""
        return MotionPlaces(
            self.time[chosen],
            self.states[:, chosen],
            self.rates[:, chosen],
            self.accelerations[:, chosen],
            np.ascontiguousarray(self.turned[:, chosen]),
        )


ClosedPlaces = tuple[MotionPlaces, DoubleDoubles, "Bools"]
"""Closed places, what would have to act along the chart (freedoms, places), and which of them are
good: closed, and all loads have values there."""


UnitResponse = tuple["Floats", "Floats"]
"""The response of places to unit accelerations along the chart, in doubles: forces (places,
freedoms, freedoms), which are the reduced inertia, and accelerations of the columns (freedoms,
columns, places)."""


class ForcedMotion:
    """A mechanism that moves under forces.

    Args:
        session: of the free motion.
        precise: the numbers of its text.
        held: (held inputs, 2) of the locked idle freedoms, in kernel units.
    """

    def __init__(self, session: Session, precise: Precise, held: Floats) -> None:
        self.session, self.precise = session, precise
        self.constants = precise.constants(session)
        self.held = held
        self.freedoms = session.plan.charts

    def closed(self, places: MotionPlaces, directions: Floats) -> ClosedPlaces:
        """Places closed along the chart of `directions` (freedoms, columns, places; or 1 for all
        of them), with their supposed motion."""
        return self._run(places, directions, self.along(directions, places.accelerations))

    def response(self, places: MotionPlaces, directions: Floats) -> UnitResponse:
        """The response of places to unit accelerations along the chart."""
        n, count = self.freedoms, places.time.size
        copies = np.tile(np.arange(count), n + 1)
        seconds = np.zeros((n, (n + 1) * count))
        for k in range(n):
            seconds[k, (k + 1) * count : (k + 2) * count] = 1.0
        along = directions if directions.shape[2] == 1 else directions[:, :, copies]
        closed, acting, _ = self._run(places.at(copies), along, DoubleDoubles(seconds))
        forces = acting.high.reshape(n, n + 1, count)
        second = closed.accelerations.high.reshape(-1, n + 1, count)
        inertia = (forces[:, 1:] - forces[:, :1]).transpose(2, 0, 1)
        return inertia, (second[:, 1:] - second[:, :1]).transpose(1, 0, 2)

    def tangents(self, place: MotionPlaces, directions: Floats) -> Floats:
        """Rates of the columns (freedoms, columns, 1) by unit rates along the chart at one
        place."""
        n = self.freedoms
        copies = place.at(np.zeros(n, dtype=np.intp))
        still = np.zeros_like(copies.rates.high)
        moving = copies._replace(accelerations=DoubleDoubles(still))
        closed, _, _ = self._run(moving, directions, DoubleDoubles(np.zeros((n, n))), np.eye(n))
        return np.ascontiguousarray(closed.rates.high.T)[:, :, None]

    def corrected(
        self, closed: MotionPlaces, forces: DoubleDoubles, response: UnitResponse
    ) -> tuple[DoubleDoubles, Floats]:
        """The accelerations of the columns that leave no `forces` to act, as far as a `response` is
        right; and by how much they differ, in parts of unit accelerations (freedoms, places)."""
        inertia, tangents = response
        with np.errstate(all="ignore"):
            missing = -eliminate(inertia, forces.high.T).T
        step = tangents[0] * missing[0]
        for k in range(1, len(missing)):
            step = step + tangents[k] * missing[k]
        return closed.accelerations + step, missing

    @staticmethod
    def along(directions: Floats, columns: DoubleDoubles) -> DoubleDoubles:
        """Rates or accelerations of columns (columns, places) along a chart (freedoms, places)."""
        total = columns[0][None] * directions[:, 0]
        for k in range(1, len(columns)):
            total = total + columns[k][None] * directions[:, k]
        return total

    def settled(self, places: MotionPlaces, directions: Floats) -> tuple[MotionPlaces, Bools]:
        """Places closed, with the accelerations that follow from the forces there; and which of
        them are."""
        closed, forces, good = self.closed(places, directions)
        response = self.response(places, directions)
        for _ in range(CORRECTIONS):
            accelerations, missing = self.corrected(closed, forces, response)
            places = closed._replace(accelerations=accelerations)
            closed, forces, still_good = self.closed(places, directions)
            good = good & np.isfinite(missing).all(axis=0) & still_good
        return places, good

    def without(self, dropped: Callable[[Load], bool]) -> ForcedMotion | None:
        """The same mechanism without some of its loads; None where it has none of them."""
        mechanism = self.session.problem.mechanism
        loads = tuple(load for load in mechanism.loads if not dropped(load))
        if len(loads) == len(mechanism.loads):
            return None
        fewer = replace(self.session.problem, mechanism=replace(mechanism, loads=loads))
        return ForcedMotion(with_loads(self.session, fewer), self.precise, self.held)

    def _run(
        self,
        places: MotionPlaces,
        directions: Floats,
        seconds: DoubleDoubles,
        rates: Floats | None = None,
    ) -> ClosedPlaces:
        count, plan = places.time.size, self.session.plan
        moved = self.along(directions, places.rates) if rates is None else DoubleDoubles(rates)
        spread = np.broadcast_to(directions, (*directions.shape[:2], count))
        direction = np.array(spread).reshape(-1, count)
        chart = Chart(direction, as_parts(moved), as_parts(seconds), np.zeros((0, count)))
        inputs = np.repeat(self.held[:, :, None], count, axis=2)
        still = np.zeros((plan.inputs, 2, count))
        rows = RowInputs(
            inputs,
            as_parts(places.states),
            rates=still,
            accelerations=still,
            full=inputs,
            turned=places.turned,
            time=np.stack([places.time.high, places.time.low]),
            chart=chart,
        )
        ask = Ask(MOVING, derivatives=True)
        batch = self.session.run(rows, ask, PreciseConstants(self.constants))
        assert batch.first is not None
        assert batch.second is not None
        good = batch.good | self.session.is_redundant
        if batch.undefined is not None:
            good &= batch.undefined == 0
        acting = batch.chart_forces
        assert acting is not None
        for part in (batch.states, batch.first, batch.second, acting):
            good &= np.isfinite(part).all(axis=(0, 1))
        states, first, second = map(as_number, (batch.states, batch.first, batch.second))
        closed = MotionPlaces(places.time, states, first, second, places.turned)
        return closed, as_number(acting), good


Fineness = tuple[int, float]
"""How finely a motion is repeated: nodes of a step, and what its last coefficients may be in parts
of the path and of the rates so far."""

FINE: Fineness = (24, tolerances.REPEATED_STEP)
ROUGH: Fineness = (20, tolerances.ROUGHLY_REPEATED_STEP)


@dataclass(frozen=True)
class LegendreStep:
    """One step: from where, how long (s), Legendre coefficients of all rates (states and columns,
    nodes), and of the powers of what does work and of what dissipates (2, nodes), kernel units."""

    begin: MotionPlaces
    length: DoubleDoubles
    rates: DoubleDoubles
    powers: DoubleDoubles

    def at(self, times: DoubleDoubles, turned: Floats) -> tuple[MotionPlaces, DoubleDoubles]:
        """Places at some moments (places,), not closed, and work put in and lost since the begin
        (2, places)."""
        count = self.rates.shape[1]
        where = (times - self.begin.time) / self.length
        steps = self.length * sum_of_products(integrals_to(where, count), self.rates).T
        states, columns = len(self.begin.states), len(self.begin.rates)
        moved = self.begin.states + steps[:states], self.begin.rates + steps[states:]
        last = values_at(where, self.rates)
        work = self.length * sum_of_products(integrals_to(where, count), self.powers).T
        return MotionPlaces(times, *moved, last[states : states + columns], turned), work


class Marching:
    """The steps of a motion.

    Args:
        motion: what moves.
        layout: of its states and columns.
        turned_at: whole turns (slots, places) that laws and springs depend on, at moments (places,)
            in s.
        fineness: of the steps.
    """

    def __init__(
        self,
        motion: ForcedMotion,
        layout: Layout,
        turned_at: Callable[[Floats], Floats],
        fineness: Fineness,
    ) -> None:
        self.motion, self.layout, self.turned_at = motion, layout, turned_at
        self.nodes, self.tolerance = fineness
        self.gauss, self.to_coefficients, integrals = collocation(self.nodes)
        self.sums = sum_of_products(integrals, self.to_coefficients.T)
        # what a load gives counts as work where it has no potential and is no damper
        self.working = (
            motion.without(lambda load: not (load.has_potential or load.dissipates)),
            motion.without(lambda load: load.dissipates),
        )
        self.path, self.level = 0.0, 0.0

    def march(
        self, begin: MotionPlaces, directions: Floats, end: DoubleDoubles
    ) -> tuple[list[LegendreStep], str]:
        """From one place with a chart of `directions` (freedoms, columns, 1) to a moment: the
        steps, and why they lead no farther; "" at the end."""
        steps: list[LegendreStep] = []
        duration = float((end - begin.time).high[0])
        length = duration * tolerances.FIRST_REPEATED_STEP
        here = self._closed(begin, directions)
        for _ in range(tolerances.MOST_REPEATED_STEPS):
            if here is None:
                break
            rest = end - here.time
            last = float(rest.high[0]) <= length
            size = rest if last else DoubleDoubles(np.array([length]))
            step, factor = self._step(here, size, directions, steps[-1] if steps else None)
            length = float(size.high[0]) * factor
            if step is None:
                continue
            moment = here.time + size
            reached, _ = step.at(moment, self.turned_at(moment.high))
            after = self._closed(reached, directions)
            if after is None:
                length = 0.5 * float(size.high[0])
                continue
            steps.append(step)
            here = after
            if last:
                return steps, ""
            directions = orthonormal(self.motion.tangents(here, directions))
        return steps, NOT_RESOLVED

    def _closed(self, place: MotionPlaces, directions: Floats) -> MotionPlaces | None:
        """One place on the motion, with the accelerations there."""
        settled, good = self.motion.settled(place, directions)
        return settled if good.all() else None

    def _step(
        self,
        here: MotionPlaces,
        size: DoubleDoubles,
        directions: Floats,
        before: LegendreStep | None,
    ) -> tuple[LegendreStep | None, float]:
        """A step, None where it is refused, and how much longer the next one may be."""
        count, h = self.nodes, float(size.high[0])
        times = here.time + size * self.gauss
        turned = self.turned_at(times.high)
        start = joined([here.states, here.rates])
        states = len(here.states)
        rates = self._guess(here, times, before)
        response = None
        for sweep in range(tolerances.MOST_SWEEPS):
            moved = start + size * sum_of_products(self.sums, rates).T
            places = MotionPlaces(
                times, moved[:states, :count], moved[states:, :count], rates[states:], turned
            )
            closed, forces, good = self.motion.closed(places, directions)
            if not good.all():
                return None, 0.4
            if sweep in (0, 3):
                response = self.motion.response(places, directions)
            assert response is not None
            accelerations, missing = self.motion.corrected(closed, forces, response)
            if not np.isfinite(missing).all():
                return None, 0.4
            new = joined([state_rates(self.layout, closed.states, closed.rates), accelerations])
            change = self._measured(np.abs((new - rates).high), new.high, states, h)
            rates = new
            if change <= self.tolerance * tolerances.SWEPT:
                break
        else:
            return None, 0.5
        coefficients = sum_of_products(self.to_coefficients, rates).T
        sizes = np.abs(coefficients.high)
        tail = (sizes[:, -1] + sizes[:, -2])[:, None]
        missed = self._measured(tail, rates.high, states, h)
        # the last coefficients go as the step to the number of nodes
        ratio = LONGER
        if missed > 0.0:
            ratio = min(LONGER, float(power(self.tolerance / missed, 1.0 / count)))
        if missed > self.tolerance:
            return None, min(0.9 * ratio, 0.7)
        powers = sum_of_products(self.to_coefficients, self._powers(places, directions)).T
        step = LegendreStep(here, size, coefficients, powers)
        if self._off_between(step, directions, response) > self.tolerance:
            return None, 0.5
        self.path += h * float(np.abs(rates.high[:states]).max())
        self.level = max(self.level, float(np.abs(moved.high[states:]).max()))
        return step, 0.9 * ratio

    def _off_between(self, step: LegendreStep, directions: Floats, response: UnitResponse) -> float:
        """By how much the forces between the nodes and at both ends need other accelerations, in
        parts of the rates so far: a kink that no node sees."""
        nodes = self.gauss.high
        between = np.concatenate([[0.0], 0.5 * (nodes[1:] + nodes[:-1]), [1.0]])
        times = step.begin.time + step.length * between
        places, _ = step.at(times, self.turned_at(times.high))
        closed, forces, good = self.motion.closed(places, directions)
        if not good.all():
            return np.inf
        number = np.arange(between.size).clip(max=nodes.size - 1)
        near = (response[0][number], response[1][:, :, number])
        accelerations, _ = self.motion.corrected(closed, forces, near)
        off = np.abs((accelerations - places.accelerations).high)
        h = float(step.length.high[0])
        level = max(self.level, h * float(np.abs(places.accelerations.high).max()))
        return h * float(off.max()) / level if level > 0.0 else 0.0

    def _guess(
        self, here: MotionPlaces, times: DoubleDoubles, before: LegendreStep | None
    ) -> DoubleDoubles:
        """All rates at the nodes as the last step would go on, or as they are."""
        if before is None:
            rates = joined([state_rates(self.layout, here.states, here.rates), here.accelerations])
            return DoubleDoubles(np.repeat(rates.high, times.size, axis=1))
        where = (times - before.begin.time) / before.length
        return values_at(where, before.rates)

    def _measured(self, off: Floats, rates: Floats, states: int, h: float) -> float:
        """What rates are off by, in parts of the path and of the columns' rates so far."""
        path = max(self.path, h * float(np.abs(rates[:states]).max()))
        level = max(self.level, h * float(np.abs(rates[states:]).max()))
        parts = [
            h * float(np.max(part)) / size
            for part, size in ((off[:states], path), (off[states:], level))
            if size > 0.0
        ]
        return max(parts, default=0.0)

    def _powers(self, places: MotionPlaces, directions: Floats) -> DoubleDoubles:
        """Powers (2, places) of what has no potential, and of what dampers take."""
        powers = DoubleDoubles(np.zeros((2, places.time.size)))
        for number, (fewer, sign) in enumerate(zip(self.working, (1.0, -1.0), strict=True)):
            if fewer is None:
                continue
            _, forces, _ = fewer.closed(places, directions)
            moved = fewer.along(directions, places.rates)
            total = forces[0] * moved[0]
            for k in range(1, len(forces)):
                total = total + forces[k] * moved[k]
            powers[number] = sign * total
        return powers


def state_rates(layout: Layout, states: DoubleDoubles, rates: DoubleDoubles) -> DoubleDoubles:
    """Derivatives of the states by the rates of the columns: of an orientation (0, w) q/2."""
    slopes = DoubleDoubles(np.zeros(states.shape))
    for carrier in layout.carriers:
        kind, s, c = carrier.part.type, carrier.state, carrier.column
        freedoms = len(kind.freedoms)
        if kind.states == freedoms:
            slopes[s : s + freedoms] = rates[c : c + freedoms]
            continue
        w, (a, x, y, z) = rates[c : c + 3], states[s : s + 4]
        slopes[s] = -0.5 * (w[0] * x + w[1] * y + w[2] * z)
        slopes[s + 1] = 0.5 * (w[0] * a + w[1] * z - w[2] * y)
        slopes[s + 2] = 0.5 * (w[1] * a + w[2] * x - w[0] * z)
        slopes[s + 3] = 0.5 * (w[2] * a + w[0] * y - w[1] * x)
    return slopes


LONGER = 4.0
"""Factor by which the next step may be longer at most."""


def orthonormal(rows: Floats) -> Floats:
    """Gram and Schmidt's basis of the same space (freedoms, columns, 1)."""
    basis: list[Floats] = []
    for row in rows:
        rest = row / sqrt(_product(row, row))
        for other in basis:
            rest = rest - _product(rest, other) * other
        basis.append(rest / sqrt(_product(rest, rest)))
    return np.array(basis)


def _product(one: Floats, other: Floats) -> float:
    """The inner product of two rows (columns, 1), in order."""
    total = 0.0
    for x, y in zip(one[:, 0].tolist(), other[:, 0].tolist(), strict=True):
        total += x * y
    return total
