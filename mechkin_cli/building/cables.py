"""Cables over points and pulleys to massless telescopes, and to the sum that their length is.

Every straight stretch of a cable is a telescope from where it leaves one place to where it meets
the next, hinged at both. At a pulley of radius r it is hinged at the centre and runs beside it at
r, so that it touches the pulley wherever that stands. With s the slide of a telescope, and theta
its turns against the links of the pulleys at its ends, the cable keeps

    sum s + sum (+-r theta) = 0,

the second sum being what is wound on pulleys, so that this is a relation between coordinates like a
gear's. In the slides its multiplier is the pull of the cable, which the telescopes hand on to both
ends along their line, and the moment r times that about the centres of pulleys, as if the pulley
turned freely. Where a cable runs several times between two points, one telescope counts as often.

At a drum the cable ends on its rim, which turns with the drum's link: the turn is that against it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import pi

from mechkin_cli import tolerances
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.joints import Halves, parts_of
from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.mechanism import (
    GROUND,
    Attached,
    Extent,
    Frame,
    Joint,
    Mechanism,
    Relation,
    RigidLink,
    Tension,
    Term,
    Vector,
    add,
    counted,
    cross,
    dot,
    frame_about,
    joint_type,
    norm,
    perpendicular,
    scale,
    subtract,
    upright,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import AnyCoupling, CableCoupling, PathPart
from mechkin_cli.tape import of_two, square_root
from mechkin_cli.units import LENGTH

_Built = tuple[dict[str, RigidLink], dict[str, Joint], dict[str, Relation]]
"""Links and joints of telescopes, and relations, by name."""


class _Place(NamedTuple):
    """A place that a cable passes: a point of a link, about which it runs at a radius (m), on its
    left (1) or right (-1) seen along the way; 0: through it. `is_drum`: it ends there."""

    centre: Attached
    radius: float = 0.0
    side: float = 0.0
    is_drum: bool = False

    @property
    def is_round(self) -> bool:
        """Whether the cable runs about it."""
        return self.side != 0.0

    @property
    def beside(self) -> float:
        """How far the cable runs to the left of the centre (m)."""
        return self.side * self.radius


def build_cables(
    fields: Fields,
    couplings: Mapping[str, AnyCoupling],
    joints: Mapping[str, Joint],
    points: Mapping[str, Attached],
) -> _Built:
    """The cables of a file; errors are noted in `fields`."""
    links: dict[str, RigidLink] = {}
    added: dict[str, Joint] = {}
    relations: dict[str, Relation] = {}
    for name, section in couplings.items():
        if not isinstance(section, CableCoupling):
            continue
        path = ("couplings", name)
        errors = fields.error_count
        places = [
            _place(fields, (*path, "path", i), part, joints, points)
            for i, part in enumerate(section.path)
        ]
        found = [place for place in places if place is not None]
        if fields.error_count > errors or not _fits(fields, path, section, found):
            continue
        keys = [
            f"{part.point or part.pulley or part.drum} {part.radius} {part.side}"
            for part in section.path
        ]
        cable = _Cable(name, keys, found, fields.plane)
        if cable.relation is None:
            text = "both ends of every stretch of this cable are on one link"
            fields.error("cable-at-rest", (*path, "path"), text, "lead it over links that move")
            continue
        links |= cable.links
        added |= cable.joints
        relations[name] = cable.relation
    return links, added, relations


class DrawnCable(NamedTuple):
    """A cable as pages and pictures draw it: the points and centres that it passes, as drawn on
    their links, and how far it runs to the left of each (m), seen along its way."""

    places: tuple[Attached, ...]
    beside: tuple[float, ...]


def drawn_cables(
    fields: Fields, couplings: Mapping[str, AnyCoupling], mechanism: Mechanism
) -> tuple[DrawnCable, ...]:
    """The cables of a file without errors."""
    found = []
    for name, section in couplings.items():
        if isinstance(section, CableCoupling):
            places = [
                _place(
                    fields, ("couplings", name, "path", i), part, mechanism.joints, mechanism.points
                )
                for i, part in enumerate(section.path)
            ]
            known = [place for place in places if place is not None]
            centres = tuple(place.centre for place in known)
            found.append(DrawnCable(centres, tuple(float(place.beside) for place in known)))
    return tuple(found)


def _place(
    fields: Fields,
    path: Path,
    part: PathPart,
    joints: Mapping[str, Joint],
    points: Mapping[str, Attached],
) -> _Place | None:
    """A place of a path; None where errors are noted."""
    if part.point is not None:
        if part.point in points:
            return _Place(points[part.point])
        if not fields.is_refused(part.point):
            hint = nearest_hint(part.point, list(points)) or "name it under points"
            fields.error("unknown-point", path, f"there is no point {part.point}", hint)
        return None
    key = "pulley" if part.drum is None else "drum"
    name = part.pulley if part.drum is None else part.drum
    assert name is not None
    if name not in joints:
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
        centre = Attached(joints[name].second, joints[name].on_second.o)
    errors = fields.error_count
    assert part.radius is not None
    radius = fields.number((*path, "radius"), part.radius, LENGTH)
    if fields.error_count > errors:
        return None
    if not radius > tolerances.SMALLEST_DIVISOR:
        text = f"the radius of a pulley is {part.radius}"
        fields.error("no-wheel", (*path, "radius"), text, limit="more than 0")
        return None
    side = 1.0 if part.side == "left" else -1.0
    return _Place(centre, radius, side, part.drum is not None)


def _fits(fields: Fields, path: Path, section: CableCoupling, places: Sequence[_Place]) -> bool:
    """Whether the stretches of a cable can be drawn; what is wrong is noted."""
    for i, (place, part) in enumerate(zip(places, section.path, strict=True)):
        if place.is_round and not fields.plane:
            text = "a cable runs over pulleys in files of a plane alone"
            hint = "lead it through points, or write the mechanism in its plane (plane: xy)"
            fields.error("spatial-pulley", (*path, "path", i), text, hint)
            return False
        if place.is_drum and 0 < i < len(places) - 1:
            text = f"the cable ends on the drum at {part.drum}, in the middle of its path"
            hint = "name the drum first or last, or write a pulley"
            fields.error("drum-between", (*path, "path", i), text, hint)
            return False
    for i, (one, other) in enumerate(pairwise(places)):
        distance = norm(subtract(other.centre.vector, one.centre.vector))
        beside = abs(one.beside - other.beside)
        if not distance > beside * (1.0 + tolerances.PARALLEL):
            measured, limit = (fields.units.text(float(x), LENGTH) for x in (distance, beside))
            fields.error(
                "no-stretch",
                (*path, "path", i + 1),
                "there is no straight stretch of the cable from the place before to this one",
                "draw them apart, or lead the cable over the other side of a pulley",
                measured=f"{measured} apart",
                limit=f"more than {limit}",
            )
            return False
    return True


class _Cable:
    """The telescopes of a cable along its places, and its relation.

    They hang on each other along the way: what leaves a pulley is hinged to what comes to it, about
    the centre, so that one turn is the bend there.
    """

    def __init__(
        self, name: str, keys: Sequence[str], places: Sequence[_Place], plane: bool
    ) -> None:
        self.name, self.places, self.plane = name, places, plane
        self.names = [key.partition(" ")[0] for key in keys]
        self.links: dict[str, RigidLink] = {}
        self.joints: dict[str, Joint] = {}
        self.slides: list[Term] = []
        self.wound: list[list[Term]] = [[] for _ in places]
        self.extents: list[Extent] = []
        self.moves = [one.centre.link != other.centre.link for one, other in pairwise(places)]
        # between points there and back is one way
        ways = [frozenset(way) for way in pairwise(keys)]
        counts = Counter(ways)
        behind = None
        for i, way in enumerate(ways):
            is_straight = not (places[i].is_round or places[i + 1].is_round)
            if not self.moves[i] or (is_straight and way in ways[:i]):
                behind = None
            else:
                behind = self._add(i, float(counts[way]) if is_straight else 1.0, behind)
        for i, place in list(enumerate(places))[1:-1]:
            if place.is_round:
                self._add_arc(i)

    @property
    def relation(self) -> Relation | None:
        """None of a cable that nothing moves."""
        terms = (*self.slides, *(term for each in self.wound for term in each))
        # the multiplier pushes the slides out
        tension = (("tension", Tension(-1.0, 0.0, 0.0)),)
        extents = tuple(self.extents)
        return Relation(terms, length=True, tensions=tension, extents=extents) if terms else None

    def _add(self, i: int, count: float, behind: str | None) -> str | None:
        """The telescope of stretch `i`, whose slide counts as often as `count`; `behind`: the link
        that comes to its first place. The link that comes to its last one, if that is a pulley."""
        one, other = self.places[i], self.places[i + 1]
        name = f"{self.name}.{i + 1}"
        near, far = f"{name} near", f"{name} far"
        self.links |= {link: RigidLink(link) for link in (near, far)}
        length, along = _stretch(one, other)
        hinge = "R" if self.plane else "S"
        start, finish = (self._upright(place.centre.vector) for place in (one, other))
        turn = self._joint(f"{name} turn", hinge, behind or one.centre.link, near, start)
        if one.is_round:
            self._wind(i, turn, -one.beside)
        from_start = add(one.centre.vector, scale(one.beside, cross(GROUND.z, along)))
        axis = frame_about(along, perpendicular(along), from_start)
        slide = counted(self._joint(f"{name} slide", "P", near, far, axis))
        self.joints[slide.name] = slide
        self.slides.append(Term(slide, "s", count))
        words, place = "has no straight stretch", f"between {self.names[i]} and {self.names[i + 1]}"
        self.extents.append(Extent(words, place, length, (Term(slide, "s", 1.0),)))
        if not other.is_round or any(self.moves[i + 1 : i + 2]):
            self._joint(f"{name} end", hinge, far, other.centre.link, finish)
            return far if other.is_round else None
        # no stretch goes on whose bend would tell what is wound here
        hub = f"{name} hub"
        self.links[hub] = RigidLink(hub)
        self._wind(
            i + 1, self._joint(f"{name} back", "R", other.centre.link, hub, finish), other.beside
        )
        self._joint(f"{name} end", "W", far, hub, GROUND)
        return None

    def _add_arc(self, i: int) -> None:
        """The arc on the pulley at place `i`."""
        before, place, after = self.places[i - 1 : i + 2]
        one, other = _stretch(before, place)[1], _stretch(place, after)[1]
        turned = of_two("ATAN2", dot(cross(one, other), GROUND.z), dot(one, other))
        angle = -place.side * turned
        if angle < -tolerances.PARALLEL:
            angle = angle + 2.0 * pi
        whole = 2.0 * pi * place.radius
        length, where = place.radius * angle, f"at {self.names[i]}"
        self.extents.append(Extent("leaves the pulley", where, length, tuple(self.wound[i]), whole))

    def _wind(self, i: int, turn: Joint, radius: float) -> None:
        """Counts what a turn winds on the pulley at place `i`."""
        self.joints[turn.name] = turn = counted(turn)
        self.wound[i].append(Term(turn, "theta", radius))

    def _upright(self, at: Vector) -> Frame:
        return frame_about(GROUND.z, GROUND.x, at) if self.plane else upright(at)

    def _joint(self, name: str, letter: str, first: str, second: str, frame: Frame) -> Joint:
        kind = joint_type(letter, self.plane)
        parts = parts_of(kind, Halves(frame, frame, (frame, frame)))
        joint = Joint(name, kind.letter, first, second, frame, frame, parts, plane=self.plane)
        self.joints[name] = joint
        return joint


def _stretch(one: _Place, other: _Place) -> tuple[float, Vector]:
    """Length of the straight stretch between two places (m), and its direction."""
    apart = subtract(other.centre.vector, one.centre.vector)
    # apart = length * along + beside * (to the left of that)
    beside = one.beside - other.beside
    square = dot(apart, apart)
    length = square_root(square - beside * beside)
    across = scale(-beside / square, cross(GROUND.z, apart))
    return length, add(scale(length / square, apart), across)
