"""The least singular value of the conditions that one block solves together.

The derivative of a body's condition by its own coordinate is the root of its discriminant; those by
the coordinates of bodies before it are differences. Angles count in rad, slides in parts of the
size. A block of points at three distances is judged by the product of its roots.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from random_families.no_wrong_row.branch import Way
from random_families.no_wrong_row.field import FAST
from random_families.no_wrong_row.linkage import Linkage
from random_families.no_wrong_row.node import Node

Array = NDArray[np.float64]
STEP = 1e-6


def least_of_block(linkage: Linkage, group: tuple[str, ...], one: Way) -> Array:
    """By place of a way."""
    bodies = {body.name: body for body in linkage.bodies}
    roots = [np.sqrt(one.margin[name]) for name in group]
    if len(group) == 1 or isinstance(bodies[group[0]], Node):
        return np.asarray(np.prod(roots, axis=0))
    t = one.sign * one.t
    placed = linkage.at(t, FAST)
    value = {name: np.asarray(placed.value[name]) for name in group}
    matrix = np.zeros((len(t), len(group), len(group)))
    for j, name in enumerate(group):
        step = STEP * (linkage.size if bodies[name].slides else 1.0)
        beside = linkage.at(t, FAST, held=value | {name: value[name] + step})
        side = linkage.side[name]
        matrix[:, j, j] = (side if bodies[name].slides else -side) * roots[j]
        for i in range(j + 1, len(group)):
            at_rest = placed.miss[group[i]](value[group[i]])
            matrix[:, i, j] = (beside.miss[group[i]](value[group[i]]) - at_rest) / STEP
    return np.asarray(np.linalg.svd(matrix, compute_uv=False)[:, -1])
