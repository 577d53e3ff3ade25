"""A free motion over a time in double-double, by collocation at Gauss's points.

In every step the rates of all states and columns are polynomials through their values at the nodes
(`legendre`), found by Picard's iteration: their integrals give places, these close along a chart
and answer with rates. A step is taken where the last coefficients are below a tolerance that is
orders of magnitude below the rounding of doubles. Nothing of this is shared with the integrator
whose rows are measured by it (kernel/core/integrator/integrator.hpp). Where forces have a kink the
coefficients do not fall, and steps are cut until what is missed there is below the tolerance, too.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.errors.legendre import (
    Collocation,
    collocation,
    integrals_to,
    sum_of_products,
    values_at,
)
from mechkin_cli.errors.rows import NOT_RESOLVED, as_number, as_parts
from mechkin_cli.kernel.functions import power
from mechkin_cli.mechanism import Damper, Spring
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.session import Ask, Chart, PreciseConstants, RowInputs
from mechkin_cli.tape import DoubleDoubles, eliminate, joined

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.mechanism import Load
    from mechkin_cli.plan import Layout
    from mechkin_cli.session import Precise, Session
    from mechkin_cli.show import Bools, Floats


# A free motion at given moments and places, in double-double: rates, accelerations, powers.
#
# The kernel closes a guess along a chart through it and tells what would have to act along the
# chart for the accelerations that are supposed; the true ones leave nothing (docs/numerics.md, Free
# motion).

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


class ClosedPlaces(NamedTuple):
    """The same closed: states, rates and accelerations, and what would have to act along the chart
    (freedoms, places); `good` places are closed and all loads have values there."""

    states: DoubleDoubles
    rates: DoubleDoubles
    accelerations: DoubleDoubles
    forces: DoubleDoubles
    good: Bools


class UnitResponse(NamedTuple):
    """What places answer to unit accelerations along the chart, in doubles: forces (places,
    freedoms, freedoms), which are the reduced inertia, and accelerations of the columns (freedoms,
    columns, places)."""

    inertia: Floats
    tangents: Floats


class ForcedMotion:
    """A mechanism that moves under forces.

    Args:
        session: of the free motion.
        precise: the numbers of its text.
        held: (held inputs, 2) what holds idle freedoms, in kernel units.
    """

    def __init__(self, session: Session, precise: Precise, held: Floats) -> None:
        self.session, self.precise = session, precise
        self.constants = precise.constants(session)
        self.held = held
        self.freedoms = session.plan.charts

    def found(
        self, places: MotionPlaces, directions: Floats, *, forces: bool = True
    ) -> ClosedPlaces:
        """Places closed along the chart of `directions` (freedoms, columns, places; or 1 for all
        of them), with what they are supposed to move by."""
        seconds = self.along(directions, places.accelerations)
        return self._run(places, directions, seconds, forces=forces)

    def response(self, places: MotionPlaces, directions: Floats) -> UnitResponse:
        """What places answer to unit accelerations along the chart."""
        n, count = self.freedoms, places.time.size
        copies = np.tile(np.arange(count), n + 1)
        seconds = np.zeros((n, (n + 1) * count))
        for k in range(n):
            seconds[k, (k + 1) * count : (k + 2) * count] = 1.0
        along = directions if directions.shape[2] == 1 else directions[:, :, copies]
        found = self._run(places.at(copies), along, DoubleDoubles(seconds))
        forces = found.forces.high.reshape(n, n + 1, count)
        second = found.accelerations.high.reshape(-1, n + 1, count)
        inertia = (forces[:, 1:] - forces[:, :1]).transpose(2, 0, 1)
        return UnitResponse(inertia, (second[:, 1:] - second[:, :1]).transpose(1, 0, 2))

    def tangents(self, place: MotionPlaces, directions: Floats) -> Floats:
        """Rates of the columns (freedoms, columns, 1) by unit rates along the chart at one
        place."""
        n = self.freedoms
        copies = place.at(np.zeros(n, dtype=np.intp))
        still = np.zeros_like(copies.rates.high)
        moving = copies._replace(accelerations=DoubleDoubles(still))
        found = self._run(moving, directions, DoubleDoubles(np.zeros((n, n))), np.eye(n))
        return np.ascontiguousarray(found.rates.high.T)[:, :, None]

    def corrected(
        self, found: ClosedPlaces, response: UnitResponse
    ) -> tuple[DoubleDoubles, Floats]:
        """The accelerations of the columns that leave nothing to act, as far as `response` tells;
        and by how much they differ, in parts of unit accelerations (freedoms, places)."""
        with np.errstate(all="ignore"):
            missing = -eliminate(response.inertia, found.forces.high.T).T
        step = response.tangents[0] * missing[0]
        for k in range(1, len(missing)):
            step = step + response.tangents[k] * missing[k]
        return found.accelerations + step, missing

    @staticmethod
    def along(directions: Floats, columns: DoubleDoubles) -> DoubleDoubles:
        """What columns do (columns, places) along a chart (freedoms, places)."""
        total = columns[0][None] * directions[:, 0]
        for k in range(1, len(columns)):
            total = total + columns[k][None] * directions[:, k]
        return total

    def settled(self, places: MotionPlaces, directions: Floats) -> tuple[MotionPlaces, Bools]:
        """Places closed, with the accelerations that follow from the forces there; and which of
        them are."""
        found = self.found(places, directions)
        response = self.response(places, directions)
        for _ in range(CORRECTIONS):
            accelerations, missing = self.corrected(found, response)
            found.good[:] &= np.isfinite(missing).all(axis=0)
            numbers = (found.states, found.rates, accelerations)
            places = MotionPlaces(places.time, *numbers, places.turned)
            good = found.good
            found = self.found(places, directions)
            found.good[:] &= good
        return places, found.good

    def without(self, dropped: Callable[[Load], bool]) -> ForcedMotion | None:
        """The same mechanism without some of its loads; None where it has none of them."""
        from mechkin_cli.response import with_loads

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
        *,
        forces: bool = True,
    ) -> ClosedPlaces:
        count, plan = places.time.size, self.session.plan
        moved = self.along(directions, places.rates) if rates is None else DoubleDoubles(rates)
        spread = np.broadcast_to(directions, (*directions.shape[:2], count))
        chart = Chart(
            np.array(spread).reshape(-1, count),
            as_parts(moved),
            as_parts(seconds),
            np.zeros((0, count)),
        )
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
        demand = MOVING if forces else Demand.VELOCITY | Demand.ACCELERATION
        ask = Ask(demand, derivatives=True)
        batch = self.session.run(rows, ask, PreciseConstants(self.constants))
        assert batch.first is not None
        assert batch.second is not None
        good = batch.good | self.session.is_redundant
        if batch.undefined is not None:
            good &= batch.undefined == 0
        acting = batch.chart_forces if forces else np.zeros((self.freedoms, 2, count))
        assert acting is not None
        for part in (batch.states, batch.first, batch.second, acting):
            good &= np.isfinite(part).all(axis=(0, 1))
        states, first, second = map(as_number, (batch.states, batch.first, batch.second))
        return ClosedPlaces(states, first, second, as_number(acting), good)


def is_damper(load: Load) -> bool:
    """Whether what a load takes counts as dissipated."""
    return isinstance(load, Damper)


def is_working(load: Load) -> bool:
    """Whether what a load gives counts as work: it has no potential and is no damper."""
    return not isinstance(load, Damper | Spring)


class Fineness(NamedTuple):
    """How finely a motion is repeated: nodes of a step, and what its last coefficients may be in
    parts of the way and of the rates so far."""

    nodes: int
    tolerance: float


FINE = Fineness(24, tolerances.REPEATED_STEP)
ROUGH = Fineness(20, tolerances.ROUGHLY_REPEATED_STEP)


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
        ways = self.length * sum_of_products(integrals_to(where, count), self.rates).T
        states, columns = len(self.begin.states), len(self.begin.rates)
        moved = self.begin.states + ways[:states], self.begin.rates + ways[states:]
        last = values_at(where, self.rates)
        work = self.length * sum_of_products(integrals_to(where, count), self.powers).T
        return MotionPlaces(times, *moved, last[states : states + columns], turned), work


class March(NamedTuple):
    """A motion: its steps, the time (s) up to which they lead, and why not farther; "" at the
    end."""

    steps: list[LegendreStep]
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
        motion: ForcedMotion,
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

    def march(self, begin: MotionPlaces, directions: Floats, end: DoubleDoubles) -> March:
        """From one place with a chart of `directions` (freedoms, columns, 1) to a moment."""
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

    def _closed(self, place: MotionPlaces, directions: Floats) -> MotionPlaces | None:
        """One place on the motion, with the accelerations there."""
        found, good = self.motion.settled(place, directions)
        return found if good.all() else None

    def _step(
        self,
        here: MotionPlaces,
        size: DoubleDoubles,
        directions: Floats,
        before: LegendreStep | None,
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
            places = MotionPlaces(
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
        step = LegendreStep(here, size, coefficients, powers)
        if self._off_between(step, directions, kept) > self.fineness.tolerance:
            return _Tried(None, None, 0.5)
        self.way += h * float(np.abs(rates.high[:states]).max())
        self.level = max(self.level, float(np.abs(moved.high[states:]).max()))
        end = here.time + size
        after, _ = step.at(end, self.turned_at(end.high))
        return _Tried(step, after, 0.9 * ratio)

    def _off_between(self, step: LegendreStep, directions: Floats, response: UnitResponse) -> float:
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
        near = UnitResponse(response.inertia[number], response.tangents[:, :, number])
        accelerations, _ = self.motion.corrected(found, near)
        off = np.abs((accelerations - places.accelerations).high)
        h = float(step.length.high[0])
        level = max(self.level, h * float(np.abs(places.accelerations.high).max()))
        return h * float(off.max()) / level if level > 0.0 else 0.0

    def _guess(
        self, here: MotionPlaces, times: DoubleDoubles, before: LegendreStep | None
    ) -> DoubleDoubles:
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

    def _powers(self, places: MotionPlaces, directions: Floats) -> DoubleDoubles:
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

    step: LegendreStep | None
    end: MotionPlaces | None
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
