"""Gravity of the file: its vector in SI, and whether bare numbers are in another unit than meant.

A file in mm whose gravity is 9.81 computes with a thousandth of what was meant, and nothing else in
it looks wrong.
"""

from __future__ import annotations

from math import sqrt

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.expressions import literal, number_of
from mechkin_cli.mechanism.vectors import Vector, scale
from mechkin_cli.schema.loads import Gravity
from mechkin_cli.tolerances import GRAVITY_ON_EARTH, LARGEST_NUMBER
from mechkin_cli.units import ACCELERATION, parse_unit

STANDARD = 9.80665
"""m/s^2, by the third General Conference on Weights and Measures."""

DOWN: Vector = (0.0, 0.0, -1.0)

USUAL = ("m/s^2", "mm/s^2", "cm/s^2", "in/s^2", "ft/s^2")
"""Units in which people know the number of gravity."""


def gravity_of(fields: Fields, path: Path, section: Gravity) -> Vector:
    """The acceleration of free fall in m/s^2; doubts are noted in `fields`."""
    if section.g == "standard":
        standard = number_of(str(STANDARD))
        assert standard is not None
        if section.direction is None:
            return scale(standard, DOWN)
        return scale(standard, fields.direction((*path, "direction"), section.direction))
    found = fields.vector((*path, "g"), section.g, ACCELERATION)
    _check_unit(fields, (*path, "g"), section.g)
    return found


def _check_unit(fields: Fields, path: Path, texts: tuple[str, ...]) -> None:
    """Warns where bare numbers are standard gravity in some usual unit, but not in the file's."""
    bare = [literal(text) or 0.0 for text in texts]
    number = sqrt(sum(value * value for value in bare if abs(value) < LARGEST_NUMBER))
    in_si = number * fields.units.factor(ACCELERATION)
    units = [unit for unit in USUAL if _like_gravity(number * float(parse_unit(unit).factor))]
    if fields.error_count or _like_gravity(in_si) or not units:
        return
    own = fields.units.label(ACCELERATION)
    pairs = list(zip(bare, texts, strict=True))[: 2 if fields.plane else 3]
    meant = ", ".join(f"{text.strip()} {units[0]}" if value else text for value, text in pairs)
    fields.note(
        Diagnostic(
            "gravity-unit",
            "warning",
            f"gravity is {number:.6g} {own} here, the number of gravity in {units[0]}",
            fields.document.place(path),
            measured=f"{in_si:.4g} m/s^2",
            hint=f"write g: [{meant}], or g: standard with its direction; {own} if that is meant",
            numbers=(Number("gravity", in_si, "m/s^2"),),
        )
    )


def _like_gravity(in_si: float) -> bool:
    return abs(in_si - STANDARD) <= GRAVITY_ON_EARTH * STANDARD
