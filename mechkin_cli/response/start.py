"""The first moment of a response: the assembly, and how it moves there.

The start's coordinates and the driven ones are inputs of a session of their own, whose assembly is
chosen as a sweep's first row is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, RowInputs

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.session import Session
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
    return Beginning(begin, _combined(rates, moved), moved[:free])


def _unit_rates(session: Session, state: Floats) -> Floats:
    """Rates of the columns (inputs, columns) where one input after the other has unit rate."""
    count = len(session.graph.inputs)
    repeated = np.zeros(count, dtype=np.intp)
    reduced = session.inputs.reduced[:, repeated]
    rows = RowInputs(reduced, state[:, None][:, repeated], np.eye(count))
    batch = session.run(rows, Ask(Demand.VELOCITY, derivatives=True))
    assert batch.first is not None
    return np.ascontiguousarray(batch.first.T)


def _combined(factors: Sequence[float] | Floats, rows: Floats) -> Floats:
    """Sum of rows with their factors, in order."""
    total = np.zeros(rows.shape[1])
    for factor, row in zip(factors, rows, strict=True):
        total = total + factor * row
    return total


def _rates(
    session: Session, response: ResponseProblem, state: Floats, moved: Floats
) -> Floats | Diagnostic:
    """Rates of all inputs in kernel units: the driven ones by their laws, the independent ones so
    that the coordinates named with a rate have it."""
    inputs = session.inputs
    rates: Floats = inputs.rates[:, 0].copy()
    independent = set(response.independent)
    others = [
        one
        for one in response.start
        if one.rate is not None and (one.joint, one.coordinate) not in independent
    ]
    if not others:
        return _known(session, response, state, rates)

    return solve_rates(session, response, state, rates, len(moved))


def _known(
    session: Session, response: ResponseProblem, state: Floats, rates: Floats
) -> Floats | Diagnostic:
    """The rates, or why they say nothing: at its dead centre a coordinate has no rate, and any
    that it is given stands for infinite ones of others."""
    from mechkin_cli.sweep import lost_rates

    if not rates.any():
        return rates
    lost = lost_rates(session, np.zeros(1, dtype=np.intp), state[:, None])[:, 0]
    inputs = session.problem.motion.inputs
    named = [one.name for one, given in zip(inputs, lost & (rates != 0.0), strict=True) if given]
    if not named:
        return rates
    return Diagnostic(
        "start-at-dead-centre",
        "error",
        f"the start is a dead centre of {', '.join(named)}: no rate of it is one of the mechanism",
        response.place,
        hint="give the rate of a coordinate that moves there, or start beside it",
    )


# Rates at the first moment that are given for coordinates other than the independent ones.


def solve_rates(
    session: Session, response: ResponseProblem, state: Floats, rates: Floats, count: int
) -> Floats | Diagnostic:
    """Rates of all inputs (inputs,), kernel units, with which the coordinates named in the start
    have the rates that they are given.

    Linear in the independent rates: the named rates are read at unit rates of one input after the
    other. `rates` holds those of the driven inputs behind the independent ones.
    """
    free = len(response.independent)
    given = [one for one in response.start if one.rate is not None]
    known = session.problem.quantities()
    wanted = [known[f"{one.name}_dot"] for one in given]
    readout = session.readout(wanted)
    repeated = np.zeros(count, dtype=np.intp)
    reduced = session.inputs.reduced[:, repeated]
    rows = RowInputs(reduced, state[:, None][:, repeated], np.eye(count))
    batch = session.run(rows, Ask(Demand.VELOCITY, readout))
    assert batch.outputs is not None
    by_rate = np.array([batch.outputs[readout.slots[quantity.name].first] for quantity in wanted])
    right = np.array([one.rate or 0.0 for one in given])
    for number in range(free, count):
        right = right - by_rate[:, number] * rates[number]
    found = _solved(by_rate[:, :free], right)
    if found is None:
        names = ", ".join(f"{one.name}_dot" for one in given)
        return Diagnostic(
            "start-rates",
            "error",
            f"the rates given at the start ({names}) do not fix how the mechanism moves",
            response.place,
            hint="give the rates of the coordinates that start names, or of others that move "
            "with each of them",
        )
    return np.array([*found, *rates[free:]])


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
    found = [0.0] * size
    for k in reversed(range(size)):
        rest = rows[k][size]
        for j in range(k + 1, size):
            rest -= rows[k][j] * found[j]
        found[k] = rest / rows[k][k]
    return found
