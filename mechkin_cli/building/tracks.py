"""`curve:` and `surface:` of joints to tracks: formulas of their parameters, or splines through
points.

A straight line is no track but a groove, whose pair the kernel knows; it is read as one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path, place_at
from mechkin_cli.expressions import (
    Expression,
    ExpressionError,
    Quantity,
    UnknownName,
    Vector as VectorValue,
    number_of,
    scalar,
)
from mechkin_cli.mechanism import (
    ELEMENTARY,
    ZERO,
    Curve as Spline,
    Ends as SplineEnds,
    Joint,
    Part,
    Track,
    Vector,
    add,
    cross,
    dot,
    joint_type,
    norm,
    perpendicular,
    scale,
    smooth_curve,
    subtract,
    unit,
    upright,
)
from mechkin_cli.record import dataclass, replace
from mechkin_cli.schema import Curve, MechanismFile, Surface
from mechkin_cli.tape import (
    JetNumber,
    Recorded,
    as_recorded,
    cos,
    is_traced,
    of_numbers,
    of_two,
    plain,
    sin,
)
from mechkin_cli.tolerances import PARALLEL
from mechkin_cli.units import ANGLE, DIMENSIONLESS, LENGTH, Dimension, UnitSystem

FULL_TURN = (0.0, 2.0 * pi)
"""Ends of an angle that comes back to its begin."""

_Z: Vector = (0.0, 0.0, 1.0)


def is_carried(section: object) -> bool:
    """Whether a joint goes along a curve that is not straight, or over a surface."""
    curve, surface = (getattr(section, key, None) for key in ("curve", "surface"))
    return surface is not None or (curve is not None and curve.line is None)


def carried_joint(fields: Fields, name: str, section: Any, points: tuple[Vector, Vector]) -> Joint:
    """A joint on a curve that is not straight, or on a surface.

    Args:
        fields: where errors are noted; the joint then stands still at its point.
        name: of the joint.
        section: the file's, with a `curve` or a `surface` on the second link.
        points: of the joint on its first link and on its second, as drawn (m).
    """
    path: Path = ("joints", name)
    surface, errors = getattr(section, "surface", None), fields.error_count
    if surface is not None:
        letter, track = "Sp on a surface", _surface(fields, (*path, "surface"), surface, points[1])
    else:
        letter = f"{section.type} on a curve"
        track = _curve(fields, (*path, "curve"), section.curve, points[1])
    kind = joint_type(letter)
    if track is None or fields.error_count > errors:
        ends, here = len(kind.named) - fields.plane, points[1]
        track = Track(((0.0, 1.0),) * ends, (False,) * ends, lambda *_: here)
    first, second = map(upright, points)
    at = _drawn_at(track, points[0])
    parts = []
    for step in kind.steps:
        if ELEMENTARY[step.letter].is_carriage:
            parts.append(Part(step.letter, second, second, track=track, sense=-1.0, at=at))
        else:
            parts.append(Part(step.letter, first, second))
    links = section.links[0], section.links[1]
    return Joint(name, letter, *links, first, second, tuple(parts), plane=fields.plane)


def _drawn_at(track: Track, point: Vector) -> tuple[float, ...]:
    """The parameters as drawn; of recorded numbers, from which nothing starts, some between the
    ends."""
    middle = tuple(as_recorded(0.5 * (low + high)) for low, high in track.ends)
    numbers: list[Any] = [*middle, *point]
    numbers += [] if track.knots else track.orders(middle)[0]
    if any(isinstance(number, Recorded) for number in numbers):
        return middle
    return track.nearest(point)


TrackEnds = Mapping[tuple[str, str], tuple[Path, float, float]]


def track_ends(fields: Fields, file: MechanismFile, joints: Mapping[str, Joint]) -> TrackEnds:
    """Where curves and surfaces end, by joint and coordinate: the place in the file, and the least
    and the largest parameter (rad, m or a number), of a straight curve the slide (m)."""
    found: dict[tuple[str, str], tuple[Path, float, float]] = {}
    for name, section in file.joints.items():
        if name not in joints:
            continue
        joint = joints[name]
        curve = getattr(section, "curve", None)
        path: Path = ("joints", name, "surface" if curve is None else "curve")
        if curve is not None and curve.line is not None and not fields.error_count:
            ends = line_ends(fields, path, curve)
            assert ends is not None
            along = unit(subtract(ends[1], ends[0]))
            low, high = (dot(subtract(e, joint.on_second.o), along) for e in ends)
            found[name, "s"] = path, low, high
        for part in joint.parts:
            if part.track is not None:
                own = zip(part.track.names, part.track.ends, part.track.bounded, strict=True)
                for coordinate, (low, high), bounded in own:
                    if bounded:
                        found[name, coordinate] = path, low, high
    return found


def along_line(fields: Fields, path: Path, section: Any) -> Vector:
    """The direction (unit vector, as drawn) of a straight curve, from its first place to its last;
    x where an error is noted."""
    ends = line_ends(fields, (*path, "curve"), section.curve)
    return (1.0, 0.0, 0.0) if ends is None else unit(subtract(ends[1], ends[0]))


def line_ends(fields: Fields, path: Path, section: Curve) -> tuple[Vector, Vector] | None:
    """The ends of a straight line as drawn (m); None where an error was noted."""
    assert section.line is not None
    errors = fields.error_count
    first, last = (
        place_at(fields, (*path, "line", k), place) for k, place in enumerate(section.line)
    )
    if fields.error_count > errors:
        return None
    if not norm(subtract(last, first)) > 0.0:
        fields.error("no-line", (*path, "line"), "the line has no length", "give two places")
        return None
    return first, last


def _curve(fields: Fields, path: Path, section: Curve, point: Vector) -> Track | None:
    if section.center is not None:
        return _circle(fields, path, section, point)
    if section.arc is not None:
        return _arc(fields, path, section.arc)
    if section.points is not None:
        return _spline(fields, path, section)
    assert section.at is not None
    assert section.first is not None
    assert section.last is not None
    ends, dimension = _parameter_ends(fields, path, ("from", "to"), (section.first, section.last))
    return _by_expressions(fields, path, section.at, {"u": dimension}, (ends,), (section.closed,))


def _center_and_axis(
    fields: Fields, path: Path, section: Curve | Surface, place: Any, key: str
) -> tuple[Vector, Vector]:
    """The centre (m) and the axis (unit vector) of what is round, as drawn."""
    center = place_at(fields, (*path, key), place)
    axis = _Z if section.axis is None else fields.direction((*path, "axis"), section.axis)
    return center, axis


def _radial(
    fields: Fields, path: Path, center: Vector, axis: Vector, point: Vector
) -> tuple[Vector, float]:
    """The unit vector square to an axis towards the joint's point, and how far off that is (m)."""
    off = subtract(point, center)
    off = subtract(off, scale(dot(off, axis), axis))
    far = norm(off)
    return (scale(1.0 / far, off), far) if far > 0.0 else (perpendicular(axis), far)


