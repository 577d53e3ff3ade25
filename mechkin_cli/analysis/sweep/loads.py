"""Loads that vary: evaluated over all rows from what they read, before the forces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.mechanism.load_laws import law_values, quantities_read
from mechkin_cli.solver.varying_loads import kernel_loads

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.diagnostics import Diagnostic


class RowLoads(NamedTuple):
    """Values of the laws (laws, rows) in SI, loads as the kernel takes them (columns, rows), rows
    (rows,) that lack one, and why."""

    values: Floats
    columns: Floats
    lost: Bools
    diagnostics: list[Diagnostic]


def row_loads(result: Result) -> RowLoads:
    """The loads of all rows of a result."""
    problem, reached = result.problem, result.row_states.reached
    known = problem.quantities()
    result.read([known[name] for name in quantities_read(problem)])
    found = law_values(problem, result.quantity, reached)
    lost = reached & np.isnan(found.values).any(axis=0)
    return RowLoads(
        found.values, kernel_loads(result.session.layout, found.values), lost, found.diagnostics
    )
