"""Values of varying loads as the kernel takes them, row by row.

A load along a coordinate has one column, a load on a link three: its components in the axes that it
is given in, in the kernel's units, in the order of the mechanism's loads.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.model import Amount, JointLoad, LinkLoad, Load, Varying, varying
from mechkin_cli.solver.layout import Layout

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def kernel_loads(layout: Layout, values: Floats) -> Floats:
    """The columns (columns, rows) of `Plan.run`'s loads, from the laws' values (laws, rows) in
    SI."""
    rows = values.shape[1]
    columns: list[Floats] = []
    for load in layout.mechanism.loads:
        if varying(load):
            columns += _columns(layout, load, values)
    return np.ascontiguousarray(columns).reshape(len(columns), rows)


def _columns(layout: Layout, load: Load, values: Floats) -> list[Floats]:
    length = layout.length
    if isinstance(load, JointLoad):
        per = length * length if is_angle(load.coordinate) else length
        return [_rows(load.value, values) / per]
    assert isinstance(load, LinkLoad)
    per = 1.0 / length if load.kind == "force" else 1.0 / (length * length)
    given = [_rows(amount, values) for amount in load.value]
    if load.axes == "link":
        frame = layout.link_frame[load.link]
        given = [_along(axis, given) for axis in (frame.x, frame.y, frame.z)]
    return [per * component for component in given]


def _rows(amount: Amount, values: Floats) -> Floats:
    if isinstance(amount, Varying):
        row: Floats = values[amount.number]
        return row
    return np.full(values.shape[1], amount)


def _along(axis: Sequence[float], given: Sequence[Floats]) -> Floats:
    return axis[0] * given[0] + axis[1] * given[1] + axis[2] * given[2]
