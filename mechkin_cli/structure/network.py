"""The mechanism as a network: links are vertices, every joint and constraint is a connection.

Independent of any tree. A constraint without coordinates is an edge between the links
that it joins.

Components (`biconnected`) are the parts of the network whose loops share connections: loops of
different components have none in common, so each component is solved by itself, against the link at
which it hangs (Hopcroft, Tarjan 1973, Algorithm 447; linear).

The order of a loop (`loop_order`) is the rank of all its joints' screws as drawn: six in general,
three in a plane or about a point. Less the cut joint's freedoms it is the number of closing
equations that determine something: a plane loop that is closed at an R has five equations, of which
two determine unknowns; the other three hold by its dimensions.

Regions (`find_regions`) are joints whose screws span less than those of their component. Links of a
plane linkage in space have three freedoms against each other, not six, and each of its joints that
many equations less; likewise about a point, without turning, in Bennett's loop. Where such a region
is only a part of a component, its links share the pose of its frame (the plane), and have the
freedoms of its order beside it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterable, Mapping, Sequence
from functools import lru_cache

from mechkin_cli.exact import part
from mechkin_cli.mechanism import (
    FREE,
    GROUND,
    GROUND_NAME,
    ZERO,
    Constraint,
    Joint,
    Mechanism,
    PairConstraint,
    Part,
    Vector,
    add,
    diagonal,
    frame_about,
    is_angle,
    scale,
    upright,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.tolerances import LOOP_RANK

# What the spanning tree is laid through: a mechanism of joints alone, every body within reach.
#
# The joints and links of a constraint leave it. A body that only constraints hold hangs from ground
# by a free pair of six unknowns. A loop without a joint to close it at, or whose cut joint has
# all its unknowns, is closed through a link: the link is cut in two halves that a weld joins
# (docs/numerics.md, Closing joints).

HALF = " (cut)"
"""Ends the name of the second half of a cut link; a name as written has no such end."""


class Reduction(NamedTuple):
    """Joints by name and moving links of the tree and its cut joints, and the constraints
    beside them; joints in loops that are `cut` close none."""

    joints: Mapping[str, Joint]
    links: tuple[str, ...]
    constraints: tuple[Constraint, ...]
    cut: frozenset[str] = frozenset()

    @property
    def loops(self) -> int:
        """Joints that close loops."""
        return len(self.joints) - len(self.links)


def reduce(mechanism: Mechanism) -> Reduction:
    """The mechanism of joints alone, with free pairs for what only other constraints hold."""
    constraints = mechanism.constraints
    inside = {name for c in constraints for name in c.joints}
    bodies = {name for c in constraints for name in c.links}
    links = tuple(n for n in mechanism.links if n != GROUND_NAME and n not in bodies)
    joints = {name: joint for name, joint in mechanism.joints.items() if name not in inside}
    held: dict[str, list[Vector]] = {}
    for constraint in constraints:
        for link, point in constraint.points:
            held.setdefault(link, []).append(point)
    at: dict[str, list[str]] = {}
    for joint in joints.values():
        at.setdefault(joint.first, []).append(joint.second)
        at.setdefault(joint.second, []).append(joint.first)
    reached = {GROUND_NAME}
    _reach(at, reached, GROUND_NAME)
    # of bodies that joints hold together the one that most of them hold
    for body in sorted(held, key=lambda link: -len(held[link])):
        if body not in reached:
            joints[f"{body} (free)"] = _free_pair(body, held[body])
            _reach(at, reached, body)
    return Reduction(joints, links, constraints)


def cut_link(reduction: Reduction, link: str, loop: Sequence[str]) -> Reduction:
    """The same with a link cut in two halves between its joints in a loop."""
    own = [
        reduction.joints[name]
        for name in loop
        if link in (reduction.joints[name].first, reduction.joints[name].second)
    ]
    joints = dict(reduction.joints)
    half = link + HALF
    while half in joints:  # a link may be cut in several loops
        half += HALF
    last = own[-1]
    on_half = last._replace(first=half) if last.first == link else last._replace(second=half)
    joints[last.name] = on_half
    parts = (Part("W", GROUND, GROUND),)
    joints[half] = Joint(half, "W", link, half, GROUND, GROUND, parts, plane=last.plane)
    return reduction._replace(
        joints=joints, links=(*reduction.links, half), cut=reduction.cut.union(loop)
    )


def whole_link(link: str) -> str:
    """The link of which one is a half, however often it is cut, or itself."""
    while link.endswith(HALF):
        link = link.removesuffix(HALF)
    return link


def _reach(at: Mapping[str, list[str]], reached: set[str], start: str) -> None:
    """Adds to the reached links those that joints lead to from one more."""
    reached.add(start)
    front = [start]
    for link in front:
        for other in at.get(link, ()):
            if other not in reached:
                reached.add(other)
                front.append(other)


def _free_pair(body: str, points: list[Vector]) -> Joint:
    """Slides along the ground's axes, then turns about the middle of its points."""
    total = ZERO
    for point in points:
        total = add(total, point)
    middle = scale(part(len(points)), total)
    still = upright(middle)
    axes = ((GROUND.x, GROUND.y), (GROUND.y, GROUND.z), (GROUND.z, GROUND.x))
    slides = [frame_about(axis, x, middle) for axis, x in axes]
    parts = (*(Part("P", frame, frame) for frame in slides), Part("S", still, still))
    return Joint(f"{body} (free)", FREE.letter, GROUND_NAME, body, still, still, parts)


