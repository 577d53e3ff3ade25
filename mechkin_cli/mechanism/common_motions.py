"""Motions that all joints around some links allow, so that nothing but these links moves.

Screws (angular, linear at the origin of the drawing; lengths in parts of a size) are taken on the
links' own drawing at general coordinates of the joints: what is common there is common everywhere,
and no accident of the drawing. Two such places are compared, so that a line that the links carry
with them is told from one that only happens to be there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from mechkin_cli import tolerances
from mechkin_cli.mechanism.elementary import Part, Screw
from mechkin_cli.mechanism.frames import GROUND, Frame
from mechkin_cli.mechanism.model import Joint
from mechkin_cli.mechanism.vectors import ZERO, Vector, add, cross, norm, scale, subtract

Freedom = tuple[str, int]
"""A joint's name and the number of its freedom."""

PLACES = 2
"""General places at which motions are compared."""

DRAWN = -1
"""The drawing, as a place: links have at least the common motions there that they have anywhere."""

_TURNS = ((0.6, 0.8), (5 / 13, 12 / 13), (15 / 17, -8 / 17), (7 / 25, 24 / 25), (-20 / 29, 21 / 29))
"""Cosine and sine of the angles of general places: Pythagorean, so that no function is needed."""

_SLIDES = (0.37, -0.23, 0.51, 0.29, -0.43)
"""Slides of general places in parts of the size."""

_BALLS = ((1.0, 2.0, 3.0, 4.0), (4.0, 1.0, -2.0, 3.0), (2.0, -3.0, 1.0, 4.0))
"""Directions of the quaternions of general places."""


class Displacement(NamedTuple):
    """A rigid displacement: axes and origin of a frame that stood along the ground's axes."""

    x: Vector
    y: Vector
    z: Vector
    o: Vector

    def vector(self, a: Vector) -> Vector:
        """A direction, displaced."""
        return add(add(scale(a[0], self.x), scale(a[1], self.y)), scale(a[2], self.z))

    def after(self, first: Displacement) -> Displacement:
        """`first`, then this."""
        x, y, z = (self.vector(axis) for axis in (first.x, first.y, first.z))
        return Displacement(x, y, z, add(self.vector(first.o), self.o))

    def reversed(self) -> Displacement:
        """The displacement back."""
        frame = Frame(self.x, self.y, self.z, ZERO)
        x, y, z = (frame.components(axis) for axis in (GROUND.x, GROUND.y, GROUND.z))
        return Displacement(x, y, z, scale(-1.0, frame.components(self.o)))

    def screw(self, screw: Screw) -> Screw:
        """A screw, displaced."""
        angular = self.vector(screw[0])
        return angular, add(self.vector(screw[1]), cross(self.o, angular))


STILL = Displacement(*GROUND)


class Motion(NamedTuple):
    """A motion of some links at one place: the rates of the freedoms that move, the twist of each
    link on its own drawing, and by what twist the joints miss to have it in common."""

    rates: Mapping[Freedom, float]
    twists: Mapping[str, Screw]
    miss: float = 0.0

    @property
    def fastest(self) -> float:
        """The largest rate."""
        return max((abs(rate) for rate in self.rates.values()), default=0.0)

    def less(self, factor: float, other: Motion) -> Motion:
        """This, and another motion back by a factor."""
        rates = {
            known: self.rates.get(known, 0.0) - factor * other.rates.get(known, 0.0)
            for known in (*self.rates, *(each for each in other.rates if each not in self.rates))
        }
        twists = dict(self.twists)
        for link, (angular, linear) in other.twists.items():
            own = twists.get(link, (ZERO, ZERO))
            twists[link] = (
                subtract(own[0], scale(factor, angular)),
                subtract(own[1], scale(factor, linear)),
            )
        return Motion(rates, twists, self.miss + abs(factor) * other.miss)


