"""Motions that all joints around some links allow, so that nothing but these links moves.

`common_motions`: screws (angular, linear at the origin of the drawing; lengths in parts of a size)
are taken on the links' own drawing at general coordinates of the joints: what is common there is
common everywhere, and no accident of the drawing. Two such places are compared, which distinguishes
a line that the links carry with them from one that only happens to be there.

`idle_groups`: links with two joints and more, and chains of links with two joints each, are taken
one after the other, few links first. A group's motions are those that no smaller group has: in
S-E-C with the axes in line the two links in between turn, each on its own, and that both turn
together adds nothing. This is a matter of the rates of all joints at one place, so motions are
stored at each general place and reduced by those before (`IdleBasis`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from mechkin_cli import tolerances
from mechkin_cli.mechanism import (
    GROUND,
    GROUND_NAME,
    ZERO,
    Frame,
    Joint,
    Mechanism,
    Part,
    Relation,
    Screw,
    Track,
    Vector,
    add,
    cross,
    norm,
    scale,
    subtract,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import largest

Freedom = tuple[str, int]
"""A joint's name and the number of its freedom."""

Rates = Mapping[Freedom, float]
"""Rates, or their factors in a sum; slides in parts of a size."""

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


# a rigid displacement is a frame that stood along the ground's axes; GROUND stands still


def _back(by: Frame) -> Frame:
    """The displacement back."""
    x, y, z = (by.components(axis) for axis in (GROUND.x, GROUND.y, GROUND.z))
    return Frame(x, y, z, scale(-1.0, by.components(by.o)))


def _displaced(screw: Screw, by: Frame) -> Screw:
    angular = by.vector(screw[0])
    return angular, add(by.vector(screw[1]), cross(by.o, angular))


class LinkMotion(NamedTuple):
    """A motion of some links at one place: the rates of the freedoms that move, the twist of each
    link on its own drawing, and the twist by which the joints miss having it in common."""

    rates: Rates
    twists: Mapping[str, Screw]
    miss: float = 0.0

    @property
    def fastest(self) -> float:
        """The largest rate."""
        return max((abs(rate) for rate in self.rates.values()), default=0.0)

    @property
    def fastest_freedom(self) -> Freedom:
        """The first freedom that has it."""
        return max(self.rates, key=lambda freedom: abs(self.rates[freedom]))

    def part(self, freedom: Freedom) -> float:
        """The rate of a freedom in parts of the largest."""
        return abs(self.rates.get(freedom, 0.0)) / (self.fastest or 1.0)

    def less(self, factor: float, other: LinkMotion) -> LinkMotion:
        """This, less another motion times a factor."""
        rates = {
            freedom: self.rates.get(freedom, 0.0) - factor * other.rates.get(freedom, 0.0)
            for freedom in dict.fromkeys((*self.rates, *other.rates))
        }
        twists = dict(self.twists)
        for link, (angular, linear) in other.twists.items():
            turn, slide = twists.get(link, (ZERO, ZERO))
            turn = subtract(turn, scale(factor, angular))
            twists[link] = turn, subtract(slide, scale(factor, linear))
        return LinkMotion(rates, twists, self.miss + abs(factor) * other.miss)


