"""Following a branch along the rows of a sweep: guesses for every row, where it ended.

The kernel does the work in one call (kernel/core/stepping/polyline.cpp), linear in the rows.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel._kernel import StepLimits
from mechkin_cli.plan import Layout, PassageEnd, TrackEnd
from mechkin_cli.record import NamedTuple
from mechkin_cli.session.kernel_run import turn_count

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.session.path import FollowedPath
    from mechkin_cli.show import Floats


_ENDS = tuple(TrackEnd)  # by their numbers: calling an enumeration takes longer than a step

# The kernel's limits of a step along a path, by name.


@cache
def step_limits(
    longest_step: float = tolerances.LONGEST_STEP, *, straight: bool = False
) -> StepLimits:
    """What a step may do, from `tolerances`; `straight`: pass branch points."""
    return StepLimits(**step_numbers(longest_step, straight=straight))


def step_numbers(
    longest_step: float = tolerances.LONGEST_STEP, *, straight: bool = False
) -> dict[str, Any]:
    """The same by name, in the order of the kernel's struct (kernel/core/stepping/stepper.hpp)."""
    return {
        "turn_cosine": tolerances.TURN_LIMIT_COSINE,
        "turn": tolerances.TURN_WANTED,
        "bend": tolerances.BEND_WANTED,
        "jump": tolerances.JUMP_LIMIT,
        "infill": tolerances.INFILL_LIMIT,
        "longest_step": longest_step,
        "least_step": tolerances.LEAST_STEP,
        "most_steps": tolerances.MOST_STEPS,
        "tight": tolerances.RESIDUAL_TIGHT,
        "coarse": tolerances.STEP_COARSE,
        "accept": tolerances.RESIDUAL_ACCEPT,
        "pivot": tolerances.NODE_PIVOT,
        "arc_pivot": tolerances.ARC_PIVOT,
        "radius": tolerances.SPECTRAL_RADIUS,
        "narrow": tolerances.NARROW_STEP,
        "arc_steps": tolerances.ARC_STEPS,
        "arc_work": tolerances.ARC_WORK,
        "straight": straight,
        "iterations": tolerances.NEWTON_ITERATIONS,
        "same_line": tolerances.SAME_LINE,
        "knot": tolerances.PATH_KNOT,
        "corner_cosine": tolerances.PATH_CORNER_COSINE,
        "stray": tolerances.PATH_STRAY,
        "angle_step": tolerances.CLOSING_ANGLE_STEP,
        "angle_miss": tolerances.CLOSING_ANGLE_MISS,
        "angle_bend": tolerances.CLOSING_ANGLE_BEND,
        "plan_step": tolerances.PLAN_STEP,
    }


class Ending(NamedTuple):
    """A dead centre or a branch point that ends a branch.

    `block` is the one that is singular there, `inputs` (inputs,) and `state` (states,) the place;
    `first` and `second` are derivatives of the columns by the arclength of the block's branch,
    `bend` the second one of the path's parameter, whose first is zero at a dead centre. `beyond`
    are inputs and states of a place on a dead centre's other side, where the path goes back.
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

    @property
    def is_dead_centre(self) -> bool:
        """Whether the path stops while the mechanism could go on; else two branches cross."""
        return self.kind == PassageEnd.DEAD_CENTRE


class Followed(NamedTuple):
    """Guesses for the rows that were reached.

    `guess` (states, rows) and `limit` (rows: largest correction that a fill-in row may still need)
    hold for the first `reached` rows, and so do `turns` (turn slots, rows) where they were asked
    for (`follow`): the angles and quaternions of cut joints, continuous from the
    first row, and the whole turns of the tree's angles, whose states are then within half a turn.
    If the branch could not be followed further, `inputs` and `state` are the last place on it,
    `turn` the turns there, and `direction` the way the inputs were going; where that lies on a
    piece of their course, `parameter` is the course's, at the ending where it is known.
    `crossings` are branch points that were passed straight on: the first row behind, the inputs.
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
    crossings: tuple[tuple[int, Floats], ...] = ()
    parameter: float | None = None


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
    slots: int | None = None,
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
        slots: `turn_count` of the plan, where it is known.
    """
    rows = inputs.shape[1]
    guess, limit = np.empty((start.size, rows)), np.empty(rows)
    # a branch that ends at its first row leaves them as they are
    along = None
    if turns:
        along = np.zeros((turn_count(plan) if slots is None else slots, rows))
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
    return Followed(
        guess,
        limit,
        reached,
        _ENDS[end],
        steps,
        place,
        state,
        direction,
        along,
        last_turn,
        ending,
        tuple(crossings),
        parameter if piece >= 0 else None,
    )


def follow_way(
    plan: Plan,
    way: FollowedPath,
    start: Floats,
    *,
    every_row: bool = False,
    straight: bool = False,
    turn: Floats | None = None,
) -> Followed:
    """Follows the branch along a way, with the turns of cut joints, and gives its rows alone;
    arguments as those of `follow`."""
    found = follow(
        plan,
        way.values,
        start,
        every_row=every_row,
        turns=True,
        turn=turn,
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
            (int(np.count_nonzero(real < row)), inputs) for row, inputs in found.crossings
        ),
    )


# Runaways: a branch that goes to infinity, a slide growing out of bounds before some input value.
#
# RCCC is an example: its turns have a dead centre there, and its slides go with their rates.


class Runaway(NamedTuple):
    """The joint whose slide has grown the most, to `slide` (length units)."""

    joint: str
    slide: float


def find_runaway(layout: Layout, state: Floats) -> Runaway | None:
    """The longest slide at the last place of a branch that was lost, if it is out of bounds."""
    driven = {layout.state(edge, freedom) for edge, freedom in layout.graph.inputs}
    longest = Runaway("", 0.0)
    for carrier in layout.carriers:
        for freedom, slide in enumerate(carrier.part.type.slides):
            number = carrier.state + freedom
            length = float(state[number])
            if slide and number not in driven and abs(length) > abs(longest.slide):
                longest = Runaway(layout.graph.edges[carrier.edge].joint.name, length)
    return longest if abs(longest.slide) >= tolerances.RUNAWAY_SLIDE else None
