"""Branch points: where two branches cross, so that the mechanism may change from one to the other.

There the smallest singular value s of the closing equations vanishes although the motion does not
stop. Along a branch s goes to zero linearly (next to a fold only as a square root), so the place
follows from values at some distance, never from a minimum of a determinant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.approach import Extrapolated, approach, zero_of
from mechkin_cli.solver.follow import Followed

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


class BranchPoint(NamedTuple):
    """How far beyond the last place on the branch, in the direction it went (rad or length
    units)."""

    distance: float


def locate_branch_point(
    session: Session, followed: Followed, inputs: Floats, state: Floats
) -> BranchPoint | None:
    """The branch point next to the place where a branch could not be followed further, or None if
    the singular value tells of none.

    Args:
        session: the mechanism as it is driven.
        followed: the way to that place.
        inputs: (inputs,) an earlier place of the same straight way, where it begins to be read.
        state: (states,) there.
    """
    places = [
        _extrapolated(session, followed, inputs, state, span)
        for span in tolerances.BRANCH_POINT_SPANS
    ]
    sure = [p for p in places if p is not None and p.doubt <= tolerances.BRANCH_POINT_DOUBT]
    best = min(sure, key=lambda place: place.doubt, default=None)
    if best is None or abs(best.distance) > tolerances.BRANCH_POINT_NEAR:
        return None
    return BranchPoint(best.distance)


def _extrapolated(
    session: Session, followed: Followed, inputs: Floats, state: Floats, span: float
) -> Extrapolated | None:
    """The zero of the singular value as seen over a span before the last place."""
    seen = approach(session, followed, inputs, state, span)
    if seen is None or seen.batch.condition is None or not np.all(seen.batch.condition > 0.0):
        return None
    singular = 1.0 / seen.batch.condition
    found = zero_of(singular, seen.before)
    if found is None or not _is_linear(singular, seen.before + found.distance):
        return None
    return found


def _is_linear(singular: Floats, distance: Floats) -> bool:
    """Whether the distance goes as the singular value, not as its square as next to a fold."""
    ratio = float(singular[-2] / singular[-1])
    return float(distance[-2] / distance[-1]) ** 2 < ratio * ratio * ratio
