"""What a sweep has to say about its rows beside their verdicts."""

from __future__ import annotations

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.rows import RowStates
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.solver.batch import Batch
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.status import Status


def redundancy_note(graph: SolverGraph) -> Diagnostic:
    """Redundant constraints leave some reactions arbitrary."""
    count = sum(block.equations - len(block.unknowns) for block in graph.blocks)
    joints = sorted({graph.edges[k].joint.name for c in graph.closings for k, _ in c.loop})
    joints = sorted({*joints, *(c.joint.name for c in graph.closings)})
    constraints = "one redundant constraint" if count == 1 else f"{count} redundant constraints"
    return Diagnostic(
        "not-unique",
        "note",
        f"{constraints} in the loops through {', '.join(joints)}: cells of reactions that depend "
        "on them are not unique and stay empty",
        hint="free a joint to make them unique (a sphere for a pin, a cylinder for a slide)",
    )


def not_converged_note(rows: RowStates, batch: Batch) -> Diagnostic:
    """Rows whose loops did not close."""
    failed = np.flatnonzero(rows.status == Status.not_converged)
    worst = float(np.max(batch.residual[failed]))
    return Diagnostic(
        "not-converged",
        "error",
        f"{failed.size} rows did not close, the first is row {failed[0] + 1}",
        measured=f"residual {worst:.2g}",
        limit=f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint="this may be a special position; move the sweep by a fraction of its step",
        numbers=(Number("residual", worst, limit=tolerances.RESIDUAL_ACCEPT),),
    )