def common_motions(
    links: Sequence[str],
    inner: Sequence[Joint],
    border: Sequence[Joint],
    still: Sequence[Rates],
    general: General,
) -> list[LinkMotion]:
    """Independent motions of a chain of links as one body that leave all others at rest.

    Args:
        links: in the order of the chain.
        inner: the joints between them, each leads from one to the next.
        border: the joints to other links.
        still: sums of rates, each with its factor, that are zero.
        general: the place.
    """
    if _advance_apart(border):
        return []
    pose = {links[0]: GROUND}
    for here, there, joint in zip(links, links[1:], inner, strict=False):
        pose[there] = pose[here].carry(general.seen_from(joint, here)[0])
    columns: list[tuple[int, Freedom, tuple[float, ...]]] = []
    for number, joint in enumerate(border):
        link = joint.first if joint.first in pose else joint.second
        at = pose[link]
        outward = 1.0 if link == joint.second else -1.0  # rates are of the second link
        for own, screw in enumerate(general.seen_from(joint, link)[1]):
            seen = screw if at is GROUND else _displaced(screw, at)
            entries = tuple(outward * entry for entry in (*seen[0], *seen[1]))
            columns.append((number, (joint.name, own), entries))
    one_each = [number for number, _, _ in columns] == list(range(len(border)))
    if one_each and any(_are_independent(columns[0][2], more[2]) for more in columns[1:]):
        return []  # of joints with one motion each two that differ are enough
    # the twist by the first joint is that by each other
    rows = [
        [
            screw[i] if number == 0 else -screw[i] if number == k else 0.0
            for number, _, screw in columns
        ]
        for k in range(1, len(border))
        for i in range(6)
    ]
    for rates in still:
        rows.append([rates.get(freedom, 0.0) for _, freedom, _ in columns])
    motions = []
    for motion in _null_space([row.copy() for row in rows], len(columns)):
        v = [0.0] * 6
        for rate, (number, _, entries) in zip(motion, columns, strict=True):
            if number == 0:
                v = [known + rate * entry for known, entry in zip(v, entries, strict=True)]
        twist: Screw = ((v[0], v[1], v[2]), (v[3], v[4], v[5]))
        rates = {freedom: rate for rate, (_, freedom, _) in zip(motion, columns, strict=True)}
        twists = {link: _displaced(twist, _back(pose[link])) for link in links}
        mapped = (sum(a * b for a, b in zip(row, motion, strict=True)) for row in rows)
        miss = max((abs(entry) for entry in mapped), default=0.0)
        motions.append(LinkMotion(rates, twists, miss))
    return motions


