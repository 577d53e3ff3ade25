"""Joints of the file to joints of the mechanism: links checked, frames drawn on both links."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.mechanism.frames import (
    GROUND,
    Frame,
    frame_about,
    perpendicular,
    turned_shortest,
)
from mechkin_cli.mechanism.joint_types import joint_types
from mechkin_cli.mechanism.model import GROUND_NAME, Joint
from mechkin_cli.mechanism.vectors import Vector, cross, norm
from mechkin_cli.tolerances import PARALLEL
from mechkin_cli.units import LENGTH


def build_joints(
    fields: Fields, sections: Mapping[str, Any], links: Mapping[str, Any]
) -> dict[str, Joint]:
    """All joints that can be built; the rest is noted in `fields`."""
    joints = {}
    for name, section in sections.items():
        joint = _build(fields, name, section, links)
        if joint is None:
            fields.refused.add(name)
        else:
            joints[name] = joint
    return joints


def _build(fields: Fields, name: str, section: Any, links: Mapping[str, Any]) -> Joint | None:
    path: Path = ("joints", name)
    known = True
    for i, link in enumerate(section.links):
        if link != GROUND_NAME and link not in links:
            fields.error(
                "unknown-link",
                (*path, "links", i),
                f"there is no link {link}",
                nearest_hint(link, [GROUND_NAME, *links]),
            )
            known = False
    if section.type not in joint_types():
        supported = ", ".join(joint_types())
        fields.error(
            "joint-type",
            (*path, "type"),
            f"joints of type {section.type} are not solved by this version",
            f"it solves {supported}",
        )
        return None
    if not known:
        return None
    first, second = section.links
    on_first, on_second = _frames(fields, path, section)
    lead = _lead(fields, (*path, "lead"), section.lead) if section.type == "H" else 0.0
    return Joint(name, section.type, first, second, on_first, on_second, lead)


def _lead(fields: Fields, path: Path, text: str) -> float:
    errors = fields.error_count
    lead = fields.number(path, text, LENGTH)
    if lead == 0.0 and fields.error_count == errors:
        fields.error("zero-lead", path, "the lead is zero", "use type R for no slide")
    return lead


def nearest_hint(name: str, known: list[str]) -> str | None:
    """The nearest known name as a hint."""
    from mechkin_cli.expressions.errors import nearest

    return nearest(name, known)


def _frames(fields: Fields, path: Path, section: Any) -> tuple[Frame, Frame]:
    points = _per_link(fields, (*path, "point"), section.point, section.links, False)
    if section.type == "S":
        return (
            Frame(GROUND.x, GROUND.y, GROUND.z, points[0]),
            Frame(GROUND.x, GROUND.y, GROUND.z, points[1]),
        )
    axes = _per_link(fields, (*path, "axis"), section.axis, section.links, True)
    x_first, x_second = _zero_directions(fields, path, section, axes)
    return frame_about(axes[0], x_first, points[0]), frame_about(axes[1], x_second, points[1])


def _per_link(
    fields: Fields, path: Path, value: Any, links: tuple[str, str], direction: bool
) -> tuple[Vector, Vector]:
    """A vector for either link; one vector stands for both."""

    def read(where: Path, texts: Any) -> Vector:
        return fields.direction(where, texts) if direction else fields.vector(where, texts, LENGTH)

    if isinstance(value, Mapping):
        return read((*path, links[0]), value[links[0]]), read((*path, links[1]), value[links[1]])
    both = read(path, value)
    return both, both


def _zero_directions(
    fields: Fields, path: Path, section: Any, axes: tuple[Vector, Vector]
) -> tuple[Vector, Vector]:
    """Directions on either link that are in line, seen along the axis, at coordinate zero."""
    if section.zero is None:
        x = perpendicular(axes[0])
        return x, turned_shortest(axes[0], axes[1], x)
    given = _per_link(fields, (*path, "zero"), section.zero, section.links, True)
    found = []
    for link, axis, vector in zip(section.links, axes, given, strict=True):
        if norm(cross(axis, vector)) <= PARALLEL:
            fields.error(
                "zero-parallel",
                (*path, "zero", link),
                "this direction is parallel to the joint's axis",
                "give one that is square to it, or nearly so",
            )
            vector = perpendicular(axis)
        found.append(vector)
    return found[0], found[1]
