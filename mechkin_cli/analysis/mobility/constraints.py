"""Constraints of the joints on the poses of the links, with their gradients, for questions of rank.

Unknowns are the poses of all moving links, so that no spanning tree and no input is needed, and a
row of the gradient is the wrench that the joint carries: (moment about the origin, force) against
the links' twists (angular first) at the origin. Lengths are in parts of the size.

With A the joint's frame on its first link, B on its second, d = B.o - A.o, a joint's equations are
components of d along axes of either frame, cosines between axes that stay square, and for a thread
d.z = lead/(2 pi) * turn. NumPy's linear algebra is used on them: they feed messages, never cells.
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.mechanism.frames import Frame
from mechkin_cli.mechanism.model import Joint

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

GROUND_AXES = np.eye(3)


class Axes(NamedTuple):
    """A frame in the ground: rows of `axes` are x, y, z; `o` its origin."""

    axes: Floats
    o: Floats


class Constraint(NamedTuple):
    """One equation: its miss, its gradient for the twists of the first and second link (6,) each.

    `kind` is the freedom it takes: a "force" along `direction` or a "moment" about it.
    """

    miss: float
    on_first: Floats
    on_second: Floats
    kind: str
    direction: Floats


def carried(frame: Frame, turn: Floats, place: Floats, centre: Floats, size: float) -> Axes:
    """A frame drawn on a link whose pose maps the drawing p to turn p + place (lengths scaled)."""
    axes = np.array([frame.x, frame.y, frame.z])
    origin = (np.array(frame.o) - centre) / size
    return Axes(axes @ turn.T, turn @ origin + place)


def constraints(joint: Joint, first: Axes, second: Axes, size: float) -> list[Constraint]:
    """The 6 - f equations of a joint."""
    a, b = first.axes, second.axes
    letter = joint.letter
    if letter == "S":
        return _along(first, second, GROUND_AXES, 0)
    if letter == "Sp":
        return _along(first, second, b[2:], 2)
    if letter == "Sg":
        return _along(first, second, b[:2], 2)
    if letter == "Cp":
        return [*_along(first, second, b[2:], 2), _square(a[2], b[2])]
    if letter == "Sc":
        square = np.array([_cylinder(joint, first)[1], a[2]])
        return [*_along(first, second, square, 1), _square(a[2], b[2])]
    if letter in ("U", "Ss"):
        return [*_along(first, second, GROUND_AXES, 0), _square(a[2], b[2], joint.parameter)]
    parallel = [_square(a[2], b[0]), _square(a[2], b[1])]
    if letter == "E":
        return [*_along(first, second, a[2:], 1), *parallel]
    across = _along(first, second, a[:2], 1)
    if letter == "C":
        return [*across, *parallel]
    if letter == "P":
        return [*across, *parallel, _square(a[0], b[1])]
    (along,) = _along(first, second, a[2:], 1)
    if letter == "H":
        return [*across, *parallel, _thread(along, first, second, joint.lead / (2 * pi * size))]
    turn = [_square(a[0], b[1])] if letter == "W" else []
    return [*across, along, *parallel, *turn]


def on_side(joint: Joint, first: Axes, second: Axes) -> bool:
    """Whether the axes that the equations only square also point the same way."""
    if joint.letter in ("S", "Sp", "Sg", "U", "Ss", "Sc", "Cp"):
        return True
    axes = (0, 2) if joint.letter in ("P", "W") else (2,)
    return all(float(first.axes[i] @ second.axes[i]) > 0.0 for i in axes)


def freedoms(joint: Joint, first: Axes, second: Axes, size: float) -> Floats:
    """Screws (freedoms, 6) of the second link against the first, in the order of the joint's
    coordinates."""
    a, b = first.axes, second.axes
    at = first.o if joint.letter in ("Sp", "Sg", "Cp") else second.o
    ball = [_turn(axis, at) for axis in GROUND_AXES]
    z = _turn(a[2], at)
    return np.array(
        {
            "R": [z],
            "P": [_slide(a[2])],
            "C": [z, _slide(a[2])],
            "H": [z + joint.lead / (2 * pi * size) * _slide(a[2])],
            "S": ball,
            "Sp": [*ball, _slide(b[0]), _slide(b[1])],
            "Sg": [*ball, _slide(b[2])],
            "U": [z, _turn(b[2], at)],
            "Ss": [z, _turn(b[2], at)],
            "Sc": [_slide(_cylinder(joint, first)[0]), z, _turn(b[2], at)],
            "Cp": [z, _turn(b[2], at), _slide(b[0]), _slide(b[1])],
            "E": [_slide(a[0]), _slide(a[1]), z],
            "W": [],
        }[joint.letter]
    ).reshape(-1, 6)


def _cylinder(joint: Joint, first: Axes) -> tuple[Floats, Floats]:
    """Axis of the slotted cylinder of Sc, and the direction across it in the slot's plane."""
    cosine = joint.parameter
    sine = np.sqrt(1.0 - cosine * cosine)
    x, y = first.axes[:2]
    return sine * x - cosine * y, cosine * x + sine * y


def _turn(axis: Floats, at: Floats) -> Floats:
    return np.concatenate([axis, np.cross(at, axis)])


def _slide(axis: Floats) -> Floats:
    return np.concatenate([np.zeros(3), axis])


def _along(first: Axes, second: Axes, axes: Floats, carrier: int) -> list[Constraint]:
    """d . u for axes u that stand still (0) or ride on the first (1) or second (2) link."""
    d = second.o - first.o
    found = []
    for u in axes:
        on_first = -np.concatenate([np.cross(first.o, u), u])
        on_second = np.concatenate([np.cross(second.o, u), u])
        turned = np.concatenate([np.cross(u, d), np.zeros(3)])
        if carrier == 1:
            on_first = on_first + turned
        elif carrier == 2:
            on_second = on_second + turned
        found.append(Constraint(float(d @ u), on_first, on_second, "force", u))
    return found


def _square(a: Floats, b: Floats, cosine: float = 0.0) -> Constraint:
    """a . b = cosine, a on the first link and b on the second."""
    moment = np.concatenate([np.cross(b, a), np.zeros(3)])
    return Constraint(float(a @ b) - cosine, -moment, moment, "moment", np.cross(b, a))


def _thread(along: Constraint, first: Axes, second: Axes, per_radian: float) -> Constraint:
    """The slide follows the turn; of the turns that look alike, the one next to the slide."""
    x, y = first.axes[:2]
    angle = np.arctan2(float(second.axes[0] @ y), float(second.axes[0] @ x))
    miss = along.miss - per_radian * angle
    if per_radian:
        miss -= 2 * pi * per_radian * round(miss / (2 * pi * per_radian))
    turn = per_radian * np.concatenate([first.axes[2], np.zeros(3)])
    return Constraint(miss, along.on_first + turn, along.on_second - turn, "force", along.direction)
