"""The axis of a coordinate: the unit wrench that works on it and on no other of its joint's.

A couple (or, for a slide, a force through the joint's point) along a sum of two vectors that ride
on links. The sum is only needed for two turns, whose axes may be oblique: their dual basis is
(z1 - c z2) / (1 - c^2) with c = z1 . z2.
"""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.mechanism.joint_type import Coordinate
from mechkin_cli.mechanism.model import Attached, Joint
from mechkin_cli.mechanism.vectors import ZERO, dot, scale


class CoordinateAxis(NamedTuple):
    """`terms`: the two vectors, in the home drawing."""

    slide: bool
    terms: tuple[Attached, Attached]


def coordinate_axis(joint: Joint, coordinate: str) -> CoordinateAxis:
    """The axis of one of a joint's coordinates."""
    known = joint.type.coordinate[coordinate]
    if known.axis is not None:
        terms = joint.drawn(known.axis), Attached(joint.second, ZERO)
        return CoordinateAxis(not known.is_angle, terms)
    own = Attached(joint.first, joint.on_first.z), Attached(joint.second, joint.on_second.z)
    turn, other = own if known == _turns_of(joint)[0] else own[::-1]
    c = dot(joint.on_first.z, joint.on_second.z)
    dual = 1.0 / (1.0 - c * c)
    along = Attached(turn.link, scale(dual, turn.vector))
    return CoordinateAxis(False, (along, Attached(other.link, scale(-c * dual, other.vector))))


def _turns_of(joint: Joint) -> list[Coordinate]:
    return [coordinate for coordinate in joint.type.named if coordinate.axis is None]