def _radius(fields: Fields, path: Path, text: str | None, drawn: float) -> float:
    errors = fields.error_count
    radius = drawn if text is None else fields.number((*path, "radius"), text, LENGTH)
    if not radius > tolerances.SMALLEST_DIVISOR and fields.error_count == errors:
        hint = "give a positive radius, or draw the joint's point off the axis"
        fields.error(
            "no-radius", (*path, "radius") if text else path, "the radius is not positive", hint
        )
        return 1.0
    return radius


def _circle(fields: Fields, path: Path, section: Curve, point: Vector) -> Track:
    center, axis = _center_and_axis(fields, path, section, section.center, "center")
    x, drawn = _radial(fields, path, center, axis, point)
    radius = _radius(fields, path, section.radius, drawn)
    numbers = _circle_numbers(center, x, cross(axis, x), radius)
    return Track(((-pi, pi),), (True,), _on_circle, numbers=numbers)


def _circle_numbers(center: Vector, x: Vector, y: Vector, radius: float) -> tuple[Any, ...]:
    """A circle: its centre, and the vectors from it to the places at 0 and at a quarter turn."""
    return (*center, *scale(radius, x), *scale(radius, y))


def _on_circle(*given: Any) -> list[Any]:
    """The place at the angle u of `_circle_numbers`."""
    center, across, along, (u,) = given[:3], given[3:6], given[6:9], given[9:]
    c, s = cos(u), sin(u)
    return [c * across[k] + s * along[k] + center[k] for k in range(3)]