class Connection(NamedTuple):
    """A joint or another constraint between two links, or one between joints, which is no edge.

    `driven` counts its driven freedoms (of its slides, where it has no others); `stays` says that
    no loop may be closed at it; `others` are further links of the joints that it is between.
    """

    name: str
    first: str
    second: str
    constraint: Constraint
    driven: int = 0
    stays: bool = False
    others: tuple[str, ...] = ()

    @property
    def ends(self) -> tuple[str, ...]:
        """The links that have to be placed for its equations."""
        return self.first, self.second, *self.others

    @property
    def joint(self) -> Joint:
        """The joint whose name it has."""
        return self.constraint.joint

    @property
    def freedoms(self) -> int:
        """Freedoms between the two links, those of its own slides included."""
        return self.constraint.freedoms

    @property
    def equations(self) -> int:
        """Closing equations."""
        return self.constraint.equations

    @property
    def has_coordinates(self) -> bool:
        """Whether a tree may go through it."""
        return self.constraint.has_coordinates

    @property
    def own_unknowns(self) -> int:
        """Freedoms of its own slides that are not driven: its equations only place these."""
        return max(0, len(self.constraint.slides) - self.driven)

    @property
    def space(self) -> int:
        """Freedoms of a free body where it works: six, or three in a plane."""
        return self.constraint.space

    @property
    def has_screws(self) -> bool:
        """Whether its freedoms are screws of a joint that holds something."""
        return self.has_coordinates and not self.joint.type.is_free

    def other(self, link: str) -> str:
        """The link at the other end."""
        return self.second if link == self.first else self.first


def connections_of(
    mechanism: Mechanism, whole: Reduction, inputs: Sequence[tuple[str, str]]
) -> list[Connection]:
    """The joints in the order written, then the other constraints between links.

    Inputs stay in the tree, and springs whose angle goes beyond half a turn, which a cut joint
    does not count; so do joints that couplings are between, or limits hold at rest, which need
    their coordinates; H and free pairs, which close no loop; and joints of loops that are cut.
    """
    driven = Counter(joint for joint, _ in inputs)
    sprung = {
        load.acts_at[0]
        for load in mechanism.loads
        if load.has_potential and load.acts_at and is_angle(load.acts_at[1])
    }
    related = {term.joint.name for c in whole.constraints for term in c.terms}
    stay = driven.keys() | sprung | related | mechanism.kept | whole.cut
    found = [
        Connection(
            name,
            joint.first,
            joint.second,
            PairConstraint.of(joint),
            driven[name],
            name in stay or not joint.type.equations,
        )
        for name, joint in whole.joints.items()
    ]
    for c in whole.constraints:
        if c.terms:
            continue
        count = sum(driven[slide.name] for slide in c.slides)
        found.append(Connection(c.name, c.first, c.second, c, count, True))
    return found


def couplings_of(whole: Reduction, connections: Iterable[Connection]) -> list[Connection]:
    """The constraints between joints anywhere, each with the links of these."""
    ends = {name: c.ends for c in connections for name in c.constraint.joints}
    found = []
    for c in whole.constraints:
        links = dict.fromkeys(link for term in c.terms for link in ends[term.joint.name])
        if links:
            first, second, *others = links
            found.append(Connection(c.name, first, second, c, 0, True, tuple(others)))
    return found


