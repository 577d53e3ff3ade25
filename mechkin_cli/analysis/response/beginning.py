"""The first moment of a response: the assembly, and how it moves there.

The start's coordinates and the driven ones are inputs of a session of their own, whose assembly is
chosen as a sweep's first row is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.solver.codes import Demand

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.session import Session


class Beginning(NamedTuple):
    """States (states,), rates of the columns (columns,) and a basis of the free rates (freedoms,
    columns) at the first moment, in kernel units."""

    state: Floats
    first: Floats
    tangents: Floats


def beginning(session: Session, response: Response, state: Floats) -> Beginning | Diagnostic:
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
    batch = session.run(
        session.inputs.reduced[:, repeated],
        state[:, None][:, repeated],
        rates=np.eye(count),
        demand=Demand.VELOCITY,
        derivatives=True,
    )
    assert batch.first is not None
    return np.ascontiguousarray(batch.first.T)


def _combined(factors: Sequence[float] | Floats, rows: Floats) -> Floats:
    """Sum of rows with their factors, in order."""
    total = np.zeros(rows.shape[1])
    for factor, row in zip(factors, rows, strict=True):
        total = total + factor * row
    return total


def _rates(
    session: Session, response: Response, state: Floats, moved: Floats
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
    from mechkin_cli.analysis.response.other_rates import solve_rates

    return solve_rates(session, response, state, rates, len(moved))


def _known(
    session: Session, response: Response, state: Floats, rates: Floats
) -> Floats | Diagnostic:
    """The rates, or why they say nothing: at its dead centre a coordinate has no rate, and any
    that it is given stands for infinite ones of others."""
    from mechkin_cli.analysis.sweep.lost_rates import lost_rates

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
