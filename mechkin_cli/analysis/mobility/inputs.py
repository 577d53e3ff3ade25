"""What the declared inputs do to the freedoms: locked, dependent, or too few."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.words import freedoms as in_words
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.freedoms.motions import Motions
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.graph.errors import listed

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


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
    _, values, right = np.linalg.svd(rates)
    rank = int(np.count_nonzero(values > doubt))
    if rank < len(driven) - len(locked):
        notes.append(
            Diagnostic(
                "inputs-dependent",
                "error",
                f"the inputs {', '.join(names)} are not independent",
                measured=f"{len(driven)} inputs drive {in_words(rank)}",
                hint="drive fewer coordinates",
            )
        )
    left = motions.tangents @ right[rank:].T
    return [*notes, *undriven_notes(motions.mobility, idle, rank, moving(motions, left, doubt))]


def moving(motions: Motions, ways: Floats, doubt: float) -> tuple[str, ...]:
    """Coordinates that some motions (freedoms, count) change."""
    rates = np.abs(ways).max(axis=1, initial=0.0)
    return tuple(
        f"{joint.name}.{name}"
        for joint in motions.body.mechanism.joints.values()
        for name in joint.type.freedom_of
        if rates[motions.body.column(joint.name, name)] > doubt
    )


def undriven_notes(
    freedoms: int, idle: int, driven: int, candidates: tuple[str, ...] = ()
) -> list[Diagnostic]:
    """Freedoms that neither spin idly nor are driven; `candidates` are coordinates that they
    move."""
    left = freedoms - driven - idle
    if left <= 0:
        return []
    message = f"{in_words(left)} {'is' if left == 1 else 'are'} not driven"
    if candidates:
        message += f"; candidates: {listed(candidates)}"
    measured = f"{in_words(freedoms)}, {idle} idle, {driven} driven"
    hint = "add inputs under motion"
    return [Diagnostic("undriven-freedom", "warning", message, measured=measured, hint=hint)]
