"""How far places of a mechanism are from each other, unknown by unknown."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout

FULL_TURN = 2.0 * np.pi


def balls(layout: Layout) -> list[slice]:
    """The columns of each orientation."""
    return [
        slice(carrier.column, carrier.column + 3)
        for carrier in layout.carriers
        if carrier.part.type.is_ball
    ]


def differences(layout: Layout, one: Floats, others: Floats) -> Floats:
    """Sizes of the ways from a place (states,) to others (columns, places), in rad and lengths of
    the kernel: angles up to whole turns; of an orientation the largest of the increments x that
    turn it by (1, x / 2), in all three columns."""
    found = np.zeros((sum(len(c.part.type.freedoms) for c in layout.carriers), others.shape[1]))
    for carrier in layout.carriers:
        kind, row, column = carrier.part.type, carrier.state, carrier.column
        if kind.is_ball:
            turn = _increments(one[row : row + 4], others[row : row + 4])
            found[column : column + 3] = turn
            continue
        for number, freedom in enumerate(kind.freedoms):
            off = others[row + number] - one[row + number]
            if freedom.is_cyclic:
                off -= FULL_TURN * np.rint(off / FULL_TURN)
            found[column + number] = np.abs(off)
    return found


def _increments(a: Floats, b: Floats) -> Floats:
    """Largest of the increments that turn an orientation to others (places,)."""
    w = np.abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3])
    x = a[0] * b[1] - b[0] * a[1] - a[2] * b[3] + a[3] * b[2]
    y = a[0] * b[2] - b[0] * a[2] - a[3] * b[1] + a[1] * b[3]
    z = a[0] * b[3] - b[0] * a[3] - a[1] * b[2] + a[2] * b[1]
    size: Floats = 2.0 * np.maximum(np.maximum(np.abs(x), np.abs(y)), np.abs(z))
    # half a turn has no finite increments
    found: Floats = size / np.maximum(w, np.finfo(float).eps)
    return found
