"""Cams of couplings with a follower as they are drawn: the disc on its link, the roller on its own.

The disc turns about z of its own axes as its coordinate grows. A translating follower rises along
y; the pivot of an oscillating one lies on x, and it rises the other way about.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.building import DrawnWheel
from mechkin_cli.cams import POINTS, profile_of
from mechkin_cli.mechanism import (
    Frame,
    Joint,
    Mechanism,
    Relation,
    add,
    cross,
    dot,
    far_link,
    frame_about,
    frame_on,
    scale,
    subtract,
)
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

THICKNESS = 0.3
"""Of a disc in parts of its base circle's radius."""


class DrawnCam(NamedTuple):
    """A disc on its link's home drawing: its frame `on`, the `outline` (n, 2) in x and y of that
    (m), and its `width` along z; and the roller of its follower, if it has one."""

    link: str
    on: Frame
    outline: Floats
    width: float
    roller: DrawnWheel | None

    @property
    def line(self) -> Floats:
        """The outline (n, 3) as drawn on its link, m."""
        x, y = np.array(self.on.x), np.array(self.on.y)
        place: Floats = np.array(self.on.o) + self.outline[:, :1] * x + self.outline[:, 1:] * y
        return place


def drawn_cams(mechanism: Mechanism) -> Iterator[DrawnCam]:
    """The cams of all couplings with a follower whose disc and follower move on one link."""
    for relation in mechanism.couplings.values():
        if relation.follower is not None:
            yield from _drawn(relation)


def _drawn(relation: Relation) -> Iterator[DrawnCam]:
    follower = relation.follower
    assert follower is not None
    leading = next(term for term in relation.terms if term.law is not None)
    lead = leading.joint
    follow = next(term.joint for term in relation.terms if term.law is None)
    shared = {lead.first, lead.second} & {follow.first, follow.second}
    if not shared or leading.law is None:
        return
    carrier = next(iter(shared))
    about, along = frame_on(lead, carrier), frame_on(follow, carrier)
    z = _grows(lead, carrier)
    if follower.oscillates:
        if dot(_grows(follow, carrier), z) > 0.0:
            return  # it would rise towards the cam
        on = frame_about(z, subtract(along.o, about.o), about.o)
    else:
        on = frame_about(z, cross(_grows(follow, carrier), z), about.o)
    turns = 2.0 * np.pi * np.arange(POINTS) / POINTS
    curve = leading.law.curve
    if curve is not None and leading.law.period == 0.0:
        turns = np.linspace(curve.first, curve.last, POINTS)
    found = profile_of(follower, turns, leading.law.orders(turns))
    outline = found.surface.T[np.isfinite(found.surface).all(axis=0)]
    if len(outline) < 3:
        return
    width = THICKNESS * follower.base_radius
    roller = None
    if follower.contact == "roller":
        (x,), (y,) = profile_of(follower, np.zeros(1), leading.law.orders(np.zeros(1))).pitch
        place = add(on.o, add(scale(float(x), on.x), scale(float(y), on.y)))
        wheel = _across(follow, carrier, on._replace(o=place))
        roller = DrawnWheel(far_link(follow, carrier), wheel, follower.radius, 1.2 * width)
    yield DrawnCam(far_link(lead, carrier), _across(lead, carrier, on), outline, width, roller)


def _grows(joint: Joint, carrier: str) -> tuple[float, float, float]:
    """Axis of a joint as drawn on the carrier, on which the other link's coordinate grows."""
    return scale(1.0 if joint.first == carrier else -1.0, frame_on(joint, carrier).z)


def _across(joint: Joint, link: str, frame: Frame) -> Frame:
    """A frame drawn on one link of a joint as it is drawn on the other one."""
    return frame_on(joint, far_link(joint, link)).carry(frame_on(joint, link).of(frame))