def incidence(connections: Sequence[Connection]) -> dict[str, list[int]]:
    """Numbers of the connections at each link, in their order."""
    at: dict[str, list[int]] = {}
    for number, c in enumerate(connections):
        at.setdefault(c.first, []).append(number)
        at.setdefault(c.second, []).append(number)
    return at


def depths(connections: Sequence[Connection], known: Mapping[str, int]) -> dict[str, int]:
    """Number of connections from ground to each link at some connections that is reached from
    those whose number is known."""
    depth = {
        link: known[link] for c in connections for link in (c.first, c.second) if link in known
    }
    for link, before in outward(connections, known).items():
        depth[link] = depth[before] + 1
    return depth


def outward(connections: Sequence[Connection], known: Container[str]) -> dict[str, str]:
    """The link from which each link at some connections is reached, breadth first from those that
    are known."""
    ends: dict[str, list[str]] = {}
    for c in connections:
        ends.setdefault(c.first, []).append(c.second)
        ends.setdefault(c.second, []).append(c.first)
    front = [link for link in ends if link in known]
    seen = set(front)
    before: dict[str, str] = {}
    for link in front:
        for other in ends[link]:
            if other not in seen:
                seen.add(other)
                before[other] = link
                front.append(other)
    return before


class Subgraph(NamedTuple):
    """Links, and the connections that hold them to each other and to the link `entry`, in order: a
    component, or an Assur group, whose links are placed together by its connections; `entry` is
    the component's link nearest to ground."""

    entry: str
    links: tuple[str, ...]
    connections: tuple[Connection, ...]

    @classmethod
    def of(cls, entry: str, connections: tuple[Connection, ...]) -> Subgraph:
        """That of connections: with all links at their ends."""
        ends = (link for c in connections for link in (c.first, c.second))
        links = tuple(link for link in dict.fromkeys(ends) if link != entry)
        return cls(entry, links, connections)

    @property
    def space(self) -> int:
        """Freedoms of a free body of it: six, or three in a plane."""
        return min(c.space for c in self.connections)

    @property
    def loops(self) -> int:
        """Independent loops."""
        return len(self.connections) - len(self.links)


def biconnected(
    connections: Sequence[Connection], at: dict[str, list[int]], root: str
) -> list[Subgraph]:
    """The components of what is joined to the root; each after the one that holds its entry."""
    depth = {root: 0}
    low = {root: 0}
    walked: list[int] = []
    used: set[int] = set()
    components: list[Subgraph] = []
    path = [(root, iter(at.get(root, ())), 0)]
    while path:
        link, ahead, start = path[-1]
        for number in ahead:
            if number in used:
                continue
            used.add(number)
            walked.append(number)
            other = connections[number].other(link)
            if other in depth:
                low[link] = min(low[link], depth[other])
                continue
            depth[other] = low[other] = len(path)
            path.append((other, iter(at[other]), len(walked) - 1))
            break
        else:
            path.pop()
            if path:
                parent = path[-1][0]
                low[parent] = min(low[parent], low[link])
                if low[link] >= depth[parent]:
                    members = tuple(connections[k] for k in sorted(walked[start:]))
                    components.append(Subgraph.of(parent, members))
                    del walked[start:]
    return components[::-1]


@lru_cache(maxsize=1024)
def loop_order(joints: tuple[Joint, ...]) -> int:
    """Rank of the screws of a loop's joints as drawn, moments in parts of the loop's size."""
    length = diagonal([f.o for joint in joints for f in (joint.on_first, joint.on_second)])
    rows: list[list[float]] = []
    for joint in joints:
        for angular, linear in joint.screws:
            # the moment of a turn in parts of the size, a slide as it is
            unit = 1.0 if angular == ZERO else length
            rows.append([*angular, *(component / unit for component in linear)])
    order = 0
    for column in range(6):
        best = max(range(order, len(rows)), key=lambda i: abs(rows[i][column]), default=None)
        if best is None or abs(rows[best][column]) <= LOOP_RANK:
            continue
        rows[order], rows[best] = rows[best], rows[order]
        pivot = rows[order]
        for row in rows[order + 1 :]:
            factor = row[column] / pivot[column]
            for i in range(column, 6):
                row[i] -= factor * pivot[i]
        order += 1
    return order


SPACE = 6
"""Freedoms of a body in space."""