def _on_cylinder(*given: Any) -> list[Any]:
    """The place at the angle u of `_circle_numbers`, and v along an axis."""
    *circle, ax, ay, az, u, v = given
    around = _on_circle(*circle, u)
    return [at + v * a for at, a in zip(around, (ax, ay, az), strict=True)]


def _on_torus(*given: Any) -> list[Any]:
    """Of a centre, three directions, the radius of the circle and that of the tube."""
    center, x, y, axis = given[:3], given[3:6], given[6:9], given[9:12]
    radius, tube, u, v = given[12:]
    far, up = cos(v) * tube + radius, sin(v) * tube
    across, along = far * cos(u), far * sin(u)
    return [across * x[k] + along * y[k] + up * axis[k] + center[k] for k in range(3)]


def _on_sphere(*given: Any) -> list[Any]:
    """Of a centre, three directions and the radius."""
    center, x, y, axis, (radius, u, v) = given[:3], given[3:6], given[6:9], given[9:12], given[12:]
    far, up = cos(v) * radius, sin(v) * radius
    across, along = far * cos(u), far * sin(u)
    return [across * x[k] + along * y[k] + up * axis[k] + center[k] for k in range(3)]


def _arc(fields: Fields, path: Path, section: Sequence[Any]) -> Track | None:
    """Through three places A, B, C: the centre is A + ((c.c) b + ...) as of a triangle's
    circumcircle, u the angle from A."""
    a, b, c = (place_at(fields, (*path, "arc", k), place) for k, place in enumerate(section))
    ab, ac = subtract(b, a), subtract(c, a)
    normal = cross(ab, ac)
    twice = dot(normal, normal)
    if not twice > PARALLEL**2 * (dot(ab, ab) * dot(ac, ac)):
        text, hint = "the three places of an arc lie on a line", "write line: with two of them"
        fields.error("straight-arc", (*path, "arc"), text, hint)
        return None
    to_center = scale(
        0.5 / twice,
        add(
            scale(dot(ac, ac), cross(normal, ab)),
            scale(dot(ab, ab), cross(ac, normal)),
        ),
    )
    center, axis = add(a, to_center), unit(normal)
    radius = norm(to_center)
    x = scale(-1.0 / radius, to_center)
    y = cross(axis, x)
    last = subtract(c, center)
    end = plain(of_two("ATAN2", dot(last, y), dot(last, x)))
    turn = end if end > 0.0 else end + 2.0 * pi
    numbers = _circle_numbers(center, x, y, radius)
    return Track(((0.0, turn),), (False,), _on_circle, numbers=numbers)


def _spline(fields: Fields, path: Path, section: Curve) -> Track | None:
    assert section.points is not None
    places = [
        place_at(fields, (*path, "points", k), place) for k, place in enumerate(section.points)
    ]
    if section.closed and places[0] != places[-1]:
        places.append(places[0])
    chords = [norm(subtract(b, a)) for a, b in pairwise(places)]
    for k, chord in enumerate(chords):
        if not chord > 0.0:
            at = (*path, "points", min(k + 1, len(section.points) - 1))
            fields.error("same-point", at, "this point is the one before it", "leave one out")
            return None
    u = [0.0]
    for chord in chords:
        u.append(u[-1] + chord)
    ends: SplineEnds = "periodic" if section.closed else "not-a-knot"
    knots = tuple(smooth_curve(u, list(values), ends) for values in zip(*places, strict=True))
    if not section.closed:
        knots = tuple(_prolonged(curve, u[-1]) for curve in knots)
    return Track(((0.0, u[-1]),), (section.closed,), knots=knots)


