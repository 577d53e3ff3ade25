"""mechkin's own methods: the kernel and the sweep, what each of their settings costs, and the dense
systems of the sources.

A dense system has all reactions and efforts of a position at once: six equations for every link and
the conditions of the pairs (24, 34, 40, 50 unknowns in the dissertation on successive screws;
`balances/newton_euler.py`). Only its solution by LAPACK is timed, not the motion that it needs nor
its making.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from mechkin_cli.balances import DenseSystem, dense_system, row_motion
from mechkin_cli.bench.measurement import Method, Unable
from mechkin_cli.bench.scene import ALONE, BATCH, LEVELS, BenchScene, Values
from mechkin_cli.kernel.functions import widths
from mechkin_cli.session import Batch, Packing, follow, step_limits
from mechkin_cli.show import Floats
from mechkin_cli.sweep import Result, analyze

FAMILY = "mechkin"
UNIT = "kernel, guesses as followed"
"""The curve that others are measured by."""

FOLLOWED = "sweep, followed and closed"
ANALYZED = "sweep, verdicts"

TOLERANCES = tuple(10.0**-k for k in (1, 2, 4, 6, 8, 10, 12, 14))
STEPS = (1, 2, 3, 4)
SPACINGS = tuple(2.0**-k for k in range(1, 7))
"""Longest steps of the skeleton (rad, length units); the first is that of every sweep."""


def kernel_methods(scene: BenchScene) -> Iterator[Method]:
    """Newton's tolerance and steps, levels, widths, the sweep with its skeleton, verdicts."""
    for level in LEVELS:
        yield _kernel(scene, UNIT, level, level, scene.followed)
    for limit in TOLERANCES:
        name, tests = "kernel, by tolerance", (limit, np.sqrt(limit), limit)
        yield _kernel(scene, name, f"{limit:.0e}", "position", scene.from_before, tests=tests)
    for steps in STEPS:
        start, name = scene.from_before, "kernel, by Newton steps"
        yield _kernel(scene, name, str(steps), "position", start, iterations=steps)
    for lanes in widths():
        name, packing = "kernel, by width", Packing(lanes, 1)
        yield _kernel(scene, name, f"{lanes} lanes", "everything", scene.followed, packing=packing)
    yield from _sweeps(scene)


def _kernel(
    scene: BenchScene, curve: str, setting: str, level: str, guess: Floats, **options: Any
) -> Method:
    make = partial(scene.kernel, level, guess, **options)
    call, once = make(count=BATCH), make()
    return Method(FAMILY, curve, setting, level, call, BATCH, lambda: scene.found(level, once()))


def _sweeps(scene: BenchScene) -> Iterator[Method]:
    rows, session = scene.result.rows, scene.model.session.packed(ALONE)
    if scene.session.route is None and scene.is_whole:
        for spacing in SPACINGS:
            call, read = followed_by(scene, "position", spacing)
            curve = "sweep, by skeleton spacing"
            yield Method(FAMILY, curve, f"{spacing:g}", "position", call, rows, read)
        for level in LEVELS:
            call, read = followed_by(scene, level, SPACINGS[0])
            yield Method(FAMILY, FOLLOWED, level, level, call, rows, read)
    for level in LEVELS:
        for verdicts, curve in ((True, ANALYZED), (False, "sweep, no verdicts")):
            call = partial(analyze, session, scene.asked.level(level), verdicts=verdicts)
            read = partial(_values, scene, level, call)
            yield Method(FAMILY, curve, level, level, call, rows, read)


def _values(scene: BenchScene, level: str, call: Callable[[], Result]) -> Values:
    columns = call().columns
    names = scene.asked.level(level)
    return {name: columns[name][:, scene.places] for name in names if name in columns}


def followed_by(
    scene: BenchScene, level: str, spacing: float
) -> tuple[Callable[[], object], Callable[[], Values]]:
    """Following all rows with steps up to `spacing`, and closing them: call, and what it finds."""
    session, inputs = scene.session, scene.session.inputs
    limits = step_limits(longest_step=spacing, straight=scene.problem.assembly.straight)
    start = np.ascontiguousarray(scene.result.row_states.states[:, scene.result.start.row])
    path, whole = inputs.reduced, inputs.whole
    close = scene.closing(level, np.arange(path.shape[1]))

    def call() -> Batch:
        followed = follow(session.plan, path, start, turns=True, whole=whole, limits=limits)
        return close(followed.guess)

    def read() -> Values:
        found = scene.found(level, call())
        return {name: columns[:, scene.places] for name, columns in found.items()}

    return call, read


DENSE = "dense"
EFFORT = 4
"""The rank of efforts among the unknowns."""


def dense_methods(scene: BenchScene) -> Iterator[Method]:
    """The solution of all places in one call."""
    if scene.problem.mechanism.spins:
        raise Unable("links between two balls spin freely, so that its system is singular")
    systems = [dense_system(scene.result, int(row)) for row in scene.places]
    first = systems[0]
    equations, unknowns = len(first.equations), len(first.unknowns)
    if equations != unknowns:
        raise Unable(f"its system is not square: {equations} equations in {unknowns} unknowns")
    matrix = np.array([system.coefficients for system in systems])
    right = np.array([system.right for system in systems])[:, :, None]
    try:
        solution = np.linalg.solve(matrix, right)[:, :, 0]
    except np.linalg.LinAlgError:
        raise Unable(f"its system of {unknowns} unknowns is singular") from None
    yield Method(
        DENSE,
        "reactions by LAPACK, solution alone",
        f"{unknowns} unknowns",
        "everything",
        partial(np.linalg.solve, matrix, right),
        scene.rows,
        partial(loads, scene, systems, solution),
    )


def loads(scene: BenchScene, systems: list[DenseSystem], solution: Floats) -> Values:
    """Efforts (1, rows) and wrenches (3, rows) about the joints' points, by name."""
    names = scene.asked.loads
    found: Values = {n: np.zeros((1 if n.endswith(".effort") else 3, scene.rows)) for n in names}
    for k, (system, values) in enumerate(zip(systems, solution, strict=True)):
        motion = row_motion(scene.result, int(scene.places[k]))
        for unknown, value in zip(system.unknowns, values, strict=True):
            force, moment = (np.array(part) * value for part in unknown.wrench)
            joint = unknown.joint
            if unknown.rank == EFFORT:
                if f"{joint}.effort" in found:
                    found[f"{joint}.effort"][0, k] = value
            elif f"{joint}.force" in found:
                found[f"{joint}.force"][:, k] += force
                place = motion.point(scene.problem.mechanism.joints[joint].point)
                found[f"{joint}.moment"][:, k] += moment - np.cross(place, force)
    return found
