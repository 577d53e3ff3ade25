"""What can move at one place while all inputs rest, by rank, and the sets of links that cannot.

Counting equations says too much where loops hold by their dimensions: of the equations of an equal
second rod none is new, of a plane loop closed in space two of five. The rates of a part's joints
are the null space of its loops' screws and its other constraints' forces, taken at a place where
all loops are closed (Hunt 1978; Davies 1981). Lengths are in parts of the mechanism's size, and a
rank is decided by complete pivoting, far above rounding and far below what a regular place has.

Sets (`determined_sets`): where there are more equations than freedoms a matching cannot decide
which equations are new, and only proposes groups. A set of links is *determined* if none of them
can move while the inputs and what is placed before rest. If a set is not, the links that cannot
move all the same hold the largest determined set within it; two determined sets are one together.
So whatever is proposed, a group is as soon as it is determined, and it is a smallest one if no
determined set is left when any one of its links is taken away.

Smallest sets that hold each other twice are solved together (`_solved_together`): two equal rods a
quarter apart couple wheels that either of them lets go in line; a strut between two copies of a
linkage has dead centres where the copies have none. Solved by one of them alone, a link is lost
where the other still holds it. So where one of its own connections is taken out of a set, and later
sets hold some of its links all the same, these sets are one.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism import (
    ELEMENTARY,
    GROUND,
    SECOND,
    ZERO,
    Attached,
    DrawnDirection,
    Frame,
    Joint,
    Mechanism,
    Part,
    Vector,
    add,
    cross,
    norm,
    scale,
    subtract,
)
from mechkin_cli.structure.matching import strong_components
from mechkin_cli.structure.network import SPACE, Connection, Subgraph, incidence
from mechkin_cli.tolerances import LOOP_RANK, MOST_SPLIT_LINKS, RANK_WORK

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


def middle_and_size(mechanism: Mechanism) -> tuple[Vector, float]:
    """The middle of a mechanism as drawn, in the ground's axes, and its size, both in m."""
    points = [at.vector for _, at in mechanism.joint_points()]
    total = ZERO
    for point in points:
        total = add(total, point)
    return scale(1.0 / max(1, len(points)), total), mechanism.box_diagonal()


