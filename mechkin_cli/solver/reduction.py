"""What the spanning tree is laid through: a mechanism without its legs, every body within reach.

Legs become distance equations (legs.py). A body that only legs hold hangs from ground by a free
pair of six unknowns. A loop without a joint to close it at, or whose closing joint has all its
unknowns, is closed through a link: the link is cut in two halves that a weld joins
(docs/numerics.md, Closing joints).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from mechkin_cli.exact import part
from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import GROUND, frame_about, upright
from mechkin_cli.mechanism.joint_table import FREE
from mechkin_cli.mechanism.legs import Leg, find_legs, frame_on
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.mechanism.vectors import ZERO, Vector, add, scale

HALF = " (cut)"
"""Ends the name of the second half of a cut link; a name as written has no such end."""


class Reduction(NamedTuple):
    """Joints by name and moving links of the tree and its closing joints, and the legs beside
    them; joints in loops that are `cut` close none."""

    joints: Mapping[str, Joint]
    links: tuple[str, ...]
    legs: tuple[Leg, ...]
    cut: frozenset[str] = frozenset()

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
    held: dict[str, list[Vector]] = {}
    for leg in legs:
        for link in (leg.first, leg.second):
            held.setdefault(link, []).append(_end_point(leg, link))
    at: dict[str, list[str]] = {}
    for joint in joints.values():
        at.setdefault(joint.first, []).append(joint.second)
        at.setdefault(joint.second, []).append(joint.first)
    reached = {GROUND_NAME}
    _reach(at, reached, GROUND_NAME)
    # of bodies that joints hold together the one that most legs hold
    for body in sorted(held, key=lambda link: -len(held[link])):
        if body not in reached:
            joints[f"{body} (free)"] = _free_pair(body, held[body])
            _reach(at, reached, body)
    return Reduction(joints, links, legs)


def cut_link(reduction: Reduction, link: str, loop: Sequence[str]) -> Reduction:
    """The same with a link cut in two halves between its joints in a loop."""
    own = [
        reduction.joints[name]
        for name in loop
        if link in (reduction.joints[name].first, reduction.joints[name].second)
    ]
    joints = dict(reduction.joints)
    half = link + HALF
    while half in joints:  # a link may be cut in several loops
        half += HALF
    joints[own[-1].name] = _moved(own[-1], link, half)
    parts = (Part("W", GROUND, GROUND),)
    joints[half] = Joint(half, "W", link, half, GROUND, GROUND, parts, plane=own[-1].plane)
    return Reduction(joints, (*reduction.links, half), reduction.legs, reduction.cut.union(loop))


def whole_link(link: str) -> str:
    """The link of which one is a half, however often it is cut, or itself."""
    while link.endswith(HALF):
        link = link.removesuffix(HALF)
    return link


def _moved(joint: Joint, link: str, half: str) -> Joint:
    if joint.first == link:
        return joint._replace(first=half)
    return joint._replace(second=half)


def _reach(at: Mapping[str, list[str]], reached: set[str], start: str) -> None:
    """Adds to the reached links those that joints lead to from one more."""
    reached.add(start)
    front = [start]
    for link in front:
        for other in at.get(link, ()):
            if other not in reached:
                reached.add(other)
                front.append(other)


def _end_point(leg: Leg, link: str) -> Vector:
    return frame_on(leg.start if link == leg.first else leg.end, link).o


def _free_pair(body: str, points: list[Vector]) -> Joint:
    """Slides along the ground's axes, then turns about the middle of the legs' ends."""
    total = ZERO
    for point in points:
        total = add(total, point)
    middle = scale(part(len(points)), total)
    still = upright(middle)
    axes = ((GROUND.x, GROUND.y), (GROUND.y, GROUND.z), (GROUND.z, GROUND.x))
    slides = [frame_about(axis, x, middle) for axis, x in axes]
    parts = (*(Part("P", frame, frame) for frame in slides), Part("S", still, still))
    return Joint(f"{body} (free)", FREE.letter, GROUND_NAME, body, still, still, parts)