def _are_independent(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether two screws have no motion in common: what `_null_space` finds, as most links have
    two pins apart."""
    if max(map(abs, one)) < max(map(abs, other)):
        one, other = other, one
    pivot = max(range(6), key=lambda i: abs(one[i]))
    if abs(one[pivot]) <= tolerances.COMMON_MOTION:
        return False
    share = other[pivot] / one[pivot]
    left = (abs(b - a * share) for a, b in zip(one, other, strict=True))
    return max(left) > tolerances.COMMON_MOTION


def _advance_apart(joints: Sequence[Joint]) -> bool:
    """Whether joints that turn about one line advance on it by different leads, so that they turn
    there together nowhere: a lead is written as it is meant, whatever the size of the drawing. A
    joint without a thread or a slide has none."""
    pitches = [j.pitch for j in joints if not any(own.is_slide for own in j.type.chain)]
    most = max(map(abs, pitches), default=0.0)
    return bool(pitches) and max(pitches) - min(pitches) > tolerances.SAME_LEAD * most


class General:
    """A general place of all joints, or the drawing; lengths in parts of `size` (m), from an
    `origin` (m) near the drawing: far from it lines would be lost in rounding."""

    def __init__(self, place: int, size: float, origin: Vector) -> None:
        self.size, self.origin = size, origin
        self._next = 7 * place
        self._drawn = place == DRAWN
        self._seen: dict[tuple[str, str], tuple[Frame, list[Screw]]] = {}

    def seen_from(self, joint: Joint, link: str) -> tuple[Frame, list[Screw]]:
        """The displacement from the drawing of the joint's other link to that of a link, and the
        joint's screws on the latter."""
        if (joint.name, link) in self._seen:
            return self._seen[joint.name, link]
        first = joint.name, joint.first
        if first not in self._seen:
            passed = GROUND
            screws: list[Screw] = []
            pitch = joint.pitch / self.size
            for part in joint.parts:
                before, after = (
                    frame._replace(o=scale(1.0 / self.size, subtract(frame.o, self.origin)))
                    for frame in (part.before, part.after)
                )
                if part.track is not None:
                    part = part._replace(at=self._on_track(part.track, part.at))
                    way = scale(1.0 / self.size, part.way)
                    own = tuple((w, scale(1.0 / self.size, v)) for w, v in part.screws(pitch))
                    screws += own if passed is GROUND else [_displaced(s, passed) for s in own]
                    passed = passed.carry(GROUND._replace(o=way))
                    continue
                part = part._replace(before=before, after=after)
                own = part.screws(pitch)
                screws += own if passed is GROUND else [_displaced(s, passed) for s in own]
                if self._drawn and before == after:
                    continue  # as drawn its links are where they are
                passed = passed.carry(self._moved(part, pitch))
            self._seen[first] = passed, screws
        passed, screws = self._seen[first]
        if link == joint.second:
            back = GROUND if passed is GROUND else _back(passed)
            on_second = screws if passed is GROUND else [_displaced(s, back) for s in screws]
            self._seen[joint.name, link] = back, on_second
        return self._seen[joint.name, link]

    def _on_track(self, track: Track, at: tuple[float, ...]) -> tuple[float, ...]:
        """General parameters between the ends of a track, or those as drawn."""
        if self._drawn:
            return at
        self._next += 1
        share = abs(_TURNS[self._next % len(_TURNS)][0])
        return tuple(low + (0.1 + 0.8 * share) * (high - low) for low, high in track.ends)

    def _moved(self, part: Part, pitch: float) -> Frame:
        """A part at general coordinates: from the drawing after it to the drawing before it."""
        self._next += 1
        turn, slide = _TURNS[self._next % len(_TURNS)], _SLIDES[self._next % len(_SLIDES)]
        own = GROUND
        if self._drawn:
            pass
        elif part.type.is_ball:
            own = _turned_by(_BALLS[self._next % len(_BALLS)])
        elif part.type.freedoms:
            motions = {freedom.motion for freedom in part.type.freedoms}
            cosine, sine = (1.0, 0.0) if motions == {"slide"} else turn
            along = slide if "slide" in motions else slide * pitch
            own = Frame((cosine, sine, 0.0), (-sine, cosine, 0.0), GROUND.z, (0.0, 0.0, along))
        return part.before.carry(own).carry(_back(part.after))


def _turned_by(quaternion: tuple[float, float, float, float]) -> Frame:
    w, x, y, z = quaternion
    square = w * w + x * x + y * y + z * z
    axis = (x, y, z)

    def turned(a: Vector) -> Vector:
        # (w^2 - v.v) a + 2 (v.a) v + 2 w v x a, over the square
        along = x * a[0] + y * a[1] + z * a[2]
        part = add(scale(2.0 * w * w - square, a), scale(2.0 * along, axis))
        return scale(1.0 / square, add(part, scale(2.0 * w, cross(axis, a))))

    return Frame(turned(GROUND.x), turned(GROUND.y), turned(GROUND.z), ZERO)


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
    basis = []
    for free in (k for k in range(count) if k not in order):
        motion = [0.0] * count
        motion[free] = 1.0
        for number, column in enumerate(order):
            motion[column] = -rows[number][free]
        basis.append(motion)
    return basis


def _same_line(one: Screw, other: Screw) -> bool:
    """Whether two screws, scaled alike, are the same or opposite."""
    a, b = (*one[0], *one[1]), (*other[0], *other[1])
    apart = max(abs(x - y) for x, y in zip(a, b, strict=True))
    mirrored = max(abs(x + y) for x, y in zip(a, b, strict=True))
    return min(apart, mirrored) <= tolerances.SAME_COMMON_MOTION


def _scaled_screw(screw: Screw) -> Screw:
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


Coordinate = tuple[str, str]
"""A joint and its coordinate."""


class IdleBasis:
    """The idle motions that are accounted for, at each place, each with a freedom that no other of
    them moves."""

    def __init__(self) -> None:
        self._at: list[list[tuple[Freedom, LinkMotion]]] = [[] for _ in range(PLACES)]

    @property
    def count(self) -> int:
        """Of the motions."""
        return len(self._at[0])

    def beside(self, place: int, motion: LinkMotion) -> LinkMotion:
        """A motion less those of the basis."""
        for freedom, known in self._at[place]:
            if rate := motion.rates.get(freedom, 0.0):
                motion = motion.less(rate / known.rates[freedom], known)
        return motion

    def add(self, place: int, freedom: Freedom, motion: LinkMotion) -> None:
        """One more, beside the others, with a freedom that none of them moves."""
        self._at[place].append((freedom, motion))


class RigidGroup:
    """Links that move as one body, and what they may do that is not accounted for.

    `joints` lead to other links; `left` are the motions at each place, each as the group makes it,
    and less the motions before it.
    """

    def __init__(
        self, links: tuple[str, ...], joints: tuple[Joint, ...], motions: list[list[LinkMotion]]
    ) -> None:
        self.links, self.joints = links, joints
        self.left = [[(motion, motion) for motion in place] for place in motions]

    @property
    def count(self) -> int:
        """How many motions are left: where there are the fewest, as others are accidents."""
        return min(len(place) for place in self.left)

    def reduce(self, basis: IdleBasis) -> None:
        """Leaves the motions that are independent of a basis."""
        for place, motions in enumerate(self.left):
            independent: list[tuple[LinkMotion, LinkMotion]] = []
            before = IdleBasis()
            for own, _ in motions:
                beside = before.beside(place, basis.beside(place, own))
                if beside.fastest > tolerances.SAME_COMMON_MOTION * own.fastest:
                    before.add(place, beside.fastest_freedom, beside)
                    independent.append((own, beside))
            self.left[place] = independent

    def join(self, basis: IdleBasis) -> None:
        """Adds all that is left to a basis, and leaves it."""
        for place, motions in enumerate(self.left):
            for _, beside in motions:
                basis.add(place, beside.fastest_freedom, beside)

    def least_rate(self, freedom: Freedom) -> float:
        """The rate of a freedom in the motion that moves it most, at the place where it is
        least."""
        return min(max(beside.part(freedom) for _, beside in place) for place in self.left)

    def take(self, freedom: Freedom, basis: IdleBasis) -> LinkMotion:
        """Moves the motion that moves a freedom most to a basis, so that the others leave the
        freedom at rest; gives it as it is at the first place."""
        taken = []
        for place, motions in enumerate(self.left):
            best = max(range(len(motions)), key=lambda k: motions[k][1].part(freedom))
            (own, beside), moved = motions.pop(best), freedom
            if beside.part(moved) <= tolerances.SAME_COMMON_MOTION:  # at rest here, by chance
                moved = beside.fastest_freedom
            basis.add(place, moved, beside)
            factors = [other.rates.get(moved, 0.0) / beside.rates[moved] for _, other in motions]
            self.left[place] = [
                (one.less(factor, own), other.less(factor, beside))
                for factor, (one, other) in zip(factors, motions, strict=True)
            ]
            taken.append(own)
        return taken[0]

    def carried(self, link: str) -> Screw | None:
        """The one motion left as a screw that a link carries with it, None where it carries
        none."""
        if any(len(place) != 1 for place in self.left):
            return None
        twists = [place[0][0].twists[link] for place in self.left]
        if not all(any(angular) or any(linear) for angular, linear in twists):
            return None
        screws = [_scaled_screw(twist) for twist in twists]
        return screws[0] if all(_same_line(screws[0], other) for other in screws[1:]) else None

    def is_steady(self, freedom: Freedom) -> bool:
        """Whether the one motion left moves a freedom as fast at every place; True of several,
        which no freedom distinguishes."""
        if any(len(place) != 1 for place in self.left):
            return True
        speeds = []
        for ((motion, _),) in self.left:
            angular, linear = motion.twists[self.links[0]]
            turn, slide = norm(angular), norm(linear)
            if turn == slide == 0.0:
                return False
            speed = turn if turn > tolerances.SAME_COMMON_MOTION * slide else slide
            speeds.append(abs(motion.rates.get(freedom, 0.0)) / speed)
        apart = max(speeds) - min(speeds)
        return min(speeds) > tolerances.HELD_RATE and apart <= tolerances.SAME_COMMON_MOTION


def is_slide(screw: Screw | None) -> bool:
    """Whether a scaled screw slides and does not turn."""
    return screw is not None and not any(screw[0])


def is_pure_turn(screw: Screw | None) -> bool:
    """Whether a scaled screw turns and does not slide."""
    if screw is None or not any(screw[0]):
        return False
    angular, linear = screw
    advance = subtract(linear, cross(cross(angular, linear), angular))
    return norm(advance) <= tolerances.SAME_COMMON_MOTION


Chain = tuple[tuple[str, ...], tuple[Joint, ...], tuple[Joint, ...]]
"""Links, the joints between them, and the joints to other links."""


class DrawnGroup(NamedTuple):
    """A group as it is drawn, the sums of rates that inputs and couplings hold there, and its
    number of motions anywhere."""

    chain: Chain
    still: list[Rates]
    place: General
    anywhere: int

    def motions(self, still: Sequence[Freedom]) -> list[LinkMotion]:
        """Its motions as drawn that leave the inputs and some more freedoms at rest."""
        more = [{freedom: 1.0} for freedom in still]
        return common_motions(*self.chain, [*self.still, *more], self.place)


def idle_groups(
    mechanism: Mechanism,
    driven: Collection[Coordinate],
    size: float,
    origin: Vector,
    spinning: Collection[frozenset[str]],
) -> tuple[list[RigidGroup], list[DrawnGroup]]:
    """Groups of links with common motions that move no driven coordinate: those that may move
    wherever their joints are, few links first, and all that may move as they are drawn. Lengths in
    parts of `size` (m), about `origin` (m). Those of `spinning` only where others are beside."""
    drawn = General(DRAWN, size, origin)
    general = [General(place, size, origin) for place in range(PLACES)]
    groups: list[RigidGroup] = []
    coupled = [_coupled(relation, size) for relation in mechanism.couplings.values()]
    waiting: list[tuple[Chain, list[Rates]]] = []
    as_drawn: list[DrawnGroup] = []
    for chain in _chains(mechanism):
        links, _, border = chain
        others = {end for joint in border for end in (joint.first, joint.second)}
        if len(others.difference(links)) < 2:
            continue  # a freedom like any other
        names = {joint.name for joint in border}
        still = [rates for rates in coupled if any(name in names for name, _ in rates)]
        still += [
            {(joint.name, joint.type.freedom_of[coordinate]): 1.0}
            for joint in border
            for name, coordinate in driven
            if name == joint.name
        ]
        if frozenset(links) in spinning:
            waiting.append((chain, still))
            continue
        if not common_motions(*chain, still, drawn):
            continue
        group = RigidGroup(links, border, [common_motions(*chain, still, one) for one in general])
        as_drawn.append(DrawnGroup(chain, still, drawn, group.count))
        groups += [group] if group.count else []
    beside = {joint.name for group in groups for joint in group.joints}
    for chain, still in waiting:
        if beside & {joint.name for joint in chain[2]}:
            motions = [common_motions(*chain, still, one) for one in general]
            groups.append(RigidGroup(chain[0], chain[2], motions))
    return groups, as_drawn


def _coupled(relation: Relation, size: float) -> Rates:
    """The sum of rates that a coupling holds at a general place, where functions have a slope."""
    rates: dict[Freedom, float] = {}
    for number, term in enumerate(relation.terms):
        slope = 1.0 if term.law is None else _TURNS[number % len(_TURNS)][0]
        freedom = term.joint.name, term.joint.freedom_number(term.coordinate)
        factor = slope * float(term.factor * term.joint.unit_of(term.coordinate, size))
        rates[freedom] = rates.get(freedom, 0.0) + factor
    most = largest(0.0, *(abs(factor) for factor in rates.values()))
    return {freedom: factor / most for freedom, factor in rates.items()}


def _chains(mechanism: Mechanism) -> Iterator[Chain]:
    """Single links with two or more joints, then chains of links with two joints each."""
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
