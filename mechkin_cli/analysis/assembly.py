"""The assembly at the first row: near given coordinates, a named mode, the home drawing, or
nearest to it."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.home import follow_from_home, is_home_assembled, nearest_to_home
from mechkin_cli.analysis.named_modes import NamedModes, is_cyclic, name_modes, wrapped
from mechkin_cli.analysis.probe import Probe
from mechkin_cli.analysis.rows import MAY_BE_RIGID, input_numbers, input_text
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, Number
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.dead_centre import DeadCentre
from mechkin_cli.solver.follow import TrackEnd
from mechkin_cli.solver.graph import SolverGraph, is_redundant
from mechkin_cli.solver.layout import Layout, is_slide
from mechkin_cli.solver.search import Found
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan


@dataclass(frozen=True)
class Start:
    """States at a row (the first, or the one nearest to an assembled home) and the mode's name;
    without states `status` says why there are none."""

    state: Floats | None
    mode: str
    how: str
    diagnostics: list[Diagnostic] = field(default_factory=list)
    status: Status = Status.not_assembled
    row: int = 0


def choose_start(
    problem: Problem,
    layout: Layout,
    plan: Plan,
    path: Floats,
    probe: Probe,
    modes: NamedModes | None = None,
) -> Start:
    """The assembly that the file means; `path` (inputs, rows) in kernel units.

    `modes` are the modes at the first row, where they are known already.
    """
    wanted = problem.assembly
    if not wanted.near and wanted.mode is None and is_home_assembled(layout, plan):
        return _from_home(problem, layout, plan, path)
    modes = modes or name_modes(problem, layout, plan, path[:, 0], probe)
    if modes.number == 0:
        return Start(None, "", "", [nothing_found(problem, layout.graph, modes.found)])
    if wanted.mode is not None:
        return _by_name(modes, wanted.mode)
    if wanted.near:
        distances, how = _distances_near(problem, modes), "near"
    else:
        distances, how = _distances_home(layout, probe, modes.points), "nearest to home"
    return _nearest(modes, distances, how)


def _from_home(problem: Problem, layout: Layout, plan: Plan, path: Floats) -> Start:
    """Followed from the drawing to the row whose inputs are nearest to it."""
    row = nearest_to_home(path)
    followed = follow_from_home(layout, plan, path[:, row])
    if followed.end == TrackEnd.FINISHED:
        return Start(followed.state, "home", "followed from the home drawing", row=row)
    places = input_numbers(problem, layout, followed.inputs)
    rigid = f"; {MAY_BE_RIGID}" if is_redundant(layout.graph) else ""
    diagnostic = Diagnostic(
        "home-branch-ends",
        "error",
        "the assembly drawn at home ends before it comes to a row",
        measured=f"followed up to {', '.join(map(input_text, places))}",
        hint=f"choose another assembly with assembly: {{near: ...}}{rigid}",
        numbers=places,
    )
    from mechkin_cli.solver.branch_limit import find_limit

    driven = problem.motion.driven
    limit = find_limit(layout, plan, driven, followed, followed.inputs, followed.state)
    folds = isinstance(limit, DeadCentre)
    status = Status.beyond_dead_centre if folds else Status.branch_lost
    return Start(None, "home", "", [diagnostic], status)


def nothing_found(
    problem: Problem, graph: SolverGraph, found: Found, place: str = "at the first row"
) -> Diagnostic:
    """What to say where no start closed."""
    hint = "check the dimensions, or start the sweep at another input"
    if is_redundant(graph):
        hint = "dimensions of an overconstrained loop must be exact (write expressions)"
    return Diagnostic(
        "not-assembled",
        "error",
        f"{problem.mechanism.name} cannot be assembled {place}",
        measured=_missed(found),
        limit=f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint=hint,
        numbers=(
            Number("starts", found.starts),
            Number("residual", found.closest, limit=tolerances.RESIDUAL_ACCEPT),
        ),
    )


def _missed(found: Found) -> str:
    if found.free:
        return (
            f"{found.free} of {found.starts} random starts closed the loops, all where they still "
            "move with the inputs held, or in a singular position"
        )
    return (
        f"none of {found.starts} random starts closed the loops, "
        f"the best to {found.closest:.2g} of the size"
    )


def _distances_near(problem: Problem, modes: NamedModes) -> list[float]:
    mechanism = problem.mechanism
    size = mechanism.box_diagonal()
    distances = []
    for i in range(modes.number):
        total = 0.0
        for name, target in problem.assembly.near.items():
            miss = float(modes.coordinates[name][i]) - target
            if is_cyclic(mechanism, name):
                miss = wrapped(miss)
            elif is_slide(name.partition(".")[2]):
                miss /= size
            total += miss * miss
        distances.append(sqrt(total))
    return distances


def _distances_home(layout: Layout, probe: Probe, points: Floats) -> list[float]:
    """Root mean square over the moving links' joint points, in parts of the size."""
    home = np.array([at.vector for at in probe.points])[:, :, None]
    miss = (points - home) / layout.mechanism.box_diagonal()
    total = np.zeros(points.shape[2])
    for x, y, z in miss:
        total = total + (x * x + y * y + z * z)
    return [sqrt(float(squares) / len(home)) for squares in total]


def _by_name(modes: NamedModes, name: str) -> Start:
    for i, letter in modes.letters.items():
        if letter == name:
            return Start(modes.found.states[:, i], name, "by name")
    diagnostic = Diagnostic(
        "no-such-mode",
        "error",
        f"there is no mode {name[:LONGEST_NAME]} at the first row",
        measured=f"modes {', '.join(modes.letters.values())}",
        hint="take one of these",
    )
    return Start(None, name, "", [diagnostic])


def _nearest(modes: NamedModes, distances: list[float], how: str) -> Start:
    order = sorted(range(modes.number), key=lambda i: distances[i])
    best = order[0]
    notes = []
    if len(order) > 1:
        second = order[1]
        if distances[second] < tolerances.NEAR_RUNNER_UP * distances[best]:
            both = f"modes {modes.letters[best]} and {modes.letters[second]}"
            notes.append(
                Diagnostic(
                    "nearest-unclear",
                    "warning",
                    f"{both} are about equally near",
                    measured=f"distances {distances[best]:.4g} and {distances[second]:.4g}",
                    limit=f"ratio {tolerances.NEAR_RUNNER_UP}",
                    hint="give more coordinates under assembly: near",
                    numbers=tuple(Number("distance", distances[i]) for i in (best, second)),
                )
            )
    words = f"{how}, 1 of {modes.number} found"
    return Start(modes.found.states[:, best], modes.letters[best], words, notes)
