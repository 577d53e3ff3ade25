"""Generalised forces of a free mechanism about a place, and their derivatives there.

A free motion has coordinates u of a chart about a place: u_i = t_i . d(q), with d the displacement
of all joint coordinates and t_i an orthonormal basis of the rates that the loops allow there
(docs/numerics.md, Free motion). What would have to act along them for a motion u(t) is

    f(u, u', u'') = M u'' + r(u, u'),

which the kernel gives row by row: loads balance where f(u, 0, 0) is zero, the reduced inertia is
df/du'', and damping and stiffness about the place are df/du' and df/du. Since loads are anything
that a file may say, f is differentiated by differences: central ones of eighth order, all places of
all coordinates in one call of the kernel. No dead centre of a coordinate does any harm.

All numbers are in kernel units (kg, the kernel's length, s). Sums go in the order of their terms.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, Chart, RowInputs, continuous_angle

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from mechkin_cli.plan import Readout
    from mechkin_cli.session import Batch, Session
    from mechkin_cli.show import Bools, Floats

_WEIGHTS = np.array([4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0])
_WEIGHTS_BEFORE = np.array([3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0, 0.0])
"""Of f(k h) - f(-k h), k = 1 to 4, in h f': eighth order, and sixth, whose difference from it tells
the error (B. Fornberg, Mathematics of Computation 51, 1988)."""


class FreePlace(NamedTuple):
    """A place of a free mechanism.

    Attributes:
        state: (states,) closed.
        turns: (turn slots,) of cut joints, as `RowInputs.turned`.
        tangents: (freedoms, columns) orthonormal rates of the columns that the loops allow; the
            directions of the chart about the place.

    Of many places each array has them as its last axis.
    """

    state: Floats
    turns: Floats
    tangents: Floats

    def at(self, numbers: NDArray[np.intp] | Bools | int) -> FreePlace:
        """Some of many places, or one."""
        return FreePlace(*(array[..., numbers] for array in self))

    def each(self, times: int) -> FreePlace:
        """Many places, each some times after the other."""
        return FreePlace(*(np.repeat(array, times, axis=-1) for array in self))

    @classmethod
    def many(cls, places: Sequence[FreePlace]) -> FreePlace:
        """Single places as many."""
        return cls(*(np.stack(arrays, axis=-1) for arrays in zip(*places, strict=True)))


class DrivenAt(NamedTuple):
    """Driven inputs at a place in kernel units, each (inputs,), and the time (s) that laws read;
    `whole` are turns that the values are without, `full` the values with them."""

    values: Floats
    whole: Floats
    full: Floats
    rates: Floats
    accelerations: Floats
    time: float = 0.0

    @classmethod
    def row(cls, session: Session, row: int = 0, *, moving: bool = False) -> DrivenAt:
        """Those of a row of a session's motion, at rest unless `moving`."""
        inputs, moments = session.inputs, session.problem.motion.time
        still = np.zeros(len(inputs.values))
        return cls(
            inputs.reduced[:, row],
            inputs.whole[:, row],
            inputs.values[:, row],
            inputs.rates[:, row] if moving else still,
            inputs.accelerations[:, row] if moving else still,
            0.0 if moments is None else float(moments.values[row]),
        )


class ForcesAt(NamedTuple):
    """What would have to act along the chart at some places: forces (freedoms, places), states
    (states, places), turns (turn slots, places), and which of them are closed and have loads with
    values (places,); about many places with an axis of these before the last."""

    forces: Floats
    states: Floats
    turns: Floats
    good: Bools

    def of_many(self, count: int) -> ForcesAt:
        """The same with an axis of so many places, about each of which are as many."""
        forces, states, turns, good = self
        each = good.size // count
        return ForcesAt(
            forces.reshape(-1, count, each),
            states.reshape(len(states), count, each),
            turns.reshape(len(turns), count, each),
            good.reshape(count, each),
        )

    def at(self, numbers: slice) -> ForcesAt:
        """Some of the places, or of those about each of many."""
        forces, states, turns, good = self
        return ForcesAt(
            forces[..., numbers], states[..., numbers], turns[..., numbers], good[..., numbers]
        )


class Derivative(NamedTuple):
    """A derivative of the forces (freedoms, numbers) by numbers, and an estimate of the largest
    error of its entries; nan where forces have no values about the place."""

    matrix: Floats
    error: float


