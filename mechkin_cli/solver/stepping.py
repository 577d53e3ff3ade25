"""The kernel's limits of a step along a path, by name."""

from __future__ import annotations

from functools import cache

from mechkin_cli import tolerances
from mechkin_cli.kernel._kernel import StepLimits


@cache
def step_limits(
    longest_step: float = tolerances.LONGEST_STEP,
    least_step: float = tolerances.LEAST_STEP,
    *,
    straight: bool = False,
) -> StepLimits:
    """What a step may do, from `tolerances`; `straight`: pass branch points."""
    return StepLimits(
        turn_cosine=tolerances.TURN_LIMIT_COSINE,
        turn=tolerances.TURN_WANTED,
        bend=tolerances.BEND_WANTED,
        jump=tolerances.JUMP_LIMIT,
        infill=tolerances.INFILL_LIMIT,
        longest_step=longest_step,
        least_step=least_step,
        most_steps=tolerances.MOST_STEPS,
        tight=tolerances.RESIDUAL_TIGHT,
        coarse=tolerances.STEP_COARSE,
        accept=tolerances.RESIDUAL_ACCEPT,
        pivot=tolerances.NODE_PIVOT,
        iterations=tolerances.NEWTON_ITERATIONS,
        same_line=tolerances.SAME_LINE,
        knot=tolerances.PATH_KNOT,
        corner_cosine=tolerances.PATH_CORNER_COSINE,
        stray=tolerances.PATH_STRAY,
        angle_step=tolerances.CLOSING_ANGLE_STEP,
        angle_miss=tolerances.CLOSING_ANGLE_MISS,
        angle_bend=tolerances.CLOSING_ANGLE_BEND,
        plan_step=tolerances.PLAN_STEP,
        arc_pivot=tolerances.ARC_PIVOT,
        radius=tolerances.SPECTRAL_RADIUS,
        narrow=tolerances.NARROW_STEP,
        arc_steps=tolerances.ARC_STEPS,
        straight=straight,
    )
