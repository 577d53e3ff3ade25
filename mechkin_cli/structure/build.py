"""From a mechanism and its inputs to its solver graph.

Blocks (`in_order`, `lay_blocks`) are groups with their cut joints, each after the groups that place
the links it hangs on. The tree is laid from ground (`spanning_tree`), and each cut joint makes a
loop with it (`TreePaths`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from heapq import heapify, heappop, heappush

from mechkin_cli.mechanism import GROUND_NAME, Constraint, Frame, Joint, Mechanism, PairConstraint
from mechkin_cli.structure import graph as errors
from mechkin_cli.structure.assur import assur_groups, coupled_groups
from mechkin_cli.structure.cut_joints import NothingCloses, closing_names
from mechkin_cli.structure.graph import (
    Block,
    Loop,
    SolverGraph,
    TreeEdge,
    neighbours_together,
)
from mechkin_cli.structure.matching import strong_components
from mechkin_cli.structure.network import (
    Connection,
    Reduction,
    Subgraph,
    biconnected,
    connections_of,
    couplings_of,
    cut_link,
    depths,
    incidence,
    order_of,
    reduce,
)
from mechkin_cli.structure.rank import Rates, middle_and_size
from mechkin_cli.tolerances import FULL_EQUATIONS

Freedom = tuple[int, int]

AssembledPlaces = Callable[[Mechanism, Callable[[], SolverGraph]], Iterator[Callable[[str], Frame]]]
"""Gives where the links' drawings stand, place by place."""


class NothingSolved(Exception):
    """Some connections without unknowns beside those of their cut joints.

    `loops` are the names of the joints in their loops, the cut joint first, without those that
    constraints beside the joints close.
    """

    def __init__(
        self, connections: Sequence[Connection], loops: Sequence[Sequence[str]], equations: int
    ) -> None:
        self.connections, self.loops, self.equations = tuple(connections), loops, equations
        super().__init__()


def in_order(
    groups: Sequence[Subgraph], edges: Sequence[TreeEdge], place: Mapping[str, int]
) -> list[list[Subgraph]]:
    """Groups in the order of solution; those together that the tree makes depend on each other.

    `place` numbers the closings; first comes what has fewest of them, then what is numbered first.
    """
    owner = {link: k for k, group in enumerate(groups) for link in group.links}
    ahead: list[set[int]] = [set() for _ in groups]
    for k, group in enumerate(groups):
        ends = {link for c in group.connections for link in c.ends}
        ahead[k] = {owner[link] for link in (*ends, group.entry) if link != GROUND_NAME} - {k}
    for edge in edges:
        if edge.child in owner and edge.parent in owner:
            one, other = owner[edge.child], owner[edge.parent]
            if one != other:
                ahead[one].add(other)
    parts = strong_components([sorted(some) for some in ahead], range(len(groups)))
    part_of = {k: p for p, part in enumerate(parts) for k in part}
    waits = [{part_of[o] for k in part for o in ahead[k]} - {p} for p, part in enumerate(parts)]
    behind: list[list[int]] = [[] for _ in parts]
    for p, some in enumerate(waits):
        for other in some:
            behind[other].append(p)

    def key(p: int) -> tuple[int, list[int], int]:
        names = [c.name for k in parts[p] for c in groups[k].connections]
        numbers = sorted(place[name] for name in names if name in place)
        return (len(numbers), numbers, p)

    count = [len(some) for some in waits]
    ready = [key(p) for p in range(len(parts)) if not count[p]]
    heapify(ready)
    order: list[list[Subgraph]] = []
    while ready:
        p = heappop(ready)[2]
        order.append([groups[k] for k in parts[p]])
        for other in behind[p]:
            count[other] -= 1
            if not count[other]:
                heappush(ready, key(other))
    return order