class Forces:
    """The generalised forces of a free mechanism.

    Args:
        session: of the free motion (`response.free_session`), without friction.
        driven: its inputs.
    """

    def __init__(self, session: Session, driven: DrivenAt) -> None:
        if session.problem.mechanism.frictions:
            raise ValueError("forces about a place are those without friction")
        self.session, self.driven = session, driven
        self.freedoms: int = session.plan.charts
        self._widths = [(slot, width) for *_, slot, width in _kernel.closing_turns(session.plan)]

    def place(self, state: Floats, turns: Floats, directions: Floats) -> FreePlace:
        """A place from a closed state (states,), with an orthonormal basis of its free rates.

        Args:
            state: closed at the driven inputs.
            turns: (turn slots,) of cut joints.
            directions: (freedoms, columns) independent on the free rates, as the basis of a place
                nearby.

        Raises:
            ValueError: the directions do not determine the rates there.
        """
        found, good = self.charted(FreePlace.many([FreePlace(state, turns, directions)]))
        if not good[0]:
            raise ValueError("the directions do not determine the rates at this place")
        return found.at(0)

    def charted(self, places: FreePlace) -> tuple[FreePlace, Bools]:
        """Many places with charts of their own, from directions that are independent on the free
        rates there; and where these determine the rates (places,)."""
        n, count = self.freedoms, places.state.shape[1]
        zeros = np.zeros((n, n * count))
        # rates of driven inputs would add to those along the chart
        still = self.driven._replace(rates=np.zeros_like(self.driven.rates))
        unit = np.tile(np.eye(n), count)
        batch = self._run(still, places.each(n), zeros, unit, zeros, derivatives=True)
        assert batch.first is not None
        rates = batch.first.reshape(-1, count, n)
        good = np.logical_and.reduce(np.isfinite(rates), axis=(0, 2))
        good = good & np.logical_and.reduce(batch.good.reshape(count, n), axis=1)
        tangents, independent = orthonormal_each(
            np.where(good[:, None], rates, 0.0).transpose(2, 0, 1)
        )
        states = batch.states.reshape(-1, count, n)[:, :, 0]
        return FreePlace(states, places.turns, tangents), good & independent

    def about(self, places: FreePlace, u: Floats) -> ForcesAt:
        """The forces at rest at some places u (freedoms, places, each) of the charts about many."""
        n, count, each = u.shape
        found = self.at(places.each(each), np.ascontiguousarray(u.reshape(n, -1)))
        return found.of_many(count)

    def along(
        self, places: FreePlace, steps: Floats, parts: Floats, beside: Floats
    ) -> tuple[ForcesAt, ForcesAt, Floats]:
        """The forces at `parts` (parts,) of a step (freedoms, places) from each of many places, and
        `beside` (freedoms, others) its end; and the free rates (freedoms, columns, places) at its
        end, where one direction of the chart after the other has unit rate."""
        n, count = steps.shape
        at_end = np.concatenate([beside, np.zeros((n, n))], axis=1)
        whole = steps[:, :, None]
        u = np.concatenate([whole * parts, whole + at_end[:, None, :]], axis=2)
        rates = np.zeros_like(u)
        rates[:, :, -n:] = np.eye(n)[:, None, :]
        each = u.shape[2]
        u, rates = (np.ascontiguousarray(array.reshape(n, -1)) for array in (u, rates))
        rows = places.each(each)
        batch = self._run(self.driven, rows, u, rates, np.zeros_like(u), derivatives=True)
        assert batch.first is not None
        found = self._forces_at(rows, batch).of_many(count)
        first = batch.first.reshape(-1, count, each)[:, :, -n:].transpose(2, 0, 1)
        return found.at(slice(parts.size)), found.at(slice(parts.size, -n)), first

    def at(
        self,
        place: FreePlace,
        u: Floats,
        rates: Floats | None = None,
        accelerations: Floats | None = None,
        driven: DrivenAt | None = None,
    ) -> ForcesAt:
        """The forces at places u (freedoms, places) of the chart about `place`, or each about one
        of many, at rest unless rates and accelerations (freedoms, places) are given; turns are
        continuous from `place`.

        `driven`: other inputs; each of its numbers may be one for all places (inputs,) or one for
        each (inputs, places).
        """
        zeros = np.zeros_like(u)
        batch = self._run(
            driven or self.driven,
            place,
            u,
            zeros if rates is None else rates,
            zeros if accelerations is None else accelerations,
        )
        return self._forces_at(place, batch)

    def _forces_at(self, place: FreePlace, batch: Batch) -> ForcesAt:
        assert batch.chart_forces is not None
        good = batch.good & np.isfinite(batch.chart_forces).all(axis=0)
        if batch.undefined is not None:
            good &= batch.undefined == 0
        return ForcesAt(batch.chart_forces, batch.states, self._turned(place, batch), good)

    def read(self, place: FreePlace, readout: Readout) -> Floats:
        """Outputs (slots, freedoms) at a place, where one direction of its chart after the other
        has unit rate and the driven inputs are at rest; of many places one after the other."""
        n = self.freedoms
        count = 1 if place.state.ndim == 1 else place.state.shape[1]
        zeros = np.zeros((n, n * count))
        still = self.driven._replace(rates=np.zeros_like(self.driven.rates))
        rows = place if place.state.ndim == 1 else place.each(n)
        batch = self._run(still, rows, zeros, np.tile(np.eye(n), count), zeros, readout)
        assert batch.outputs is not None
        return batch.outputs

    def continuous(self, values: Floats, place: FreePlace, slot: int) -> Floats:
        """Values of a cut joint's angle with the whole turns that a place has in a slot."""
        return continuous_angle(values, np.full(values.shape, place.turns[slot]))

    def moved(self, place: FreePlace, at: ForcesAt, number: int = 0) -> FreePlace:
        """The place that is one of those of `at` about another."""
        return self.place(at.states[:, number], at.turns[:, number], place.tangents)

    def inertia(self, place: FreePlace) -> Floats:
        """The reduced inertia M (freedoms, freedoms) there."""
        n = self.freedoms
        unit = np.concatenate([np.zeros((n, 1)), np.eye(n)], axis=1)
        found = self.at(place, np.zeros_like(unit), accelerations=unit)
        matrix = found.forces[:, 1:] - found.forces[:, :1]
        return 0.5 * (matrix + matrix.T)

    def stiffness_and_inertia(
        self, place: FreePlace, beside: Floats
    ) -> tuple[Derivative, Floats, ForcesAt]:
        """Both at rest, and the forces at places `beside` (freedoms, places), where one call of the
        kernel is enough for all."""
        n = self.freedoms
        unit = np.concatenate([np.zeros((n, 1)), np.eye(n)], axis=1)
        others: ForcesAt | None = None

        def along(u: Floats) -> ForcesAt:
            nonlocal others
            if others is not None:
                return self.at(place, u)
            places = np.concatenate([u, np.zeros_like(unit), beside], axis=1)
            accelerations = np.zeros_like(places)
            accelerations[:, u.shape[1] : u.shape[1] + n + 1] = unit
            found = self.at(place, places, accelerations=accelerations)
            others = found.at(slice(u.shape[1], None))
            return found.at(slice(u.shape[1]))

        stiffness = differentiated(along, n)
        assert others is not None
        pushed = others.forces[:, 1 : n + 1] - others.forces[:, :1]
        return stiffness, 0.5 * (pushed + pushed.T), others.at(slice(n + 1, None))

    def stiffness(self, place: FreePlace) -> Derivative:
        """df/du (freedoms, freedoms) at rest along the chart; with the drives' rates where these
        move."""
        return differentiated(lambda u: self.at(place, u), self.freedoms)

    def damping(self, place: FreePlace) -> Derivative:
        """df/du' (freedoms, freedoms) at rest along the chart, with the gyroscopic terms of drives
        that move."""
        return differentiated(
            lambda rates: self.at(place, np.zeros_like(rates), rates), self.freedoms
        )

    def told(
        self,
        place: FreePlace,
        readout: Readout,
        u: Floats,
        rates: Floats,
        accelerations: Floats,
        driven: DrivenAt | None = None,
    ) -> Batch:
        """Outputs at places of the chart, with arguments as those of `at`; no more is computed."""
        demand = demand_of(self.session.problem.mechanism, readout.wanted)
        at = driven or self.driven
        return self._run(at, place, u, rates, accelerations, readout, demand)

    def _run(
        self,
        driven: DrivenAt,
        place: FreePlace,
        u: Floats,
        rates: Floats,
        seconds: Floats,
        readout: Readout | None = None,
        demand: Demand | None = None,
        *,
        derivatives: bool = False,
    ) -> Batch:
        """Closes places of the chart with a motion along it, and balances the forces, unless
        something else is demanded."""
        count, session = u.shape[1], self.session

        def of_rows(array: Floats) -> Floats:
            column = array[:, None] if array.ndim == 1 else array
            return np.repeat(column, count, axis=1) if column.shape[1] == 1 else column

        state = of_rows(place.state)
        guess = session.moved_along(state, combined(place.tangents, u)) if u.any() else state
        shape = (place.tangents.shape[0] * place.tangents.shape[1], *place.tangents.shape[2:])
        directions = of_rows(place.tangents.reshape(shape))
        none = np.zeros((0, count))
        chart = Chart(directions, rates, seconds, none)
        rows = RowInputs(
            of_rows(driven.values),
            guess,
            of_rows(driven.rates),
            of_rows(driven.accelerations),
            None,
            session.constraint_rates,
            of_rows(place.turns),
            of_rows(driven.whole),
            of_rows(driven.full),
            np.full(count, driven.time),
            chart,
            state,
            u,
        )
        if demand is not None:
            return session.run(rows, Ask(demand, readout))
        return session.run(rows, Ask(_BALANCED, readout, derivatives=derivatives, balance=True))

    def _turned(self, place: FreePlace, batch: Batch) -> Floats:
        """The turns (turn slots, places) of places, continuous from those of another."""
        assert batch.turns is not None
        turns = batch.turns.copy()
        for slot, width in self._widths:
            own, known = turns[slot : slot + width], place.turns[slot : slot + width]
            known = known[:, None] if known.ndim == 1 else known
            if width == 1:
                turns[slot] = continuous_angle(own[0], known[0])
            else:
                turns[slot : slot + width] = np.where(summed(own * known) < 0.0, -own, own)
        return turns


