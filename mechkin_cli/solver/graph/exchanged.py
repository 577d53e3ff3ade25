"""The solver graph in which an unknown drives the mechanism in place of an input.

At a dead centre of the input its rate by the unknown is zero: there the input is no parameter of
the branch, and the unknown is one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.solver.graph.records import Block, SolverGraph

if TYPE_CHECKING:
    from mechkin_cli.solver.graph.blocks import Freedom


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
        if any(edge == on_way for c in block.closings for on_way, _ in graph.closings[c].loop)
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
