"""How many closing equations of a loop tell something new: its order, less the closing joint's
freedoms.

The order of a loop is the rank of all its joints' screws as drawn: six in general, three in a plane
or about a point. A plane loop that is closed at an R has five equations, of which two determine
unknowns; the other three hold by its dimensions.
"""

from __future__ import annotations

from functools import lru_cache

from mechkin_cli.mechanism.frames import Frame
from mechkin_cli.mechanism.model import Joint, diagonal
from mechkin_cli.mechanism.vectors import ZERO, cross
from mechkin_cli.tolerances import LOOP_RANK

Screw = tuple[float, ...]


@lru_cache(maxsize=1024)
def loop_order(joints: tuple[Joint, ...]) -> int:
    """Rank of the screws of a loop's joints as drawn, moments in parts of the loop's size."""
    length = diagonal([f.o for joint in joints for f in (joint.on_first, joint.on_second)])
    rows = [list(screw) for joint in joints for screw in _screws(joint, length)]
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


def _screws(joint: Joint, length: float) -> list[Screw]:
    """Angular part first, moments in parts of `length`."""
    found: list[Screw] = []
    for part in joint.parts:
        frame, letter = part.before, part.letter
        if letter in "RHC":
            pitch = joint.lead / 6.283185307179586 if letter == "H" else 0.0
            found.append(_turn(frame, frame.z, pitch, length))
        if letter in "PC":
            found.append((*ZERO, *frame.z))
        if letter == "S":
            found += [_turn(frame, axis, 0.0, length) for axis in (frame.x, frame.y, frame.z)]
    return found


def _turn(frame: Frame, axis: tuple[float, float, float], pitch: float, length: float) -> Screw:
    moment = cross(frame.o, axis)
    return (*axis, *((m + pitch * a) / length for m, a in zip(moment, axis, strict=True)))
