"""Cables over points, pulleys and drums to massless telescopes, and to the sum of their lengths.

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

In space a telescope turns about the axis of its pulley alone, and what its other end does beside
that plane is left free and measured: a slide along the axis, and the tilt of another pulley's axis.
These are zero as long as the cable runs in the grooves. A swivelling pulley hangs on a fork that
turns about its line, so that its telescope reaches any point. On a free one the telescopes on both
sides hang, one by a ball about its centre, the other on the first, turning about its axis.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import pi

from mechkin_cli import tolerances
from mechkin_cli.building.cable_places import Place, arc, read_places, stretch
from mechkin_cli.building.fields import Fields
from mechkin_cli.building.joints import Halves, parts_of
from mechkin_cli.mechanism import (
    GROUND,
    Arm,
    Attached,
    Extent,
    Fleet,
    Frame,
    Joint,
    Mechanism,
    Relation,
    RigidLink,
    Swing,
    Tension,
    Term,
    Vector,
    add,
    counted,
    cross,
    dot,
    frame_about,
    joint_type,
    perpendicular,
    scale,
    subtract,
    unit,
    upright,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import AnyCoupling, CableCoupling

_Built = tuple[dict[str, RigidLink], dict[str, Joint], dict[str, Relation]]
"""Links and joints of telescopes, and relations, by name."""


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
        path = ("couplings", name, "path")
        places = read_places(fields, path, section.path, joints, points)
        if places is None:
            continue
        keys = [
            f"{part.point or part.pulley or part.drum} {part.radius} {part.side}"
            for part in section.path
        ]
        cable = _Cable(name, keys, places, fields.plane)
        if cable.relation is None:
            text = "both ends of every stretch of this cable are on one link"
            fields.error("cable-at-rest", path, text, "lead it over links that move")
            continue
        links |= cable.links
        added |= cable.joints
        relations[name] = cable.relation
    return links, added, relations


class DrawnCable(NamedTuple):
    """A cable as pages and pictures draw it: the points and centres that it passes, as drawn on
    their links, how far it runs to the left of each (m), seen along its way, and the axes of its
    pulleys. One that swivels has its place and axis on the line about which it does, along the
    cable as it runs onto the pulley; `swivels` is 1 where it comes along that line, -1 where it
    leaves along it, 2 of a free pulley, else 0."""

    places: tuple[Attached, ...]
    beside: tuple[float, ...]
    axes: tuple[Vector, ...]
    swivels: tuple[int, ...]


def drawn_cables(
    fields: Fields, couplings: Mapping[str, AnyCoupling], mechanism: Mechanism
) -> tuple[DrawnCable, ...]:
    """The cables of a file without errors."""
    found = []
    for name, section in couplings.items():
        if isinstance(section, CableCoupling):
            path = ("couplings", name, "path")
            places = read_places(fields, path, section.path, mechanism.joints, mechanism.points)
            found.append(DrawnCable(*zip(*map(_drawn, places or ()), strict=True)))
    return tuple(found)


def _drawn(place: Place) -> tuple[Attached, float, Vector, int]:
    """What a drawn cable knows of a place."""
    if place.swivel is None:
        return place.centre, float(place.beside), place.axis, 2 if place.is_free else 0
    return place.swivel.entry, float(place.beside), place.swivel.along, place.swivel.way


class _Cable:
    """The telescopes of a cable along its places, and its relation.

    In a plane they hang on each other along the way: what leaves a pulley is hinged to what comes
    to it, about the centre, so that one turn is the bend there. In space each hangs on the links at
    its ends.
    """

    def __init__(
        self, name: str, keys: Sequence[str], places: Sequence[Place], plane: bool
    ) -> None:
        self.name, self.places, self.plane = name, places, plane
        self.names = [key.partition(" ")[0] for key in keys]
        self.links: dict[str, RigidLink] = {}
        self.joints: dict[str, Joint] = {}
        self.slides: list[Term] = []
        self.wound: list[list[Term]] = [[] for _ in places]
        self.extents: list[Extent | Swing] = []
        self.fleets: list[Fleet] = []
        self.moves = [one.centre.link != other.centre.link for one, other in pairwise(places)]
        # between points there and back is one way
        ways = [frozenset(way) for way in pairwise(keys)]
        counts = Counter(ways)
        behind = None
        for i, way in enumerate(ways):
            is_straight = not (places[i].is_round or places[i + 1].is_round)
            count = float(counts[way]) if is_straight else 1.0
            if any(place.is_free for place in places[i : i + 2]):
                if places[i].is_free and any(self.moves[i - 1 : i + 1]):
                    self._add_free(i)
            elif not self.moves[i] or (is_straight and way in ways[:i]):
                behind = None
            elif plane:
                behind = self._add(i, count, behind)
            else:
                self._add_in_space(i, count)
        for i, place in list(enumerate(places))[1:-1]:
            if place.is_round:
                self._add_arc(i)

    @property
    def relation(self) -> Relation | None:
        """None of a cable that nothing moves."""
        terms = (*self.slides, *(term for each in self.wound for term in each))
        if not terms:
            return None
        # the multiplier pushes the slides out
        tension = (("tension", Tension(-1.0, 0.0, 0.0)),)
        extents, fleets = tuple(self.extents), tuple(self.fleets)
        return Relation(terms, length=True, tensions=tension, extents=extents, fleets=fleets)

    def _add(self, i: int, count: float, behind: str | None) -> str | None:
        """The telescope of stretch `i`, whose slide counts as often as `count`; `behind`: the link
        that comes to its first place. The link that comes to its last one, if that is a pulley."""
        one, other = self.places[i], self.places[i + 1]
        name = f"{self.name}.{i + 1}"
        length, along = stretch(one, other)
        start, finish = (_upright(place.centre.vector) for place in (one, other))
        near = f"{name} near"
        turn = self._joint(f"{name} turn", "R", behind or one.centre.link, near, start)
        if one.is_round:
            self._wind(i, turn, -one.beside)
        far = self._slide(i, near, one, length, along, count)
        if not other.is_round or any(self.moves[i + 1 : i + 2]):
            self._joint(f"{name} end", "R", far, other.centre.link, finish)
            return far if other.is_round else None
        # no stretch goes on whose bend would tell what is wound here
        hub = f"{name} hub"
        turn = self._joint(f"{name} back", "R", other.centre.link, hub, finish)
        self._wind(i + 1, turn, other.beside)
        self._joint(f"{name} end", "W", far, hub, GROUND)
        return None

    def _add_in_space(self, i: int, count: float) -> None:
        """As `_add`, from a pulley to a point where it leads to one, and from the line of a
        swivelling pulley."""
        one, other = self.places[i].facing(1), self.places[i + 1].facing(-1)
        name, at = f"{self.name}.{i + 1}", i + 1
        if (other.is_round and not one.is_round and one.swivel is None) or (
            other.swivel is not None and not other.is_round
        ):
            one, other, at = other.reversed, one.reversed, i
        length, along = stretch(one, other)
        finish = upright(other.centre.vector)
        link, near = one.centre.link, f"{name} near"
        if not (one.is_round or other.is_round or one.swivel is not None):
            self._joint(f"{name} turn", "S", link, near, upright(one.centre.vector))
            far = self._slide(i, near, one, length, along, count)
            self._joint(f"{name} end", "S", far, other.centre.link, finish)
            return
        if one.is_round:
            if one.swivel is not None:
                fork = f"{name} fork"
                line = _about(one.swivel.along, one.swivel.entry.vector)
                self._joint(f"{name} swivel", "R", link, fork, line)
                link = fork
            turn = self._joint(f"{name} turn", "R", link, near, _about(one.axis, one.centre.vector))
            self._wind(2 * i + 1 - at, turn, -one.beside)
        else:
            near = link
        far = self._slide(i, near, one, length, along, count)
        if one.swivel is not None and one.is_round:
            self._joint(f"{name} end", "S", far, other.centre.link, finish)
            self._swing(i, one, other, along)
            return
        words = "leaves the plane of a pulley"
        rounds = [place.axis for place in (one, other) if place.is_round]
        across = (*rounds, perpendicular(along))[0]
        if not one.is_round:
            words = "leaves the line of a swivelling pulley"
            far = self._stray(name, "beside", far, cross(across, along), finish, words, length)
        if not other.is_round:
            far = self._stray(name, "off", far, across, finish, words, length)
            self._joint(f"{name} end", "S", far, other.centre.link, finish)
            return
        hub, link = f"{name} hub", other.centre.link
        link = self._stray(name, "tilt", link, along, finish, words)
        link = self._stray(name, "lean", link, cross(across, along), finish, words)
        link = self._stray(name, "off", link, across, finish, words, length)
        back = self._joint(f"{name} back", "R", link, hub, _about(other.axis, other.centre.vector))
        self._wind(at, back, other.beside)
        self._joint(f"{name} end", "W", far, hub, GROUND)

    def _add_free(self, i: int) -> None:
        """The telescopes from a free pulley to the points before and after it: the first turns
        about the centre as a ball does, the second against it in its plane."""
        place = self.places[i]
        at = place.centre.vector
        link, arms = place.centre.link, []
        for k, mount, end in ((i, place.reversed, i - 1), (i + 1, place, i + 1)):
            name, near, other = f"{self.name}.{k}", f"{self.name}.{k} near", self.places[end]
            is_first = end < i
            frame = upright(at) if is_first else _about(place.axis, at)
            turn = self._joint(f"{name} turn", "S" if is_first else "R", link, near, frame)
            if not is_first:
                self._wind(i, turn, -place.beside)
            length, along = stretch(mount, other)
            far = self._slide(k - 1, near, mount, length, along, 1.0)
            self._joint(f"{name} end", "S", far, other.centre.link, upright(other.centre.vector))
            arms.append((subtract(other.centre.vector, at), along))
            link = near
        out = unit(arms[0][0])
        beside = cross(place.axis, out)
        (first, by_first), (second, by_second) = (
            ((dot(arm, out), dot(arm, beside)), (dot(along, out), dot(along, beside)))
            for arm, along in arms
        )
        slides = [Term(self.joints[f"{self.name}.{k} slide"], "s", 1.0) for k in (i, i + 1)]
        turned = Term(self.joints[f"{self.name}.{i + 1} turn"], "theta", 1.0)
        words = "has behind a free pulley a point to which it leads"
        ends = Arm(first, by_first, slides[0]), Arm(second, by_second, slides[1])
        self.extents.append(Swing(words, f"at {self.names[i]}", second[1], 0.0, *ends, turned))

    def _slide(
        self, i: int, near: str, one: Place, length: float, along: Vector, count: float
    ) -> str:
        """The slide of the telescope of stretch `i` on its part at the first place, and the part
        that slides."""
        name = f"{self.name}.{i + 1}"
        far = f"{name} far"
        start = one.centre.vector
        if one.is_round:
            start = add(start, scale(one.beside, cross(one.axis, along)))
        axis = frame_about(along, perpendicular(along), start)
        slide = self._joint(f"{name} slide", "P", near, far, axis, is_counted=True)
        self.slides.append(Term(slide, "s", count))
        words, terms = "has no straight stretch", (Term(slide, "s", 1.0),)
        self.extents.append(Extent(words, self._between(i), length, terms))
        return far

    def _between(self, i: int) -> str:
        """Where stretch `i` is."""
        return f"between {self.names[i]} and {self.names[i + 1]}"

    def _swing(self, i: int, one: Place, other: Place, along: Vector) -> None:
        """How far the point to which a pulley swivels by stretch `i` is from its line."""
        assert one.swivel is not None
        out = scale(1.0 / one.radius, subtract(one.centre.vector, one.swivel.entry.vector))
        beside = cross(one.axis, out)
        apart = subtract(other.centre.vector, one.centre.vector)
        slide, turn = (self.joints[f"{self.name}.{i + 1} {word}"] for word in ("slide", "turn"))
        words = "has behind its line the point to which a pulley swivels"
        arm, way = ((dot(each, out), dot(each, beside)) for each in (apart, along))
        end = Arm(arm, way, Term(slide, "s", 1.0))
        # against its line, run down
        line = Arm((0.0, -1.0), (0.0, 0.0), None)
        turned = Term(turn, "theta", 1.0)
        drawn = one.radius + arm[0]
        self.extents.append(Swing(words, self._between(i), drawn, one.radius, line, end, turned))

    def _stray(
        self,
        name: str,
        word: str,
        link: str,
        along: Vector,
        at: Frame,
        words: str,
        length: float | None = None,
    ) -> str:
        """A part on a link that gives way where the cable leaves its groove: along a direction at
        the end of a stretch of a `length` (m), or about it."""
        own = f"{name} {word}ward"
        letter, coordinate = ("R", "theta") if length is None else ("P", "s")
        joint = self._joint(
            f"{name} {word}", letter, link, own, _about(along, at.o), is_counted=True
        )
        self.fleets.append(Fleet(words, Term(joint, coordinate, 1.0), length))
        return own

    def _add_arc(self, i: int) -> None:
        """The arc on the pulley at place `i`."""
        place = self.places[i]
        angle = arc(*self.places[i - 1 : i + 2])
        if angle < -tolerances.PARALLEL:
            angle = angle + 2.0 * pi
        whole = 2.0 * pi * place.radius
        length, where = place.radius * angle, f"at {self.names[i]}"
        self.extents.append(Extent("leaves the pulley", where, length, tuple(self.wound[i]), whole))

    def _wind(self, i: int, turn: Joint, radius: float) -> None:
        """Counts what a turn winds on the pulley at place `i`."""
        self.joints[turn.name] = turn = counted(turn)
        self.wound[i].append(Term(turn, "theta", radius))

    def _joint(
        self,
        name: str,
        letter: str,
        first: str,
        second: str,
        frame: Frame,
        *,
        is_counted: bool = False,
    ) -> Joint:
        """A joint, and those of its links that are parts of the cable."""
        for link in (first, second):
            if link.startswith(f"{self.name}."):
                self.links.setdefault(link, RigidLink(link))
        kind = joint_type(letter, self.plane)
        parts = parts_of(kind, Halves(frame, frame, (frame, frame)))
        joint = Joint(name, kind.letter, first, second, frame, frame, parts, plane=self.plane)
        joint = counted(joint) if is_counted else joint
        self.joints[name] = joint
        return joint


def _upright(at: Vector) -> Frame:
    return frame_about(GROUND.z, GROUND.x, at)


def _about(axis: Vector, at: Vector) -> Frame:
    return frame_about(axis, perpendicular(axis), at)
