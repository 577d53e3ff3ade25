"""The first moment of a response: the assembly, and how it moves there.

The start's coordinates and the driven ones are inputs of a session of their own, whose assembly is
chosen as a sweep's first row is. Rates may be those of other coordinates, too (`solve_rates`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, RowInputs, Session
from mechkin_cli.sweep import lost_rates

if TYPE_CHECKING:
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.show import Floats


class Beginning(NamedTuple):
    """States (states,), rates of the columns (columns,) and a basis of the free rates (freedoms,
    columns) at the first moment, in kernel units."""

    state: Floats
    first: Floats
    tangents: Floats


def beginning(session: Session, response: ResponseProblem, state: Floats) -> Beginning | Diagnostic:
    """How the mechanism moves from an assembly `state` (states,) of a session whose inputs are the
    response's independent coordinates and then its driven ones."""
    free = len(response.independent)
    moved = _unit_rates(session, state)
    rates = _rates(session, response, state, moved)
    if isinstance(rates, Diagnostic):
        return rates
    begin = state.copy()
    layout = session.layout
    # the whole turns of an angle that the file names stay in its state
    for number, (edge, freedom) in enumerate(session.graph.inputs):
        begin[layout.state(edge, freedom)] = session.inputs.values[number, 0]
    first = np.zeros(moved.shape[1])
    for rate, row in zip(rates, moved, strict=True):
        first = first + rate * row
    return Beginning(begin, first, moved[:free])


def _unit_rates(session: Session, state: Floats) -> Floats:
    """Rates of the columns (inputs, columns) where one input after the other has unit rate."""
    count = len(session.graph.inputs)
    repeated = np.zeros(count, dtype=np.intp)
    reduced = session.inputs.reduced[:, repeated]
    rows = RowInputs(reduced, state[:, None][:, repeated], np.eye(count))
    batch = session.run(rows, Ask(Demand.VELOCITY, derivatives=True))
    assert batch.first is not None
    return np.ascontiguousarray(batch.first.T)


def _rates(
    session: Session, response: ResponseProblem, state: Floats, moved: Floats
) -> Floats | Diagnostic:
    """Rates of all inputs in kernel units: the driven ones by their laws, the independent ones so
    that the coordinates named with a rate have it."""
    rates: Floats = session.inputs.rates[:, 0].copy()
    independent = set(response.independent)
    if any(
        one.rate is not None and (one.joint, one.coordinate) not in independent
        for one in response.start
    ):
        return solve_rates(session, response, state, rates, len(moved))
    if not rates.any():
        return rates
    # at its dead centre a coordinate has no rate: any other than zero means infinite ones of others
    lost = lost_rates(session, np.zeros(1, dtype=np.intp), state[:, None])[:, 0]
    inputs = session.problem.motion.inputs
    named = [one.name for one, wrong in zip(inputs, lost & (rates != 0.0), strict=True) if wrong]
    if not named:
        return rates
    return Diagnostic(
        "start-at-dead-centre",
        "error",
        f"the start is a dead centre of {', '.join(named)}: no rate of it is one of the mechanism",
        response.place,
        hint="give the rate of a coordinate that moves there, or start beside it",
    )


def solve_rates(
    session: Session, response: ResponseProblem, state: Floats, rates: Floats, count: int
) -> Floats | Diagnostic:
    """Rates of all inputs (inputs,), kernel units, with which the coordinates named in the start
    have their rates there.

    Linear in the independent rates: the named rates are read at unit rates of one input after the
    other. `rates` holds those of the driven inputs behind the independent ones.
    """
    free = len(response.independent)
    with_rate = [one for one in response.start if one.rate is not None]
    known = session.problem.quantities()
    wanted = [known[f"{one.name}_dot"] for one in with_rate]
    readout = session.readout(wanted)
    repeated = np.zeros(count, dtype=np.intp)
    reduced = session.inputs.reduced[:, repeated]
    rows = RowInputs(reduced, state[:, None][:, repeated], np.eye(count))
    batch = session.run(rows, Ask(Demand.VELOCITY, readout))
    assert batch.outputs is not None
    by_rate = np.array([batch.outputs[readout.slots[quantity.name].first] for quantity in wanted])
    right = np.array([one.rate or 0.0 for one in with_rate])
    for number in range(free, count):
        right = right - by_rate[:, number] * rates[number]
    solved = _solved(by_rate[:, :free], right)
    if solved is None:
        names = ", ".join(f"{one.name}_dot" for one in with_rate)
        return Diagnostic(
            "start-rates",
            "error",
            f"the rates given at the start ({names}) do not fix how the mechanism moves",
            response.place,
            hint="give the rates of the coordinates that start names, or of others that move "
            "with each of them",
        )
    return np.array([*solved, *rates[free:]])


def _solved(matrix: Floats, right: Floats) -> list[float] | None:
    """Gauss's elimination with rows scaled and the largest pivot; None where the rows depend on one
    another."""
    size = len(right)
    rows = [[float(x) for x in row] + [float(b)] for row, b in zip(matrix, right, strict=True)]
    for row in rows:
        scale = max((abs(x) for x in row[:-1]), default=0.0)
        if not scale > 0.0:
            return None
        row[:] = [x / scale for x in row]
    for k in range(size):
        pivot = max(range(k, size), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        if not abs(rows[k][k]) > tolerances.RANK_ZERO:
            return None
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    values = [0.0] * size
    for k in reversed(range(size)):
        rest = rows[k][size]
        for j in range(k + 1, size):
            rest -= rows[k][j] * values[j]
        values[k] = rest / rows[k][k]
    return values