def _prolonged(curve: Spline, by: float) -> Spline:
    """A curve that goes straight on beyond its ends, by a length (m): a place beyond an end is
    found, and told to be beyond its limit, where the spline's last cubic would turn away."""
    (y, b, *_), (y_end, b_end, *_) = curve.coefficients[:, 0], curve.coefficients[:, -1]
    first, last = curve.first, curve.last
    before = [y - b * by, b, 0.0, 0.0]
    behind, end = [y_end, b_end, 0.0, 0.0], [y_end + b_end * by, b_end, 0.0, 0.0]
    pieces = [before, *curve.coefficients[:, :-1].T.tolist(), behind, end]
    x = [first - by, *curve.x.tolist(), last + by]
    return Spline(of_numbers(x), np.array(pieces).T.copy())


def _parameter_ends(
    fields: Fields, path: Path, keys: Sequence[str | int], texts: Sequence[str]
) -> tuple[tuple[float, float], Dimension]:
    """Begin and end of a parameter in SI, and what it is; a bare zero is of any dimension."""
    found: list[Any] = []
    for key, text in zip(keys, texts, strict=True):
        bare = number_of(text)
        value: Any
        try:
            value = (
                Quantity(bare, DIMENSIONLESS)
                if bare is not None
                else fields.definitions.parse(text).evaluate(fields.resolve, fields.units)
            )
            if not isinstance(as_recorded(value.value), float | int):
                raise ExpressionError("expected one number", 0)
        except ExpressionError as error:
            fields.expression_error((*path, key), error)
            value = Quantity(0.0, DIMENSIONLESS)
        found.append(value)
    first, last = (plain(one.value) for one in found)
    dimensions = [one.dimension for one in found if one.value != 0.0]
    dimension = dimensions[0] if dimensions else DIMENSIONLESS
    if any(other != dimension for other in dimensions):
        words = " and ".join(dict.fromkeys(d.phrase for d in dimensions))
        fields.error("dimension", (*path, keys[1]), f"begin and end must be alike, found {words}")
    elif dimension not in (ANGLE, LENGTH, DIMENSIONLESS):
        text = f"a parameter is an angle, a length or a number, this is {dimension.phrase}"
        fields.error("dimension", (*path, keys[1]), text)
    elif not first < last:
        text = "the parameter ends before it begins"
        fields.error("no-room", (*path, keys[1]), text, "write the least value first")
        first, last = 0.0, 1.0
    return (first, last), dimension


@dataclass(frozen=True)
class _Formula:
    """The coordinates x, y, z of a place (m) from an `origin`: numbers, or expressions of those
    along a curve or surface, which have `dimensions` by name, and of the file's `parameters`."""

    coordinates: tuple[Expression | float, ...]
    dimensions: Mapping[str, Dimension]
    parameters: Mapping[str, Quantity]
    origin: Vector
    units: UnitSystem

    def __call__(self, *at: Any) -> list[Any]:
        """The coordinates at numbers of any kind, in SI."""
        named = dict(zip(self.dimensions, at, strict=True))

        def resolve(name: str) -> Quantity:
            if name in named:
                return Quantity(named[name], self.dimensions[name])
            parameter = self.parameters[name]
            if not isinstance(at[0], JetNumber) or isinstance(parameter.value, VectorValue):
                return parameter
            return replace(parameter, value=at[0].beside(parameter.value))

        values: list[Any] = [
            one.evaluate(resolve, self.units).value if isinstance(one, Expression) else one
            for one in self.coordinates
        ]
        if self.origin == ZERO:
            return values
        return [value - off for value, off in zip(values, self.origin, strict=True)]


