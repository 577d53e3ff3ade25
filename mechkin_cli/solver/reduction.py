"""What the spanning tree is laid through: a mechanism without its legs, every body within reach.

Legs become distance equations (legs.py). A body that only legs hold hangs from ground by a free
pair of six unknowns. A loop without a joint to close it at is closed through a link: the link is
cut in two halves that a weld joins (docs/numerics.md,
Closing joints).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import GROUND, frame_about, upright
from mechkin_cli.mechanism.joint_table import FREE
from mechkin_cli.mechanism.legs import Leg, find_legs, frame_on
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.mechanism.vectors import ZERO, Vector, add, scale


class Reduction(NamedTuple):
    """Joints by name and moving links of the tree and its closing joints, and the legs beside
    them."""

    joints: Mapping[str, Joint]
    links: tuple[str, ...]
    legs: tuple[Leg, ...]

    @property
    def loops(self) -> int:
        """Joints that close loops, legs not counted."""
        return len(self.joints) - len(self.links)


def reduce(mechanism: Mechanism) -> Reduction:
    """The mechanism without its legs, with free pairs for what only legs hold."""
    legs = find_legs(mechanism)
    of_legs = {name for leg in legs for name in leg.joints}
    bodies = {name for leg in legs for name in leg.links}
    links = tuple(n for n in mechanism.links if n != GROUND_NAME and n not in bodies)
    joints = {name: joint for name, joint in mechanism.joints.items() if name not in of_legs}
    ends = [(link, _end_point(leg, link)) for leg in legs for link in (leg.first, leg.second)]
    while True:
        loose = [link for link, _ in ends if link not in _reached(joints)]
        if not loose:
            return Reduction(joints, links, legs)
        # the link that most legs hold
        body = max(loose, key=loose.count)
        points = [point for link, point in ends if link == body]
        joints[f"{body} (free)"] = _free_pair(body, points)


def cut_links(reduction: Reduction) -> Iterator[Reduction]:
    """The same with one link cut in two halves, for every link that can be."""
    for link in reduction.links:
        own = [joint for joint in reduction.joints.values() if link in (joint.first, joint.second)]
        if len(own) < 2:
            continue
        half = f"{link} (cut)"
        joints = dict(reduction.joints)
        joints[own[-1].name] = _moved(own[-1], link, half)
        joints[half] = Joint(half, "W", link, half, GROUND, GROUND, (Part("W", GROUND, GROUND),))
        yield Reduction(joints, (*reduction.links, half), reduction.legs)


def _moved(joint: Joint, link: str, half: str) -> Joint:
    if joint.first == link:
        return joint._replace(first=half)
    return joint._replace(second=half)


def _reached(joints: Mapping[str, Joint]) -> set[str]:
    reached, grown = {GROUND_NAME}, True
    while grown:
        before = len(reached)
        for joint in joints.values():
            if joint.first in reached or joint.second in reached:
                reached |= {joint.first, joint.second}
        grown = len(reached) > before
    return reached


def _end_point(leg: Leg, link: str) -> Vector:
    return frame_on(leg.start if link == leg.first else leg.end, link).o


def _free_pair(body: str, points: list[Vector]) -> Joint:
    """Slides along the ground's axes, then turns about the middle of the legs' ends."""
    total = ZERO
    for point in points:
        total = add(total, point)
    middle = scale(1.0 / len(points), total)
    still = upright(middle)
    axes = ((GROUND.x, GROUND.y), (GROUND.y, GROUND.z), (GROUND.z, GROUND.x))
    slides = [frame_about(axis, x, middle) for axis, x in axes]
    parts = (*(Part("P", frame, frame) for frame in slides), Part("S", still, still))
    return Joint(f"{body} (free)", FREE.letter, GROUND_NAME, body, still, still, parts)