def common_motions(
    links: Sequence[str],
    inner: Sequence[Joint],
    border: Sequence[Joint],
    still: Sequence[Freedom],
    general: General,
) -> list[Motion]:
    """Independent motions of a chain of links as one body that leave all others at rest.

    Args:
        links: in the order of the chain.
        inner: the joints between them, each leads from one to the next.
        border: the joints to other links.
        still: freedoms that shall not move.
        general: the place.
    """
    pose = {links[0]: STILL}
    for here, there, joint in zip(links, links[1:], inner, strict=False):
        pose[there] = pose[here].after(general.seen_from(joint, here)[0])
    columns: list[tuple[int, Freedom, tuple[float, ...]]] = []
    for number, joint in enumerate(border):
        link = joint.first if joint.first in pose else joint.second
        at = pose[link]
        outward = 1.0 if link == joint.second else -1.0  # rates are of the second link
        for own, screw in enumerate(general.seen_from(joint, link)[1]):
            seen = screw if at is STILL else at.screw(screw)
            entries = tuple(outward * entry for entry in (*seen[0], *seen[1]))
            columns.append((number, (joint.name, own), entries))
    # the twist by the first joint is that by each other
    rows = [
        [
            screw[i] if number == 0 else -screw[i] if number == k else 0.0
            for number, _, screw in columns
        ]
        for k in range(1, len(border))
        for i in range(6)
    ]
    for freedom in still:
        rows.append([1.0 if known == freedom else 0.0 for _, known, _ in columns])
    found = []
    for motion in _null_space([row.copy() for row in rows], len(columns)):
        v = [0.0] * 6
        for rate, (number, _, entries) in zip(motion, columns, strict=True):
            if number == 0:
                v = [known + rate * entry for known, entry in zip(v, entries, strict=True)]
        twist: Screw = ((v[0], v[1], v[2]), (v[3], v[4], v[5]))
        rates = {freedom: rate for rate, (_, freedom, _) in zip(motion, columns, strict=True)}
        twists = {n: pose[n].reversed().screw(twist) for n in links}
        found.append(Motion(rates, twists, _miss(rows, motion)))
    return found


class General:
    """A general place of all joints, or the drawing; lengths in parts of `size` (m), from an
    `origin` (m) near the drawing: far from it lines would be lost in rounding."""

    def __init__(self, place: int, size: float, origin: Vector) -> None:
        self.size, self.origin = size, origin
        self._next = 7 * place
        self._drawn = place == DRAWN
        self._seen: dict[tuple[str, str], tuple[Displacement, list[Screw]]] = {}

    def seen_from(self, joint: Joint, link: str) -> tuple[Displacement, list[Screw]]:
        """The displacement from the drawing of the joint's other link to that of a link, and the
        joint's screws on the latter."""
        if (joint.name, link) not in self._seen:
            passed = STILL
            screws: list[Screw] = []
            pitch = joint.pitch / self.size
            for part in joint.parts:
                part = _scaled(part, self.size, self.origin)
                own = part.screws(pitch)
                screws += own if passed is STILL else [passed.screw(screw) for screw in own]
                passed = passed.after(self._moved(part, pitch))
            back = passed.reversed()
            self._seen[joint.name, joint.first] = passed, screws
            self._seen[joint.name, joint.second] = back, [back.screw(screw) for screw in screws]
        return self._seen[joint.name, link]

    def _moved(self, part: Part, pitch: float) -> Displacement:
        """A part at general coordinates: from the drawing after it to the drawing before it."""
        self._next += 1
        turn, slide = _TURNS[self._next % len(_TURNS)], _SLIDES[self._next % len(_SLIDES)]
        own = STILL
        if self._drawn:
            pass
        elif part.type.is_ball:
            own = _turned_by(_BALLS[self._next % len(_BALLS)])
        elif part.type.freedoms:
            motions = {freedom.motion for freedom in part.type.freedoms}
            cosine, sine = (1.0, 0.0) if motions == {"slide"} else turn
            along = slide if "slide" in motions else slide * pitch
            own = Displacement(
                (cosine, sine, 0.0), (-sine, cosine, 0.0), GROUND.z, (0.0, 0.0, along)
            )
        before, after = Displacement(*part.before), Displacement(*part.after)
        return before.after(own).after(after.reversed())


