"""Following a branch along the rows of a sweep: guesses for every row, where it ended.

The kernel does the work in one call (kernel/src/polyline.cpp), linear in the rows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.solver.closing_turns import turn_count
from mechkin_cli.solver.codes import PassageEnd as PassageEnd
from mechkin_cli.solver.codes import TrackEnd as TrackEnd
from mechkin_cli.solver.stepping import step_limits

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan, StepLimits
    from mechkin_cli.solver.route import Way


class Ending(NamedTuple):
    """A dead centre or a branch point that ends a branch.

    `block` is the one that is singular there, `inputs` (inputs,) and `state` (states,) the place;
    `first` and `second` are derivatives of the columns by the arclength of the block's branch,
    `bend` the second one of the path's parameter, whose first is zero at a dead centre. `beyond`
    are inputs and states of a place on a dead centre's other side.
    """

    kind: PassageEnd
    block: int
    inputs: Floats
    state: Floats
    first: Floats
    second: Floats
    bend: float
    inputs_beyond: Floats
    beyond: Floats


class Crossing(NamedTuple):
    """A branch point that was passed straight on: the first row behind it, and its inputs."""

    row: int
    inputs: Floats


class Followed(NamedTuple):
    """Guesses for the rows that were reached.

    `guess` (states, rows) and `limit` (rows: largest correction that a fill-in row may still need)
    hold for the first `reached` rows, and so do `turns` (turn slots, rows) where they were asked
    for (`solver.closing_turns`): the angles and quaternions of closing joints, continuous from the
    first row, and the whole turns of the tree's angles, whose states are then within half a turn.
    If the branch could not be followed further, `inputs` and `state` are the last place on it,
    `turn` the turns there, and `direction` the way the inputs were going; where that lies on a
    piece of their course, `parameter` is the course's, at the ending where it is known.
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
    ending: Ending | None = None
    crossings: tuple[Crossing, ...] = ()
    parameter: float | None = None

    @property
    def turn_is_known(self) -> bool:
        """Whether turns were asked for, and the first row closed."""
        return self.turn is not None and self.turn.size > 0


def follow(
    plan: Plan,
    inputs: Floats,
    start: Floats,
    *,
    every_row: bool = False,
    turns: bool = False,
    turn: Floats | None = None,
    straight: bool = False,
    course: _kernel.Course | None = None,
    whole: Floats | None = None,
    limits: StepLimits | None = None,
) -> Followed:
    """Follows the branch through `start` (states at the first row) along all rows.

    Args:
        plan: the kernel's plan.
        inputs: (inputs, rows) in kernel units; angles without their `whole` turns, if these are
            given.
        start: (states,) closed at the first row.
        every_row: make each row a node of the skeleton instead of filling in.
        turns: carry turns along.
        turn: (turn slots,) turns at the first row, where they are known from a way before it.
        straight: pass branch points along the smooth continuation.
        course: of the inputs between the rows, where they do not go straight.
        whole: (inputs, rows) whole turns.
        limits: what a step may do, instead of what `tolerances` says (and of `straight`).
    """
    rows = inputs.shape[1]
    guess, limit = np.empty((start.size, rows)), np.empty(rows)
    along = np.empty((turn_count(plan), rows)) if turns else None
    given = [] if turn is None else turn.tolist()
    found = _kernel.follow_rows(
        plan,
        np.ascontiguousarray(inputs),
        None if whole is None else np.ascontiguousarray(whole),
        start.tolist(),
        given,
        every_row,
        limits or step_limits(straight=straight),
        guess,
        limit,
        along,
        course,
    )
    end, reached, steps, _, place, state, last_turn, direction = found[:8]
    ends, crossings, piece, parameter = found[8:]
    ending = None if ends is None else Ending(PassageEnd(ends[0]), *ends[1:])
    crossed = tuple(Crossing(*each) for each in crossings)
    return Followed(
        guess,
        limit,
        reached,
        TrackEnd(end),
        steps,
        place,
        state,
        direction,
        along,
        last_turn,
        ending,
        crossed,
        parameter if piece >= 0 else None,
    )


def follow_way(
    plan: Plan,
    way: Way,
    start: Floats,
    *,
    every_row: bool = False,
    straight: bool = False,
) -> Followed:
    """Follows the branch along a way, with the turns of closing joints, and gives its rows alone;
    arguments as those of `follow`."""
    found = follow(
        plan,
        way.values,
        start,
        every_row=every_row,
        turns=True,
        straight=straight,
        course=way.course,
    )
    if found.end != TrackEnd.FINISHED and found.parameter is None:
        inputs = found.inputs if found.ending is None else found.ending.inputs
        found = found._replace(parameter=way.parameter_of(found.reached - 1, inputs))
    real = way.real
    if real.size == way.rows.size:
        return found
    assert found.turns is not None
    return found._replace(
        guess=np.ascontiguousarray(found.guess[:, real]),
        limit=found.limit[real],
        reached=int(np.count_nonzero(real < found.reached)),
        turns=np.ascontiguousarray(found.turns[:, real]),
        crossings=tuple(
            Crossing(int(np.count_nonzero(real < crossing.row)), crossing.inputs)
            for crossing in found.crossings
        ),
    )