_BALANCED = Demand.VELOCITY | Demand.ACCELERATION | Demand.FORCES


def differentiated(forces: _Along, count: int) -> Derivative:
    """The derivative of forces by `count` numbers at zero.

    Args:
        forces: at numbers (count, places).
        count: of the numbers.
    """
    best: Derivative | None = None
    for step in tolerances.FORCE_STEPS:
        found = _difference(forces, count, step)
        size = float(np.abs(found.matrix).max(initial=0.0))
        if best is None or not best.error <= found.error:
            best = found
        # forces that bend sharply beside the place need shorter steps
        if found.error <= tolerances.FORCE_DIFFERENCE * size:
            break
    assert best is not None
    return best


def _difference(forces: _Along, count: int, step: float) -> Derivative:
    offsets = np.array([1.0, 2.0, 3.0, 4.0, -1.0, -2.0, -3.0, -4.0]) * step
    u = np.zeros((count, count, 8))
    for k in range(count):
        u[k, k] = offsets
    found = forces(u.reshape(count, -1))
    values = np.where(found.good, found.forces, np.nan).reshape(-1, count, 8)
    differences = values[:, :, :4] - values[:, :, 4:]
    matrix, before = (
        summed(np.moveaxis(differences * weights, -1, 0)) / step
        for weights in (_WEIGHTS, _WEIGHTS_BEFORE)
    )
    return Derivative(matrix, float(np.abs(matrix - before).max(initial=0.0)))