def _scaled(part: Part, size: float, origin: Vector) -> Part:
    before, after = (
        f._replace(o=scale(1.0 / size, subtract(f.o, origin))) for f in (part.before, part.after)
    )
    return part._replace(before=before, after=after)


def _turned_by(quaternion: tuple[float, float, float, float]) -> Displacement:
    w, x, y, z = quaternion
    square = w * w + x * x + y * y + z * z
    axis = (x, y, z)

    def turned(a: Vector) -> Vector:
        # (w^2 - v.v) a + 2 (v.a) v + 2 w v x a, over the square
        along = x * a[0] + y * a[1] + z * a[2]
        part = add(scale(2.0 * w * w - square, a), scale(2.0 * along, axis))
        return scale(1.0 / square, add(part, scale(2.0 * w, cross(axis, a))))

    return Displacement(turned(GROUND.x), turned(GROUND.y), turned(GROUND.z), ZERO)


def _null_space(rows: list[list[float]], count: int) -> list[list[float]]:
    """A basis of what some rows, of entries of the order of one, map to zero: by elimination with
    complete pivoting."""
    order: list[int] = []
    done = 0
    while done < len(rows):
        best, at, column = 0.0, -1, -1
        for i in range(done, len(rows)):
            for k in range(count):
                if abs(rows[i][k]) > best:
                    best, at, column = abs(rows[i][k]), i, k
        if best <= tolerances.COMMON_MOTION:
            break
        rows[done], rows[at] = rows[at], rows[done]
        pivot = rows[done]
        pivot[:] = [entry / pivot[column] for entry in pivot]
        for i, row in enumerate(rows):
            if i != done and row[column] != 0.0:
                factor = row[column]
                row[:] = [a - factor * b for a, b in zip(row, pivot, strict=True)]
        order.append(column)
        done += 1
    found = []
    for free in (k for k in range(count) if k not in order):
        motion = [0.0] * count
        motion[free] = 1.0
        for number, column in enumerate(order):
            motion[column] = -rows[number][free]
        found.append(motion)
    return found


def _miss(rows: list[list[float]], motion: list[float]) -> float:
    """The largest entry of what the rows map a motion to."""
    mapped = (sum(a * b for a, b in zip(row, motion, strict=True)) for row in rows)
    return max((abs(entry) for entry in mapped), default=0.0)


def same_line(one: Screw, other: Screw) -> bool:
    """Whether two screws, scaled alike, are the same or opposite."""
    a, b = (*one[0], *one[1]), (*other[0], *other[1])
    apart = max(abs(x - y) for x, y in zip(a, b, strict=True))
    mirrored = max(abs(x + y) for x, y in zip(a, b, strict=True))
    return min(apart, mirrored) <= tolerances.SAME_COMMON_MOTION


def scaled_screw(screw: Screw) -> Screw:
    """The screw with a unit angular part, or, of a slide, a unit linear part."""
    angular, linear = screw
    turn, slide = (max(abs(c) for c in part) for part in (angular, linear))
    part = angular if turn > tolerances.SAME_COMMON_MOTION * max(turn, slide) else linear
    factor = 1.0 / norm(part)
    flat = ZERO if part is linear else scale(factor, angular)
    return flat, scale(factor, linear)


def line_of(screw: Screw) -> tuple[Vector, Vector]:
    """Direction and nearest point of the line of a scaled screw that turns."""
    angular, linear = screw
    return angular, cross(angular, linear)


def advance_of(screw: Screw) -> Vector:
    """What a scaled screw slides along its line while it turns."""
    angular, linear = screw
    point = cross(angular, linear)
    return subtract(linear, cross(point, angular))
