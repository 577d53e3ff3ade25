"""Following a branch along the rows of a sweep: straight runs, guesses for every row, where it
ended.

The path of the inputs is straight between neighbouring rows. Rows in one line make a run, which the
kernel's tracker follows with a few careful nodes and fills in.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.codes import TrackEnd as TrackEnd

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan

LIMITS = (
    tolerances.TURN_LIMIT_COSINE,
    tolerances.TURN_WANTED,
    tolerances.BEND_WANTED,
    tolerances.JUMP_LIMIT,
    tolerances.INFILL_LIMIT,
    tolerances.LONGEST_STEP,
    tolerances.LEAST_STEP,
    float(tolerances.MOST_STEPS),
    *(tolerances.RESIDUAL_TIGHT, tolerances.STEP_COARSE, tolerances.RESIDUAL_ACCEPT),
    tolerances.NODE_PIVOT,
)


class Followed(NamedTuple):
    """Guesses for the rows that were reached.

    `guess` (states, rows) and `limit` (rows: largest correction that a fill-in row may still need)
    hold for the first `reached` rows. If the branch could not be followed further, `inputs` and
    `state` are the last place on it and `direction` the way the inputs were going.
    """

    guess: Floats
    limit: Floats
    reached: int
    end: TrackEnd
    steps: int
    inputs: Floats
    state: Floats
    direction: Floats


def follow(plan: Plan, inputs: Floats, start: Floats, *, every_row: bool = False) -> Followed:
    """Follows the branch through `start` (states at the first row) along all rows.

    Args:
        plan: the kernel's plan.
        inputs: (inputs, rows) in kernel units.
        start: (states,) closed at the first row.
        every_row: make each row a node of the skeleton instead of filling in.
    """
    rows = inputs.shape[1]
    guess = np.empty((start.size, rows))
    limit = np.full(rows, tolerances.JUMP_LIMIT)
    guess[:, 0] = start
    state, steps = start, 0
    last = np.empty(start.size)
    direction = np.zeros(inputs.shape[0])
    for begin, end, direction in _runs(inputs, every_row):
        if not direction.any():
            guess[:, begin:end] = state[:, None]
            continue
        origin = inputs[:, begin - 1]
        leading = int(np.argmax(np.abs(direction)))
        sigma = np.abs(inputs[leading, begin:end] - origin[leading])
        part, bound = np.empty((start.size, end - begin)), np.empty(end - begin)
        code, reached, taken, _, last_sigma, _ = plan.track(
            origin.tolist(), direction.tolist(), sigma, state, part, bound, last, LIMITS
        )
        steps += taken
        guess[:, begin : begin + reached] = part[:, :reached]
        limit[begin : begin + reached] = bound[:reached]
        if code != TrackEnd.FINISHED:
            place = origin + last_sigma * direction
            return Followed(
                guess, limit, begin + reached, TrackEnd(code), steps, place, last.copy(), direction
            )
        state = last.copy()
    return Followed(
        guess, limit, rows, TrackEnd.FINISHED, steps, inputs[:, -1].copy(), state, direction
    )


def _runs(inputs: Floats, every_row: bool) -> Iterator[tuple[int, int, Floats]]:
    """Runs (first row, end, direction); the direction's largest part is 1, zero for repeated
    rows."""
    rows = inputs.shape[1]
    if len(inputs) == 0:
        yield 1, rows, np.zeros(0)
        return
    if len(inputs) == 1 and rows > 1 and not every_row:
        steps = np.diff(inputs[0])
        for sign in (1.0, -1.0):
            if (sign * steps > 0.0).all():
                yield 1, rows, np.array([sign])
                return
    begin = 1
    while begin < rows:
        step = inputs[:, begin] - inputs[:, begin - 1]
        leading = int(np.argmax(np.abs(step)))
        size = abs(float(step[leading]))
        if size == 0.0:
            yield begin, begin + 1, np.zeros(inputs.shape[0])
            begin += 1
            continue
        direction = step / size
        end = begin + 1 if every_row else _end_of_run(inputs, begin, leading, direction)
        yield begin, end, direction
        begin = end


def _end_of_run(inputs: Floats, begin: int, leading: int, direction: Floats) -> int:
    origin = inputs[:, begin - 1 : begin]
    along = (inputs[leading, begin - 1 :] - origin[leading]) * direction[leading]
    onward = np.diff(along) > 0.0
    if inputs.shape[0] > 1:
        line = origin + direction[:, None] * along
        scale = 1.0 + np.abs(inputs[:, begin - 1 :]).max(axis=1, keepdims=True)
        off_line = np.abs(inputs[:, begin - 1 :] - line)
        on_line = np.all(off_line <= tolerances.SAME_LINE * scale, axis=0)
        onward &= on_line[1:]
    stops = np.flatnonzero(~onward)
    return begin + (int(stops[0]) if stops.size else onward.size)
