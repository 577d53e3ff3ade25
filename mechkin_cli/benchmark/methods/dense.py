"""The dense systems of the sources: all reactions and efforts of a position at once.

Six equations for every link and the conditions of the pairs (24, 34, 40, 50 unknowns in the
dissertation on successive screws; `analysis/dense`). Only their solution by LAPACK is timed, not
the motion that they need nor their making.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.benchmark.measurement import Method
from mechkin_cli.benchmark.methods import Unable
from mechkin_cli.derived import DenseSystem, dense_system, row_motion
from mechkin_cli.mechanism import find_legs

if TYPE_CHECKING:
    from mechkin_cli.benchmark.scene import Scene, Values
    from mechkin_cli.show import Floats


FAMILY = "dense"
EFFORT = 4
"""The rank of efforts among the unknowns."""


def methods(scene: Scene) -> Iterator[Method]:
    """The solution of all places in one call."""
    if find_legs(scene.problem.mechanism):
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
        FAMILY,
        "reactions by LAPACK, solution alone",
        f"{unknowns} unknowns",
        "everything",
        partial(np.linalg.solve, matrix, right),
        scene.rows,
        partial(loads, scene, systems, solution),
    )


def loads(scene: Scene, systems: list[DenseSystem], solution: Floats) -> Values:
    """Efforts (1, rows) and wrenches (3, rows) about the joints' points, by name."""
    names = scene.asked.loads
    found: Values = {n: np.zeros((3 if _is_vector(n) else 1, scene.rows)) for n in names}
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


def _is_vector(name: str) -> bool:
    return not name.endswith(".effort")
