"""Outlines of wheels, racks and belts for pictures, with straight flanks in place of involutes, the
lines of cables, and those of threads that face the eye."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import DrawnBelt, DrawnWheel

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats

ABOVE, BELOW = 1.0, 1.25
"""Height of teeth beyond the pitch line and below it, in modules."""

FLANK = 0.36
"""Tangent of the angle of a flank: 20 degrees."""

SIDES = 48
"""Of what is drawn round."""

FRONT = 7
"""Places on half a turn of a thread."""

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


def is_solid(wheel: DrawnWheel) -> bool:
    """Whether its teeth go on aslant behind its face: they lean, or run to an apex."""
    aslant = wheel.apex != 0.0 or wheel.lean != 0.0
    return aslant and wheel.teeth > 0 and not (wheel.inner or wheel.is_worm or wheel.slide)


def toothed_faces(wheel: DrawnWheel) -> tuple[Floats, Floats]:
    """The outlines of both faces of a wheel, the lower one first: four corners a tooth (n, 3), of
    which the middle two are its tip, on the home drawing of its link, m."""
    x, y = _teeth(wheel, wheel.pitch / np.pi / np.sqrt(1.0 + wheel.lean**2))
    found = []
    for height in (-0.5 * wheel.width, 0.5 * wheel.width):
        size = 1.0 - height / wheel.apex if wheel.apex else 1.0
        turn = wheel.lean * height / wheel.radius
        c, s = size * np.cos(turn), size * np.sin(turn)
        found.append(_placed(wheel, c * x - s * y, s * x + c * y, height))
    return found[0], found[1]


def facing_teeth(wheel: DrawnWheel, axes: Floats) -> Bools:
    """Which teeth of a wheel (teeth,) face the eye, where x, y and z of its frame (3, 3) are seen
    with their last component towards it: by the normal of its cylinder or cone."""
    turns = 2.0 * np.pi * np.arange(wheel.teeth) / wheel.teeth
    steep = wheel.radius / wheel.apex if wheel.apex else 0.0
    near: Floats = axes[:, 2]
    found: Bools = near[0] * np.cos(turns) + near[1] * np.sin(turns) + near[2] * steep > 0.0
    return found


def runs_of(facing: Bools) -> list[NDArray[np.intp]]:
    """The numbers of those that face the eye, in runs round the wheel."""
    numbers = np.flatnonzero(facing)
    if numbers.size in (0, facing.size):
        return [numbers] if numbers.size else []
    # from one after a gap on, a run that passes the last tooth is whole
    start = int(np.flatnonzero(facing & ~np.roll(facing, 1))[0])
    turned = (np.flatnonzero(np.roll(facing, -start)) + start) % facing.size
    breaks = np.flatnonzero(np.diff(turned) % facing.size != 1) + 1
    return np.split(turned, breaks)


def facing_threads(
    origin: Floats, axes: Floats, radius: float, lead: float, starts: int, ends: tuple[float, float]
) -> list[Floats]:
    """The lines (n, 3) of a thread of some `starts`, one of which is on x at the origin, as far as
    they face the eye: of a frame as it is seen, its origin (3,) and its axes (3, 3), z between two
    `ends`; the last component is towards the eye."""
    x, y, z = axes
    facing = float(np.arctan2(y[2], x[2]))
    found: list[Floats] = []
    for start in range(starts):
        # at a turn t the height is lead * (t/(2 pi) - shift), less whole turns
        shift = start / starts
        low, high = sorted(end / lead + shift - facing / (2.0 * np.pi) for end in ends)
        for whole in range(int(np.ceil(low - 0.25)), int(np.floor(high + 0.25)) + 1):
            begin, end = (min(max(each - whole, -0.25), 0.25) for each in (low, high))
            if begin == end:
                continue
            turns = facing + 2.0 * np.pi * np.linspace(begin, end, FRONT)
            round_ = radius * (np.cos(turns)[:, None] * x + np.sin(turns)[:, None] * y)
            heights = lead * (turns / (2.0 * np.pi) - shift + whole)
            found.append(origin + round_ + heights[:, None] * z)
    return found


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
