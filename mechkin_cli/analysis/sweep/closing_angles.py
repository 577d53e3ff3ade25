"""Continuous angles: the kernel gives them within a turn, following counts whole turns
(`solver.closing_turns`)."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.solver.closing_turns import continuous_angle, tree_slots, turn_slots

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Columns, Result
    from mechkin_cli.mechanism.quantities import Wanted


def make_continuous(result: Result, wanted: Sequence[Wanted], columns: Columns) -> Columns:
    """Makes angles in `columns` continuous from the first row, in place; returns what they are
    within a turn."""
    rows, layout = result.row_states, result.session.layout
    angles = [quantity for quantity in wanted if has_turns(quantity)]
    rests: Columns = {}
    if not angles or not rows.reached.any():
        return rests
    closing, tree = turn_slots(result.session.plan), tree_slots(result.session.plan)
    reached = np.flatnonzero(rows.reached)
    driven = {item.name: item.values for item in result.problem.motion.inputs}
    for quantity in angles:
        reference = layout.joint_reference[quantity.owner]
        freedom = layout.mechanism.joints[quantity.owner].type.freedom_of[quantity.coordinate]
        column = columns[quantity.name][0]
        if quantity.name in driven:
            column[reached] = driven[quantity.name][reached]
            continue
        slot = (
            closing.get((-1 - reference, freedom))
            if reference < 0
            else tree.get(layout.state(layout.edge_number[quantity.owner], freedom))
        )
        if slot is None:
            continue
        turned, rest = rows.turns[slot, reached], column.copy()
        if reference < 0:
            column[reached] = continuous_angle(column[reached], turned)
        else:
            column[reached] += turned * (2.0 * pi)
        if np.any(column[reached] != rest[reached]):
            rests[quantity.name] = rest
    return rests


def has_turns(quantity: Wanted) -> bool:
    """Whether a quantity is an angle, which may have whole turns."""
    return quantity.kind == "coordinate" and is_angle(quantity.coordinate) and quantity.order == 0