_MANY_TERMS = 12
"""From so many terms on adding them one by one in Python takes longer."""


def summed(terms: Floats) -> Floats:
    """Terms (terms, ...) added in their order, whatever the machine."""
    if not len(terms):
        return np.zeros(terms.shape[1:])
    if len(terms) > _MANY_TERMS:
        many: Floats = np.add.accumulate(terms, axis=0)[-1]
        return many
    total: Floats = np.array(terms[0])
    for term in terms[1:]:
        total = total + term
    return total


def combined(basis: Floats, weights: Floats) -> Floats:
    """Sums (columns, places) of rows of a basis (numbers, columns), or of one for each place
    (numbers, columns, places), by weights (numbers, places)."""
    total = np.zeros((basis.shape[1], weights.shape[1]))
    for row, weight in zip(basis, weights, strict=True):
        total = total + (row[:, None] if row.ndim == 1 else row) * weight
    return total


def orthonormal(rows: Floats) -> Floats:
    """An orthonormal basis (numbers, columns) of the span of independent rows.

    Raises:
        ValueError: the rows are not independent, to rounding.
    """
    basis, independent = orthonormal_each(rows[:, :, None])
    if not independent[0]:
        raise ValueError("the directions are not independent")
    return basis[:, :, 0]


def orthonormal_each(rows: Floats, columns: int | None = None) -> tuple[Floats, Bools]:
    """Orthonormal bases (numbers, columns, places) of the spans of rows, by two passes of Gram and
    Schmidt; and where the rows are independent (places,), to rounding. Where only so many `columns`
    are given, further ones go along."""
    basis = np.array(rows, dtype=np.float64)
    own = basis[:, :columns]
    independent = np.ones(rows.shape[2], dtype=bool)
    for k in range(len(basis)):
        size = _length(own[k])
        for _ in range(2):
            for before in range(k):
                basis[k] = basis[k] - summed(own[before] * own[k]) * basis[before]
        left = _length(own[k])
        independent &= left > tolerances.RANK_ZERO * size
        basis[k] = basis[k] / np.where(independent, left, 1.0)
    return basis, independent


def determinant(matrix: Floats) -> float:
    """The determinant of a small matrix, by elimination."""
    rows, found = [row[:] for row in matrix.tolist()], 1.0
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i: abs(rows[i][k]))
        if pivot != k:
            rows[k], rows[pivot], found = rows[pivot], rows[k], -found
        if rows[k][k] == 0.0:
            return 0.0
        found *= rows[k][k]
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    return found


def _length(row: Floats) -> Floats:
    return np.sqrt(summed(row * row))


if TYPE_CHECKING:
    from collections.abc import Callable

    _Along = Callable[[Floats], ForcesAt]
