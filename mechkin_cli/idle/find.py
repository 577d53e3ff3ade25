"""Motions that all joints around some links allow, so that nothing but these links moves.

Screws (angular, linear at the origin of the drawing; lengths in parts of a size) are taken on the
links' own drawing at general coordinates of the joints: what is common there is common everywhere,
and no accident of the drawing. Two such places are compared, so that a line that the links carry
with them is told from one that only happens to be there.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    ZERO,
    Frame,
    Joint,
    Mechanism,
    Part,
    Screw,
    Vector,
    add,
    cross,
    norm,
    scale,
    subtract,
)

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


class LinkMotion(NamedTuple):
    """A motion of some links at one place: the rates of the freedoms that move, the twist of each
    link on its own drawing, and by what twist the joints miss to have it in common."""

    rates: Mapping[Freedom, float]
    twists: Mapping[str, Screw]
    miss: float = 0.0

    @property
    def fastest(self) -> float:
        """The largest rate."""
        return max((abs(rate) for rate in self.rates.values()), default=0.0)

    def less(self, factor: float, other: LinkMotion) -> LinkMotion:
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
        return LinkMotion(rates, twists, self.miss + abs(factor) * other.miss)


def common_motions(
    links: Sequence[str],
    inner: Sequence[Joint],
    border: Sequence[Joint],
    still: Sequence[Freedom],
    general: General,
) -> list[LinkMotion]:
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
        found.append(LinkMotion(rates, twists, _miss(rows, motion)))
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


# The motions that some links may make, as one body, while all others stay at rest.
#
# Links with two joints and more, and chains of links with two joints each, are looked at one after
# the other, few links first. A group's motions are those that no smaller group has: in S-E-C with
# the axes in line the two links in between turn, each on its own, and that both turn together says
# nothing more. This is a matter of the rates of all joints at one place, so motions are kept at
# each general place, and reduced by those that were found before.

Coordinate = tuple[str, str]
"""A joint and its coordinate."""


class Moving(NamedTuple):
    """A motion as a group makes it (`own`), and less the motions that were found before
    (`beside`)."""

    own: LinkMotion
    beside: LinkMotion

    def rate(self, freedom: Freedom) -> float:
        """The rate of a freedom beside what is found, in parts of the fastest."""
        return abs(self.beside.rates.get(freedom, 0.0)) / (self.beside.fastest or 1.0)

    def less(self, factor: float, other: Moving) -> Moving:
        """This, and another motion back by a factor."""
        return Moving(self.own.less(factor, other.own), self.beside.less(factor, other.beside))


class IdleBasis:
    """The idle motions that are accounted for, at each place, each with a freedom that no other of
    them moves."""

    def __init__(self) -> None:
        self._at: list[list[tuple[Freedom, LinkMotion]]] = [[] for _ in range(PLACES)]

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self._at[0])

    def beside(self, place: int, motion: LinkMotion) -> LinkMotion:
        """A motion less those that were found."""
        for freedom, known in self._at[place]:
            if rate := motion.rates.get(freedom, 0.0):
                motion = motion.less(rate / known.rates[freedom], known)
        return motion

    def add(self, place: int, freedom: Freedom, motion: LinkMotion) -> None:
        """One more, beside the others, with a freedom that tells it from them."""
        self._at[place].append((freedom, motion))


class RigidGroup:
    """Links that move as one body, and what they may do that is not accounted for.

    `joints` lead to other links; `left` are the motions at each place.
    """

    def __init__(
        self, links: tuple[str, ...], joints: tuple[Joint, ...], motions: list[list[LinkMotion]]
    ) -> None:
        self.links, self.joints = links, joints
        self.left = [[Moving(motion, motion) for motion in place] for place in motions]

    @property
    def count(self) -> int:
        """How many motions are left: where there are the fewest, as others are accidents."""
        return min(len(place) for place in self.left)

    def look_beside(self, found: IdleBasis) -> None:
        """Leaves the motions that are independent of those found."""
        for place, motions in enumerate(self.left):
            kept: list[Moving] = []
            own = IdleBasis()
            for moving in motions:
                beside = own.beside(place, found.beside(place, moving.own))
                if beside.fastest > tolerances.SAME_COMMON_MOTION * moving.own.fastest:
                    freedom = max(beside.rates, key=lambda each: abs(beside.rates[each]))
                    own.add(place, freedom, beside)
                    kept.append(Moving(moving.own, beside))
            self.left[place] = kept

    def join(self, found: IdleBasis) -> None:
        """Accounts for all that is left, and keeps it."""
        for place, motions in enumerate(self.left):
            for _, beside in motions:
                freedom = max(beside.rates, key=lambda each: abs(beside.rates[each]))
                found.add(place, freedom, beside)

    def least_rate(self, freedom: Freedom) -> float:
        """The rate of a freedom in the motion that moves it most, at the place where it is
        least."""
        return min(max(moving.rate(freedom) for moving in place) for place in self.left)

    def take(self, freedom: Freedom, found: IdleBasis) -> Moving:
        """Accounts for the motion that moves a freedom most, which the others then leave at rest;
        gives it as it is at the first place."""
        taken = []
        for place, motions in enumerate(self.left):
            best = max(range(len(motions)), key=lambda k: motions[k].rate(freedom))
            one, own = motions[best], freedom
            if one.rate(own) <= tolerances.SAME_COMMON_MOTION:  # at rest here, by chance
                own = max(one.beside.rates, key=lambda each: abs(one.beside.rates[each]))
            rate = one.beside.rates[own]
            found.add(place, own, one.beside)
            self.left[place] = [
                other.less(other.beside.rates.get(own, 0.0) / rate, one)
                for k, other in enumerate(motions)
                if k != best
            ]
            taken.append(one)
        return taken[0]

    def carried(self, link: str) -> Screw | None:
        """The one motion left as a screw that a link carries with it, None where it carries
        none."""
        if any(len(place) != 1 for place in self.left):
            return None
        twists = [place[0].own.twists[link] for place in self.left]
        if not all(any(angular) or any(linear) for angular, linear in twists):
            return None
        screws = [scaled_screw(twist) for twist in twists]
        return screws[0] if all(same_line(screws[0], other) for other in screws[1:]) else None

    def is_steady(self, freedom: Freedom) -> bool:
        """Whether the one motion left moves a freedom as fast at every place; of several, which are
        told in no way of their own, nothing is said."""
        if any(len(place) != 1 for place in self.left):
            return True
        speeds = []
        for (moving,) in self.left:
            angular, linear = moving.own.twists[self.links[0]]
            turn, slide = norm(angular), norm(linear)
            if turn == slide == 0.0:
                return False
            speed = turn if turn > tolerances.SAME_COMMON_MOTION * slide else slide
            speeds.append(abs(moving.own.rates.get(freedom, 0.0)) / speed)
        apart = max(speeds) - min(speeds)
        return min(speeds) > tolerances.HELD_RATE and apart <= tolerances.SAME_COMMON_MOTION


def is_slide(screw: Screw | None) -> bool:
    """Whether a scaled screw slides and does not turn."""
    return screw is not None and not any(screw[0])


def is_pure_turn(screw: Screw | None) -> bool:
    """Whether a scaled screw turns and does not slide."""
    return (
        screw is not None
        and any(screw[0])
        and norm(advance_of(screw)) <= tolerances.SAME_COMMON_MOTION
    )


Chain = tuple[tuple[str, ...], tuple[Joint, ...], tuple[Joint, ...]]
"""Links, the joints between them, and the joints to other links."""


class Groups(NamedTuple):
    """Groups that may move wherever their joints are, few links first; `drawn` are all that may
    move as they are drawn, with the number of motions that they have anywhere."""

    groups: list[RigidGroup]
    drawn: list[DrawnGroup]


class DrawnGroup(NamedTuple):
    """A group as it is drawn, the freedoms of inputs there, and its number of motions anywhere."""

    chain: Chain
    still: list[Freedom]
    place: General
    anywhere: int

    def motions(self, still: Sequence[Freedom]) -> list[LinkMotion]:
        """Its motions as drawn that leave the inputs and some more freedoms at rest."""
        return common_motions(*self.chain, [*self.still, *still], self.place)


def idle_groups(
    mechanism: Mechanism,
    driven: Collection[Coordinate],
    size: float,
    origin: Vector,
    legs: Collection[frozenset[str]],
) -> Groups:
    """Groups of links with common motions that move no driven coordinate; lengths in parts of
    `size` (m), about `origin` (m). Those of `legs` only where others are beside them."""
    drawn = General(DRAWN, size, origin)
    general = [General(place, size, origin) for place in range(PLACES)]
    groups: list[RigidGroup] = []
    waiting: list[tuple[Chain, list[Freedom]]] = []
    found: list[DrawnGroup] = []
    for chain in _chains(mechanism):
        links, _, border = chain
        others = {end for joint in border for end in (joint.first, joint.second)}
        if len(others.difference(links)) < 2:
            continue  # a freedom like any other
        still = [
            (joint.name, joint.type.freedom_of[coordinate])
            for joint in border
            for name, coordinate in driven
            if name == joint.name
        ]
        if frozenset(links) in legs:
            waiting.append((chain, still))
            continue
        if not common_motions(*chain, still, drawn):
            continue
        group = RigidGroup(links, border, [common_motions(*chain, still, one) for one in general])
        found.append(DrawnGroup(chain, still, drawn, group.count))
        groups += [group] if group.count else []
    beside = {joint.name for group in groups for joint in group.joints}
    for chain, still in waiting:
        if beside & {joint.name for joint in chain[2]}:
            motions = [common_motions(*chain, still, one) for one in general]
            groups.append(RigidGroup(chain[0], chain[2], motions))
    return Groups(groups, found)


def _chains(mechanism: Mechanism) -> Iterator[Chain]:
    """Single links with two or more joints, then
    chains of links with two joints each."""
    joints_of = mechanism.joints_of
    single = [name for name in mechanism.links if name != GROUND_NAME and len(joints_of[name]) > 1]
    for name in single:
        yield (name,), (), joints_of[name]
    chains: list[tuple[str, ...]] = [(name,) for name in single if len(joints_of[name]) == 2]
    inner: dict[tuple[str, ...], tuple[Joint, ...]] = dict.fromkeys(chains, ())
    for _ in range(tolerances.MOST_IDLE_LINKS - 1):
        longer = []
        for chain in chains:
            for joint in joints_of[chain[-1]]:
                far = joint.second if joint.first == chain[-1] else joint.first
                binary = far != GROUND_NAME and len(joints_of[far]) == 2
                if binary and far not in chain and joint not in inner[chain]:
                    grown = (*chain, far)
                    inner[grown] = (*inner[chain], joint)
                    longer.append(grown)
        chains = longer
        for chain in chains:
            if chain[0] > chain[-1]:
                continue
            ends = [
                next((j for j in joints_of[link] if j not in inner[chain]), None)
                for link in (chain[0], chain[-1])
            ]
            if ends[0] is not None and ends[1] is not None and ends[0] != ends[1]:
                yield chain, inner[chain], (ends[0], ends[1])
