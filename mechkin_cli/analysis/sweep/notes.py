"""What a sweep has to say about its rows beside their verdicts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.named_modes import is_cyclic
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.solver.clusters import pose_keys, same_poses
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.solver.graph import SolverGraph
    from mechkin_cli.solver.session import Session


def open_turn_note(session: Session, states: Floats, reached: Bools) -> Diagnostic | None:
    """Rows a full turn of the one moving input apart at which the mechanism is not the same.

    `states` (states, rows) in kernel units.
    """
    inputs = session.inputs.values
    moving = np.flatnonzero(np.ptp(inputs, axis=1) > 0.0)
    if moving.size != 1:
        return None
    number = int(moving[0])
    item = session.problem.motion.inputs[number]
    if not is_cyclic(session.problem.mechanism, item.name):
        return None
    turns = (inputs[number] - inputs[number, 0]) / (2.0 * np.pi)
    whole = (np.rint(turns) != 0.0) & (np.abs(turns - np.rint(turns)) <= tolerances.SAME_TURN)
    rows = np.flatnonzero(whole & reached)
    if not rows.size or not reached[0]:
        return None
    row = int(rows[0])
    keys = pose_keys(session.layout, np.ascontiguousarray(states[:, [0, row]]))
    if same_poses(keys[:, :1], keys[:, 1:])[0, 0]:
        return None
    count = round(abs(float(turns[row])))
    return Diagnostic(
        "turn-not-closed",
        "note",
        f"after {count} full turn{'s' * (count > 1)} of {item.name}, in row {row + 1}, the "
        "mechanism is not back at its first row's position: it has gone on to another assembly",
        hint="mechkin ranges shows the circuit",
    )


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


def not_converged_note(rows: Rows, residual: Floats) -> Diagnostic:
    """Rows whose loops did not close."""
    failed = np.flatnonzero(rows.status == Status.not_converged)
    worst = float(np.max(residual[failed]))
    return Diagnostic(
        "not-converged",
        "error",
        f"{failed.size} rows did not close, the first is row {failed[0] + 1}",
        measured=f"residual {worst:.2g}",
        limit=f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint="this may be a special position; move the sweep by a fraction of its step",
        numbers=(Number("residual", worst, limit=tolerances.RESIDUAL_ACCEPT),),
    )
