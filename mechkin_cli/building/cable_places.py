"""The places that a cable passes - points, pulleys and drums - and its straight stretches from one
to the next as drawn.

In a plane all pulleys turn about z. In space each has its axis; a stretch leaves a pulley square to
that, so its other end lies in the pulley's plane. A swivelling pulley turns its plane to where its
cable leads: on one side the cable runs along the line about which it swivels, on the other to a
point, in the plane of that line and the point. With A the point of the line level with the centre,
r the radius and u the unit vector from the line square towards the point, its centre is A + r u. A
free pulley hangs on its centre, in the plane of that and the points before and after it, which it
has in front.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.mechanism import (
    GROUND,
    Attached,
    Joint,
    Vector,
    add,
    cross,
    dot,
    norm,
    scale,
    subtract,
    unit,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import PathPart
from mechkin_cli.tape import of_two, square_root
from mechkin_cli.units import ANGLE, LENGTH


class Swivel(NamedTuple):
    """How a pulley turns to where its cable leads: about a line through `entry`, the point of its
    link that is level with the centre, `along` the cable as it runs onto the pulley; `way` is 1
    where the cable comes along the line and -1 where it leaves along it."""

    entry: Attached
    along: Vector
    way: int = 1


class Place(NamedTuple):
    """A place that a cable passes: a point of a link, about which it runs at a radius (m), on its
    left (1) or right (-1) seen along the way against `axis`; 0: through it. `is_drum`: it ends
    there. A swivelling pulley, or one that `is_free`, has its centre and axis as drawn."""

    centre: Attached
    radius: float = 0.0
    side: float = 0.0
    is_drum: bool = False
    axis: Vector = GROUND.z
    swivel: Swivel | None = None
    is_free: bool = False

    @property
    def is_round(self) -> bool:
        """Whether the cable runs about it."""
        return self.side != 0.0

    @property
    def beside(self) -> float:
        """How far the cable runs to the left of the centre (m)."""
        return self.side * self.radius

    @property
    def reversed(self) -> Place:
        """As passed the other way."""
        swivel = None if self.swivel is None else self.swivel._replace(way=-self.swivel.way)
        return self._replace(side=-self.side, swivel=swivel)

    def facing(self, way: int) -> Place:
        """What a stretch meets that comes to it (-1) or leaves it (1): of a swivelling pulley, on
        the side of its line, the point of that."""
        if self.swivel is not None and way != self.swivel.way:
            return Place(self.swivel.entry, swivel=self.swivel)
        return self


def stretch(one: Place, other: Place) -> tuple[float, Vector]:
    """Length of the straight stretch between two places (m), and its direction."""
    axis, near, far = _beside(one, other)
    apart = subtract(other.centre.vector, one.centre.vector)
    apart = (
        subtract(apart, scale(dot(apart, axis), axis)) if one.is_round or other.is_round else apart
    )
    # apart = length * along + beside * (to the left of that)
    beside = near - far
    square = dot(apart, apart)
    length = square_root(square - beside * beside)
    across = scale(-beside / square, cross(axis, apart))
    return length, add(scale(length / square, apart), across)


def _beside(one: Place, other: Place) -> tuple[Vector, float, float]:
    """The axis square to a stretch, and how far it runs to the left of both ends against that."""
    if not one.is_round:
        return other.axis, 0.0, other.beside
    same = dot(one.axis, other.axis) > 0.0 or not other.is_round
    return one.axis, one.beside, other.beside if same else -other.beside


def arc(before: Place, place: Place, after: Place) -> float:
    """Angle of the arc about a pulley from the stretch before it to the one after it."""
    one = stretch(before.facing(1), place.facing(-1))[1]
    other = stretch(place.facing(1), after.facing(-1))[1]
    turned: float = of_two("ATAN2", dot(cross(one, other), place.axis), dot(one, other))
    return -place.side * turned


def read_places(
    fields: Fields,
    path: Path,
    parts: Sequence[PathPart],
    joints: Mapping[str, Joint],
    points: Mapping[str, Attached],
) -> list[Place] | None:
    """The places of a path, at most as drawn; None where errors are noted."""
    errors = fields.error_count
    found = [
        _read(fields, (*path, i), part, joints, points, 0 < i < len(parts) - 1)
        for i, part in enumerate(parts)
    ]
    places = [place for place in found if place is not None]
    if fields.error_count > errors or not (fields.plane or _turned(fields, path, places)):
        return None
    return places if _are_apart(fields, path, places) else None


def _read(
    fields: Fields,
    path: Path,
    part: PathPart,
    joints: Mapping[str, Joint],
    points: Mapping[str, Attached],
    between: bool,
) -> Place | None:
    """A place of a path, which may be `between` others; None where errors are noted."""
    if part.point is not None:
        if part.point in points:
            return Place(points[part.point])
        if not fields.is_refused(part.point):
            hint = nearest_hint(part.point, list(points)) or "name it under points"
            fields.error("unknown-point", path, f"there is no point {part.point}", hint)
        return None
    key = "pulley" if part.drum is None else "drum"
    name = part.pulley if part.drum is None else part.drum
    assert name is not None
    axis = GROUND.z
    is_joint = name in joints
    if not is_joint:
        if part.drum is None and name in points:
            centre = points[name]
        else:
            if not fields.is_refused(name):
                text = f"there is no joint {name}"
                fields.error("unknown-joint", (*path, key), text, nearest_hint(name, list(joints)))
            return None
    elif not joints[name].type.is_bearing:
        letter = joints[name].letter
        text = f"{name} is of type {letter}: a {key} turns on an R joint"
        fields.error("wheel-joint", (*path, key), text, "name the joint that it turns on")
        return None
    else:
        # on the wheel, so that its bearing takes the pull
        centre, axis = (
            Attached(joints[name].second, joints[name].on_second.o),
            joints[name].on_second.z,
        )
    if part.drum is not None and between:
        text = f"the cable ends on the drum at {part.drum}, in the middle of its path"
        hint = "name the drum first or last, or write a pulley"
        fields.error("drum-between", path, text, hint)
        return None
    errors = fields.error_count
    assert part.radius is not None
    radius = fields.number((*path, "radius"), part.radius, LENGTH)
    axis, swivel = _axis(fields, path, part, centre, axis, is_joint)
    if fields.error_count > errors:
        return None
    if (swivel is not None or part.free) and not between:
        text = f"the path ends at the swivelling pulley at {name}"
        hint = "lead the cable on to a point, a pulley or a drum on the line about which it swivels"
        fields.error("swivel-end", path, text, hint)
        return None
    if not radius > tolerances.SMALLEST_DIVISOR:
        text = f"the radius of a pulley is {part.radius}"
        fields.error("no-wheel", (*path, "radius"), text, limit="more than 0")
        return None
    side = -1.0 if part.side == "right" else 1.0
    return Place(centre, radius, side, part.drum is not None, axis, swivel, part.free)


def _axis(
    fields: Fields, path: Path, part: PathPart, centre: Attached, axis: Vector, is_joint: bool
) -> tuple[Vector, Swivel | None]:
    """The axis of a pulley, and how it swivels; what is wrong is noted."""
    for key, given in (
        ("axis", part.axis),
        ("swivel", part.swivel),
        ("free", part.free or None),
    ):
        if given is not None and fields.plane:
            text = "in a plane pulleys turn about z"
            fields.error("pulley-axis", (*path, key), text, f"leave out {key}")
        elif given is not None and is_joint:
            text = f"{part.pulley or part.drum} is a joint, which has the axis of the pulley"
            hint = f"leave out {key}, or name a point instead of the joint"
            fields.error("pulley-axis", (*path, key), text, hint)
    if part.swivel is not None:
        return axis, Swivel(centre, fields.direction((*path, "swivel"), part.swivel))
    if part.axis is not None:
        return fields.direction((*path, "axis"), part.axis), None
    if not (fields.plane or is_joint or part.free):
        text = f"the pulley at the point {part.pulley} has no axis"
        hint = (
            "add axis: [0, 1, 0], name an R joint instead of the point, or let it swivel about a "
            "line through the point: swivel: [0, 0, 1]"
        )
        fields.error("pulley-axis", path, text, hint)
    return axis, None


def _turned(fields: Fields, path: Path, places: list[Place]) -> bool:
    """Turns swivelling pulleys to where their cable leads as drawn, and tells whether all stretches
    lie in the planes of their pulleys; what is wrong is noted."""
    for i, (one, other) in enumerate(pairwise(places)):
        if one.swivel is not None and other.swivel is not None:
            text = "the cable runs from one swivelling pulley to another"
            fields.error("two-swivels", (*path, i + 1), text, "lead it through a point between")
            return False
    for i, place in enumerate(places):
        if place.swivel is not None or place.is_free:
            turned = _hung if place.is_free else _swivelled
            found = turned(fields, (*path, i), place, places[i - 1], places[i + 1])
            if found is None:
                return False
            places[i] = found
    for i, (before, after) in enumerate(pairwise(places)):
        one, other = before.facing(1), after.facing(-1)
        apart = subtract(other.centre.vector, one.centre.vector)
        distance = norm(apart)
        for place in (one, other):
            if place.is_round and abs(dot(apart, place.axis)) > tolerances.FLEET * distance:
                _note_fleet(fields, (*path, i + 1), abs(dot(apart, place.axis)) / distance)
                return False
        if one.is_round and other.is_round:
            tilt = norm(cross(one.axis, other.axis))
            if tilt > tolerances.FLEET:
                _note_fleet(fields, (*path, i + 1), tilt)
                return False
    return True


def _note_fleet(fields: Fields, path: Path, sine: float) -> None:
    fields.error(
        "fleet-angle",
        path,
        "the stretch of the cable from the place before to this one leaves the plane of a pulley",
        "draw both places in that plane, or let the pulley swivel: swivel: [0, 0, 1]",
        measured=f"fleet angle {_angle(fields, sine)}",
        limit=fields.units.text(tolerances.FLEET, ANGLE),
    )


def _angle(fields: Fields, sine: float) -> str:
    angle = of_two("ATAN2", sine, square_root(abs(1.0 - sine * sine)))
    return fields.units.text(float(angle), ANGLE)


def _swivelled(
    fields: Fields, path: Path, place: Place, before: Place, after: Place
) -> Place | None:
    """A swivelling pulley with centre and axis as drawn; None where errors are noted."""
    swivel = place.swivel
    assert swivel is not None
    entry = Place(swivel.entry)
    # as passed towards the pulley
    ways = before, after.reversed
    off = [_off_line(each, entry, swivel.along) for each in ways]
    way = next((w for w, sine in zip((1, -1), off, strict=True) if sine <= tolerances.FLEET), 0)
    if way == 0:
        fields.error(
            "swivel-line",
            path,
            "the cable neither comes nor leaves along the line about which this pulley swivels",
            "draw the place before it or after it on the line; a pulley or drum so that it touches "
            "the line",
            measured=f"angle to the line {_angle(fields, min(off))}",
            limit=fields.units.text(tolerances.FLEET, ANGLE),
        )
        return None
    line, end = ways if way > 0 else ways[::-1]
    if end.is_round:
        text = "this pulley swivels to another pulley"
        hint = "let it swivel to a point, or give axis instead of swivel"
        fields.error("two-swivels", path, text, hint)
        return None
    along = stretch(line, entry)[1]
    apart = subtract(end.centre.vector, swivel.entry.vector)
    out = subtract(apart, scale(dot(apart, swivel.along), swivel.along))
    if not norm(out) > tolerances.FLEET * norm(apart):
        text = "both ends of the cable lie on the line about which this pulley swivels"
        hint = "draw the place to which it swivels beside the line"
        fields.error("swivel-line", path, text, hint)
        return None
    out = unit(out)
    centre = Attached(swivel.entry.link, add(swivel.entry.vector, scale(place.radius, out)))
    # seen from the line on, the cable passes it on the left
    along = scale(1.0 if dot(along, swivel.along) > 0.0 else -1.0, swivel.along)
    axis = cross(out, along)
    return place._replace(
        centre=centre, axis=axis, side=float(way), swivel=Swivel(swivel.entry, along, way)
    )


def _hung(fields: Fields, path: Path, place: Place, before: Place, after: Place) -> Place | None:
    """A free pulley with its axis as drawn; None where errors are noted."""
    if before.is_round or after.is_round:
        text = "the cable comes to this free pulley from another pulley, or leaves to one"
        hint = "lead it through a point between, or give axis instead of free"
        fields.error("two-swivels", path, text, hint)
        return None
    centre = place.centre.vector
    one, other = (subtract(each.centre.vector, centre) for each in (before, after))
    # with both places in front, the cable passes it on the left
    normal = cross(one, other)
    if not norm(normal) > tolerances.FLEET * norm(one) * norm(other):
        text = "the centre of this free pulley lies in line with the places before and after it"
        fields.error("swivel-line", path, text, "draw it beside that line")
        return None
    return place._replace(axis=unit(normal), side=1.0)


def _off_line(place: Place, entry: Place, along: Vector) -> float:
    """Sine of the angle between a line and a stretch to a point of it."""
    apart = subtract(entry.centre.vector, place.centre.vector)
    axial = dot(apart, place.axis)
    square = dot(apart, apart) - (axial * axial if place.is_round else 0.0)
    if not square > place.radius * place.radius:
        return 1.0
    return norm(cross(stretch(place, entry)[1], along))


def _are_apart(fields: Fields, path: Path, places: Sequence[Place]) -> bool:
    """Whether the stretches of a cable can be drawn; what is wrong is noted."""
    for i, (before, after) in enumerate(pairwise(places)):
        one, other = before.facing(1), after.facing(-1)
        distance = norm(subtract(other.centre.vector, one.centre.vector))
        _, near, far = _beside(one, other)
        beside = abs(near - far)
        if not distance > beside * (1.0 + tolerances.PARALLEL):
            measured, limit = (fields.units.text(float(x), LENGTH) for x in (distance, beside))
            fields.error(
                "no-stretch",
                (*path, i + 1),
                "there is no straight stretch of the cable from the place before to this one",
                "draw them apart, or lead the cable over the other side of a pulley",
                measured=f"{measured} apart",
                limit=f"more than {limit}",
            )
            return False
    return True