class Region(NamedTuple):
    """Numbers of the connections of a region in its component, its links, and its order."""

    connections: frozenset[int]
    links: frozenset[str]
    order: int


def order_of(connections: Iterable[Connection]) -> int:
    """Rank of the screws of some connections; six where not all have screws."""
    members = tuple(connections)
    if not all(c.has_screws for c in members):
        return SPACE
    return loop_order(tuple(sorted(c.joint for c in members)))


def find_regions(component: Subgraph, order: int) -> list[Region]:
    """The regions of lower order than the component's, the lowest first."""
    connections = component.connections
    at = incidence(connections)
    cycles = {
        cycle
        for one, other in _neighbours(connections, at)
        if (cycle := _shortest(connections, at, one, other))
    }
    seeds = [
        (rank, sorted(cycle))
        for cycle in cycles
        if (rank := order_of(connections[k] for k in cycle)) < order
    ]
    if not seeds:
        return []
    merged = _merged(connections, sorted(seeds))
    regions = [_grown(connections, at, numbers, rank) for rank, numbers in merged]
    return sorted(regions, key=lambda region: (region.order, -len(region.connections)))


def _neighbours(
    connections: Sequence[Connection], at: dict[str, list[int]]
) -> list[tuple[int, int]]:
    """Pairs of joints on a link, of each joint's two links that with fewer joints."""
    pairs: set[tuple[int, int]] = set()
    for number, c in enumerate(connections):
        fewest = min(len(at[c.first]), len(at[c.second]))
        for link in (c.first, c.second):
            if len(at[link]) == fewest:
                pairs |= {(min(number, k), max(number, k)) for k in at[link] if k != number}
    screws = [c.has_screws for c in connections]
    return sorted(pair for pair in pairs if screws[pair[0]] and screws[pair[1]])


def _shortest(
    connections: Sequence[Connection], at: dict[str, list[int]], one: int, other: int
) -> frozenset[int] | None:
    """A shortest loop of joints through two on one link, None where there is none."""
    pair = (connections[one], connections[other])
    link = next(end for end in (pair[0].first, pair[0].second) if end in pair[1][1:3])
    start, goal = pair[0].other(link), pair[1].other(link)
    came = {start: (start, one), link: (link, one)}
    front = [start]
    for near in front:
        if near == goal:
            cycle = [one, other]
            while near != start:
                near, k = came[near]
                cycle.append(k)
            return frozenset(cycle)
        for k in at[near]:
            far = connections[k].other(near)
            if far not in came and connections[k].has_screws:
                came[far] = (near, k)
                front.append(far)
    return None


def _merged(
    connections: Sequence[Connection], seeds: Sequence[tuple[int, list[int]]]
) -> list[tuple[int, set[int]]]:
    """Loops of one order that share a joint and span nothing more together, as one region."""
    regions: list[tuple[int, set[int], tuple[int, ...]] | None] = []
    owners: dict[int, list[int]] = {}
    for rank, cycle in seeds:
        members, base = set(cycle), _base(connections, cycle, rank)
        near = {r for k in cycle for r in owners.get(k, ())}
        for r in sorted(near):
            other = regions[r]
            if other is None or other[0] != rank:
                continue
            both = {*base, *other[2]}
            if order_of(connections[k] for k in both) == rank:
                members |= other[1]
                regions[r] = None
        for k in members:
            owners.setdefault(k, []).append(len(regions))
        regions.append((rank, members, base))
    return [(region[0], region[1]) for region in regions if region is not None]


def _base(connections: Sequence[Connection], cycle: Sequence[int], rank: int) -> tuple[int, ...]:
    """The first joints of a loop that span what all of them do."""
    for count in range(1, len(cycle)):
        if order_of(connections[k] for k in cycle[:count]) == rank:
            return tuple(cycle[:count])
    return tuple(cycle)


def _grown(
    connections: Sequence[Connection], at: dict[str, list[int]], numbers: set[int], rank: int
) -> Region:
    """With the joints between links of the region that span nothing more."""
    links = {link for k in numbers for link in (connections[k].first, connections[k].second)}
    base = _base(connections, sorted(numbers), rank)
    inside = {k for link in links for k in at[link]} - numbers
    more = {
        k
        for k in inside
        if connections[k].first in links
        and connections[k].second in links
        and connections[k].has_screws
        and order_of(connections[b] for b in (*base, k)) == rank
    }
    return Region(frozenset(numbers | more), frozenset(links), rank)
