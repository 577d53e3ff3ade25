"""Outlines of wheels, racks and belts for pictures, with straight flanks in place of involutes, and
the lines of cables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import DrawnBelt, DrawnWheel

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

ABOVE, BELOW = 1.0, 1.25
"""Height of teeth beyond the pitch line and below it, in modules."""

FLANK = 0.36
"""Tangent of the angle of a flank: 20 degrees."""

SIDES = 48
"""Of what is drawn round."""

RIM, RACK = 3.5, 2.5
"""Of a ring beyond its pitch circle, and of a rack below its pitch line, in modules."""

RACK_ENDS = 2.5
"""Half the length of a rack in parts of its pinion's radius."""


def wheel_outlines(wheel: DrawnWheel, toothed: bool) -> list[Floats]:
    """Closed lines (n, 3) on the home drawing of its link, m: of a ring the rim, too; teeth where
    they are to be seen, else the pitch circle. Of a worm places whose hull is its cylinder."""
    module = wheel.pitch / np.pi / np.sqrt(1.0 + wheel.lean**2) if wheel.teeth else 0.0
    if wheel.slide is not None:
        return [_placed(wheel, *_rack(wheel, module, toothed))]
    if wheel.is_worm:
        tip, half = wheel.radius + ABOVE * module, 0.5 * wheel.width
        return [np.concatenate([_circle(wheel, tip, -half), _circle(wheel, tip, half)])]
    if not (toothed and wheel.teeth):
        lines = [_circle(wheel, wheel.radius)]
    else:
        lines = [_placed(wheel, *_teeth(wheel, module), 0.0)]
    if wheel.inner:
        lines.append(_circle(wheel, wheel.radius + RIM * (module or 0.03 * wheel.radius)))
    return lines


def belt_line(belt: DrawnBelt) -> Floats:
    """Its closed line (n, 3) on the home drawing of the carrier, m."""
    return np.array(belt.line)


def cable_pulleys(
    places: Floats, beside: Sequence[float], axes: Floats, swivels: Sequence[int]
) -> tuple[Floats, Floats]:
    """Centres (n, 3) and axes of the pulleys at a cable's places (m), and the places of what is
    none. One that swivels turns about its line to the place after it, or before it where the cable
    leaves along the line; a free one to both (`DrawnCable`)."""
    centres, turned = np.array(places), np.array(axes)
    for k, way in enumerate(swivels):
        if way == 2:
            normal = np.cross(places[k - 1] - places[k], places[k + 1] - places[k])
            turned[k] = normal / np.linalg.norm(normal)
        elif way:
            apart = places[k + way] - places[k]
            out = apart - (apart @ axes[k]) * axes[k]
            out = out / np.linalg.norm(out)
            centres[k] = places[k] + abs(beside[k]) * out
            turned[k] = np.cross(out, axes[k])
    return centres, turned


def cable_line(
    places: Floats, beside: Sequence[float], axes: Floats, swivels: Sequence[int]
) -> Floats:
    """The line (n, 3) of a cable past places (m): straight between two, round where it runs
    `beside` a centre, to the left against its axis where that is more than 0. Its begin and end on
    drums are where it leaves them."""
    centres, turned = cable_pulleys(places, beside, axes, swivels)
    line = [centres[0]] if beside[0] == 0.0 else []
    for k in range(len(places) - 1):
        one, other, near, far = centres[k], centres[k + 1], beside[k], beside[k + 1]
        # on its line a swivelling pulley is a point
        if swivels[k] == -1:
            one, near = places[k], 0.0
        if swivels[k + 1] == 1:
            other, far = places[k + 1], 0.0
        start, end = one, other
        if not near == far == 0.0:
            axis = turned[k] if near else turned[k + 1]
            if near and far and axis @ turned[k + 1] < 0.0:
                far = -far
            apart = other - one
            apart = apart - (apart @ axis) * axis
            square = float(apart @ apart)
            by = near - far
            length = np.sqrt(max(square - by * by, 0.0))
            along = (length * apart - by * np.cross(axis, apart)) / square
            left = np.cross(axis, along)
            start, end = one + near * left, other + far * left
        if beside[k] != 0.0 and k == 0:
            line.append(start)
        elif beside[k] != 0.0:
            line += _wound(centres[k], line[-1], start, beside[k], turned[k])
        line.append(end)
    return np.array(line)


