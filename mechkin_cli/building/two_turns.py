"""U, Ss, Sc and Cp: turns about a direction of the first link, then about one of the second.

Both frames have x square to the two directions as drawn (the first cross the second) and z along
their own; slides come before the turns (Sc) or after them (Cp).
"""

from __future__ import annotations

from collections.abc import Callable

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.per_link import Frames, directions_of, place_of, points_of
from mechkin_cli.mechanism.frames import Frame, frame_about, perpendicular
from mechkin_cli.mechanism.model import Part
from mechkin_cli.mechanism.vectors import Vector, cross, dot, norm, scale, subtract, unit
from mechkin_cli.schema.joints import (
    CylinderPlaneJoint,
    PointJoint,
    SlottedSphereJoint,
    SphereCylinderJoint,
    UniversalJoint,
)
from mechkin_cli.tolerances import AXES_SQUARE, PARALLEL

Turns = tuple[Frame, Frame, tuple[Part, Part]]
"""Frames on either link and the two turns between them."""


def _universal_frames(fields: Fields, path: Path, section: UniversalJoint) -> Frames:
    """U: about `axis`, then about `axis2`, at the angle drawn between them."""
    at = points_of(fields, path, section)
    errors = fields.error_count
    one = fields.direction((*path, "axis"), section.axis)
    two = fields.direction((*path, "axis2"), section.axis2)
    if norm(cross(one, two)) <= PARALLEL:
        if fields.error_count == errors:
            fields.error(
                "parallel-axes",
                (*path, "axis2"),
                "the two axes of a universal joint are parallel",
                "turn one of them, or use type R",
            )
        one = perpendicular(two)
    return _turns((one, one), (two, two), at)


def _slotted_sphere_frames(fields: Fields, path: Path, section: SlottedSphereJoint) -> Frames:
    """Ss: about the slot's normal, then about the pin."""
    at = points_of(fields, path, section)
    cure = "the slot's plane holds the pin: give the normal of that plane"
    slots, pins = _square_pairs(fields, path, section, ("slot", "pin"), cure)
    return _turns(slots, pins, at)


def _slotted_cylinder_frames(fields: Fields, path: Path, section: SphereCylinderJoint) -> Frames:
    """Sc: along the cylinder, then about the slot's normal, then about the pin."""
    at = points_of(fields, path, section)
    errors = fields.error_count
    axes = directions_of(fields, path, section, "axis")
    pins = directions_of(fields, path, section, "pin")
    normals: list[Vector] = []
    for side, (axis, pin) in enumerate(zip(axes, pins, strict=True)):
        normal = cross(pin, axis)
        if norm(normal) <= PARALLEL:
            if fields.error_count == errors:
                fields.error(
                    "pin-parallel",
                    place_of(path, section, "pin", side),
                    "the pin is parallel to the cylinder's axis: the two do not tell the slot's "
                    "plane",
                    "draw the pin where it comes out of the slot",
                )
            normal = perpendicular(pin)
        normals.append(unit(normal))
    on_first, on_second, turns = _turns((normals[0], normals[1]), pins, at)
    slide = frame_about(axes[0], normals[0], at[0])
    return on_first, on_second, (Part("P", slide, slide), *turns)


def _cylinder_plane_frames(fields: Fields, path: Path, section: CylinderPlaneJoint) -> Frames:
    """Cp: about the cylinder's axis, then about the plane's normal, then along the plane's x and
    y."""
    at = points_of(fields, path, section)
    cure = "a cylinder touches a plane along a line only with its axis square to the normal"
    axes, normals = _square_pairs(fields, path, section, ("axis", "normal"), cure)
    on_first, on_second, turns = _turns(axes, normals, at)
    slides = [frame_about(axis, on_second.z, at[1]) for axis in (on_second.x, on_second.y)]
    return on_first, on_second, (*turns, *(Part("P", f, f) for f in slides))


def _turns(
    ones: tuple[Vector, Vector], twos: tuple[Vector, Vector], at: tuple[Vector, Vector]
) -> Turns:
    """Turns about `ones`, then about `twos`, each as drawn on either link; the body between
    stands as drawn on the second."""
    x_first, x_second = (unit(cross(one, two)) for one, two in zip(ones, twos, strict=True))
    on_first = frame_about(ones[0], x_first, at[0])
    between = frame_about(ones[1], x_second, at[1])
    on_second = frame_about(twos[1], x_second, at[1])
    return on_first, on_second, (Part("R", on_first, between), Part("R", on_second, on_second))


def _square_pairs(
    fields: Fields, path: Path, section: PointJoint, keys: tuple[str, str], cure: str
) -> tuple[tuple[Vector, Vector], tuple[Vector, Vector]]:
    """Two directions on either link, the first made exactly square to the second; refused where
    they are not drawn square."""
    errors = fields.error_count
    ones, twos = (directions_of(fields, path, section, key) for key in keys)
    squared: list[Vector] = []
    for side, (one, two) in enumerate(zip(ones, twos, strict=True)):
        cosine = dot(one, two)
        if abs(cosine) > AXES_SQUARE:
            if fields.error_count == errors:
                fields.error(
                    "not-square",
                    place_of(path, section, keys[1], side),
                    f"{keys[0]} and {keys[1]} of this joint must be square to each other",
                    cure,
                    measured=f"cosine of their angle {cosine:.3g}",
                    limit=f"{AXES_SQUARE:g}",
                )
            squared.append(perpendicular(two))
            continue
        squared.append(unit(subtract(one, scale(cosine, two))))
    return (squared[0], squared[1]), twos


FRAMES: dict[str, Callable[..., Frames]] = {
    "U": _universal_frames,
    "Ss": _slotted_sphere_frames,
    "Sc": _slotted_cylinder_frames,
    "Cp": _cylinder_plane_frames,
}
"""Frames on both links and parts, by type."""
