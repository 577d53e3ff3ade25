"""Legs that spin freely about the line between two spheres: S-S links and S-P-S legs.

Their spin changes nothing else. Its rate is taken as zero: the angular velocities of the leg's
links have no component along the line, summed over the links. The pose keeps whatever spin it had.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from oracle.bodies import Bodies
from oracle.mechanism import Mechanism
from oracle.series import Series, cut, derivative
from oracle.vectors import add, apply, axial, dot, product, subtract, transpose


@dataclass(frozen=True)
class Leg:
    """The links of a leg from one sphere to the other, and the joints there."""

    links: tuple[str, ...]
    first: str
    last: str


def legs(mechanism: Mechanism) -> list[Leg]:
    """All legs of a mechanism, each once."""
    found: dict[frozenset[str], Leg] = {}
    for name, joint in mechanism.joints.items():
        for link in (joint.first, joint.second) if joint.type == "S" else ():
            if leg := _walk(mechanism, name, link):
                found.setdefault(frozenset(leg.links), leg)
    return list(found.values())


def _walk(mechanism: Mechanism, sphere: str, link: str) -> Leg | None:
    links, joint = [], sphere
    while link != "ground":
        at_link = [n for n, j in mechanism.joints.items() if link in (j.first, j.second)]
        if len(at_link) != 2:
            return None
        links.append(link)
        joint = at_link[1] if at_link[0] == joint else at_link[0]
        its = mechanism.joints[joint]
        if its.type == "S":
            return Leg(tuple(links), sphere, joint)
        if its.type != "P":
            return None
        link = its.second if its.first == link else its.first
    return None


def line(bodies: Bodies, leg: Leg, poses: Any) -> list[Any]:
    """From the first sphere to the last; constants or series."""
    mechanism = bodies.mechanism
    ends = []
    for name, link in ((leg.first, leg.links[0]), (leg.last, leg.links[-1])):
        joint = mechanism.joints[name]
        place = joint.points[joint.second == link]
        rotation, shift = poses[link]
        ends.append(add(apply(rotation, place), shift))
    return subtract(ends[1], ends[0])


def spin_rate(bodies: Bodies, leg: Leg, poses: Any, order: int) -> Any:
    """The sum of angular velocities along the line as a series up to t^(order - 1)."""
    direction = [cut(x, order - 1) for x in line(bodies, leg, poses)]
    total: Any = 0
    for link in leg.links:
        rotation = poses[link][0]
        slope = [[derivative(x) for x in row] for row in rotation]
        same = [[cut(x, order - 1) for x in row] for row in rotation]
        total = total + dot(axial(product(slope, transpose(same))), direction)
    assert isinstance(total, Series)
    return total