def _by_expressions(
    fields: Fields,
    path: Path,
    texts: Sequence[str],
    dimensions: Mapping[str, Dimension],
    ends: tuple[tuple[float, float], ...],
    closed: tuple[bool, ...],
) -> Track | None:
    """A track by expressions of its parameters."""
    parameters = dict(fields.parameters)
    expressions: list[Expression | float] = []
    for k, text in enumerate(texts):
        try:
            expression = fields.definitions.parse(text)
            bare = number_of(text)
            if bare is None:
                sample = {
                    name: Quantity(as_recorded(0.5 * (low + high)), dimension)
                    for (name, dimension), (low, high) in zip(dimensions.items(), ends, strict=True)
                }
                known = {n: _sampled(q) for n, q in parameters.items()} | sample
                scalar(expression.in_doubles, LENGTH, fields.units, _resolver(fields, known))
        except ExpressionError as error:
            fields.expression_error((*path, "at", k), error)
            return None
        expressions.append(expression if bare is None else fields.units.to_si(bare, LENGTH))

    coordinates = tuple(expressions)
    formula = _Formula(coordinates, dimensions, fields.parameters, fields.origin, fields.units)
    return Track(ends, closed, formula)


def _sampled(quantity: Quantity) -> Quantity:
    value: Any = quantity.value
    return replace(quantity, value=as_recorded(value)) if is_traced(value) else quantity


def _resolver(fields: Fields, known: Mapping[str, Quantity]) -> Callable[[str], Quantity]:
    def quantity(name: str) -> Quantity:
        if name in known:
            return known[name]
        if fields.is_refused(name):
            return fields.resolve(name)
        raise UnknownName(name, list(known))

    return quantity


def _surface(fields: Fields, path: Path, section: Surface, point: Vector) -> Track | None:
    if section.at is not None:
        assert section.u is not None
        assert section.v is not None
        ranges = [
            _parameter_ends(fields, (*path, key), (0, 1), texts)
            for key, texts in (("u", section.u), ("v", section.v))
        ]
        (u, of_u), (v, of_v) = ranges
        dimensions = {"u": of_u, "v": of_v}
        return _by_expressions(fields, path, section.at, dimensions, (u, v), (False, False))
    if section.sphere is not None:
        return _sphere(fields, path, section, point)
    key = "cylinder" if section.cylinder is not None else "torus"
    center, axis = _center_and_axis(fields, path, section, getattr(section, key), key)
    x, drawn = _radial(fields, path, center, axis, point)
    y = cross(axis, x)
    radius = _radius(fields, path, section.radius, drawn)
    if section.cylinder is not None:
        # along its axis it has no end; searches start about as far off as the drawing is
        reach = 10.0 * as_recorded(radius + abs(dot(subtract(point, center), axis)))
        numbers = (*_circle_numbers(center, x, y, radius), *axis)
        ends = ((-pi, pi), (-reach, reach))
        return Track(ends, (True, False), _on_cylinder, endless=("v",), numbers=numbers)
    assert section.tube is not None
    tube = fields.number((*path, "tube"), section.tube, LENGTH)
    if not (tube > 0.0 and tube < radius):
        text = "the tube of a torus is thinner than its circle"
        fields.error("no-torus", (*path, "tube"), text, "give a smaller positive radius")

    numbers = (*center, *x, *y, *axis, radius, tube)
    return Track(((-pi, pi), (-pi, pi)), (True, True), _on_torus, numbers=numbers)


def _sphere(fields: Fields, path: Path, section: Surface, point: Vector) -> Track:
    assert section.sphere is not None
    center = place_at(fields, (*path, "sphere"), section.sphere)
    off = subtract(point, center)
    radius = _radius(fields, path, section.radius, norm(off))
    if section.axis is None:
        # the poles, where the longitude is none, far from the drawing
        axis = perpendicular(unit(off)) if norm(off) > 0.0 else _Z
    else:
        axis = fields.direction((*path, "axis"), section.axis)
    x, _ = _radial(fields, path, center, axis, point)
    y = cross(axis, x)

    # beyond a pole it goes on along the other side
    ends = ((-pi, pi), (-0.5 * pi, 0.5 * pi))
    numbers = (*center, *x, *y, *axis, radius)
    return Track(ends, (True, False), _on_sphere, endless=("v",), numbers=numbers)