def lay_blocks(
    order: Sequence[Sequence[Subgraph]],
    edges: Sequence[TreeEdge],
    closings: Mapping[str, tuple[Constraint, Loop]],
    place: Mapping[str, int],
    driven: Sequence[Freedom],
) -> tuple[list[tuple[Constraint, Loop]], list[Block], set[Freedom]]:
    """Closings with their loops in block order, the blocks, and the freedoms that are known in the
    end.

    Raises:
        NothingSolved: a block has no unknowns.
    """
    solved = set(driven)
    laid: list[tuple[Constraint, Loop]] = []
    blocks: list[Block] = []
    carrier = {edge.child: k for k, edge in enumerate(edges)}
    unplaced: set[int] = set()  # tree edges that the loops of a later part place

    def passed(part: Sequence[Subgraph]) -> set[int]:
        names = [c.name for group in part for c in group.connections if c.name in closings]
        return {k for name in names for k, _ in closings[name][1]}

    def hangs(part: Sequence[Subgraph]) -> bool:
        own = passed(part)
        return not unplaced.isdisjoint(_carrying(edges, own) - own)

    waiting = list(order)
    while waiting:
        # what hangs on such an edge waits for it
        ready = (k for k, one in enumerate(waiting) if not unplaced or not hangs(one))
        part = waiting.pop(next(ready, 0))
        connections = [c for group in part for c in group.connections]
        names = sorted((c.name for c in connections if c.name in closings), key=place.__getitem__)
        if not names:
            links = [link for group in part for link in group.links if link in carrier]
            unplaced |= {
                k
                for k in (carrier[link] for link in links)
                if any((k, f) not in solved for f in range(edges[k].freedoms))
            }
            continue
        some = [closings[name] for name in names]
        members = sorted(passed(part))
        unplaced -= set(members)
        freedoms = [(k, f) for k in members for f in range(edges[k].freedoms)]
        unknowns = tuple(freedom for freedom in freedoms if freedom not in solved)
        equations = sum(closing.equations for closing, _ in some)
        if not unknowns:
            loops = [
                [closing.name, *(edges[k].joint.name for k, _ in loop)]
                for closing, loop in some
                if closing.has_coordinates
            ]
            raise NothingSolved(connections, loops, equations)
        solved.update(unknowns)
        for own, freed in _with_couplings_apart(some, unknowns, edges):
            start = len(laid)
            if len(freed) > FULL_EQUATIONS:
                together, freed = neighbours_together([loop for _, loop in own], freed)
                own = [own[k] for k in together]
            laid.extend(own)
            count = sum(closing.equations for closing, _ in own)
            blocks.append(Block(tuple(range(start, len(laid))), freed, count))
    return laid, blocks, solved


_Part = tuple[list[tuple[Constraint, Loop]], tuple[Freedom, ...]]
"""Closings that are solved together, and for which freedoms."""


def _with_couplings_apart(
    closings: Sequence[tuple[Constraint, Loop]],
    unknowns: tuple[Freedom, ...],
    edges: Sequence[TreeEdge],
) -> list[_Part]:
    """The closings in parts, one after the other: a coupling that has one unknown left comes before
    what goes by that, and one with an unknown that nothing else has comes behind.

    What is left over is as regular as the whole, since the factor of that unknown is not zero. A
    joint is placed where all its freedoms and those of the joints that carry it are known.
    """
    left, open_ = list(closings), set(unknowns)
    if sum(closing.equations for closing, _ in left) != len(open_):
        return [(left, unknowns)]
    of = {closing.name: _freedoms_of(closing, loop, edges) for closing, loop in left}
    ahead: list[_Part] = []
    behind: list[_Part] = []

    def take(one: tuple[Constraint, Loop], own: Freedom, parts: list[_Part]) -> None:
        parts.append(([one], (own,)))
        left.remove(one)
        open_.remove(own)

    moved = True
    while moved:
        moved = False
        for one in [each for each in left if each[0].terms]:
            name = one[0].name
            own = of[name] & open_
            used = {k for c, loop in left if c.name != name for k, _ in loop}
            standing = {k for k, _ in one[1]} | _carrying(edges, (k for k, _ in one[1]))
            alone = [(k, f) for k, f in sorted(own) if k not in used | _carrying(edges, used)]
            # what hangs between two points waits for both of them
            hangs = any(edges[k].hung for k in standing)
            if len(own) == 1 and not hangs and own == {(k, f) for k, f in open_ if k in standing}:
                take(one, own.pop(), ahead)
            elif alone and len([1 for k, _ in open_ if k == alone[0][0]]) == 1:
                take(one, alone[0], behind)
            else:
                continue
            moved = True
    rest = tuple(freedom for freedom in unknowns if freedom in open_)
    return [*ahead, *([(left, rest)] if left else []), *reversed(behind)]


def _freedoms_of(constraint: Constraint, loop: Loop, edges: Sequence[TreeEdge]) -> set[Freedom]:
    """The freedoms (tree edge, number) that the equations of a constraint are between."""
    if not constraint.terms:
        return {(k, f) for k, _ in loop for f in range(edges[k].freedoms)}
    number = {edges[k].joint.name: k for k, _ in loop}
    places = [(number[term.joint.name], term.coordinate) for term in constraint.terms]
    return {(k, edges[k].joint.freedom_number(coordinate)) for k, coordinate in places}


