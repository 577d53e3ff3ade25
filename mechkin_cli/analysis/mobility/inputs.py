"""What the declared inputs do to the freedoms: locked, dependent, or too few."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.configurations import Configuration
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.problem import Problem

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def input_notes(
    problem: Problem, configuration: Configuration, motions: Floats, idle: int
) -> list[Diagnostic]:
    """Inputs that are locked, depend on each other, or leave freedoms undriven."""
    driven = problem.motion.driven
    if not driven:
        return []
    rates = motions[[configuration.body.column(*each) for each in driven]]
    notes = []
    names = [f"{name}.{coordinate}" for name, coordinate in driven]
    locked = [n for n, row in zip(names, rates, strict=True) if _is_still(row)]
    for name in locked:
        message = f"the input {name} is locked: no motion changes it"
        notes.append(Diagnostic("input-locked", "error", message, hint="drive another coordinate"))
    rank = int(np.linalg.matrix_rank(rates, tol=tolerances.RANK_ZERO)) if rates.size else 0
    if rank < len(driven) - len(locked):
        notes.append(
            Diagnostic(
                "inputs-dependent",
                "error",
                f"the inputs {', '.join(names)} are not independent",
                measured=f"{len(driven)} inputs drive {rank} freedoms",
                hint="drive fewer coordinates",
            )
        )
    return [*notes, *undriven_notes(motions.shape[1], idle, rank)]


def undriven_notes(freedoms: int, idle: int, driven: int) -> list[Diagnostic]:
    """Freedoms that neither spin idly nor are driven."""
    left = freedoms - driven - idle
    if left <= 0:
        return []
    message = f"{left} freedoms are not driven" if left > 1 else "one freedom is not driven"
    measured = f"{freedoms} freedoms, {idle} of them idle, {driven} driven"
    hint = "add inputs under motion"
    return [Diagnostic("undriven-freedom", "warning", message, measured=measured, hint=hint)]


def _is_still(rates: Floats) -> bool:
    return float(np.abs(rates).max(initial=0.0)) < tolerances.RANK_ZERO
