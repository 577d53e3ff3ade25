"""What is known of the inputs from the drawing alone, without a search: for `check`."""

from __future__ import annotations

from mechkin_cli.analysis.mobility.inputs import input_notes, undriven_notes
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.freedoms.configurations import Body, home
from mechkin_cli.freedoms.idle import idle_freedoms
from mechkin_cli.freedoms.local_dimension import freedom_of
from mechkin_cli.freedoms.motions import Motions
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.random_starts import RandomStarts


def drawn_faults(problem: Problem) -> list[Diagnostic]:
    """Inputs that are locked, dependent or too few, as warnings.

    Nothing is said where the drawing is not assembled or a special position.
    """
    body = Body(problem.mechanism)
    start, random = home(body), RandomStarts()
    if not start.assembled:
        return []
    freedoms = [(p, freedom_of(p, start.state, random, regular=True)) for p in body.parts]
    if any(found.doubt for _, found in freedoms):
        return []
    motions = Motions(body, start, freedoms)
    driven = problem.motion.driven
    idle = len(idle_freedoms(motions.general, driven)) if motions.mobility else 0
    if not driven:
        return undriven_notes(motions.mobility, idle, 0)
    return [note._replace(severity="warning") for note in input_notes(problem, motions, idle)]
