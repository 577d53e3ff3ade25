"""The first of two runs of a sweep whose loads vary: what the loads read, and their values.

Positions and rates do not depend on loads, so one run computes the quantities that the laws read;
the laws are evaluated over all rows, and the run of the forces takes their values row by row.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.analysis.batched import failed_rows, run_reached
from mechkin_cli.analysis.closing_angles import unwrap_closing_angles
from mechkin_cli.analysis.rows import RowStates
from mechkin_cli.analysis.setup import Setup
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.expressions import Quantity, UnknownName, Vector
from mechkin_cli.mechanism.load_laws import law_values, quantities_read
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.varying_loads import kernel_loads

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


class RowLoads(NamedTuple):
    """Loads as the kernel takes them (columns, rows), rows (rows,) that lack one, and why."""

    columns: Floats
    lost: NDArray[np.bool_]
    diagnostics: list[Diagnostic]


def row_loads(setup: Setup, rows: RowStates) -> RowLoads:
    """The loads of all rows; `rows` is left as it is."""
    problem = setup.problem
    known = problem.quantities()
    wanted = [known[name] for name in quantities_read(problem)]
    # velocities also tell on which side of a fold a row lies
    reading = setup.reading(wanted, demand_of(problem.mechanism, wanted) | Demand.VELOCITY)
    batch = run_reached(reading, rows)
    values = batch.outputs
    assert values is not None
    reached = rows.reached & ~failed_rows(batch, rows)
    unwrap_closing_angles(reading, values, reached)
    given = _given(problem)

    def resolve(name: str) -> Quantity:
        if name in problem.parameters:
            return problem.parameters[name]
        if name not in known:
            raise UnknownName(name, known)
        dimension = known[name].dimension
        if name in given:
            return Quantity(given[name], dimension)
        slot = reading.outputs.slots[name]
        columns = values[slot.first : slot.first + slot.width]
        if known[name].vector:
            return Quantity(Vector(columns[0], columns[1], columns[2]), dimension)
        return Quantity(columns[0], dimension)

    found = law_values(problem, resolve, reached)
    lost = reached & np.isnan(found.values).any(axis=0)
    return RowLoads(kernel_loads(setup.layout, found.values), lost, found.diagnostics)


def _given(problem: Problem) -> dict[str, Floats]:
    """What the rows were given, in SI: time, and the inputs with their rates."""
    motion = problem.motion
    found = {} if motion.time is None else {"time": motion.time.values}
    for driven in motion.inputs:
        found |= {name: in_si for name, (in_si, _) in driven.orders.items()}
    return found
