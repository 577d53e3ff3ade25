"""Reading the last stretch before a place where a branch could not be followed, and extrapolating
to it.

At the place itself numbers are lost in rounding; some way before it they are exact. The place is
where a measure that goes to zero there does so: the zero of the polynomial through Chebyshev's
places (Neville's scheme), which keeps the polynomial tame.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.kernel import functions
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.follow import Followed, TrackEnd
from mechkin_cli.tolerances import APPROACH_PLACES

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.batch import Batch
    from mechkin_cli.solver.session import Session


class Approach(NamedTuple):
    """Distances before the last place, falling, and the solved positions there."""

    before: Floats
    batch: Batch


class Extrapolated(NamedTuple):
    """How far beyond the last place on the branch, in the direction it went; and about how far off
    that may be (rad or length units)."""

    distance: float
    doubt: float


def approach(
    session: Session, followed: Followed, inputs: Floats, state: Floats, span: float
) -> Approach | None:
    """Places between a span and a tenth of it before the last one.

    Args:
        session: the mechanism as it is driven.
        followed: the way to the last place.
        inputs: (inputs,) an earlier place of the same straight way, farther off than the span.
        state: (states,) there.
        span: distance in rad or length units.
    """
    if span >= float(np.max(np.abs(followed.inputs - inputs))):
        return None
    angles = np.asarray(
        (2.0 * np.arange(APPROACH_PLACES) + 1.0) * np.pi / (2.0 * APPROACH_PLACES),
        dtype=np.float64,
    )
    before: Floats = span * (0.55 + 0.45 * functions.cos(angles))
    places = followed.inputs[:, None] - followed.direction[:, None] * before
    path = np.concatenate([inputs[:, None], places], axis=1)
    way = session.follow(np.ascontiguousarray(path), state)
    if way.end != TrackEnd.FINISHED:
        return None
    batch = session.run(
        path[:, 1:],
        way.guess[:, 1:],
        rates=np.repeat(followed.direction[:, None], APPROACH_PLACES, axis=1),
        demand=Demand.VELOCITY | Demand.CONDITION | Demand.SINGULAR,
    )
    return Approach(before, batch) if batch.good.all() else None


def zero_of(measure: Floats, before: Floats) -> Extrapolated | None:
    """Where a falling measure vanishes; None if it does not fall.

    Inverse interpolation: the distance as a polynomial of the measure, at zero.
    """
    if not np.all(np.diff(measure) < 0.0):
        return None
    table = -before
    last = table[0]
    for order in range(1, measure.size):
        last = table[0]
        ahead, behind = measure[order:], measure[:-order]
        table = (ahead * table[:-1] - behind * table[1:]) / (ahead - behind)
    return Extrapolated(float(table[0]), float(abs(table[0] - last)))