def _carrying(edges: Sequence[TreeEdge], some: Iterable[int]) -> set[int]:
    """The tree edges that carry some edges."""
    carrier = {edge.child: k for k, edge in enumerate(edges)}
    found: set[int] = set()
    for k in some:
        link = edges[k].parent
        while link in carrier and carrier[link] not in found:
            found.add(carrier[link])
            link = edges[carrier[link]].parent
    return found


def spanning_tree(whole: Reduction, closing: Iterable[str]) -> list[TreeEdge] | None:
    """Edges from ground outward, breadth first, own links of constraints last; None if no tree is
    left."""
    names = set(closing)
    free = [joint for name, joint in whole.joints.items() if name not in names]
    at: dict[str, list[Joint]] = {}
    for joint in free:
        at.setdefault(joint.first, []).append(joint)
        at.setdefault(joint.second, []).append(joint)
    reached = {GROUND_NAME}
    edges: list[TreeEdge] = []
    front = [GROUND_NAME]
    for link in front:
        for joint in at.get(link, ()):
            other = joint.second if link == joint.first else joint.first
            if other not in reached:
                reached.add(other)
                edges.append(TreeEdge(joint, link, other))
                front.append(other)
    if len(edges) != len(free) or len(reached) != len(whole.links) + 1:
        return None
    for constraint in whole.constraints:
        edges += [TreeEdge(*edge) for edge in constraint.own_edges]
    return edges


class TreePaths:
    """Paths through a tree."""

    def __init__(self, edges: Sequence[TreeEdge]) -> None:
        self.edges = edges
        self.carrier = {edge.child: k for k, edge in enumerate(edges)}
        self.depth = {GROUND_NAME: 0}
        for edge in edges:
            self.depth[edge.child] = self.depth[edge.parent] + 1
        self.number = {edge.joint.name: k for k, edge in enumerate(edges) if not edge.hung}

    def loop(self, constraint: Constraint) -> Loop:
        """The loop that a constraint closes, or the joints that it is between."""
        if constraint.terms:
            own = dict.fromkeys(self.number[term.joint.name] for term in constraint.terms)
            return tuple((k, 1 if self.edges[k].forward else -1) for k in own)
        slides = [(self.number[slide.name], -1) for slide in constraint.slides]
        return (*self._between(constraint.first, constraint.second), *slides)

    def _between(self, one: str, other: str) -> Loop:
        """Edges from where the paths part to the other link (+1), then to the one (-1)."""
        first: list[tuple[int, int]] = []
        second: list[tuple[int, int]] = []
        while one != other:
            if self.depth[one] >= self.depth[other]:
                first.append((self.carrier[one], -1))
                one = self.edges[self.carrier[one]].parent
            else:
                second.append((self.carrier[other], 1))
                other = self.edges[self.carrier[other]].parent
        return (*reversed(second), *reversed(first))


def build_graph(
    mechanism: Mechanism,
    inputs: Sequence[tuple[str, str]],
    assembled_places: AssembledPlaces,
    closed_at: Sequence[str] | None = None,
) -> SolverGraph:
    """The solver graph of a mechanism whose `inputs` (joint, coordinate) are driven.

    `closed_at` forces the cut joints (one per independent loop). `assembled_places` gives places to
    take ranks at, from the mechanism and a graph that closes all loops of a component at once.

    Raises:
        UnsolvableGraph: links not connected to ground, no joint to close a loop at, undriven or
            overconstrained loops.
    """

    def assembled() -> Iterator[Rates]:
        joints = mechanism.joints
        driven = {(name, joints[name].freedom_number(c)) for name, c in inputs}
        middle, size = middle_and_size(mechanism)
        for poses in assembled_places(mechanism, lambda: _built(mechanism, inputs, None, ())):
            yield Rates(poses, driven, middle, size)

    return _built(mechanism, inputs, closed_at, _Remembered(assembled()))


class _Remembered:
    """Rates that are computed once, each when it is first needed."""

    def __init__(self, rates: Iterator[Rates]) -> None:
        self._ahead, self._known = rates, list[Rates]()

    def __iter__(self) -> Iterator[Rates]:
        yield from self._known
        for rates in self._ahead:
            self._known.append(rates)
            yield rates


