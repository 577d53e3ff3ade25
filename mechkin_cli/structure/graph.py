"""The solver graph as records: tree edges, cut joints, blocks; and the errors where there is none,
which name the joints concerned. Graphs changed: of a free motion, with other inputs, of other
dimensions.

Free motion (`charted`): a chart's equations (kernel/core/rows) take the place of the inputs,
which are solved for, too, and all loops are one block: which of them depend on which coordinate
changes along a motion, and no coordinate is to have a dead centre.

Other inputs (`exchanged`): at a dead centre of an input its rate by an unknown is zero. There the
input is no parameter of the branch, and the unknown is one.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence

from mechkin_cli.diagnostics import Diagnostic, MechkinError
from mechkin_cli.mechanism import Constraint, Joint, Mechanism, PairConstraint
from mechkin_cli.record import NamedTuple
from mechkin_cli.structure.assur import Undriven
from mechkin_cli.structure.loop_order import entries_of, in_order
from mechkin_cli.structure.network import Connection, reduce
from mechkin_cli.tolerances import MOST_BAND_EQUATIONS, MOST_EQUATIONS


class UnsolvableGraph(MechkinError):
    """The mechanism's graph cannot be solved as it is driven; `diagnostic` says why, `joints`
    where. Where too little is driven, `missing` counts the freedoms left and `candidates` are
    coordinates that could be driven."""

    def __init__(
        self,
        diagnostic: Diagnostic,
        joints: tuple[str, ...] = (),
        missing: int = 0,
        candidates: tuple[str, ...] = (),
    ) -> None:
        self.diagnostic, self.joints = diagnostic, joints
        self.missing, self.candidates = missing, candidates
        super().__init__(str(diagnostic))


class TreeEdge(NamedTuple):
    """A joint of the tree: it carries `child`; `forward` where the child is the joint's second
    link.

    The body of a constraint may be `hung`: two points place it, it has no freedom of its own.
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


Loop = tuple[tuple[int, int], ...]
"""The tree edges on the way to the second (+1) and first link (-1) of a constraint that closes a
loop, and its own slides (-1)."""


class Block(NamedTuple):
    """Cut joints (by index) that are solved together for unknown coordinates (edge,
    freedom); the last `charts` of its equations are those of a chart (`charted`)."""

    closings: tuple[int, ...]
    unknowns: tuple[tuple[int, int], ...]
    equations: int
    charts: int = 0


class SolverGraph(NamedTuple):
    """Tree edges in placing order (edge k carries link k); the constraints that close loops, in
    block order, and their loops; blocks.

    `inputs` are (edge, freedom), `driven` the same as (joint, coordinate).
    """

    edges: tuple[TreeEdge, ...]
    closings: tuple[Constraint, ...]
    loops: tuple[Loop, ...]
    blocks: tuple[Block, ...]
    inputs: tuple[tuple[int, int], ...]
    driven: tuple[tuple[str, str], ...]

    def passed(self, block: Block) -> set[int]:
        """The tree edges that a block's loops pass."""
        return {edge for c in block.closings for edge, _ in self.loops[c]}


def is_redundant(graph: SolverGraph) -> bool:
    """Whether some loop has more closing equations than unknowns (redundant constraints)."""
    return any(block.equations > len(block.unknowns) for block in graph.blocks)


MOST_NAMES = 20
"""Names in a message."""


def listed(names: Sequence[str]) -> str:
    """Names with commas, the first of them where they are many."""
    if len(names) <= MOST_NAMES:
        return ", ".join(names)
    return f"{', '.join(names[:MOST_NAMES])}, ... ({len(names)} in all)"


def no_cut_joint(name: str, joints: Sequence[str]) -> UnsolvableGraph:
    """A loop has no joint that may close it."""
    text = f"the loops of {name} cannot be closed: every loop needs a joint "
    text += "other than H that is not an input and has no spring on its angle"
    hint = "drive another coordinate, or put the spring on another joint"
    return UnsolvableGraph(Diagnostic("no-closing-joint", "error", text, hint=hint), tuple(joints))


def input_closes(name: str) -> UnsolvableGraph:
    """A loop was to be closed at an input."""
    text, hint = f"{name} is driven, so no loop can be closed there", "choose another closing joint"
    return UnsolvableGraph(Diagnostic("input-closes", "error", text, hint=hint), (name,))


