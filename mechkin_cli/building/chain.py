"""Rows (theta, s, alpha, a) of a chain to joints and links of the mechanism.

With Z(theta, s) a screw about and along z, and X(alpha, a) one about and along x, the frame behind
row i is F_i = F_(i-1) Z(theta_i, s_i) X(alpha_i, a_i), from F_0, the ground axes, on; a loop closes
with F_n = F_0. Joint i lies on z of F_(i-1); its point is the foot of the common normal behind it,
which is the origin of F_(i-1) Z(theta_i, s_i). That is the drawing, where all coordinates are zero:
the angle from x to x about the axis is theta_i plus the joint's coordinate. Row n is drawn twice,
behind the rows before it and in front of the ground axes, X(alpha_n, a_n)^-1: where the two differ,
the drawing is not assembled.
Source: J. Denavit, R. S. Hartenberg, A kinematic notation for lower-pair mechanisms, 1955.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from mechkin_cli.building.fields import Fields
from mechkin_cli.building.joints import lead_of
from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import GROUND, Frame, frame_about
from mechkin_cli.mechanism.joint_table import joint_type
from mechkin_cli.mechanism.model import GROUND_NAME, Joint
from mechkin_cli.mechanism.vectors import Vector, add, scale, subtract, unit
from mechkin_cli.tape.scalars import cos, sin
from mechkin_cli.units import ANGLE, LENGTH


class _Row(NamedTuple):
    """Angles in rad, distances in m."""

    theta: float
    s: float
    alpha: float
    a: float


def build_chain(
    fields: Fields, rows: Sequence[Any], pairs: Sequence[tuple[str, str]]
) -> dict[str, Joint]:
    """The joints of a chain, `pairs` their two links; what is wrong is noted in `fields`."""
    if not _closes_at_ground(fields, rows):
        fields.refused |= {row.joint for row in rows} | {link for _, link in pairs}
        return {}
    joints = {}
    here = GROUND
    for i, (row, (first, second)) in enumerate(zip(rows, pairs, strict=True)):
        numbers = _numbers(fields, i, row)
        at_joint = _along_z(here, numbers.theta, numbers.s)
        here = _along_x(at_joint, numbers.alpha, numbers.a)
        behind = at_joint
        if second == GROUND_NAME:
            behind = _along_x(GROUND, -numbers.alpha, -numbers.a)
        parts = (Part(row.type, at_joint, behind),)
        lead = (
            lead_of(fields, ("chain", i, "lead"), row.lead)
            if joint_type(row.type).is_threaded
            else 0.0
        )
        joints[row.joint] = Joint(row.joint, row.type, first, second, at_joint, behind, parts, lead)
    return joints


def _closes_at_ground(fields: Fields, rows: Sequence[Any]) -> bool:
    """Whether the rows run from ground over differing links back to ground."""
    errors = fields.error_count
    last = len(rows) - 1
    seen: set[str] = set()
    for i, row in enumerate(rows):
        path = ("chain", i, "link")
        if row.link == GROUND_NAME:
            if i < last:
                text = f"the chain is back at ground before its last row ({last + 1})"
                fields.error("chain-ends-early", path, text, "name the link behind this joint")
        elif row.link in seen:
            text = f"the chain comes through link {row.link} twice"
            fields.error("chain-crosses-itself", path, text, "name another link")
        elif i == last:
            text = f"the chain ends at link {row.link}"
            fields.error("open-chain", path, text, "the last row closes the loop: link: ground")
        seen.add(row.link)
    if last == 0 and fields.error_count == errors:
        text = "a chain of one row joins ground to itself"
        fields.error("short-chain", ("chain", 0), text, "a loop has two rows or more")
    return fields.error_count == errors


def _numbers(fields: Fields, i: int, row: Any) -> _Row:
    dimensions: Mapping[str, Any] = {"theta": ANGLE, "s": LENGTH, "alpha": ANGLE, "a": LENGTH}
    return _Row(
        *(
            fields.number(("chain", i, key), getattr(row, key), dimension)
            for key, dimension in dimensions.items()
        )
    )


def _along_z(frame: Frame, angle: float, distance: float) -> Frame:
    """The frame moved by a screw about its own z."""
    x, _ = _turned(frame.x, frame.y, angle)
    return frame_about(frame.z, x, add(frame.o, scale(distance, frame.z)))


def _along_x(frame: Frame, angle: float, distance: float) -> Frame:
    """The frame moved by a screw about its own x."""
    _, z = _turned(frame.y, frame.z, angle)
    return frame_about(unit(z), frame.x, add(frame.o, scale(distance, frame.x)))


def _turned(p: Vector, q: Vector, angle: float) -> tuple[Vector, Vector]:
    """Two square unit vectors turned from p towards q."""
    c, s = cos(angle), sin(angle)
    return add(scale(c, p), scale(s, q)), subtract(scale(c, q), scale(s, p))
