"""`motion.inputs: {p.position.z: ...}` - one, two or three coordinates of a point as inputs.

A slide that no drawing has runs along those axes of the ground and carries a ball on a plane, in a
groove or in a socket, in a plane a pin in a slot or in a hole, whose centre is the point: one
equation for each coordinate and no unknown more. Its coordinates are those of the point; in the
drawing they are not zero.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.halves import Halves
from mechkin_cli.building.joints import parts_of
from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import GROUND, Frame, frame_about, perpendicular, upright
from mechkin_cli.mechanism.joint_table import (
    guide_letter,
    joint_type,
    seat_letter,
)
from mechkin_cli.mechanism.joint_type import JointType
from mechkin_cli.mechanism.model import GROUND_NAME, Attached, Joint, Link
from mechkin_cli.mechanism.vectors import Vector, scale
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.schema.motion import MotionSection

_NAME = re.compile(r"(?P<point>\w+)\.position\.(?P<axis>[xyz])")


@dataclass
class Guides:
    """Links and joints that guide points, by name."""

    plane: bool = False
    links: dict[str, Link] = field(default_factory=dict)
    joints: dict[str, Joint] = field(default_factory=dict)

    def add(self, name: str, at: Attached, axes: str) -> None:
        """Guides a point along some of the axes x, y and z."""
        guide = f"{name}.position"
        self.links[guide] = Link(guide)
        slide = joint_type(guide_letter(axes))
        place = upright(at.vector)
        parts = tuple(_slide_part(axis, at.vector) for axis in axes)
        self.joints[guide] = Joint(guide, slide.letter, GROUND_NAME, guide, place, place, parts)
        held = f"{guide} of {at.link}"
        hold = _held_pin if self.plane else _held_ball
        self.joints[held] = hold(held, at, guide, axes)


def point_guides(
    fields: Fields,
    section: MotionSection | None,
    points: Mapping[str, Attached],
) -> Guides:
    """What guides the points whose coordinates are inputs; what is wrong is noted in `fields`."""
    guides = Guides(fields.plane)
    wanted: dict[str, str] = {}
    for name in section.inputs if section is not None else ():
        found = _NAME.fullmatch(name)
        if found and fields.plane and _leaves_plane(fields, name, found["axis"]):
            continue
        if found and _is_moving_point(fields, ("motion", "inputs", name), found["point"], points):
            wanted[found["point"]] = wanted.get(found["point"], "") + found["axis"]
    for name, axes in wanted.items():
        guides.add(name, points[name], "".join(sorted(axes)))
    return guides


def _leaves_plane(fields: Fields, name: str, axis: str) -> bool:
    if axis in "xy":
        return False
    text = f"{name} is not free in a plane file"
    fields.key_error("spatial", ("motion", "inputs", name), text, "drive x and y")
    fields.refused.add(name.rpartition(".")[0])
    return True


def _is_moving_point(fields: Fields, path: Path, name: str, points: Mapping[str, Attached]) -> bool:
    if name not in points:
        if not fields.is_refused(name):
            hint = nearest_hint(name, list(points)) or "name it under points"
            fields.key_error("unknown-point", path, f"there is no point {name}", hint)
            fields.refused.add(f"{name}.position")
        return False
    if points[name].link == GROUND_NAME:
        text = f"{name} is a point of ground and does not move"
        fields.key_error("point-on-ground", path, text, "drive a point of a moving link")
        fields.refused.add(f"{name}.position")
        return False
    return True


def _axis(axis: str) -> Frame:
    """The frame at the origin whose z runs along x, y or z."""
    along: Vector = getattr(GROUND, axis)
    return frame_about(along, perpendicular(along), GROUND.o)


def _slide_part(axis: str, at: Vector) -> Part:
    """A slide whose coordinate is the point's own: zero where that is, and as drawn where the
    point is drawn."""
    still = _axis(axis)
    drawn = at["xyz".index(axis)]
    x, y, z = scale(drawn, still.z)
    before = Frame(still.x, still.y, still.z, (at[0] - x, at[1] - y, at[2] - z))
    return Part("P", before, Frame(still.x, still.y, still.z, at), drawn)


def _held_ball(name: str, at: Attached, guide: str, axes: str) -> Joint:
    """The ball about the point, of its link, on what the slide carries."""
    kind = joint_type(seat_letter(axes))
    centre, second = upright(at.vector), _seat(kind, at.vector, axes)
    meeting = (centre, centre)
    parts = []
    for step in kind.steps:
        along = step.along
        if along is None:
            parts.append(Part(step.letter, *meeting))
            continue
        direction = getattr(second, along.axis)
        still = frame_about(
            scale(-1.0, direction) if along.reverse else direction,
            second.x if along.axis == "z" else second.z,
            second.o,
        )
        parts.append(Part(step.letter, still, still))
    return Joint(name, kind.letter, at.link, guide, centre, second, tuple(parts))


def _held_pin(name: str, at: Attached, guide: str, axes: str) -> Joint:
    """The pin about the point, of its link, in a hole of what the slide carries; where one axis
    alone is guided in a slot square to it."""
    kind = joint_type(seat_letter(axes, plane=True), plane=True)
    along = GROUND.y if axes == "x" else GROUND.x
    pin = frame_about(GROUND.z, along, at.vector)
    halves = Halves(pin, pin, (pin, pin))
    return Joint(name, kind.letter, at.link, guide, pin, pin, parts_of(kind, halves), plane=True)


def _seat(kind: JointType, at: Vector, axes: str) -> Frame:
    """The frame of the ball's seat: z along the one axis that guides it, or along the one that does
    not."""
    if len(axes) == 1:
        still = _axis(axes)
    elif len(axes) == 2:
        still = _axis(next(axis for axis in "xyz" if axis not in axes))
    else:
        return upright(at)
    return Frame(still.x, still.y, still.z, at)
