"""Friction of a joint: the keys of its law, coefficients, lengths and directions, oil films.

A film of oil between a shaft of radius r and its bearing of length l, c wide and of the dynamic
viscosity mu, is sheared as one between plates (N. Petroff 1883): the speed v of the surfaces needs
the force mu 2 pi r l v / c. So it is a damper, 2 pi mu r l / c along the axis, and r^2 times that
about it. Under load a bearing first rubs dry, by a coefficient that falls with the speed, and then
in its film: together that is Stribeck's curve (R. Stribeck 1902).
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import (
    JOINT_TYPES,
    PLANE_JOINT_TYPES,
    Attached,
    Damper,
    FrictionLaw,
    Joint,
    Mechanism,
    Rubbing,
    cross,
    dot,
    is_angle,
    norm,
    scale,
    subtract,
    unit,
)
from mechkin_cli.record import replace
from mechkin_cli.schema import FallingCoefficient, FrictionAtJoint
from mechkin_cli.tolerances import LARGEST_FLANK, PARALLEL
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH, VELOCITY, VISCOSITY

_FRICTION = "friction"
_FRICTION_LENGTHS = ("radius", "length", "collar", "width")
_FRICTION_KEYS = (*_FRICTION_LENGTHS, "across", "flank")
_FILM_KEYS = ("viscosity", "clearance", "radius", "length")


def without_friction(fields: Fields, mechanism: Mechanism, path: Path) -> Mechanism:
    """The mechanism as it rests without friction, which would hold it in a range of places; where
    joints rub, that is noted."""
    if not mechanism.frictions:
        return mechanism
    text = "friction is left out: the loads balance without it"
    hint = "friction holds the mechanism in a range about this place, too"
    place = fields.document.place(path)
    fields.note(Diagnostic("friction-left-out", "note", text, place, hint=hint))
    return replace(mechanism, frictions=())


def build_friction(
    fields: Fields, path: Path, section: FrictionAtJoint, joint: Joint
) -> Iterator[Rubbing | Damper]:
    """The friction of a joint, dry and by its film; errors are noted in `fields`."""
    if section.law != "dry":
        yield from _film(fields, path, section, joint)
    if section.law != "viscous":
        rubbing = _dry(fields, path, section, joint)
        if rubbing is not None:
            yield rubbing


def _film(fields: Fields, path: Path, section: FrictionAtJoint, joint: Joint) -> Iterator[Damper]:
    """A film of oil, as dampers of the coordinates of its joint."""
    if not (joint.type.is_bearing or joint.type.is_slider):
        text = f"{joint.name} is of type {joint.letter}, for which there is no film of oil"
        fields.error(_FRICTION, (*path, "joint"), text, "films are known for R, C and P")
        return
    errors = fields.error_count
    for key in _FRICTION_KEYS if section.law == "viscous" else ():
        if key not in _FILM_KEYS and getattr(section, key) is not None:
            text = f"a film of oil has no {key}"
            hint = f"it takes {', '.join(_FILM_KEYS)}"
            fields.key_error(_FRICTION, (*path, key), text, hint)
    assert section.viscosity is not None
    viscosity = fields.number((*path, "viscosity"), section.viscosity, VISCOSITY)
    sizes = [_length_of(fields, path, section, key) for key in _FILM_KEYS[1:]]
    if fields.error_count > errors:
        return
    if not viscosity > 0.0:
        text = f"the viscosity of the film is {section.viscosity}"
        fields.error(_FRICTION, (*path, "viscosity"), text, "give it in Pa*s", limit="more than 0")
        return
    clearance, radius, length = sizes
    assert clearance is not None
    assert radius is not None
    assert length is not None
    along = 2.0 * pi * viscosity * radius * length / clearance
    for coordinate in joint.type.coordinates:
        damping = radius * radius * along if is_angle(coordinate) else along
        yield Damper(None, joint.name, coordinate, damping)


def _dry(fields: Fields, path: Path, section: FrictionAtJoint, joint: Joint) -> Rubbing | None:
    """What rubs by the joint's reaction; None, and errors in `fields`, where it cannot."""
    law = joint.type.friction
    if law is None:
        types = PLANE_JOINT_TYPES if joint.type.space == 3 else JOINT_TYPES
        known = ", ".join(letter for letter, entry in types.items() if entry.friction)
        text = f"{joint.name} is of type {joint.letter}, for which there is no law of friction"
        fields.error(_FRICTION, (*path, "joint"), text, f"friction is known for {known}")
        return None
    errors = fields.error_count
    _check_friction_keys(fields, path, section, joint, law)
    coefficients = _coefficients(fields, path, section)
    radius, length, collar, width = (
        _length_of(fields, path, section, key) if key in (*law.needs, *law.may) else None
        for key in _FRICTION_LENGTHS
    )
    flank, across = _flank(fields, path, section), _across(fields, path, section, joint)
    if fields.error_count > errors:
        return None
    place = fields.document.place(path)
    return Rubbing(joint.name, *coefficients, radius, length, collar, width, flank, across, place)