class Rates:
    """The joints' rates at a place.

    Args:
        poses: where the drawing's axes and origin (m) stand with each link.
        driven: freedoms (joint, number along its chain) that rest.
        middle: the point about which moments are taken (m).
        size: the length that is one in rows (m).
    """

    def __init__(
        self,
        poses: Callable[[str], Frame],
        driven: Collection[tuple[str, int]],
        middle: Vector,
        size: float,
    ) -> None:
        self.poses, self.driven = poses, driven
        self.middle, self.size = middle, size
        self.work = 0
        self._screws: dict[str, Floats] = {}
        self._forces: dict[str, tuple[float, ...]] = {}

    def still(
        self, links: Collection[str], connections: Sequence[Connection], placed: Collection[str]
    ) -> set[str]:
        """Which of some links cannot move against what is placed, by the connections between
        them and those that lead to it; none where that would take more than `RANK_WORK`."""
        some = [c for c in connections if joins(c, links, placed)]
        tree, closing = _tree([c for c in some if c.has_coordinates], placed)
        if not tree:
            return set()
        columns, count = self._columns([*tree.values(), *closing])
        height = 6 * len(closing) + len(some) - len(tree) - len(closing)
        work = height * count * min(height, count)
        if self.work + work > RANK_WORK:
            return set()
        self.work += work
        twists = self._twists(tree, columns, count)
        rows = [np.zeros((0, count))]
        for c in closing:
            apart = _of(twists, c.second, count) - _of(twists, c.first, count)
            apart[:, columns[c.name]] -= self._of_joint(c)
            rows.append(apart)
        for c in some:
            ends = [end for end in (c.first, c.second) if end not in placed]
            if not c.has_coordinates and all(end in tree for end in ends):
                apart = _of(twists, c.second, count) - _of(twists, c.first, count)
                rows.append(_along(self._force(c), apart)[None])
        equations = np.concatenate(rows)
        below = np.concatenate([twists[link] for link in tree])
        left = _reduced(equations, below).reshape(len(tree), -1)
        moved = np.max(np.abs(left), axis=1, initial=0.0)
        return {link for link, most in zip(tree, moved, strict=True) if most <= LOOP_RANK}

    def _columns(self, joints: Sequence[Connection]) -> tuple[dict[str, slice], int]:
        """Which columns are each joint's rates, and how many there are."""
        columns, count = {}, 0
        for c in joints:
            freedoms = self._of_joint(c).shape[1]
            columns[c.name] = slice(count, count + freedoms)
            count += freedoms
        return columns, count

    def _twists(
        self, tree: Mapping[str, Connection], columns: Mapping[str, slice], count: int
    ) -> dict[str, Floats]:
        """Twists (6, rates) of the links of a tree, each after that before it."""
        twists: dict[str, Floats] = {}
        for link, c in tree.items():
            twist = _of(twists, c.other(link), count).copy()
            sign = 1.0 if link == c.second else -1.0
            twist[:, columns[c.name]] += sign * self._of_joint(c)
            twists[link] = twist
        return twists

    def _of_joint(self, c: Connection) -> Floats:
        """Screws (6, freedoms that do not rest) of a joint's second link against its first."""
        if c.name not in self._screws:
            chain = enumerate(self._chain(c.joint))
            screws = [screw for number, screw in chain if (c.name, number) not in self.driven]
            self._screws[c.name] = np.array(screws, dtype=np.float64).reshape(-1, 6).T
        return self._screws[c.name]

    def _chain(self, joint: Joint) -> list[list[float]]:
        """The screws of all freedoms: turns go through the joint's point."""
        at = self._place(self._point(joint.point))
        pitch = joint.pitch / self.size
        screws: list[list[float]] = []
        parts = iter(joint.parts)
        for step in joint.type.steps:
            part = next(parts)
            if part.track is not None:
                ways = [scale(part.sense, way) for way in part.track.slopes(part.at)]
                own = [Attached(joint.second, scale(1.0 / self.size, way)) for way in ways]
                screws += [[*ZERO, *self._direction(way)] for way in own]
                continue
            if ELEMENTARY[step.letter].is_ball and not part.type.is_ball:
                turns = self._three_turns(joint, (part, next(parts), next(parts)))
                screws += [[*turn, *cross(at, turn)] for turn in turns]
                continue
            for freedom in part.type.freedoms:
                direction: Vector
                if step.between:
                    direction = self._square_turn(joint, screws[-1][:3])
                elif freedom.motion == "ball":
                    direction = getattr(GROUND, freedom.axis)
                elif step.along is None:
                    # it leads from one drawing to the other, behind slides alone
                    direction = self._direction(Attached(joint.first, part.before.z))
                else:
                    direction = self._direction(joint.drawn(step.along))
                if freedom.is_slide:
                    screws.append([*ZERO, *direction])
                    continue
                along = pitch if freedom.motion == "thread" else 0.0
                screws.append([*direction, *add(cross(at, direction), scale(along, direction))])
        return screws

    def _square_turn(self, joint: Joint, before: Sequence[float]) -> Vector:
        """The axis of a turn between two others: that before it, and x of the second link."""
        x, y, z = before
        across = cross((x, y, z), self._direction(joint.drawn(DrawnDirection(SECOND, "x"))))
        length = norm(across)
        if length > LOOP_RANK:
            return scale(1.0 / length, across)
        return self._direction(joint.drawn(DrawnDirection(SECOND, "y")))

    def _three_turns(self, joint: Joint, parts: tuple[Part, Part, Part]) -> list[Vector]:
        """The axes of a ball that is made of three turns: on its links, and square to both."""
        first = self._direction(Attached(joint.first, parts[0].before.z))
        last = self._direction(Attached(joint.second, parts[2].after.z))
        across = cross(last, first)
        length = norm(across)
        middle = self._direction(Attached(joint.first, parts[1].before.z))
        return [first, scale(1.0 / length, across) if length > LOOP_RANK else middle, last]

    def _force(self, c: Connection) -> tuple[float, ...]:
        """The force of a constraint without coordinates: its moment, then itself."""
        if c.name not in self._forces:
            point, line = c.constraint.force_line(self._point)
            self._forces[c.name] = (*cross(self._place(point), line), *line)
        return self._forces[c.name]

    def _direction(self, at: Attached) -> Vector:
        return self.poses(at.link).vector(at.vector)

    def _place(self, point: Vector) -> Vector:
        """A point (m) about the middle, in parts of the size."""
        return scale(1.0 / self.size, subtract(point, self.middle))

    def _point(self, at: Attached) -> Vector:
        return add(self.poses(at.link).o, self._direction(at))


