"""Joints of the file to joints of the mechanism: links checked, frames drawn on both links."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.per_link import Frames, directions_of, place_of, points_of
from mechkin_cli.mechanism.frames import (
    GROUND,
    frame_about,
    perpendicular,
    turned_shortest,
    upright,
)
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Part
from mechkin_cli.mechanism.vectors import Vector, cross, norm, scale
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.schema.joints import (
    AnyAxisJoint,
    AnyJoint,
    AxisJoint,
    HelicalJoint,
    PlanarJoint,
    PointJoint,
    SphereGrooveJoint,
    SpherePlaneJoint,
    TwoTurnJoint,
    WeldJoint,
)
from mechkin_cli.tolerances import PARALLEL
from mechkin_cli.units import LENGTH


def build_joints(
    fields: Fields, sections: Mapping[str, AnyJoint], links: Mapping[str, object]
) -> dict[str, Joint]:
    """All joints that can be built; the rest is noted in `fields`."""
    joints = {}
    for name, section in sections.items():
        known = _links_known(fields, ("joints", name), section, links)
        joint = _build(fields, name, section)
        if known:
            joints[name] = joint
        else:
            fields.refused.add(name)
    return joints


def _links_known(
    fields: Fields, path: Path, section: AnyJoint, links: Mapping[str, object]
) -> bool:
    known = True
    for i, link in enumerate(section.links):
        if link != GROUND_NAME and link not in links:
            hint = nearest_hint(link, [GROUND_NAME, *links])
            fields.error("unknown-link", (*path, "links", i), f"there is no link {link}", hint)
            known = False
    return known


def _build(fields: Fields, name: str, section: AnyJoint) -> Joint:
    path: Path = ("joints", name)
    first, second = section.links
    on_first, on_second, parts = _FRAMES[section.type](fields, path, section)
    lead = (
        lead_of(fields, (*path, "lead"), section.lead) if isinstance(section, HelicalJoint) else 0.0
    )
    return Joint(name, section.type, first, second, on_first, on_second, parts, lead)


def lead_of(fields: Fields, path: Path, text: str) -> float:
    """The lead of a helical joint in m; zero is noted in `fields`."""
    errors = fields.error_count
    lead = fields.number(path, text, LENGTH)
    if lead == 0.0 and fields.error_count == errors:
        fields.error("zero-lead", path, "the lead is zero", "use type R for no slide")
    return lead


def _axis_frames(fields: Fields, path: Path, section: AnyAxisJoint) -> Frames:
    """R, P, C, H: z along the axis on either link."""
    points = points_of(fields, path, section)
    errors = fields.error_count
    axes = directions_of(fields, path, section, "axis")
    x_first, x_second = _zero_directions(fields, path, section, axes, errors)
    on_first = frame_about(axes[0], x_first, points[0])
    on_second = frame_about(axes[1], x_second, points[1])
    return on_first, on_second, (Part(section.type, on_first, on_second),)


def _spheric_frames(fields: Fields, path: Path, section: PointJoint) -> Frames:
    """S: ground axes at the sphere's centre."""
    first, second = points_of(fields, path, section)
    on_first, on_second = upright(first), upright(second)
    return on_first, on_second, (Part("S", on_first, on_second),)


def _plane_frames(fields: Fields, path: Path, section: SpherePlaneJoint) -> Frames:
    """Sp: turns about the sphere's centre, then slides in the plane of the second link."""
    first, second = points_of(fields, path, section)
    normal = directions_of(fields, path, section, "normal")[1]
    x = perpendicular(normal)
    on_second = frame_about(normal, x, second)
    slides = [frame_about(axis, normal, second) for axis in (on_second.x, on_second.y)]
    turn = Part("S", upright(first), upright(second))
    return upright(first), on_second, (turn, *(Part("P", f, f) for f in slides))


def _groove_frames(fields: Fields, path: Path, section: SphereGrooveJoint) -> Frames:
    """Sg: turns about the sphere's centre; where s grows the second link runs back along its
    groove."""
    first, second = points_of(fields, path, section)
    groove = directions_of(fields, path, section, "groove")[1]
    on_second = frame_about(groove, perpendicular(groove), second)
    back = frame_about(scale(-1.0, groove), on_second.x, second)
    turn = Part("S", upright(first), upright(second))
    return upright(first), on_second, (turn, Part("P", back, back))


def _planar_frames(fields: Fields, path: Path, section: PlanarJoint) -> Frames:
    """E: slides along x and y of the first link, then turns about the normal."""
    points = points_of(fields, path, section)
    errors = fields.error_count
    normals = directions_of(fields, path, section, "normal")
    x = directions_of(fields, path, section, "x")
    directions: list[Vector] = []
    for i in range(2):
        if i == 1 and (normals[1], x[1]) == (normals[0], x[0]):
            directions.append(directions[0])
            continue
        place = place_of(path, section, "x", i)
        directions.append(_square(fields, place, normals[i], x[i], "x", "normal", errors))
    frames = [frame_about(n, d, p) for n, d, p in zip(normals, directions, points, strict=True)]
    on_first, on_second = frames
    slides = [frame_about(axis, on_first.z, points[0]) for axis in (on_first.x, on_first.y)]
    return on_first, on_second, (*(Part("P", f, f) for f in slides), Part("R", on_first, on_second))


def _turning_frames(fields: Fields, path: Path, section: TwoTurnJoint) -> Frames:
    """U, Ss, Sc, Cp: two turns."""
    from mechkin_cli.building.two_turns import FRAMES

    return FRAMES[section.type](fields, path, section)


def _weld_frames(fields: Fields, path: Path, section: WeldJoint) -> Frames:
    """W: one body."""
    return GROUND, GROUND, (Part("W", GROUND, GROUND),)


_FRAMES: dict[str, Callable[..., Frames]] = {
    "R": _axis_frames,
    "P": _axis_frames,
    "C": _axis_frames,
    "H": _axis_frames,
    "S": _spheric_frames,
    "Sp": _plane_frames,
    "Sg": _groove_frames,
    "U": _turning_frames,
    "E": _planar_frames,
    "Ss": _turning_frames,
    "Sc": _turning_frames,
    "Cp": _turning_frames,
    "W": _weld_frames,
}


def _zero_directions(
    fields: Fields, path: Path, section: AxisJoint, axes: tuple[Vector, Vector], errors: int
) -> tuple[Vector, Vector]:
    """Directions on either link that are in line, seen along the axis, at coordinate zero.

    `errors` as in `_square`.
    """
    if section.zero is None:
        x = perpendicular(axes[0])
        return x, turned_shortest(axes[0], axes[1], x)
    given = directions_of(fields, path, section, "zero")
    first, second = (
        _square(fields, (*path, "zero", link), axis, vector, "this direction", "axis", errors)
        for link, axis, vector in zip(section.links, axes, given, strict=True)
    )
    return first, second


def _square(
    fields: Fields, path: Path, axis: Vector, vector: Vector, what: str, line: str, errors: int
) -> Vector:
    """A reference direction, refused where it is parallel to the axis it should stand square to.

    `errors` counts those before the two were read: what stands in for a wrong one says nothing.
    """
    if norm(cross(axis, vector)) > PARALLEL:
        return vector
    if fields.error_count == errors:
        fields.error(
            "zero-parallel",
            path,
            f"{what} is parallel to the joint's {line}",
            "give one that is square to it, or nearly so",
        )
    return perpendicular(axis)
