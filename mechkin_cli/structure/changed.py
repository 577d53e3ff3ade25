"""Changed solver graphs: of a free motion, with other inputs, of other dimensions.

Free motion (`charted`): a chart's equations (kernel/core/rows) take the place of the inputs,
which are solved for, too, and all loops are one block: which of them depend on which coordinate
changes along a motion, and no coordinate is to have a dead centre.

Other inputs (`exchanged`): at a dead centre of an input its rate by an unknown is zero. There the
input is no parameter of the branch, and the unknown is one.
"""

from __future__ import annotations

from collections.abc import Container
from typing import TYPE_CHECKING

from mechkin_cli.mechanism import Joint, Mechanism, PairConstraint
from mechkin_cli.structure.graph import Block, SolverGraph
from mechkin_cli.structure.network import reduce

if TYPE_CHECKING:
    from mechkin_cli.structure.build import Freedom


def charted(graph: SolverGraph, free: Container[tuple[str, str]]) -> SolverGraph:
    """The same tree and closing joints with the inputs `free` (joint, coordinate) undriven."""
    pairs = list(zip(graph.inputs, graph.driven, strict=True))
    freed = [at for at, name in pairs if name in free]
    driven = [(at, name) for at, name in pairs if name not in free]
    closings = tuple(c for block in graph.blocks for c in block.closings)
    unknowns = (*freed, *(at for block in graph.blocks for at in block.unknowns))
    equations = sum(block.equations for block in graph.blocks) + len(freed)
    block = Block(closings, unknowns, equations, len(freed))
    inputs, names = tuple(at for at, _ in driven), tuple(name for _, name in driven)
    return graph._replace(blocks=(block,), inputs=inputs, driven=names)


def exchanged(
    graph: SolverGraph, number: int, unknown: Freedom, name: tuple[str, str]
) -> SolverGraph:
    """The same tree and closing joints, driven at an unknown (edge, freedom) in place of input
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
    moved = [
        b
        for b, block in enumerate(graph.blocks[:last])
        if any(edge == passed for c in block.closings for passed, _ in graph.closings[c].loop)
    ]
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
        closing._replace(
            constraint=others.get(closing.name) or PairConstraint.of(renewed(closing.joint))
        )
        for closing in graph.closings
    )
    return graph._replace(edges=edges, closings=closings)
