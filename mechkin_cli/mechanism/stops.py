"""A pair that holds a slide: a plane on the link, square to the slide, keeps a point of its
neighbour.

Whatever else moves, a slide of the link along the plane's normal takes the plane off the point at
the same rate, so the hold is never singular.
"""

from __future__ import annotations

from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import frame_about, perpendicular, upright
from mechkin_cli.mechanism.joint_table import JOINT_TYPES
from mechkin_cli.mechanism.legs import frame_on
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.vectors import Vector

_STOP = "Sp"


def stop_of(joint: Joint, link: str, slide: Vector) -> Joint:
    """The pair beside a joint that keeps one of its links from sliding along a unit vector on that
    link's drawing."""
    far = joint.second if joint.first == link else joint.first
    centre = upright(frame_on(joint, far).o)
    plane = frame_about(slide, perpendicular(slide), frame_on(joint, link).o)
    ball, *ways = JOINT_TYPES[_STOP].steps
    parts = [Part(ball.letter, centre, upright(plane.o))]
    for way, z in zip(ways, (plane.x, plane.y), strict=True):
        along = frame_about(z, plane.z, plane.o)
        parts.append(Part(way.letter, along, along))
    # no user's name has a blank
    name = f"{joint.name} (stop)"
    return Joint(name, _STOP, far, link, centre, plane, tuple(parts))
