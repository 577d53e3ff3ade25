"""Both halves of every joint, as drawn on its two links."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mechkin_cli.mechanism.joint_type import FIRST, SECOND
from mechkin_cli.mechanism.model import Joint, Mechanism, is_written
from mechkin_cli.mechanism.vectors import scale

if TYPE_CHECKING:
    from mechkin_cli.mechanism.frames import Frame
    from mechkin_cli.mechanism.vectors import Vector
    from mechkin_cli.view.encoding import Plain
    from mechkin_cli.view.lengths import Lengths


def drawn_joints(mechanism: Mechanism) -> list[Joint]:
    """The joints that are drawn: those of the machine that have a place."""
    return [
        joint
        for joint in mechanism.joints.values()
        if is_written(joint.name) and joint.type.has_point and not joint.type.is_free
    ]


def sliding_coordinate(joint: Joint) -> str | None:
    """The full name of the slide of a joint that has one alone; None of others."""
    slides = [known.name for known in joint.type.named if not known.is_angle]
    return f"{joint.name}.{slides[0]}" if len(slides) == 1 else None


def joint_records(
    mechanism: Mechanism,
    links: Sequence[str],
    travels: Mapping[str, tuple[float, float]],
    joint_radius: float | None,
    lengths: Lengths,
) -> list[Plain]:
    """The joints for the page; `travels` of slides by joint, in the file's unit of length.

    The radius is that of the `view:` section, else that at which the joint rubs.
    """
    rubs = {one.joint: one.radius for one in mechanism.frictions}
    found: list[Plain] = []
    for joint in drawn_joints(mechanism):
        radius = joint_radius if joint_radius is not None else rubs.get(joint.name)
        travel = travels.get(joint.name)
        found.append(
            {
                "name": joint.name,
                "type": joint.type.shape or joint.letter,
                "links": [links.index(joint.first), links.index(joint.second)],
                "halves": [_half(joint, side, lengths) for side in (FIRST, SECOND)],
                "lead": lengths.one(joint.lead) if joint.type.is_threaded else None,
                "travel": None if travel is None else list(travel),
                "radius": None if radius is None else lengths.one(radius),
            }
        )
    return found


def half_axis(joint: Joint, side: int) -> Vector:
    """The axis of the half on one link, as drawn: that of the pair where this link carries it, else
    z of the pair's frame."""
    carries_axis = joint.type.axis is not None and joint.type.axis.side == side
    return joint.axis.vector if carries_axis else half_frame(joint, side).z


def half_frame(joint: Joint, side: int) -> Frame:
    """The frame of the half on one link, as drawn."""
    return joint.on_first if side == FIRST else joint.on_second


def _half(joint: Joint, side: int, lengths: Lengths) -> Plain:
    """The half on one link; `axis2` is the pin that stands square to, or askew of, an axis of its
    own."""
    frame, axis = half_frame(joint, side), half_axis(joint, side)
    has_pin = joint.type.parameter == "from axis to pin" and side == FIRST
    return {
        "point": lengths.vector(frame.o),
        "axis": list(axis),
        "x": list(frame.z if axis == frame.x else frame.x),
        "axis2": list(scale(-1.0, frame.y)) if has_pin else None,
    }
