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


def make_continuous(result: Result, wanted: Sequence[Wanted], columns: Columns) -> None:
    """Makes angles in `columns` continuous from the first row, in place."""
    rows, layout = result.row_states, result.session.layout
    angles = [quantity for quantity in wanted if _is_angle(quantity)]
    if not angles or not rows.reached.any():
        return
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
        if reference < 0:
            followed = rows.turns[closing[-1 - reference, freedom], reached]
            column[reached] = continuous_angle(column[reached], followed)
            continue
        slot = tree.get(layout.state(layout.edge_number[quantity.owner], freedom))
        if slot is not None:
            column[reached] += rows.turns[slot, reached] * (2.0 * pi)


def _is_angle(quantity: Wanted) -> bool:
    return quantity.kind == "coordinate" and is_angle(quantity.coordinate) and quantity.order == 0