def _check_friction_keys(
    fields: Fields, path: Path, section: FrictionAtJoint, joint: Joint, law: FrictionLaw
) -> None:
    known = (*law.needs, *law.may, *(_FILM_KEYS if section.law == "stribeck" else ()))
    takes = f"it takes {', '.join(('coefficient', *known))}"
    for key in _FRICTION_KEYS:
        is_written = getattr(section, key) is not None
        if is_written and key not in known:
            text = f"friction of {joint.name}, a joint of type {joint.letter}, has no {key}"
            fields.key_error(_FRICTION, (*path, key), text, takes)
        elif key in law.needs and not is_written:
            text = f"friction of {joint.name}, a joint of type {joint.letter}, needs a {key}"
            fields.error(_FRICTION, path, text, takes)
    if section.across is not None and section.width is None and "across" in known:
        text = "across is the direction of a width, and there is none"
        fields.key_error(_FRICTION, (*path, "across"), text, "give width, too, or leave out across")


def _coefficients(
    fields: Fields, path: Path, section: FrictionAtJoint
) -> tuple[float, float, float | None]:
    """At rest, sliding, and the speed over which it falls from one to the other."""
    coefficient = section.coefficient
    assert coefficient is not None
    path = (*path, "coefficient")
    if not isinstance(coefficient, FallingCoefficient):
        number = _coefficient(fields, path, coefficient)
        return number, number, None
    at_rest = _coefficient(fields, (*path, "static"), coefficient.static)
    sliding = _coefficient(fields, (*path, "sliding"), coefficient.sliding)
    if at_rest < sliding:
        text = "the static coefficient is smaller than that of sliding"
        hint = "static friction is never below sliding friction: exchange the two values"
        fields.error(_FRICTION, (*path, "static"), text, hint)
    if coefficient.speed is None:
        return at_rest, sliding, None
    errors = fields.error_count
    speed = fields.number((*path, "speed"), coefficient.speed, VELOCITY)
    if fields.error_count == errors and not speed > 0.0:
        text = "the speed from static to sliding friction must be positive"
        hint = "leave it out where the coefficient falls at once"
        fields.error(_FRICTION, (*path, "speed"), text, hint)
    return at_rest, sliding, speed


def _coefficient(fields: Fields, path: Path, text: str) -> float:
    number = fields.number(path, text, DIMENSIONLESS)
    if number < 0.0:
        fields.error(
            _FRICTION, path, "a coefficient of friction is not negative", "write its magnitude"
        )
    return number


def _length_of(fields: Fields, path: Path, section: FrictionAtJoint, key: str) -> float | None:
    text = getattr(section, key)
    if text is None:
        return None
    errors = fields.error_count
    number = fields.number((*path, key), text, LENGTH)
    if fields.error_count == errors and not number > 0.0:
        fields.error(
            _FRICTION, (*path, key), f"the {key} of friction must be positive", "give its size"
        )
    return number


def _flank(fields: Fields, path: Path, section: FrictionAtJoint) -> float | None:
    if section.flank is None:
        return None
    angle = fields.number((*path, "flank"), section.flank, ANGLE)
    if abs(angle) <= LARGEST_FLANK:
        return angle
    hint = "give half the angle of the thread: 15 deg for trapezoidal, 30 deg for metric threads"
    fields.error(_FRICTION, (*path, "flank"), "such a flank stands nearly along the axis", hint)
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
        fields.error(_FRICTION, (*path, "across"), text, "give a direction square to the axis")
        return None
    along = scale(dot(across, axis.vector), axis.vector)
    return Attached(axis.link, unit(subtract(across, along)))
