"""The axis of a coordinate: the unit wrench that works on it and on no other of its joint's.

A couple (or, for a slide, a force through the joint's point) along a sum of two vectors that ride
on links. The sum is only needed for the two turns of U, Ss, Sc and Cp, whose axes may be oblique
in U: their dual basis is (z1 - c z2) / (1 - c^2) with c = z1 . z2.
"""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.mechanism.model import Attached, Joint
from mechkin_cli.mechanism.vectors import ZERO, dot, scale


class CoordinateAxis(NamedTuple):
    """`terms`: the two vectors, in the home drawing."""

    slide: bool
    terms: tuple[Attached, Attached]


def coordinate_axis(joint: Joint, coordinate: str) -> CoordinateAxis:
    """The axis of one of a joint's coordinates."""
    first, second = joint.on_first, joint.on_second
    nothing = Attached(joint.second, ZERO)
    if coordinate in ("theta1", "theta2"):
        c = dot(first.z, second.z)
        one, two = (first.z, second.z) if coordinate == "theta1" else (second.z, first.z)
        links = (joint.first, joint.second)
        own, other = links if coordinate == "theta1" else links[::-1]
        dual = 1.0 / (1.0 - c * c)
        return CoordinateAxis(
            False, (Attached(own, scale(dual, one)), Attached(other, scale(-c * dual, two)))
        )
    if joint.letter == "E" and coordinate in ("x", "y"):
        direction = first.x if coordinate == "x" else first.y
        return CoordinateAxis(True, (Attached(joint.first, direction), nothing))
    if joint.letter == "Cp":
        direction = second.x if coordinate == "x" else second.y
        return CoordinateAxis(True, (Attached(joint.second, direction), nothing))
    if joint.letter == "Sc":
        return CoordinateAxis(True, (joint.axis, nothing))
    if joint.letter == "Sg":
        return CoordinateAxis(True, (Attached(joint.second, scale(-1.0, second.z)), nothing))
    return CoordinateAxis(coordinate == "s", (Attached(joint.second, second.z), nothing))
