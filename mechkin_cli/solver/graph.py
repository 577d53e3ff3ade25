"""The solver graph: a spanning tree from ground, closing joints, and blocks in the order of
solution.

Every independent loop is closed at one joint or by one leg. Incidence is per closing joint: all its
equations together, never per scalar row, since accidental zeros change with the drawing's axes. The
tree is the one with the smallest largest block (RCSR: closed at S, 3 unknowns).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations, islice
from typing import NamedTuple

from mechkin_cli.diagnostics import Diagnostic, MechkinError
from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.mechanism.legs import Leg
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism, Spring
from mechkin_cli.solver.loop_rank import loop_order
from mechkin_cli.solver.reduction import Reduction, cut_links, reduce

MOST_TREES = 20000
"""Choices of closing joints that are compared; mechanisms with more have their first ones
compared."""


class UnsolvableGraph(MechkinError):
    """The mechanism's graph cannot be solved as it is driven; `diagnostic` says why, `joints`
    where."""

    def __init__(self, diagnostic: Diagnostic, joints: tuple[str, ...] = ()) -> None:
        self.diagnostic = diagnostic
        self.joints = joints
        super().__init__(str(diagnostic))


class TreeEdge(NamedTuple):
    """A joint of the tree: it carries `child`; `forward` where the child is the joint's second
    link.

    The body of a leg is `hung`: two points place it, it has no freedom of its own.
    """

    joint: Joint
    parent: str
    child: str
    hung: bool = False

    @property
    def forward(self) -> bool:
        """Whether the tree passes the joint from its first link to its second."""
        return self.child == self.joint.second

    @property
    def freedoms(self) -> int:
        """Unknown or driven freedoms."""
        return 0 if self.hung else self.joint.type.freedoms


class Closing(NamedTuple):
    """A closing joint; `loop` holds the tree edges on the way to its second (+1) and first link
    (-1).

    Of a leg it is the sphere at the end; the ways lead to the links that the leg joins, and its
    slide counts -1.
    """

    joint: Joint
    loop: tuple[tuple[int, int], ...]
    leg: Leg | None = None

    @property
    def equations(self) -> int:
        """Number of closing equations."""
        return 1 if self.leg else self.joint.type.equations


class Block(NamedTuple):
    """Closing joints (by index) that are solved together for unknown coordinates (edge,
    freedom)."""

    closings: tuple[int, ...]
    unknowns: tuple[tuple[int, int], ...]
    equations: int


class SolverGraph(NamedTuple):
    """Tree edges in placing order (edge k carries link k), closings in block order, blocks.

    `inputs` are (edge, freedom), `driven` the same as (joint, coordinate).
    """

    edges: tuple[TreeEdge, ...]
    closings: tuple[Closing, ...]
    blocks: tuple[Block, ...]
    inputs: tuple[tuple[int, int], ...]
    driven: tuple[tuple[str, str], ...]

    def link_index(self, link: str) -> int:
        """Number of a link, -1 for ground."""
        if link == GROUND_NAME:
            return -1
        return next(k for k, edge in enumerate(self.edges) if edge.child == link)


def is_redundant(graph: SolverGraph) -> bool:
    """Whether some loop has more closing equations than unknowns (redundant constraints)."""
    return any(block.equations > len(block.unknowns) for block in graph.blocks)


def build_graph(
    mechanism: Mechanism,
    inputs: Sequence[tuple[str, str]],
    closed_at: Sequence[str] | None = None,
) -> SolverGraph:
    """The solver graph of a mechanism whose `inputs` (joint, coordinate) are driven.

    `closed_at` forces the closing joints (one per independent loop).

    Raises:
        UnsolvableGraph: links not connected to ground, no joint to close a loop at, undriven or
            overconstrained loops.
    """
    whole = reduce(mechanism)
    kept = _kept(mechanism, inputs)
    best, problem = _best(whole, inputs, kept, closed_at)
    if best is None and problem is None and closed_at is None:
        for cut in cut_links(whole):
            graph, problem = _best(cut, inputs, kept, None)
            if graph is not None and (best is None or _cost(graph) < _cost(best)):
                best = graph
    if best is not None:
        return best
    raise problem or _no_closing_joint(mechanism)


def _best(
    whole: Reduction,
    inputs: Sequence[tuple[str, str]],
    kept: set[str],
    closed_at: Sequence[str] | None,
) -> tuple[SolverGraph | None, UnsolvableGraph | None]:
    """The graph with the smallest blocks, or why there is none."""
    best: SolverGraph | None = None
    problem: UnsolvableGraph | None = None
    for names in _choices(whole, kept, closed_at):
        edges = _spanning_tree(whole, names)
        if edges is None:
            continue
        try:
            graph = _with_blocks(whole, edges, names, inputs)
        except UnsolvableGraph as error:
            problem = problem or error
            continue
        if best is None or _cost(graph) < _cost(best):
            best = graph
    return best, problem


def _kept(mechanism: Mechanism, inputs: Sequence[tuple[str, str]]) -> set[str]:
    """Joints that must stay in the tree: inputs, and springs whose angle goes beyond half a turn,
    which a closing joint does not count."""
    return {joint for joint, _ in inputs} | {
        load.joint
        for load in mechanism.loads
        if isinstance(load, Spring) and load.joint and is_angle(load.coordinate or "")
    }


def _choices(
    whole: Reduction, kept: set[str], closed_at: Sequence[str] | None
) -> Iterator[tuple[str, ...]]:
    if closed_at is not None:
        yield tuple(name for name in closed_at if name in whole.joints)
        return
    able = [
        name for name, joint in whole.joints.items() if joint.type.equations and name not in kept
    ]
    able.sort(key=lambda name: whole.joints[name].type.equations)
    yield from islice(combinations(able, whole.loops), MOST_TREES)


def _no_closing_joint(mechanism: Mechanism) -> UnsolvableGraph:
    diagnostic = Diagnostic(
        "no-closing-joint",
        "error",
        f"the loops of {mechanism.name} cannot be closed: every loop needs a joint "
        "other than H that is not an input and has no spring on its angle",
        hint="drive another coordinate, or put the spring on another joint",
    )
    return UnsolvableGraph(diagnostic, tuple(mechanism.joints))


def _input_closes(name: str) -> UnsolvableGraph:
    diagnostic = Diagnostic(
        "input-closes",
        "error",
        f"{name} is driven, so no loop can be closed there",
        hint="choose another closing joint",
    )
    return UnsolvableGraph(diagnostic, (name,))


def _spanning_tree(whole: Reduction, closing: Iterable[str]) -> list[TreeEdge] | None:
    """Edges from ground outward, breadth first, the legs last; None if links stay unreached."""
    closing = set(closing)
    free = [joint for name, joint in whole.joints.items() if name not in closing]
    reached = {GROUND_NAME}
    edges: list[TreeEdge] = []
    front = [GROUND_NAME]
    while front:
        link = front.pop(0)
        for joint in free:
            if link == joint.first and joint.second not in reached:
                edges.append(TreeEdge(joint, link, joint.second))
            elif link == joint.second and joint.first not in reached:
                edges.append(TreeEdge(joint, link, joint.first))
            else:
                continue
            reached.add(edges[-1].child)
            front.append(edges[-1].child)
    if len(edges) != len(free) or len(reached) != len(whole.links) + 1:
        return None
    for leg in whole.legs:
        edges.append(TreeEdge(leg.start, leg.first, leg.body, hung=True))
        if leg.slide is not None and leg.rod is not None:
            edges.append(TreeEdge(leg.slide, leg.body, leg.rod))
    return edges


def _root_path(edges: Sequence[TreeEdge], link: str) -> list[int]:
    carrier = {edge.child: k for k, edge in enumerate(edges)}
    path = []
    while link != GROUND_NAME:
        path.append(carrier[link])
        link = edges[path[-1]].parent
    return path[::-1]


def _loop(edges: Sequence[TreeEdge], one: str, other: str) -> tuple[tuple[int, int], ...]:
    first, second = _root_path(edges, one), _root_path(edges, other)
    shared = 0
    while shared < min(len(first), len(second)) and first[shared] == second[shared]:
        shared += 1
    return tuple([(k, 1) for k in second[shared:]] + [(k, -1) for k in first[shared:]])


def _leg_loop(edges: Sequence[TreeEdge], leg: Leg) -> tuple[tuple[int, int], ...]:
    slides = [(k, -1) for k, edge in enumerate(edges) if edge.joint is leg.slide]
    return (*_loop(edges, leg.first, leg.second), *slides)


def _closings(whole: Reduction, edges: Sequence[TreeEdge], names: Iterable[str]) -> list[Closing]:
    joints = [whole.joints[name] for name in names]
    return [
        *(Closing(joint, _loop(edges, joint.first, joint.second)) for joint in joints),
        *(Closing(leg.end, _leg_loop(edges, leg), leg) for leg in whole.legs),
    ]


def _with_blocks(
    whole: Reduction,
    edges: list[TreeEdge],
    names: tuple[str, ...],
    inputs: Sequence[tuple[str, str]],
) -> SolverGraph:
    number = {edge.joint.name: k for k, edge in enumerate(edges)}
    driven = []
    for name, coordinate in inputs:
        if name not in number:
            raise _input_closes(name)
        driven.append((number[name], edges[number[name]].joint.type.freedom_of[coordinate]))
    closings = _closings(whole, edges, names)
    blocks: list[Block] = []
    order: list[Closing] = []
    solved = set(driven)
    left = list(closings)
    while left:
        group = _smallest_group(edges, left, solved)
        if group is None:
            raise _not_square(edges, left, solved)
        unknowns = _unknowns(edges, group, solved)
        start = len(order)
        order.extend(group)
        solved.update(unknowns)
        equations = sum(c.equations for c in group)
        blocks.append(Block(tuple(range(start, len(order))), tuple(unknowns), equations))
        left = [c for c in left if c not in group]
    everything = {(k, f) for k, e in enumerate(edges) for f in range(e.freedoms)}
    if everything - solved:
        raise _undriven(edges, sorted(everything - solved), len(everything - solved))
    return SolverGraph(tuple(edges), tuple(order), tuple(blocks), tuple(driven), tuple(inputs))


def _unknowns(
    edges: Sequence[TreeEdge], group: Iterable[Closing], solved: set[tuple[int, int]]
) -> list[tuple[int, int]]:
    members = {k for closing in group for k, _ in closing.loop}
    freedoms = [(k, f) for k in sorted(members) for f in range(edges[k].freedoms)]
    return [freedom for freedom in freedoms if freedom not in solved]


def _smallest_group(
    edges: Sequence[TreeEdge], left: Sequence[Closing], solved: set[tuple[int, int]]
) -> tuple[Closing, ...] | None:
    """The smallest group of closing joints with at least as many equations as unknowns.

    Where there are more equations (overconstrained loops) the dimensions decide whether they close;
    of the equations only those count that a loop of its order has (a plane five-bar has too many by
    number, but needs another loop to move it), unless no group is left then.
    A loop on a moving link comes after, or together with, the loops that move this link.
    """
    doubtful = None
    for size in range(1, len(left) + 1):
        for group in combinations(left, size):
            equations = sum(c.equations for c in group)
            unknowns = _unknowns(edges, group, solved)
            others = _unknowns(edges, [c for c in left if c not in group], solved)
            moves_later = set(others) - set(unknowns)
            if not 0 < len(unknowns) <= equations or moves_later & _carrying(edges, group):
                continue
            # a single loop is left to its dimensions whatever its order
            alone = len(left) == 1 or equations == len(unknowns)
            if alone or len(unknowns) <= sum(_independent(edges, c) for c in group):
                return group
            doubtful = doubtful or group
    return doubtful


def _independent(edges: Sequence[TreeEdge], closing: Closing) -> int:
    """How many of a closing joint's equations its loop's order leaves, at least one."""
    if closing.leg is not None or closing.equations == 1:
        return 1
    joints = sorted((closing.joint, *(edges[k].joint for k, _ in closing.loop)))
    order = loop_order(tuple(joints))
    return max(1, min(closing.equations, order - closing.joint.type.freedoms))


def _carrying(edges: Sequence[TreeEdge], group: Iterable[Closing]) -> set[tuple[int, int]]:
    """Freedoms of all tree joints between ground and the loops of a group, the loops included."""
    links = [link for c in group for link in (c.joint.first, c.joint.second)]
    members = {k for link in links for k in _root_path(edges, link)}
    return {(k, f) for k in members for f in range(edges[k].freedoms)}


def _not_square(
    edges: Sequence[TreeEdge], left: Sequence[Closing], solved: set[tuple[int, int]]
) -> UnsolvableGraph:
    unknowns = _unknowns(edges, left, solved)
    equations = sum(c.equations for c in left)
    if len(unknowns) > equations:
        return _undriven(edges, unknowns, len(unknowns) - equations)
    members = {edges[k].joint.name for c in left for k, _ in c.loop}
    joints = sorted(members | {c.joint.name for c in left})
    diagnostic = Diagnostic(
        "driven-solid",
        "error",
        f"nothing is left to close the loop through {', '.join(joints)}: "
        "all its other freedoms are driven",
        measured=f"{equations} equations, no unknowns",
        hint="drive fewer coordinates",
    )
    return UnsolvableGraph(diagnostic, tuple(joints))


def _undriven(
    edges: Sequence[TreeEdge], unknowns: Sequence[tuple[int, int]], missing: int
) -> UnsolvableGraph:
    names: list[str] = []
    for k, _ in unknowns:
        joint = edges[k].joint
        names.extend(name for name in joint.coordinates or (joint.name,) if name not in names)
    count = "one free coordinate is" if missing == 1 else f"{missing} free coordinates are"
    diagnostic = Diagnostic(
        "undriven-freedom",
        "error",
        f"{count} not driven; candidates: {', '.join(names)}",
        measured=f"{missing} more unknowns than closing equations",
        hint="add inputs under motion",
    )
    return UnsolvableGraph(diagnostic, tuple(edges[k].joint.name for k, _ in unknowns))


def _cost(graph: SolverGraph) -> tuple[int, int, int]:
    """Largest block, total work, and how unevenly the loops are split at their closing joints."""
    sizes = [block.equations for block in graph.blocks]
    uneven = sum(abs(sum(sign for _, sign in closing.loop)) for closing in graph.closings)
    return (max(sizes, default=0), sum(n**3 for n in sizes), uneven)
