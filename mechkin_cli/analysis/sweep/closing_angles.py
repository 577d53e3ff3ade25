"""Continuous angles of closing joints.

The kernel has the angle of a closing joint from an arctangent; whole turns come from what following
carried along (`solver.closing_turns`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.solver.closing_turns import continuous_angle, turn_slots

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Columns, Result
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.layout import Layout


def make_continuous(result: Result, wanted: Sequence[Wanted], columns: Columns) -> None:
    """Makes the angles of closing joints in `columns` continuous from the first row, in place."""
    rows, layout = result.row_states, result.session.layout
    angles = [quantity for quantity in wanted if _is_closing_angle(layout, quantity)]
    if not angles or not rows.reached.any():
        return
    slots = turn_slots(result.session.plan)
    reached = np.flatnonzero(rows.reached)
    for quantity in angles:
        number = -1 - layout.joint_reference[quantity.owner]
        freedom = layout.mechanism.joints[quantity.owner].type.freedom_of[quantity.coordinate]
        followed = rows.turns[slots[number, freedom], reached]
        column = columns[quantity.name][0]
        column[reached] = continuous_angle(column[reached], followed, 0)


def _is_closing_angle(layout: Layout, quantity: Wanted) -> bool:
    return (
        quantity.kind == "coordinate"
        and is_angle(quantity.coordinate)
        and quantity.order == 0
        and layout.joint_reference[quantity.owner] < 0
    )