def _built(
    mechanism: Mechanism,
    inputs: Sequence[tuple[str, str]],
    closed_at: Sequence[str] | None,
    places: Iterable[Rates],
) -> SolverGraph:
    """As `build_graph`; without places whatever has too many equations is one block."""
    whole = reduce(mechanism)
    while True:
        connections = connections_of(mechanism, whole, inputs)
        groups = _groups(mechanism, whole, connections, inputs, places)
        try:
            names = closing_names(whole, groups) if closed_at is None else list(closed_at)
            return _laid(mechanism, whole, groups, names, inputs)
        except NothingCloses as loop:
            whole = _cut(mechanism, whole, connections, loop.connections)
        except NothingSolved as block:
            if closed_at is not None:
                raise errors.driven_solid(block.connections, block.equations) from None
            whole = _cut(mechanism, whole, connections, _carried_loop(block, connections))


def _groups(
    mechanism: Mechanism,
    whole: Reduction,
    connections: Sequence[Connection],
    inputs: Sequence[tuple[str, str]],
    places: Iterable[Rates],
) -> list[Subgraph]:
    """The Assur groups of all components, each after those that it hangs on, with the couplings
    that drive them."""
    components = biconnected(connections, incidence(connections), GROUND_NAME)
    reached = {link for component in components for link in component.links}
    if apart := [link for link in whole.links if link not in reached]:
        raise errors.disconnected(apart)
    found = [assur_groups(component, places) for component in components]
    groups, loose = coupled_groups(components, found, couplings_of(whole, connections))
    if loose:
        raise errors.undriven(mechanism, inputs, loose)
    return groups


def _carried_loop(block: NothingSolved, connections: Sequence[Connection]) -> list[Connection]:
    """A loop that its cut joint alone would have to follow, with that joint as an unknown.

    Raises:
        UnsolvableGraph: a cut joint does not follow the inputs as they are drawn, or there is
            none.
    """
    named = {c.name: c for c in connections}
    first: list[Connection] = []
    for names in block.loops:
        own, *around = loop = [named[name] for name in names]
        are_inputs = all(c.driven == c.freedoms for c in around)
        if are_inputs and order_of(loop) > order_of([own]):
            raise errors.driven_solid(block.connections, block.equations)
        if not first and own.freedoms:
            first = loop
    if not first:
        raise errors.driven_solid(block.connections, block.equations)
    return first


def _cut(
    mechanism: Mechanism,
    whole: Reduction,
    connections: Sequence[Connection],
    loop: Sequence[Connection],
) -> Reduction:
    """With the link of the loop that is farthest from ground cut in two halves."""
    members = {c.name for c in loop}
    names = [name for name in whole.joints if name in members]
    ends = [link for c in loop for link in (c.first, c.second)]
    inside = [link for link in whole.links if ends.count(link) == 2]
    if not inside:
        raise errors.no_cut_joint(mechanism.name, names)
    away = depths(connections, {GROUND_NAME: 0})
    return cut_link(whole, max(inside, key=away.__getitem__), names)


def _laid(
    mechanism: Mechanism,
    whole: Reduction,
    groups: Sequence[Subgraph],
    names: Sequence[str],
    inputs: Sequence[tuple[str, str]],
) -> SolverGraph:
    """Tree, closings and blocks for chosen cut joints."""
    names = [name for name in names if name in whole.joints]
    edges = spanning_tree(whole, names)
    if edges is None:
        raise errors.no_cut_joint(mechanism.name, tuple(mechanism.joints))
    paths = TreePaths(edges)
    driven = []
    for name, coordinate in inputs:
        if name not in paths.number:
            raise errors.input_closes(name)
        k = paths.number[name]
        driven.append((k, edges[k].joint.freedom_number(coordinate)))
    constraints = [PairConstraint.of(whole.joints[name]) for name in names]
    closings = {c.name: (c, paths.loop(c)) for c in (*constraints, *whole.constraints)}
    place = {name: k for k, name in enumerate(closings)}
    order = in_order(groups, edges, place)
    laid, blocks, solved = lay_blocks(order, edges, closings, place, driven)
    everything = {(k, f) for k, e in enumerate(edges) for f in range(e.freedoms)}
    short = any(len(block.unknowns) > block.equations for block in blocks)
    unknown = everything - solved
    if short or unknown:
        # freedoms on no loop's path
        on_none = {edges[k].joint.name for k, _ in unknown}
        members = [c for group in groups for c in group.connections]
        concerned = tuple(c for c in members if c.name in on_none) or tuple(members)
        raise errors.undriven(mechanism, inputs, [(concerned, max(1, len(unknown)))])
    cuts, loops = tuple(c for c, _ in laid), tuple(loop for _, loop in laid)
    return SolverGraph(tuple(edges), cuts, loops, tuple(blocks), tuple(driven), tuple(inputs))
