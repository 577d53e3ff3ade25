"""Orientation of a joint's second link against its first, relative to the drawing.

R = R1^T R2, so that axes and components are along the ground axes as drawn on the first link. A
quaternion and its opposite are one rotation; the sign is that of what following carried along: the
quaternion of a closing joint (`solver.closing_turns`), or the state of one in the tree.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.analysis.derived.rotations import (
    inner,
    quaternion,
    relative,
    rotation_vector,
    times,
)
from mechkin_cli.solver.closing_turns import (
    ORIENTATION,
    continuous_signs,
    drawn_quaternion,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.derived.rotations import Quaternion
    from mechkin_cli.analysis.derived.row_vectors import RowVector
    from mechkin_cli.arrays import Floats


def turn(run: Reading, joint: str) -> RowVector:
    """The rotation vector (rad), of length 0 to pi."""
    return rotation_vector(_upright(run, joint))


def continuous_quaternion(run: Reading, joint: str) -> Quaternion:
    """The unit quaternion, scalar first; continuous from the first row, where q0 >= 0."""
    q = _upright(run, joint)
    reached = np.flatnonzero(run.result.row_states.reached)
    if not reached.size:
        return q
    part = _part(q, reached)
    followed = _followed(run, joint, reached)
    # a joint of a leg turns with the leg's line, less than half a turn from row to row
    signs = _alike(part) if followed is None else continuous_signs(part, followed, 0)
    first = -1.0 if part[0][0] < 0.0 else 1.0
    every = np.ones(run.result.row_states.reached.size)
    every[reached] = signs * first
    return times(every, q)


def _upright(run: Reading, joint: str) -> Quaternion:
    links = run.session.problem.mechanism.joints[joint]
    return quaternion(relative(run.rotation(links.first), run.rotation(links.second)))


def _followed(run: Reading, name: str, reached: NDArray[np.intp]) -> Quaternion | None:
    """The orientation in some rows as it was followed, of either sign as a whole; None for the
    spheres of a leg."""
    layout, rows = run.session.layout, run.result.row_states
    joint = layout.mechanism.joints[name]
    reference = layout.joint_reference[name]
    if reference < 0:
        slot = run.session.turn_slots.closing.get((-1 - reference, ORIENTATION))
        if slot is None:
            return None
        return drawn_quaternion(joint, rows.turns[slot : slot + 4, reached])
    edge = layout.edge_number[name]
    for k in layout.parts_of[edge]:
        carrier = layout.carriers[k]
        if carrier.part.type.is_ball:
            w, x, y, z = rows.states[carrier.state : carrier.state + 4, reached]
            forward = 1.0 if layout.graph.edges[edge].forward else -1.0
            return (w, forward * x, forward * y, forward * z)
    return None


def _alike(q: Quaternion) -> Floats:
    """Signs with which each quaternion is alike to the one before it, +1 at the first."""
    back = inner(_part(q, slice(1, None)), _part(q, slice(None, -1))) < 0.0
    signs: Floats = np.cumprod(np.concatenate((np.ones(1), np.where(back, -1.0, 1.0))))
    return signs


def _part(q: Quaternion, rows: slice | NDArray[np.intp]) -> Quaternion:
    return (q[0][rows], q[1][rows], q[2][rows], q[3][rows])