def joins(c: Connection, links: Collection[str], placed: Collection[str]) -> bool:
    """Whether a connection holds some of the links, or two of them together."""
    if c.own_unknowns:
        return False  # it only moves its slide
    ends = (c.first in links, c.second in links)
    return any(ends) and all(
        inside or end in placed for inside, end in zip(ends, (c.first, c.second), strict=True)
    )


def _tree(
    joints: Sequence[Connection], placed: Collection[str]
) -> tuple[dict[str, Connection], list[Connection]]:
    """The joints that carry the links which joints reach from what is placed, each after the one
    before it, and the other joints between these."""
    at: dict[str, list[Connection]] = {}
    for c in joints:
        for end in (c.first, c.second):
            at.setdefault("" if end in placed else end, []).append(c)
    tree: dict[str, Connection] = {}
    front = [""]
    for link in front:
        for c in at.get(link, ()):
            for end in (c.first, c.second):
                if end not in placed and end not in tree:
                    tree[end] = c
                    front.append(end)
    carrying = {c.name for c in tree.values()}
    reached = [c for c in joints if c.first in tree or c.second in tree]
    return tree, [c for c in reached if c.name not in carrying]


def _of(twists: Mapping[str, Floats], link: str, count: int) -> Floats:
    """The twist of a link; of what is placed zero."""
    return twists[link] if link in twists else np.zeros((6, count))


def _along(force: Sequence[float], twist: Floats) -> Floats:
    """Power (rates,) of a force and moment on twists (6, rates)."""
    power = np.zeros(twist.shape[1])
    for component, row in zip(force, twist, strict=True):
        power += component * row
    return power


def _reduced(equations: Floats, below: Floats) -> Floats:
    """What rows `below` are on the null space of `equations`: in terms of the columns without a
    pivot."""
    rows, columns = equations.shape
    table = np.concatenate([equations, below])
    rank = 0
    while rank < min(rows, columns):
        sizes = np.abs(table[rank:rows, rank:])
        row, column = divmod(int(np.argmax(sizes)), columns - rank)
        if sizes[row, column] <= LOOP_RANK:
            break
        table[[rank, rank + row]] = table[[rank + row, rank]]
        table[:, [rank, rank + column]] = table[:, [rank + column, rank]]
        factors = table[rank + 1 :, rank] / table[rank, rank]
        table[rank + 1 :, rank:] -= factors[:, None] * table[rank, rank:]
        rank += 1
    return table[rows:, rank:]


Links = tuple[str, ...]


def determined_sets(
    component: Subgraph, proposed: Sequence[Collection[str]], rates: Rates
) -> tuple[list[Links], Links]:
    """The determined sets of a component in their order, from proposals in theirs; and the links
    that are in none.

    A small component is looked at as a whole, so that no proposal decides between sets.
    """
    search = _DeterminedSearch(component.connections, rates)
    placed = {component.entry}
    sets: list[Links] = []
    waiting: list[str] = []
    ordered = [link for links in proposed for link in links]
    whole = len(ordered) <= MOST_SPLIT_LINKS
    for links in [ordered] if whole else proposed:
        waiting += links
        some = search.core(waiting, placed)
        waiting = [link for link in waiting if link not in some]
        for part in search.split(some, placed):
            sets.append(tuple(part))
            placed.update(part)
    return _solved_together(sets, search, component.entry), tuple(waiting)


