"""Why a path ends where it does: a fold, a runaway, a branch point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.plan import PassageEnd
from mechkin_cli.session.following import (
    BranchFold,
    BranchPoint,
    Followed,
    Runaway,
    find_runaway,
    step_limits,
)
from mechkin_cli.session.kernel_run import Ask, RowInputs
from mechkin_cli.tolerances import FREE_INPUT_MISS, FREE_INPUT_STEP

if TYPE_CHECKING:
    from mechkin_cli.session.session import Session
    from mechkin_cli.show import Floats


def find_limit(session: Session, followed: Followed) -> BranchFold | Runaway | BranchPoint | None:
    """What ended a branch, or None where it is not known."""
    found = followed.ending
    if found is not None and found.kind == PassageEnd.DEAD_CENTRE:
        return BranchFold(found.inputs, found.state, found.inputs_beyond, found.beyond)
    runaway = find_runaway(session.layout, followed.state)
    if runaway is None and found is not None and found.kind == PassageEnd.BRANCH_POINT:
        return BranchPoint(found.inputs, found.state)
    return runaway


def moves_freely(session: Session, inputs: Floats, state: Floats) -> bool:
    """Whether the loops still close, to third order, a little further on each input in turn, with
    the others held; False also where the rates are not known, as next to a dead centre.

    Args:
        session: the mechanism as it is driven.
        inputs: (inputs,) in kernel units.
        state: (states,) closed there.
    """
    limits = step_limits()
    for number in range(inputs.size):
        direction = np.zeros(inputs.size)
        direction[number] = 1.0
        stepper = _kernel.Stepper.straight(
            session.plan, inputs.tolist(), direction.tolist(), limits
        )
        node = stepper.close(0.0, state.tolist())
        if node is None:
            return False
        guess = np.asarray(stepper.predict(node, FREE_INPUT_STEP))[:, None]
        moved = (inputs + FREE_INPUT_STEP * direction)[:, None]
        batch = session.run(RowInputs(moved, guess), Ask(iterations=0))
        if not batch.residual[0] <= FREE_INPUT_MISS:
            return False
    return True
