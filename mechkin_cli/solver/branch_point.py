"""Branch points: where two branches cross, so that the mechanism may change from one to the other.

There the smallest singular value s of the closing equations vanishes although the motion does not
stop. Along a branch s goes to zero linearly (next to a fold only as a square root), so the place
follows from values at some distance, where they are exact: the zero of the polynomial through them
(Neville's scheme), never a minimum of a determinant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import functions
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.follow import Followed, TrackEnd, follow

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan

    Floats = NDArray[np.float64]

NODES = 9
"""Places at which the singular value is read: Chebyshev's, so that the polynomial stays tame."""


class BranchPoint(NamedTuple):
    """How far beyond the last place on the branch, in the direction it went; and about how far off
    that may be (rad or length units)."""

    distance: float
    doubt: float


def locate_branch_point(
    plan: Plan, followed: Followed, inputs: Floats, state: Floats
) -> BranchPoint | None:
    """The branch point next to the place where a branch could not be followed further, or None if
    the singular value tells of none.

    Args:
        plan: the kernel's plan.
        followed: the way to that place.
        inputs: (inputs,) an earlier place of the same straight way, where it begins to be read.
        state: (states,) there.
    """
    found = None
    room = float(np.max(np.abs(followed.inputs - inputs)))
    for span in tolerances.BRANCH_POINT_SPANS:
        place = _extrapolated(plan, followed, inputs, state, span) if span < room else None
        if place is None:
            continue
        if found is None or place.doubt < found.doubt:
            found = place
    if found is None or found.doubt > tolerances.BRANCH_POINT_DOUBT:
        return None
    return found if abs(found.distance) <= tolerances.BRANCH_POINT_NEAR else None


def _extrapolated(
    plan: Plan, followed: Followed, inputs: Floats, state: Floats, span: float
) -> BranchPoint | None:
    """The zero seen from NODES places between a span and a tenth of it before the last place."""
    angles = np.asarray((2.0 * np.arange(NODES) + 1.0) * np.pi / (2.0 * NODES), dtype=np.float64)
    before: Floats = span * (0.55 + 0.45 * functions.cos(angles))
    places = followed.inputs[:, None] - followed.direction[:, None] * before
    path = np.concatenate([inputs[:, None], places], axis=1)
    way = follow(plan, np.ascontiguousarray(path), state)
    if way.end != TrackEnd.FINISHED:
        return None
    rates = np.repeat(followed.direction[:, None], NODES, axis=1)
    batch = run(
        plan,
        np.ascontiguousarray(path[:, 1:]),
        np.ascontiguousarray(way.guess[:, 1:]),
        rates=rates,
        demand=Demand.VELOCITY | Demand.CONDITION,
    )
    if not batch.good.all() or batch.condition is None:
        return None
    singular = 1.0 / batch.condition
    if not np.all(np.diff(singular) < 0.0):
        return None
    # inverse interpolation: the distance as a polynomial of the singular value, at zero
    found = _neville(singular, -before)
    return found if _is_linear(singular, before + found.distance) else None


def _is_linear(singular: Floats, distance: Floats) -> bool:
    """Whether the distance goes as the singular value, not as its square as next to a fold."""
    ratio = float(singular[-2] / singular[-1])
    return float(distance[-2] / distance[-1]) ** 2 < ratio * ratio * ratio


def _neville(x: Floats, y: Floats) -> BranchPoint:
    table = y.copy()
    last = table[0]
    for order in range(1, x.size):
        last = table[0]
        ahead, behind = x[order:], x[:-order]
        table = (ahead * table[:-1] - behind * table[1:]) / (ahead - behind)
    return BranchPoint(float(table[0]), float(abs(table[0] - last)))
