"""Balls told as three turns one after the other, of which some can be held.

Where an idle spin moves no coordinate that has a name, a ball around the links is told as turns
about an axis of the far link, about what is square to both, and about the line of the near link;
the last one is held. It is singular where the line comes to lie along the first axis, which is
chosen as that of a joint of the far link, about which the line as a rule goes round. Where no line
is told, the turns are about the axes of the drawing; if all three are held, they are never
singular.
"""

from __future__ import annotations

from mechkin_cli import tolerances
from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import GROUND, Frame, frame_about, perpendicular
from mechkin_cli.mechanism.legs import frame_on
from mechkin_cli.mechanism.model import Joint, Mechanism
from mechkin_cli.mechanism.vectors import Vector, cross, dot, norm, scale, unit


def held_ball(mechanism: Mechanism, joint: Joint, link: str, line: Vector) -> tuple[Joint, int]:
    """A joint whose ball is told as three turns, one of them about a line (a unit vector) on the
    drawing of one of its links; and the number of that freedom."""
    far = joint.second if joint.first == link else joint.first
    ball = next(part for part in joint.parts if part.type.is_ball)
    own, other = (ball.before, ball.after) if link == joint.first else (ball.after, ball.before)
    first = _axis_of(mechanism, joint, far, other, own, line)
    parts: list[Part] = []
    number = held = 0
    for part in joint.parts:
        if not part.type.is_ball:
            parts.append(part)
            number += len(part.type.freedoms)
            continue
        near = part.after if link == joint.second else part.before
        last = near.components(line)
        middle = unit(cross(last, first))
        triad = (first, middle, last) if link == joint.second else (last, middle, first)
        held = number + (2 if link == joint.second else 0)
        before = [_about(part.before, z, middle if z is not middle else last) for z in triad]
        after = _about(part.after, triad[2], middle)
        parts += [Part("R", before[0], before[0]), Part("R", before[1], before[1])]
        parts.append(Part("R", before[2], after))
        number += 3
    return joint._replace(parts=tuple(parts)), held


def three_turns(joint: Joint) -> Joint:
    """A joint whose ball is told as turns about x, y and z as drawn."""
    parts: list[Part] = []
    for part in joint.parts:
        if not part.type.is_ball:
            parts.append(part)
            continue
        x, y, z = GROUND.x, GROUND.y, GROUND.z
        for axis, beside in ((x, y), (y, z)):
            frame = _about(part.before, axis, beside)
            parts.append(Part("R", frame, frame))
        parts.append(Part("R", _about(part.before, z, x), _about(part.after, z, x)))
    return joint._replace(parts=tuple(parts))


def _axis_of(
    mechanism: Mechanism, joint: Joint, far: str, other: Frame, own: Frame, line: Vector
) -> Vector:
    """An axis of the far link, in the ball's own axes: of its joint that stands squarest to the
    line as drawn, else any that is square to it."""
    drawn = own.components(line)
    axes = [
        other.components(frame_on(one, far).z)
        for one in mechanism.joints_of[far]
        if one is not joint and one.type.is_guide
    ]
    axes = [axis for axis in axes if abs(dot(axis, drawn)) < tolerances.HELD_ACROSS]
    if not axes:
        return perpendicular(drawn)
    return min(axes, key=lambda axis: abs(dot(axis, drawn)))


def _about(frame: Frame, z: Vector, x: Vector) -> Frame:
    """A frame at the origin of another, its z and x given in that one's axes."""

    def drawn(a: Vector) -> Vector:
        return tuple(frame.x[i] * a[0] + frame.y[i] * a[1] + frame.z[i] * a[2] for i in range(3))  # type: ignore[return-value]

    return frame_about(drawn(z), drawn(x), frame.o)


def ball_line(one: Vector, other: Vector, size: float) -> Vector | None:
    """The unit vector from one point to another, None where they coincide."""
    way = (other[0] - one[0], other[1] - one[1], other[2] - one[2])
    length = norm(way)
    return scale(1.0 / length, way) if length > tolerances.COMMON_MOTION * size else None
