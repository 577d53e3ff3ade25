"""Why a branch cannot be followed further: a dead centre, a slide that grows out of bounds, a
branch point, or no clear reason."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.branch_point import BranchPoint, locate_branch_point
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.dead_centre import DeadCentre, locate
from mechkin_cli.solver.follow import Followed
from mechkin_cli.solver.runaway import Runaway, find_runaway

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


def find_limit(
    session: Session, followed: Followed, inputs: Floats, state: Floats
) -> DeadCentre | Runaway | BranchPoint | None:
    """What ended a branch, or None.

    Args:
        session: the mechanism as it is driven.
        followed: the way to the branch's end.
        inputs: (inputs,) an earlier place of the same straight way.
        state: (states,) there.
    """
    moving = np.flatnonzero(followed.direction)
    if moving.size == 1:
        number = int(moving[0])
        first = _derivatives(session, followed)
        if first is not None:
            fold = locate(session, number, followed.inputs, followed.state, first)
            if fold is not None and _lies_ahead(fold, followed, number):
                return fold
    runaway = find_runaway(session.layout, followed.state)
    return runaway or locate_branch_point(session, followed, inputs, state)


def _derivatives(session: Session, followed: Followed) -> Floats | None:
    rates = np.ascontiguousarray(followed.direction[:, None])
    batch = session.run(
        followed.inputs[:, None],
        followed.state[:, None],
        rates=rates,
        accelerations=np.zeros_like(rates),
        demand=Demand.VELOCITY | Demand.ACCELERATION,
        derivatives=True,
    )
    return batch.first[:, 0] if batch.good[0] and batch.first is not None else None


def _lies_ahead(fold: DeadCentre, followed: Followed, number: int) -> bool:
    """Whether the fold is where the branch was going, next to where it could not be followed."""
    direction = float(followed.direction[number])
    ahead = (fold.value - float(followed.inputs[number])) * direction
    curvature = float(fold.second[fold.exchanged.input_column]) * direction
    return ahead >= -tolerances.DEAD_CENTRE_BEHIND and curvature < 0.0