def round_about(axis: Floats) -> Floats:
    """A circle of radius 1 about an axis (SIDES, 3)."""
    x = np.eye(3)[np.argmin(np.abs(axis))]
    x = x - (x @ axis) * axis
    x = x / np.linalg.norm(x)
    turns = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    found: Floats = np.cos(turns)[:, None] * x + np.sin(turns)[:, None] * np.cross(axis, x)
    return found


def _wound(
    centre: Floats, first: Floats, last: Floats, beside: float, axis: Floats
) -> list[Floats]:
    """Places on a pulley from one end of the arc to the other: clockwise about its axis where it is
    passed on its left."""
    x = first - centre
    y = np.cross(axis, x) * (-1.0 if beside > 0.0 else 1.0)
    turn = np.arctan2((last - centre) @ y, (last - centre) @ x) % (2.0 * np.pi)
    steps = max(1, int(np.ceil(turn * SIDES / (2.0 * np.pi))))
    angles = turn * np.arange(1, steps + 1) / steps
    return [centre + np.cos(a) * x + np.sin(a) * y for a in angles]


def _teeth(wheel: DrawnWheel, module: float) -> tuple[Floats, Floats]:
    """Along and square to the mark: four corners a tooth, from the mark on."""
    sign = -1.0 if wheel.inner else 1.0
    tip, root = wheel.radius + sign * ABOVE * module, wheel.radius - sign * BELOW * module
    quarter = 0.25 * wheel.pitch
    at_tip, at_root = quarter - ABOVE * module * FLANK, quarter + BELOW * module * FLANK
    turns = 2.0 * np.pi * np.arange(wheel.teeth)[:, None] / wheel.teeth
    angles = turns + np.array([-at_root, -at_tip, at_tip, at_root]) / wheel.radius
    radii = np.broadcast_to([root, tip, tip, root], angles.shape)
    return (radii * np.cos(angles)).ravel(), (radii * np.sin(angles)).ravel()


def _rack(wheel: DrawnWheel, module: float, toothed: bool) -> tuple[float | Floats, ...]:
    """Out of the teeth, beside them and along the rack."""
    ends = RACK_ENDS * wheel.radius
    count = int(ends / wheel.pitch)
    quarter, back = 0.25 * wheel.pitch, -RACK * module
    if not toothed:
        return np.array([0.0, 0.0, back, back]), 0.0, np.array([-ends, ends, ends, -ends])
    at_tip, at_root = quarter - ABOVE * module * FLANK, quarter + BELOW * module * FLANK
    middles = wheel.pitch * np.arange(-count, count + 1)[:, None]
    along = (middles + np.array([-at_root, -at_tip, at_tip, at_root])).ravel()
    out = np.tile(np.array([-BELOW, ABOVE, ABOVE, -BELOW]) * module, 2 * count + 1)
    along = np.concatenate([along, [along[-1], along[0]]])
    return np.concatenate([out, [back, back]]), 0.0, along


def _circle(wheel: DrawnWheel, radius: float, height: float = 0.0) -> Floats:
    turns = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    return _placed(wheel, radius * np.cos(turns), radius * np.sin(turns), height)


def _placed(wheel: DrawnWheel, x: float | Floats, y: float | Floats, z: float | Floats) -> Floats:
    """Places (n, 3) of coordinates in the wheel's frame."""
    x, y, z = np.broadcast_arrays(x, y, z)
    on = wheel.on
    found: Floats = np.array(on.o) + (
        x[:, None] * np.array(on.x) + y[:, None] * np.array(on.y) + z[:, None] * np.array(on.z)
    )
    return found