def _solved_together(sets: Sequence[Links], search: _DeterminedSearch, entry: str) -> list[Links]:
    """The sets, each after those that it needs, as they are to be solved."""
    owner = {link: k for k, links in enumerate(sets) for link in links}
    ahead = []
    placed = {entry}
    for k, links in enumerate(sets):
        ends = {end for c in search.around(links) for end in (c.first, c.second)}
        before = {owner[end] for end in ends if owner.get(end, k) < k}
        ahead.append(sorted(before | _holding(k, sets, search, placed)))
        placed.update(links)
    together = strong_components(ahead, range(len(sets)))
    return [tuple(link for k in part for link in sets[k]) for part in together]


def _holding(
    number: int, sets: Sequence[Links], search: _DeterminedSearch, placed: Collection[str]
) -> set[int]:
    """The later sets that hold a link of one where one of its connections is missing."""
    own = sets[number]

    def holds(later: Sequence[int], missing: str) -> bool:
        links = [*own, *(link for k in later for link in sets[k])]
        return not set(own).isdisjoint(search.core(links, placed, missing))

    for c in search.around(own):
        later = list(range(number + 1, len(sets)))
        if not joins(c, own, placed) or not holds(later, c.name):
            continue
        while later and holds(later[:-1], c.name):
            later.pop()
        for k in later[-2::-1]:
            fewer = [other for other in later if other != k]
            later = fewer if holds(fewer, c.name) else later
        return set(later)
    return set()


class _DeterminedSearch:
    def __init__(self, connections: Sequence[Connection], rates: Rates) -> None:
        self.connections, self.rates = connections, rates
        self.at = incidence(connections)
        self._failed: dict[tuple[str, ...], int] = {}

    def core(self, links: Sequence[str], placed: Collection[str], without: str = "") -> list[str]:
        """The largest determined set within some links, in their order, `without` a connection."""
        members = list(links)
        while members:
            around = [c for c in self.around(members) if c.name != without]
            still = self.rates.still(set(members), around, placed)
            if len(still) == len(members):
                break
            members = [link for link in members if link in still]
        return members

    def split(self, links: Sequence[str], placed: Collection[str]) -> Iterator[list[str]]:
        """A determined set in smallest ones, each after those that it needs."""
        rest, inside = list(links), set(placed)
        while rest:
            some = self._small(rest, inside) or self._least(rest, inside)
            if len(some) < len(rest) and len(some) > 2:
                yield from self.split(some, inside)
            else:
                yield some
            inside.update(some)
            rest = [link for link in rest if link not in some]

    def _small(self, links: Sequence[str], placed: Collection[str]) -> list[str]:
        """The first determined link or pair of joined links."""
        rank = {link: k for k, link in enumerate(links)}
        pairs = (
            [link, other]
            for link in links
            for other in dict.fromkeys(self.connections[k].other(link) for k in self.at[link])
            if rank.get(other, -1) > rank[link]
        )
        for some in (*([link] for link in links), *pairs):
            if self._is_determined(some, placed):
                return some
        return []

    def _is_determined(self, links: Sequence[str], placed: Collection[str]) -> bool:
        """Whether some links are determined; tried again only where more of their connections
        lead to what is placed."""
        inside = [c for c in self.around(links) if joins(c, links, placed)]
        joints = [c for c in inside if c.has_coordinates]
        freedoms = sum(c.freedoms - c.driven for c in joints)
        most = SPACE * (len(joints) - len(links)) + len(inside) - len(joints)
        if freedoms > most or self._failed.get(tuple(links)) == len(inside):
            return False
        if len(self.rates.still(links, inside, placed)) == len(links):
            return True
        self._failed[tuple(links)] = len(inside)
        return False

    def _least(self, links: Sequence[str], placed: Collection[str]) -> list[str]:
        """The smallest determined set that is left when one link is taken away; all links where
        none is."""
        least = list(links)
        if len(links) <= MOST_SPLIT_LINKS:
            for link in reversed(links):
                own = self.core([other for other in links if other != link], placed)
                if own and len(own) < len(least):
                    least = own
        return least

    def around(self, links: Sequence[str]) -> list[Connection]:
        """The connections at some links, in their order."""
        return [self.connections[k] for k in sorted({k for link in links for k in self.at[link]})]
