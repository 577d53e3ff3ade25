"""The solver graph of a free motion: what were its inputs is solved for, too.

A chart's equations (kernel/src/chart.hpp) take the place of the inputs, and all loops are one
block: which of them hang on which coordinate changes along a motion, and no coordinate is to have
a dead centre.
"""

from __future__ import annotations

from collections.abc import Container

from mechkin_cli.solver.graph.records import Block, SolverGraph


def charted(graph: SolverGraph, free: Container[tuple[str, str]]) -> SolverGraph:
    """The same tree and closing joints with the inputs `free` (joint, coordinate) undriven."""
    pairs = list(zip(graph.inputs, graph.driven, strict=True))
    freed = [at for at, name in pairs if name in free]
    kept = [(at, name) for at, name in pairs if name not in free]
    closings = tuple(c for block in graph.blocks for c in block.closings)
    unknowns = (*freed, *(at for block in graph.blocks for at in block.unknowns))
    equations = sum(block.equations for block in graph.blocks) + len(freed)
    block = Block(closings, unknowns, equations, len(freed))
    return graph._replace(
        blocks=(block,),
        inputs=tuple(at for at, _ in kept),
        driven=tuple(name for _, name in kept),
    )
