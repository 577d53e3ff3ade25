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
    """

    state: Floats
    turns: Floats
    tangents: Floats


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
    values (places,)."""

    forces: Floats
    states: Floats
    turns: Floats
    good: Bools


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
        n = self.freedoms
        zeros = np.zeros((n, n))
        # rates of driven inputs would add to those along the chart
        still = self.driven._replace(rates=np.zeros_like(self.driven.rates))
        batch = self._run(still, FreePlace(state, turns, directions), zeros, np.eye(n), zeros)
        assert batch.first is not None
        if not (np.isfinite(batch.first).all() and batch.good.all()):
            raise ValueError("the directions do not determine the rates at this place")
        return FreePlace(batch.states[:, 0], turns, orthonormal(batch.first.T))

    def at(
        self,
        place: FreePlace,
        u: Floats,
        rates: Floats | None = None,
        accelerations: Floats | None = None,
        driven: DrivenAt | None = None,
    ) -> ForcesAt:
        """The forces at places u (freedoms, places) of the chart about `place`, at rest unless
        rates and accelerations (freedoms, places) are given; turns are continuous from `place`.

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
        assert batch.chart_forces is not None
        good = batch.good & np.isfinite(batch.chart_forces).all(axis=0)
        if batch.undefined is not None:
            good &= batch.undefined == 0
        return ForcesAt(batch.chart_forces, batch.states, self._turned(place, batch), good)

    def read(self, place: FreePlace, readout: Readout) -> Floats:
        """Outputs (slots, freedoms) at a place, where one direction of its chart after the other
        has unit rate and the driven inputs are at rest."""
        n = self.freedoms
        zeros = np.zeros((n, n))
        still = self.driven._replace(rates=np.zeros_like(self.driven.rates))
        batch = self._run(still, place, zeros, np.eye(n), zeros, readout)
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
    ) -> Batch:
        """Closes places of the chart with a motion along it, and balances the forces, unless
        something else is demanded."""
        count, session = u.shape[1], self.session

        def of_rows(array: Floats) -> Floats:
            column = array[:, None] if array.ndim == 1 else array
            return np.repeat(column, count, axis=1) if column.shape[1] == 1 else column

        state = of_rows(place.state)
        guess = session.moved_along(state, combined(place.tangents, u)) if u.any() else state
        directions = of_rows(place.tangents.ravel())
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
        return session.run(rows, Ask(_BALANCED, readout, derivatives=True, balance=True))

    def _turned(self, place: FreePlace, batch: Batch) -> Floats:
        """The turns (turn slots, places) of places, continuous from those of another."""
        assert batch.turns is not None
        turns = batch.turns.copy()
        for slot, width in self._widths:
            own, known = turns[slot : slot + width], place.turns[slot : slot + width, None]
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


def summed(terms: Floats) -> Floats:
    """Terms (terms, ...) added in their order, whatever the machine."""
    if not len(terms):
        return np.zeros(terms.shape[1:])
    total: Floats = np.add.accumulate(terms, axis=0)[-1]
    return total


def combined(basis: Floats, weights: Floats) -> Floats:
    """Sums (columns, places) of rows of a basis (numbers, columns) by weights (numbers, places)."""
    total = np.zeros((basis.shape[1], weights.shape[1]))
    for row, weight in zip(basis, weights, strict=True):
        total = total + row[:, None] * weight
    return total


def orthonormal(rows: Floats) -> Floats:
    """An orthonormal basis (numbers, columns) of the span of independent rows, by two passes of
    Gram and Schmidt.

    Raises:
        ValueError: the rows are not independent, to rounding.
    """
    basis = np.array(rows, dtype=np.float64)
    for k in range(len(basis)):
        size = _length(basis[k])
        for _ in range(2):
            for before in basis[:k]:
                basis[k] = basis[k] - summed(before * basis[k]) * before
        left = _length(basis[k])
        if not left > tolerances.RANK_ZERO * size:
            raise ValueError("the directions are not independent")
        basis[k] = basis[k] / left
    return basis


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
