"""Why a branch cannot be followed further: a dead centre, a branch point, a slide that grows out of
bounds, or no clear reason.

Dead centres and branch points are located while the branch is followed, by arclength
(kernel/src/passage.cpp); never as minima of a determinant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.solver.follow import Ending, Followed, PassageEnd
from mechkin_cli.solver.runaway import Runaway, find_runaway

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


class DeadCentre(NamedTuple):
    """A fold: inputs (inputs,) and states (states,) where the path stops while the mechanism could
    go on; and a place of the branch on its other side, where the path goes back."""

    inputs: Floats
    state: Floats
    inputs_beyond: Floats
    beyond: Floats


class EndOfRows(NamedTuple):
    """A dead centre at which a way along rows ends: the last row before it, counted from 0, and
    what following found."""

    row: int
    ending: Ending


class BranchPoint(NamedTuple):
    """A place where two branches cross: inputs (inputs,) and states (states,)."""

    inputs: Floats
    state: Floats


def find_limit(session: Session, followed: Followed) -> DeadCentre | Runaway | BranchPoint | None:
    """What ended a branch, or None where it is not known."""
    found = followed.ending
    if found is not None and found.kind == PassageEnd.DEAD_CENTRE:
        return DeadCentre(found.inputs, found.state, found.inputs_beyond, found.beyond)
    runaway = find_runaway(session.layout, followed.state)
    if runaway is None and found is not None and found.kind == PassageEnd.BRANCH_POINT:
        return BranchPoint(found.inputs, found.state)
    return runaway
