"""Joints of the file to joints of the mechanism: links checked, frames drawn on both links."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.halves import Halves
from mechkin_cli.building.per_link import directions_of, place_of, points_of
from mechkin_cli.mechanism.elementary import Part
from mechkin_cli.mechanism.frames import (
    GROUND,
    frame_about,
    perpendicular,
    turned_shortest,
    upright,
)
from mechkin_cli.mechanism.joint_table import joint_type
from mechkin_cli.mechanism.joint_type import Drawing, JointType
from mechkin_cli.mechanism.model import GROUND_NAME, Joint
from mechkin_cli.mechanism.vectors import Vector, cross, dot, norm
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
from mechkin_cli.tape.scalars import by_rounding, either, is_settled
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
    kind = joint_type(section.type, fields.plane)
    halves = _DRAWINGS[kind.drawing.kind](fields, path, section, kind.drawing)
    first, second = section.links
    lead = 0.0
    if isinstance(section, HelicalJoint):
        lead = lead_of(fields, (*path, "lead"), section.lead)
    parts = parts_of(kind, halves)
    frames = halves.on_first, halves.on_second
    return Joint(name, kind.letter, first, second, *frames, parts, lead, fields.plane)


def parts_of(kind: JointType, halves: Halves) -> tuple[Part, ...]:
    """The chain of a pair as drawn."""
    parts = []
    for step in kind.steps:
        still = halves.along(step.along) if step.along else None
        parts.append(Part(step.letter, *((still, still) if still else halves.meeting)))
    return tuple(parts)


def lead_of(fields: Fields, path: Path, text: str) -> float:
    """The lead of a helical joint in m; zero is noted in `fields`."""
    errors = fields.error_count
    lead = fields.number(path, text, LENGTH)
    if lead == 0.0 and fields.error_count == errors:
        fields.error("zero-lead", path, "the lead is zero", "use type R for no slide")
    return lead


def _axis(fields: Fields, path: Path, section: AnyAxisJoint, drawing: Drawing) -> Halves:
    """z along the axis on either link."""
    points = points_of(fields, path, section)
    errors = fields.error_count
    axes = directions_of(fields, path, section, *drawing.keys)
    x_first, x_second = _zero_directions(fields, path, section, axes, errors)
    on_first = frame_about(axes[0], x_first, points[0])
    on_second = frame_about(axes[1], x_second, points[1])
    return Halves(on_first, on_second, (on_first, on_second))


def _ball(fields: Fields, path: Path, section: PointJoint, _: Drawing) -> Halves:
    """Ground axes at the sphere's centre."""
    first, second = points_of(fields, path, section)
    meeting = upright(first), upright(second)
    return Halves(*meeting, meeting)


def _ball_on(
    fields: Fields, path: Path, section: SpherePlaneJoint | SphereGrooveJoint, drawing: Drawing
) -> Halves:
    """Ground axes at the sphere's centre; on the second link z along its normal or groove."""
    first, second = points_of(fields, path, section)
    z = directions_of(fields, path, section, *drawing.keys)[1]
    on_second = frame_about(z, perpendicular(z), second)
    return Halves(upright(first), on_second, (upright(first), upright(second)))


def _plane(fields: Fields, path: Path, section: PlanarJoint, drawing: Drawing) -> Halves:
    """z and x along the two directions given on either link."""
    along_z, along_x = drawing.keys
    points = points_of(fields, path, section)
    errors = fields.error_count
    normals = directions_of(fields, path, section, along_z)
    x = directions_of(fields, path, section, along_x)
    directions: list[Vector] = []
    for i in range(2):
        if i == 1 and (normals[1], x[1]) == (normals[0], x[0]):
            directions.append(directions[0])
            continue
        place = place_of(path, section, along_x, i)
        directions.append(_square(fields, place, normals[i], x[i], along_x, along_z, errors))
    frames = [frame_about(n, d, p) for n, d, p in zip(normals, directions, points, strict=True)]
    on_first, on_second = frames
    return Halves(on_first, on_second, (on_first, on_second))


def _two_turns(fields: Fields, path: Path, section: TwoTurnJoint, drawing: Drawing) -> Halves:
    from mechkin_cli.building.two_turns import DRAWINGS

    return DRAWINGS[drawing.kind](fields, path, section, drawing)


def _weld(_: Fields, path: Path, section: WeldJoint, drawing: Drawing) -> Halves:
    """One body."""
    return Halves(GROUND, GROUND, (GROUND, GROUND))


_DRAWINGS: dict[str, Callable[..., Halves]] = {
    "axis": _axis,
    "ball": _ball,
    "ball on": _ball_on,
    "plane": _plane,
    "two axes": _two_turns,
    "square axes": _two_turns,
    "slotted": _two_turns,
    "weld": _weld,
}


def _zero_directions(
    fields: Fields, path: Path, section: AxisJoint, axes: tuple[Vector, Vector], errors: int
) -> tuple[Vector, Vector]:
    """Directions on either link that are in line, seen along the axis, at coordinate zero.

    `errors` as in `_square`.
    """
    if section.zero is None:
        x = perpendicular(axes[0])
        turned = turned_shortest(axes[0], axes[1], x)
        if axes[1] is axes[0] and is_settled(*axes[0]):
            # written once: exact numbers are not turned at all, where doubles round the turn
            same = by_rounding(dot(*axes) > 0.0)
            return x, either(same, lambda: turned, lambda: x)
        return x, turned
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
