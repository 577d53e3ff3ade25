"""How many closing equations of a loop tell something new: its order, less the closing joint's
freedoms.

The order of a loop is the rank of all its joints' screws as drawn: six in general, three in a plane
or about a point. A plane loop that is closed at an R has five equations, of which two determine
unknowns; the other three hold by its dimensions.
"""

from __future__ import annotations

from functools import lru_cache

from mechkin_cli.mechanism.elementary import Screw
from mechkin_cli.mechanism.model import Joint, diagonal
from mechkin_cli.mechanism.vectors import ZERO
from mechkin_cli.tolerances import LOOP_RANK


@lru_cache(maxsize=1024)
def loop_order(joints: tuple[Joint, ...]) -> int:
    """Rank of the screws of a loop's joints as drawn, moments in parts of the loop's size."""
    length = diagonal([f.o for joint in joints for f in (joint.on_first, joint.on_second)])
    rows = [_scaled(screw, length) for joint in joints for screw in joint.screws]
    order = 0
    for column in range(6):
        best = max(range(order, len(rows)), key=lambda i: abs(rows[i][column]), default=None)
        if best is None or abs(rows[best][column]) <= LOOP_RANK:
            continue
        rows[order], rows[best] = rows[best], rows[order]
        pivot = rows[order]
        for row in rows[order + 1 :]:
            factor = row[column] / pivot[column]
            for i in range(column, 6):
                row[i] -= factor * pivot[i]
        order += 1
    return order


def _scaled(screw: Screw, length: float) -> list[float]:
    """Angular part first; the moment of a turn in parts of `length`, a slide as it is."""
    angular, linear = screw
    unit = 1.0 if angular == ZERO else length
    return [*angular, *(component / unit for component in linear)]
