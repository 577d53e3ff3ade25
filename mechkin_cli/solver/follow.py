"""Following a branch along the rows of a sweep: guesses for every row, where it ended.

The kernel does the work in one call (kernel/src/polyline.cpp), linear in the rows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.solver.closing_turns import turn_count
from mechkin_cli.solver.codes import TrackEnd as TrackEnd
from mechkin_cli.solver.stepping import step_limits

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan


class Followed(NamedTuple):
    """Guesses for the rows that were reached.

    `guess` (states, rows) and `limit` (rows: largest correction that a fill-in row may still need)
    hold for the first `reached` rows, and so do `turns` (turn slots, rows), the angles and
    quaternions of closing joints, continuous from the first row, where they were asked for
    (`solver.closing_turns`). If the branch could not be followed further, `inputs` and `state` are
    the last place on it, `turn` the closing joints' turns there, and `direction` the way the inputs
    were going.
    """

    guess: Floats
    limit: Floats
    reached: int
    end: TrackEnd
    steps: int
    inputs: Floats
    state: Floats
    direction: Floats
    turns: Floats | None = None
    turn: Floats | None = None


def follow(
    plan: Plan,
    inputs: Floats,
    start: Floats,
    *,
    every_row: bool = False,
    turns: bool = False,
    turn: Floats | None = None,
) -> Followed:
    """Follows the branch through `start` (states at the first row) along all rows.

    Args:
        plan: the kernel's plan.
        inputs: (inputs, rows) in kernel units.
        start: (states,) closed at the first row.
        every_row: make each row a node of the skeleton instead of filling in.
        turns: carry the turns of closing joints along.
        turn: (turn slots,) turns at the first row, where they are known from a way before it.
    """
    rows = inputs.shape[1]
    guess, limit = np.empty((start.size, rows)), np.empty(rows)
    along = np.empty((turn_count(plan), rows)) if turns else None
    given = [] if turn is None else turn.tolist()
    end, reached, steps, _, place, state, last_turn, direction = _kernel.follow_rows(
        plan,
        np.ascontiguousarray(inputs),
        start.tolist(),
        given,
        every_row,
        step_limits(),
        guess,
        limit,
        along,
    )
    return Followed(
        guess, limit, reached, TrackEnd(end), steps, place, state, direction, along, last_turn
    )
