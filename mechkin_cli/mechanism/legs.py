"""Legs: links with two spheres and telescopes between two spheres, as distances between two points.

A link whose only joints are two spherical joints (S-S), or two links that slide on each other along
the line of their spheres (S-P-S), keep the distance of two points of other links and nothing else;
they spin freely about the line of their spheres. So they close a loop with one equation, and need
no freedom of their own.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property

from mechkin_cli import tolerances
from mechkin_cli.mechanism.frames import Frame
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.mechanism.vectors import Vector, cross, dot, norm, scale, subtract
from mechkin_cli.tape.scalars import largest


@dataclass(frozen=True)
class Leg:
    """A leg from the sphere `start` on link `first` to the sphere `end` on link `second`.

    `body` is the link at `start`; a telescope has a `rod` at `end` that moves by `slide`.
    """

    start: Joint
    end: Joint
    first: str
    second: str
    body: str
    slide: Joint | None = None
    rod: str | None = None

    @property
    def links(self) -> tuple[str, ...]:
        """The leg's own links."""
        return (self.body,) if self.rod is None else (self.body, self.rod)

    @property
    def joints(self) -> tuple[str, ...]:
        """The leg's joints, in order."""
        middle = (self.slide.name,) if self.slide is not None else ()
        return (self.start.name, *middle, self.end.name)

    @property
    def words(self) -> str:
        """The idle freedom in an engineer's words."""
        spins = "spins" if self.rod is None else "spin"
        return f"{' and '.join(self.links)} {spins} freely about {self.start.name}-{self.end.name}"

    @cached_property
    def span(self) -> Vector:
        """From sphere to sphere in the drawing of `body`, the slide at zero, in m."""
        return subtract(self._end_on_body(), frame_on(self.start, self.body).o)

    @cached_property
    def line(self) -> Vector:
        """Unit vector from sphere to sphere in the drawing of `body`."""
        span = self.span
        length = norm(span)
        if self.slide is None or length > 0.0:
            return scale(1.0 / length, span)
        return self._outward_axis()

    @cached_property
    def slide_sign(self) -> float:
        """Rate of the distance by the slide: 1 or -1; 0 without a slide."""
        if self.slide is None:
            return 0.0
        return 1.0 if dot(self._outward_axis(), self.line) > 0.0 else -1.0

    def _outward_axis(self) -> Vector:
        """The way in which the rod moves against `body` where the slide grows, in its drawing."""
        assert self.slide is not None
        axis = frame_on(self.slide, self.body).z
        return axis if self.slide.first == self.body else scale(-1.0, axis)

    def _end_on_body(self) -> Vector:
        if self.slide is None or self.rod is None:
            return frame_on(self.end, self.body).o
        on_rod, on_body = frame_on(self.slide, self.rod), frame_on(self.slide, self.body)
        x, y, z = on_rod.local(frame_on(self.end, self.rod).o)
        parts = (scale(x, on_body.x), scale(y, on_body.y), scale(z, on_body.z))
        place = on_body.o
        for part in parts:
            place = subtract(place, scale(-1.0, part))
        return place


def frame_on(joint: Joint, link: str) -> Frame:
    """A joint's frame as drawn on one of its links."""
    return joint.on_first if joint.first == link else joint.on_second


def find_legs(mechanism: Mechanism) -> tuple[Leg, ...]:
    """The legs of a mechanism, looked for once; no leg ends on another leg's links."""
    found: tuple[Leg, ...] | None = mechanism.__dict__.get("legs")
    if found is None:
        # a frozen mechanism keeps what follows from it, as its cached properties do
        found = mechanism.__dict__["legs"] = _find_legs(mechanism)
    return found


def _find_legs(mechanism: Mechanism) -> tuple[Leg, ...]:
    joints_of = mechanism.joints_of
    size = largest(0.0, *(norm(joint.on_first.o) for joint in mechanism.joints.values()))
    legs: list[Leg] = []
    taken: set[str] = set()
    ends: set[str] = set()
    for name in mechanism.links:
        leg = _leg_at(name, joints_of, taken, size)
        if leg is None or ends & set(leg.links) or taken & {leg.first, leg.second}:
            continue
        legs.append(leg)
        taken.update(leg.links)
        ends.update((leg.first, leg.second))
    return tuple(legs)


def _leg_at(
    name: str, joints_of: Mapping[str, tuple[Joint, ...]], taken: Collection[str], size: float
) -> Leg | None:
    """The leg whose first own link is `name`, if there is one; `size` is that of the drawing."""
    if name == GROUND_NAME or name in taken or len(joints_of[name]) != 2:
        return None
    start, other = joints_of[name]
    if not start.type.is_ball:
        start, other = other, start
    if not start.type.is_ball:
        return None
    first = _far(start, name)
    if other.type.is_ball:
        leg = Leg(start, other, first, _far(other, name), name)
        apart = norm(leg.span) > tolerances.PARALLEL * size
        return leg if leg.first != leg.second and apart else None
    rod = _far(other, name)
    if not other.type.is_slider or rod == GROUND_NAME or len(joints_of[rod]) != 2 or rod in taken:
        return None
    end = next(joint for joint in joints_of[rod] if joint is not other)
    if not end.type.is_ball:
        return None
    leg = Leg(start, end, first, _far(end, rod), name, other, rod)
    return leg if leg.first != leg.second and _is_straight(leg) else None


def _far(joint: Joint, link: str) -> str:
    return joint.second if joint.first == link else joint.first


def _is_straight(leg: Leg) -> bool:
    """Whether the slide runs along the line of the spheres."""
    assert leg.slide is not None
    off_line = cross(leg.span, frame_on(leg.slide, leg.body).z)
    return norm(off_line) <= tolerances.LEG_SLIDE * norm(leg.span)
