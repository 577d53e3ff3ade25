"""What the declared inputs do to the freedoms: locked, dependent, or too few."""

from __future__ import annotations

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.motions import Motions
from mechkin_cli.analysis.mobility.words import freedoms as in_words
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.problem import Problem


def input_notes(problem: Problem, motions: Motions, idle: int) -> list[Diagnostic]:
    """Inputs that are locked, depend on each other, or leave freedoms undriven."""
    driven = problem.motion.driven
    if not driven:
        return []
    rates = motions.tangents[[motions.body.column(*each) for each in driven]]
    doubt = max(motions.doubt, tolerances.RANK_ZERO)
    notes = []
    names = [f"{name}.{coordinate}" for name, coordinate in driven]
    still = np.abs(rates).max(axis=1, initial=0.0) < doubt
    locked = [name for name, is_still in zip(names, still, strict=True) if is_still]
    for name in locked:
        message = f"the input {name} is locked: no motion changes it"
        notes.append(Diagnostic("input-locked", "error", message, hint="drive another coordinate"))
    rank = int(np.linalg.matrix_rank(rates, tol=doubt)) if rates.size else 0
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
    return [*notes, *undriven_notes(motions.mobility, idle, rank)]


def undriven_notes(freedoms: int, idle: int, driven: int) -> list[Diagnostic]:
    """Freedoms that neither spin idly nor are driven."""
    left = freedoms - driven - idle
    if left <= 0:
        return []
    message = f"{in_words(left)} {'is' if left == 1 else 'are'} not driven"
    measured = f"{in_words(freedoms)}, {idle} idle, {driven} driven"
    hint = "add inputs under motion"
    return [Diagnostic("undriven-freedom", "warning", message, measured=measured, hint=hint)]