def disconnected(links: Sequence[str]) -> UnsolvableGraph:
    """Links that nothing joins to ground."""
    text = f"not joined to ground, nor to a link that is: {listed(links)}"
    hint = "add a joint, or remove the link"
    return UnsolvableGraph(Diagnostic("disconnected-link", "error", text, hint=hint))


def driven_solid(connections: Iterable[Connection], equations: int) -> UnsolvableGraph:
    """A loop, or couplings, all of whose freedoms are driven."""
    connections = tuple(connections)
    joints = sorted({name for c in connections for name in c.constraint.joints})
    couplings = [c.name for c in connections if c.constraint.terms]
    text = f"nothing is left to close the loop through {listed(joints)}: "
    text += "all its other freedoms are driven"
    if couplings:
        text = f"nothing is left that {listed(couplings)} could move: "
        text += f"all freedoms of {listed(joints)} are driven"
    diagnostic = Diagnostic(
        "driven-solid",
        "error",
        text,
        measured=f"{equations} equations, no unknowns",
        hint="drive fewer coordinates",
    )
    return UnsolvableGraph(diagnostic, tuple(joints))


def undriven(
    mechanism: Mechanism, inputs: Sequence[tuple[str, str]], parts: Sequence[Undriven]
) -> UnsolvableGraph:
    """Freedoms that neither an input nor a loop determines."""
    concerned = {
        name for connections, _ in parts for c in connections for name in c.constraint.joints
    }
    joints = [joint for name, joint in mechanism.joints.items() if name in concerned]
    taken = set(inputs)
    names = [
        f"{joint.name}.{coordinate}"
        for joint in joints
        for coordinate, freedom in joint.type.freedom_of.items()
        if not any(
            (joint.name, c) in taken for c, f in joint.type.freedom_of.items() if f == freedom
        )
    ]
    names = names or [joint.name for joint in joints]
    missing = sum(number for _, number in parts)
    count = "one free coordinate is" if missing == 1 else f"{missing} free coordinates are"
    diagnostic = Diagnostic(
        "undriven-freedom",
        "error",
        f"{count} not driven; candidates: {listed(names)}",
        measured=f"{missing} more unknown{'s' * (missing > 1)} than closing equations",
        hint="add inputs under motion",
    )
    around = tuple(joint.name for joint in joints)
    return UnsolvableGraph(diagnostic, around, missing, tuple(names))


def structure_of(graph: SolverGraph) -> object:
    """What two graphs of the same structure have in common."""
    edges = tuple((edge.joint.name, edge.parent, edge.child) for edge in graph.edges)
    closings = tuple(closing.name for closing in graph.closings)
    return edges, closings, graph.loops, graph.blocks, graph.inputs


SMALL_BLOCK = 12
"""Unknowns up to which all entries of a matrix are kept, whatever their order
(kernel/core/plan/plan_blocks.cpp)."""


def neighbours_together(
    loops: Sequence[Loop], unknowns: Sequence[tuple[int, int]]
) -> tuple[list[int], tuple[tuple[int, int], ...]]:
    """Loops and unknowns (edge, freedom) in the order of their neighbourhood (`in_order`)."""
    order, columns = in_order(_unknowns_passed(loops, unknowns), len(unknowns))
    return order, tuple(unknowns[k] for k in columns)


def _unknowns_passed(loops: Sequence[Loop], unknowns: Sequence[tuple[int, int]]) -> list[list[int]]:
    """The numbers of the unknowns of each loop's joints."""
    of_edge: dict[int, list[int]] = {}
    for number, (edge, _) in enumerate(unknowns):
        of_edge.setdefault(edge, []).append(number)
    return [sorted({k for edge, _ in loop for k in of_edge.get(edge, ())}) for loop in loops]


def most_equations(graph: SolverGraph, block: Block) -> int:
    """How many closing equations a block may have: more where most of its matrix is zeros in the
    order of its loops and unknowns, so that the kernel keeps a band of it
    (kernel/core/plan/plan_blocks.cpp)."""
    if block.equations <= MOST_EQUATIONS or block.equations != len(block.unknowns):
        return MOST_EQUATIONS
    passed = _unknowns_passed([graph.loops[c] for c in block.closings], block.unknowns)
    counts = [graph.closings[c].equations for c in block.closings]
    has_band = 2 * entries_of(passed, counts, len(block.unknowns)) <= block.equations**2
    return MOST_BAND_EQUATIONS if has_band else MOST_EQUATIONS


