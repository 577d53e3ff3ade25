"""Pairs with two turns: about a direction of the first link, then about one of the second.

Both frames have x square to the two directions as drawn (the first cross the second) and z along
their own; slides come before the turns or after them.
"""

from __future__ import annotations

from typing import Any

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.halves import Halves
from mechkin_cli.building.per_link import directions_of, place_of, points_of
from mechkin_cli.mechanism.frames import frame_about, perpendicular
from mechkin_cli.mechanism.joint_type import Drawing
from mechkin_cli.mechanism.vectors import Vector, cross, dot, norm, scale, subtract, unit
from mechkin_cli.tolerances import AXES_SQUARE, PARALLEL


def _oblique(fields: Fields, path: Path, section: Any, drawing: Drawing) -> Halves:
    """About one axis, then about another, at the angle drawn between them."""
    keys = drawing.keys
    at = points_of(fields, path, section)
    errors = fields.error_count
    one, two = (fields.direction((*path, key), getattr(section, key)) for key in keys)
    if norm(cross(one, two)) <= PARALLEL:
        if fields.error_count == errors:
            fields.error(
                "parallel-axes",
                (*path, keys[1]),
                "the two axes of a universal joint are parallel",
                "turn one of them, or use type R",
            )
        one = perpendicular(two)
    return _turns((one, one), (two, two), at)


def _square(fields: Fields, path: Path, section: Any, drawing: Drawing) -> Halves:
    """About the first of two square directions, then about the other."""
    at = points_of(fields, path, section)
    return _turns(*_square_pairs(fields, path, section, drawing), at)


def _slotted(fields: Fields, path: Path, section: Any, drawing: Drawing) -> Halves:
    """Along the cylinder, then about the slot's normal, then about the pin."""
    axis_key, pin_key = drawing.keys
    at = points_of(fields, path, section)
    errors = fields.error_count
    axes = directions_of(fields, path, section, axis_key)
    pins = directions_of(fields, path, section, pin_key)
    normals: list[Vector] = []
    for side, (axis, pin) in enumerate(zip(axes, pins, strict=True)):
        normal = cross(pin, axis)
        if norm(normal) <= PARALLEL:
            if fields.error_count == errors:
                fields.error(
                    "pin-parallel",
                    place_of(path, section, pin_key, side),
                    "the pin is parallel to the cylinder's axis: the two do not tell the slot's "
                    "plane",
                    "draw the pin where it comes out of the slot",
                )
            normal = perpendicular(pin)
        normals.append(unit(normal))
    own = frame_about(axes[0], normals[0], at[0])
    return _turns((normals[0], normals[1]), pins, at)._replace(own=own)


def _turns(
    ones: tuple[Vector, Vector], twos: tuple[Vector, Vector], at: tuple[Vector, Vector]
) -> Halves:
    """Turns about `ones`, then about `twos`, each as drawn on either link; the body between
    stands as drawn on the second."""
    x_first, x_second = (unit(cross(one, two)) for one, two in zip(ones, twos, strict=True))
    on_first = frame_about(ones[0], x_first, at[0])
    between = frame_about(ones[1], x_second, at[1])
    on_second = frame_about(twos[1], x_second, at[1])
    return Halves(on_first, on_second, (on_first, between))


def _square_pairs(
    fields: Fields, path: Path, section: Any, drawing: Drawing
) -> tuple[tuple[Vector, Vector], tuple[Vector, Vector]]:
    """Two directions on either link, the first made exactly square to the second; refused where
    they are not drawn square."""
    keys = drawing.keys
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
                    drawing.cure,
                    measured=f"cosine of their angle {cosine:.3g}",
                    limit=f"{AXES_SQUARE:g}",
                )
            squared.append(perpendicular(two))
            continue
        squared.append(unit(subtract(one, scale(cosine, two))))
    return (squared[0], squared[1]), twos


DRAWINGS = {"two axes": _oblique, "square axes": _square, "slotted": _slotted}
"""Frames on both links, by the kind of drawing."""
