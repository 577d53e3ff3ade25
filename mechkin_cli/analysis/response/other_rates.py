"""Rates at the first moment that are given for coordinates other than the independent ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.solver.codes import Demand

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.session import Session


def solve_rates(
    session: Session, response: Response, state: Floats, rates: Floats, count: int
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
    batch = session.run(
        session.inputs.reduced[:, repeated],
        state[:, None][:, repeated],
        readout=readout,
        rates=np.eye(count),
        demand=Demand.VELOCITY,
    )
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