def is_too_large(graph: SolverGraph) -> bool:
    """Whether some block has more equations than it may have."""
    return any(block.equations > most_equations(graph, block) for block in graph.blocks)


def charted(graph: SolverGraph, free: Container[tuple[str, str]]) -> SolverGraph:
    """The same tree and cut joints with the inputs `free` (joint, coordinate) undriven; the cut
    joints of many loops in the order of their neighbourhood (`in_order`)."""
    pairs = list(zip(graph.inputs, graph.driven, strict=True))
    freed = [at for at, name in pairs if name in free]
    driven = [(at, name) for at, name in pairs if name not in free]
    closings = tuple(c for block in graph.blocks for c in block.closings)
    unknowns = (*freed, *(at for block in graph.blocks for at in block.unknowns))
    equations = sum(block.equations for block in graph.blocks) + len(freed)
    inputs, names = tuple(at for at, _ in driven), tuple(name for _, name in driven)
    free_graph = graph._replace(inputs=inputs, driven=names)
    if len(unknowns) > SMALL_BLOCK:
        order, unknowns = neighbours_together([graph.loops[c] for c in closings], unknowns)
        free_graph = free_graph._replace(
            closings=tuple(graph.closings[closings[k]] for k in order),
            loops=tuple(graph.loops[closings[k]] for k in order),
        )
        closings = tuple(range(len(order)))
    block = Block(closings, unknowns, equations, len(freed))
    return free_graph._replace(blocks=(block,))


def holding(
    graph: SolverGraph,
    number: int,
    held: Sequence[tuple[int, int]],
    names: Sequence[tuple[str, str]],
) -> SolverGraph:
    """A charted graph with some of its unknowns `held` (edge, freedom), called `names` (joint,
    coordinate): inputs from `number` on, and as many equations less of the chart."""
    inputs, driven = list(graph.inputs), list(graph.driven)
    inputs[number:number] = held
    driven[number:number] = names
    blocks = []
    for block in graph.blocks:
        unknowns = tuple(at for at in block.unknowns if at not in held)
        less = len(block.unknowns) - len(unknowns)
        if unknowns:
            blocks.append(
                Block(block.closings, unknowns, block.equations - less, block.charts - less)
            )
    return graph._replace(blocks=tuple(blocks), inputs=tuple(inputs), driven=tuple(driven))


def exchanged(
    graph: SolverGraph, number: int, unknown: tuple[int, int], name: tuple[str, str]
) -> SolverGraph:
    """The same tree and cut joints, driven at an unknown (edge, freedom) in place of input
    `number`, which is solved for.

    Blocks that hang on each other by the exchange become one: those from the first whose loops the
    input moves to that of the unknown.

    Args:
        graph: as it is driven.
        number: of the input.
        unknown: of one of the blocks.
        name: its (joint, coordinate).
    """
    last = next(b for b, block in enumerate(graph.blocks) if unknown in block.unknowns)
    edge, _ = freed = graph.inputs[number]
    moved = [b for b, block in enumerate(graph.blocks[:last]) if edge in graph.passed(block)]
    first = min(moved, default=last)
    joined = graph.blocks[first : last + 1]
    unknowns = (freed, *(at for block in joined for at in block.unknowns if at != unknown))
    closings = tuple(c for block in joined for c in block.closings)
    together = Block(closings, unknowns, sum(block.equations for block in joined))
    inputs, driven = list(graph.inputs), list(graph.driven)
    inputs[number], driven[number] = unknown, name
    return graph._replace(
        blocks=(*graph.blocks[:first], together, *graph.blocks[last + 1 :]),
        inputs=tuple(inputs),
        driven=tuple(driven),
    )


def graph_of(mechanism: Mechanism, graph: SolverGraph) -> SolverGraph:
    """The graph with the joints and constraints of `mechanism` in the places of those with their
    names."""
    reduction = reduce(mechanism)
    joints = {**mechanism.joints, **reduction.joints}
    others = {c.name: c for c in reduction.constraints}

    def renewed(joint: Joint) -> Joint:
        other = joints.get(joint.name)  # the weld of a cut link has no dimensions
        return joint if other is None else other._replace(first=joint.first, second=joint.second)

    edges = tuple(edge._replace(joint=renewed(edge.joint)) for edge in graph.edges)
    closings = tuple(
        others.get(closing.name) or PairConstraint.of(renewed(closing.joint))
        for closing in graph.closings
    )
    return graph._replace(edges=edges, closings=closings)
