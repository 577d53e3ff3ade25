"""Friction of a joint: the keys of its law, coefficients, lengths and directions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.mechanism import (
    JOINT_TYPES,
    PLANE_JOINT_TYPES,
    Attached,
    FrictionLaw,
    Joint,
    Rubbing,
    cross,
    dot,
    norm,
    scale,
    subtract,
    unit,
)
from mechkin_cli.schema import FallingCoefficient
from mechkin_cli.tolerances import LARGEST_FLANK, PARALLEL
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH, VELOCITY

if TYPE_CHECKING:
    from mechkin_cli.schema import FrictionAtJoint


CODE = "friction"
LENGTHS = ("radius", "length", "collar", "width")
KEYS = (*LENGTHS, "across", "flank")


def build_friction(
    fields: Fields, path: Path, section: FrictionAtJoint, joint: Joint
) -> Rubbing | None:
    """The friction of a joint; None, and errors in `fields`, where it cannot have this one."""
    law = joint.type.friction
    if law is None:
        types = PLANE_JOINT_TYPES if joint.type.space == 3 else JOINT_TYPES
        known = ", ".join(letter for letter, entry in types.items() if entry.friction)
        text = f"{joint.name} is of type {joint.letter}, for which there is no law of friction"
        fields.error(CODE, (*path, "joint"), text, f"friction is known for {known}")
        return None
    errors = fields.error_count
    _check_keys(fields, path, section, joint, law)
    coefficients = _coefficients(fields, path, section)
    radius, length, collar, width = (_length(fields, path, section, key) for key in LENGTHS)
    flank, across = _flank(fields, path, section), _across(fields, path, section, joint)
    if fields.error_count > errors:
        return None
    place = fields.document.place(path)
    return Rubbing(joint.name, *coefficients, radius, length, collar, width, flank, across, place)


def _check_keys(
    fields: Fields, path: Path, section: FrictionAtJoint, joint: Joint, law: FrictionLaw
) -> None:
    known = (*law.needs, *law.may)
    takes = f"it takes {', '.join(('coefficient', *known))}"
    for key in KEYS:
        is_written = getattr(section, key) is not None
        if is_written and key not in known:
            text = f"friction of {joint.name}, a joint of type {joint.letter}, has no {key}"
            fields.key_error(CODE, (*path, key), text, takes)
        elif key in law.needs and not is_written:
            text = f"friction of {joint.name}, a joint of type {joint.letter}, needs a {key}"
            fields.error(CODE, path, text, takes)
    if section.across is not None and section.width is None and "across" in known:
        text = "across is the direction of a width, and there is none"
        fields.key_error(CODE, (*path, "across"), text, "give width, too, or leave out across")


def _coefficients(
    fields: Fields, path: Path, section: FrictionAtJoint
) -> tuple[float, float, float | None]:
    """At rest, sliding, and the speed over which it falls from one to the other."""
    coefficient = section.coefficient
    path = (*path, "coefficient")
    if not isinstance(coefficient, FallingCoefficient):
        number = _coefficient(fields, path, coefficient)
        return number, number, None
    at_rest = _coefficient(fields, (*path, "static"), coefficient.static)
    sliding = _coefficient(fields, (*path, "sliding"), coefficient.sliding)
    if at_rest < sliding:
        text = "the static coefficient is smaller than that of sliding"
        hint = "surfaces hold at least as well as they drag: exchange the two"
        fields.error(CODE, (*path, "static"), text, hint)
    if coefficient.speed is None:
        return at_rest, sliding, None
    errors = fields.error_count
    speed = fields.number((*path, "speed"), coefficient.speed, VELOCITY)
    if fields.error_count == errors and not speed > 0.0:
        text = "the speed from static to sliding friction must be positive"
        hint = "leave it out where the coefficient falls at once"
        fields.error(CODE, (*path, "speed"), text, hint)
    return at_rest, sliding, speed


def _coefficient(fields: Fields, path: Path, text: str) -> float:
    number = fields.number(path, text, DIMENSIONLESS)
    if number < 0.0:
        fields.error(CODE, path, "a coefficient of friction is not negative", "write its magnitude")
    return number


def _length(fields: Fields, path: Path, section: FrictionAtJoint, key: str) -> float | None:
    text = getattr(section, key)
    if text is None:
        return None
    errors = fields.error_count
    number = fields.number((*path, key), text, LENGTH)
    if fields.error_count == errors and not number > 0.0:
        fields.error(CODE, (*path, key), f"the {key} of friction must be positive", "give its size")
    return number


def _flank(fields: Fields, path: Path, section: FrictionAtJoint) -> float | None:
    if section.flank is None:
        return None
    angle = fields.number((*path, "flank"), section.flank, ANGLE)
    if abs(angle) <= LARGEST_FLANK:
        return angle
    hint = "give half the angle of the thread: 15 deg for trapezoidal, 30 deg for metric threads"
    fields.error(CODE, (*path, "flank"), "such a flank stands nearly along the axis", hint)
    return None


def _across(fields: Fields, path: Path, section: FrictionAtJoint, joint: Joint) -> Attached | None:
    """The direction of the width, square to the axis."""
    if section.across is None:
        return None
    errors = fields.error_count
    across, axis = fields.direction((*path, "across"), section.across), joint.axis
    if fields.error_count > errors:
        return None
    if norm(cross(across, axis.vector)) <= PARALLEL:
        text = f"the width of {joint.name} cannot run along its axis"
        fields.error(CODE, (*path, "across"), text, "give a direction square to the axis")
        return None
    along = scale(dot(across, axis.vector), axis.vector)
    return Attached(axis.link, unit(subtract(across, along)))
