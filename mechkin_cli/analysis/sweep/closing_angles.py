"""Continuous angles of closing joints.

The kernel has the angle of a closing joint from an arctangent. Whole turns are counted along a
refined path between the rows, on which no angle changes by half a turn from one place to the next.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.quantities import Wanted

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.sweep.result import Columns, Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Readout, Session


def make_continuous(result: Result, wanted: Sequence[Wanted], columns: Columns) -> None:
    """Makes the angles of closing joints in `columns` continuous from the first row, in place."""
    rows, start, session = result.row_states, result.start, result.session
    angles = [quantity for quantity in wanted if _is_closing_angle(session.layout, quantity)]
    if not angles or start.state is None or not rows.reached[start.row]:
        return
    readout = session.readout(angles)
    slots = [readout.slots[quantity.name].first for quantity in angles]
    turns = np.zeros((len(angles), rows.reached.size))
    for way in (slice(start.row, None), slice(start.row, None, -1)):
        count = leading_rows(rows.reached[way])
        part = turns[:, way]
        inputs = session.inputs.values[:, way][:, :count]
        part[:, :count] = _turns(session, readout, inputs, start.state, slots)
    first = int(np.argmax(rows.reached))
    for quantity, counted in zip(angles, turns, strict=True):
        columns[quantity.name][0] -= (counted - counted[first]) * (2.0 * pi)


def _is_closing_angle(layout: Layout, quantity: Wanted) -> bool:
    return (
        quantity.kind == "coordinate"
        and is_angle(quantity.coordinate)
        and quantity.order == 0
        and layout.joint_reference[quantity.owner] < 0
    )


def leading_rows(reached: NDArray[np.bool_]) -> int:
    """How many rows have a solution before the first that has none."""
    return int(reached.size if reached.all() else np.argmin(reached))


def _turns(
    session: Session, readout: Readout, inputs: Floats, start: Floats, slots: list[int]
) -> Floats:
    """Whole turns by which the arctangents have jumped back since the first row (slots, rows)."""
    turns = np.zeros((len(slots), inputs.shape[1]))
    if inputs.shape[1] < 2:
        return turns
    outputs, rows = outputs_between(session, readout, inputs, start)
    for number, slot in enumerate(slots):
        along = outputs[slot]
        jumps = np.cumsum(np.rint(np.diff(along, prepend=along[:1]) / (2.0 * pi)))
        turns[number, : rows.size] = jumps[rows]
    return turns


def outputs_between(
    session: Session, readout: Readout, inputs: Floats, start: Floats
) -> tuple[Floats, NDArray[np.int64]]:
    """Outputs (slots, places) along the refined path through some rows, and the places of the rows
    that were reached; `start` is the state at the first."""
    path, rows = refined(inputs)
    followed = session.follow(path, start)
    count = followed.reached
    batch = session.run(path[:, :count], followed.guess[:, :count], readout=readout)
    assert batch.outputs is not None
    return batch.outputs, rows[rows < count]


def refined(inputs: Floats) -> tuple[Floats, NDArray[np.int64]]:
    """The path with places added between the rows, and the rows' places on it."""
    pieces = [inputs[:, :1]]
    places = [0]
    for k in range(1, inputs.shape[1]):
        a, b = inputs[:, k - 1 : k], inputs[:, k : k + 1]
        largest = float(np.max(np.abs(b - a), initial=0.0))
        parts = max(1, int(np.ceil(largest / tolerances.CLOSING_ANGLE_STEP)))
        fractions = np.arange(1, parts) / parts
        pieces.extend((a + (b - a) * fractions, b))
        places.append(places[-1] + parts)
    return np.ascontiguousarray(np.concatenate(pieces, axis=1)), np.array(places)
