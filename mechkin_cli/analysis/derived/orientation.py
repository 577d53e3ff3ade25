"""Orientation of a joint's second link against its first, relative to the drawing.

R = R1^T R2, so that axes and components are along the ground axes as drawn on the first link. A
quaternion and its opposite are one rotation; the sign is followed along a refined path between the
rows, on which no turn changes by half a turn from one place to the next.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.derived.basis import Reading, directions, rotation_of
from mechkin_cli.analysis.derived.rotations import (
    inner,
    quaternion,
    relative,
    rotation_vector,
    times,
)
from mechkin_cli.analysis.sweep.closing_angles import leading_rows, outputs_between

if TYPE_CHECKING:
    from mechkin_cli.analysis.derived.rotations import Quaternion
    from mechkin_cli.analysis.derived.row_vectors import RowVector
    from mechkin_cli.arrays import Floats


def turn(run: Reading, joint: str) -> RowVector:
    """The rotation vector (rad), of length 0 to pi."""
    return rotation_vector(_upright(run, joint))


def continuous_quaternion(run: Reading, joint: str) -> Quaternion:
    """The unit quaternion, scalar first; continuous from the first row, where q0 >= 0."""
    q = _upright(run, joint)
    reached, start = run.result.row_states.reached, run.result.start
    if start.state is None or not reached[start.row]:
        return q
    signs = np.ones(reached.size)
    for way in (slice(start.row, None), slice(start.row, None, -1)):
        count = leading_rows(reached[way])
        part = (q[0][way][:count], q[1][way][:count], q[2][way][:count], q[3][way][:count])
        followed = _followed_signs(run, joint, part, run.session.inputs.values[:, way][:, :count])
        signs[way][: followed.size] = followed
    return times(signs * signs[int(np.argmax(reached))], q)


def _upright(run: Reading, joint: str) -> Quaternion:
    links = run.session.problem.mechanism.joints[joint]
    return quaternion(relative(run.rotation(links.first), run.rotation(links.second)))


def _followed_signs(run: Reading, joint: str, q: Quaternion, inputs: Floats) -> Floats:
    """Signs that make the quaternions of some rows continuous, +1 at the first."""
    state = run.result.start.state
    if inputs.shape[1] < 2 or state is None:
        return np.ones(inputs.shape[1])
    session = run.session
    links = session.problem.mechanism.joints[joint]
    wanted = (*directions(links.first), *directions(links.second))
    readout = session.readout(wanted)
    values, places = outputs_between(session, readout, inputs, state)
    columns = {name: values[slot.first : slot.first + 3] for name, slot in readout.slots.items()}
    ends = (rotation_of(columns, link) for link in (links.first, links.second))
    path = quaternion(relative(*ends))
    back = inner(_part(path, slice(1, None)), _part(path, slice(None, -1))) < 0.0
    signs = np.cumprod(np.concatenate((np.ones(1), np.where(back, -1.0, 1.0))))
    rows = _part(q, slice(places.size))
    there = (path[0][places], path[1][places], path[2][places], path[3][places])
    return signs[places] * np.where(inner(rows, there) < 0.0, -1.0, 1.0)


def _part(q: Quaternion, rows: slice) -> Quaternion:
    return (q[0][rows], q[1][rows], q[2][rows], q[3][rows])
