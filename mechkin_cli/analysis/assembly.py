"""The assembly at the first row: near given coordinates, a named mode, the home drawing, or
nearest to it."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.problem import Problem
from mechkin_cli.analysis.rows import MAY_BE_RIGID, input_numbers, input_text
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.demand import OutputPlan
from mechkin_cli.solver.follow import TrackEnd, follow
from mechkin_cli.solver.graph import ANGLES, SolverGraph, is_redundant
from mechkin_cli.solver.layout import Layout, is_slide
from mechkin_cli.solver.search import Found, assemblies
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan

    Floats = NDArray[np.float64]


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


class Probe:
    """Reads coordinates and joint points of assemblies."""

    def __init__(self, problem: Problem, layout: Layout) -> None:
        self.layout = layout
        self.plan = layout.build()
        self.outputs = OutputPlan(layout, self.plan, problem.motion.driven)
        quantities = problem.quantities()
        self.coordinates = list(problem.mechanism.coordinates)
        for name in self.coordinates:
            self.outputs.add(quantities[name])
        self.points = [at for _, at in layout.mechanism.joint_points() if at.link != "ground"]
        self.point_slots = [self.outputs.add_point(at, 0) for at in self.points]

    def read(self, inputs: Floats, states: Floats) -> tuple[dict[str, Floats], Floats]:
        """Coordinates by name (SI) and the joint points of the moving links (points, 3,
        assemblies)."""
        values = np.repeat(inputs[:, None], states.shape[1], axis=1)
        batch = run(self.plan, values, states, outputs=True)
        assert batch.outputs is not None
        out = batch.outputs
        coordinates = {name: out[self.outputs.slots[name].first] for name in self.coordinates}
        points = np.stack([out[slot : slot + 3] for slot in self.point_slots])
        return coordinates, points

    def size(self, inputs: Floats, state: Floats) -> float:
        """Diagonal of the box of all joint points, in m; 1 if they coincide."""
        _, points = self.read(inputs, state[:, None])
        fixed = [at.vector for _, at in self.layout.mechanism.joint_points() if at.link == "ground"]
        every = np.concatenate([points[:, :, 0], np.array(fixed).reshape(-1, 3)])
        extent = every.max(axis=0) - every.min(axis=0)
        x, y, z = (float(e) for e in extent)
        return sqrt(x * x + y * y + z * z) or 1.0


def home_state(layout: Layout) -> Floats:
    """States of the home drawing: every coordinate zero."""
    state = np.zeros(layout.states)
    for carrier in layout.carriers:
        if carrier.part.letter == "S":
            state[carrier.state] = 1.0
    return state


def is_home_assembled(layout: Layout, plan: Plan) -> bool:
    """Whether the home drawing closes all loops as drawn."""
    zeros = np.zeros((len(layout.graph.inputs), 1))
    tests = (0.0, 0.0, tolerances.HOME_ASSEMBLED)
    batch = run(plan, zeros, home_state(layout)[:, None], iterations=0, tests=tests)
    return bool(batch.good[0])


def choose_start(problem: Problem, layout: Layout, plan: Plan, path: Floats, probe: Probe) -> Start:
    """The assembly that the file means; `path` (inputs, rows) in kernel units."""
    wanted = problem.assembly
    if not wanted.near and wanted.mode is None and is_home_assembled(layout, plan):
        return _from_home(problem, layout, plan, path)
    inputs = path[:, 0]
    found = assemblies(layout, plan, inputs, wanted.turns)
    if found.number == 0:
        return Start(None, "", "", [_nothing_found(problem, layout.graph, found)])
    coordinates, points = probe.read(inputs, found.states)
    order = _mode_order(problem, coordinates, found.number)
    letters = {i: mode_name(rank) for rank, i in enumerate(order)}
    if wanted.mode is not None:
        return _by_name(found, letters, wanted.mode)
    if wanted.near:
        distances, how = _distances_near(problem, layout, coordinates, found.number), "near"
    else:
        distances, how = _distances_home(layout, probe, points), "nearest to home"
    return _nearest(found, letters, distances, how)


def mode_name(rank: int) -> str:
    """A, B, ... Z, AA, AB, ..."""
    name = ""
    rank += 1
    while rank:
        rank, digit = divmod(rank - 1, 26)
        name = chr(ord("A") + digit) + name
    return name


def _from_home(problem: Problem, layout: Layout, plan: Plan, path: Floats) -> Start:
    """Followed from the drawing to the row whose inputs are nearest to it."""
    row = int(np.argmin(np.max(np.abs(path), axis=0))) if path.size else 0
    way = np.stack([np.zeros_like(path[:, row]), path[:, row]], axis=1)
    followed = follow(plan, way, home_state(layout))
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
    return Start(None, "home", "", [diagnostic], Status.beyond_dead_centre)


def _nothing_found(problem: Problem, graph: SolverGraph, found: Found) -> Diagnostic:
    hint = "check the dimensions, or start the sweep at another input"
    if is_redundant(graph):
        hint = "dimensions of an overconstrained loop must be exact (write expressions)"
    return Diagnostic(
        "not-assembled",
        "error",
        f"{problem.mechanism.name} cannot be assembled at the first row",
        measured=f"none of {found.starts} random starts closed the loops, "
        f"the best to {found.closest:.2g} of the size",
        limit=f"{tolerances.RESIDUAL_ACCEPT:g}",
        hint=hint,
        numbers=(
            Number("starts", found.starts),
            Number("residual", found.closest, limit=tolerances.RESIDUAL_ACCEPT),
        ),
    )


def _mode_order(problem: Problem, coordinates: dict[str, Floats], count: int) -> list[int]:
    """Modes ordered by wrapped coordinates in joint order, quantised to 1e-6."""
    keys = []
    for i in range(count):
        key = []
        for name, values in coordinates.items():
            value = float(values[i])
            if _is_angle(problem, name):
                value = wrapped(value)
            key.append(round(value * 1e6))
        keys.append(tuple(key))
    return sorted(range(count), key=lambda i: keys[i])


def _is_angle(problem: Problem, name: str) -> bool:
    joint, _, coordinate = name.partition(".")
    return coordinate in ANGLES and problem.mechanism.joints[joint].letter != "H"


def wrapped(angle: float) -> float:
    """The angle brought into (-pi, pi]."""
    from math import ceil

    return angle - 2.0 * pi * ceil((angle - pi) / (2.0 * pi))


def _distances_near(
    problem: Problem, layout: Layout, coordinates: dict[str, Floats], count: int
) -> list[float]:
    size = layout.mechanism.box_diagonal()
    distances = []
    for i in range(count):
        total = 0.0
        for name, target in problem.assembly.near.items():
            miss = float(coordinates[name][i]) - target
            if _is_angle(problem, name):
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


def _by_name(found: Found, letters: dict[int, str], name: str) -> Start:
    for i, letter in letters.items():
        if letter == name:
            return Start(found.states[:, i], name, "by name")
    diagnostic = Diagnostic(
        "no-such-mode",
        "error",
        f"there is no mode {name} at the first row",
        measured=f"modes {', '.join(sorted(letters.values()))}",
        hint="take one of these",
    )
    return Start(None, name, "", [diagnostic])


def _nearest(found: Found, letters: dict[int, str], distances: list[float], how: str) -> Start:
    order = sorted(range(found.number), key=lambda i: distances[i])
    best = order[0]
    notes = []
    if len(order) > 1:
        second = order[1]
        if distances[second] < tolerances.NEAR_RUNNER_UP * distances[best]:
            notes.append(
                Diagnostic(
                    "nearest-unclear",
                    "warning",
                    f"modes {letters[best]} and {letters[second]} are about equally near",
                    measured=f"distances {distances[best]:.4g} and {distances[second]:.4g}",
                    limit=f"ratio {tolerances.NEAR_RUNNER_UP}",
                    hint="give more coordinates under assembly: near",
                    numbers=tuple(Number("distance", distances[i]) for i in (best, second)),
                )
            )
    return Start(found.states[:, best], letters[best], f"{how}, 1 of {found.number} found", notes)
