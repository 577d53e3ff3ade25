"""Proven numbers of assemblies of a loop at fixed inputs, by its pairs alone.

What is left of a loop when its inputs are fixed closes in six freedoms: turns R, slides P, and at
most one sphere S (C is R P, U is R R, E is P P R, Sp is S P P, Sg is S P; a driven freedom is
gone). The order does not matter. The bounds hold where the assemblies are isolated.

- one S and three others (Pieper 1968): the centre's curve on one link, a line or a circle, meets
  its surface on the other. Line and plane 1; with one turn circle and plane, or line and quadric,
  2; with two circle and quadric, or line and torus, 4; circle and torus 4, since four of their
  eight intersections lie on the circle at infinity.
- no S (Raghavan, Roth 1993; Lee, Liang 1988 for 7R): 3R 3P 2, 4R 2P 8, 5R P 16, 6R 16.

- a leg and one other freedom: circle or line and sphere, 2. A body on six legs: 40 (Ronga, Vust
  1995).

Loops that are planar or spherical as they are drawn have less (`loop_count`).
"""

from __future__ import annotations

from collections import Counter

from mechkin_cli.solver.graph import Block, SolverGraph

WITH_SPHERE = {0: 1, 1: 2, 2: 4, 3: 4}
"""Bound by the number of turns beside the sphere."""

WITHOUT_SPHERE = {3: 2, 4: 8, 5: 16, 6: 16}
"""Bound by the number of turns."""


ON_SIX_LEGS = 40
"""Bound of a body that six legs hold."""


def most_of_block(graph: SolverGraph, block: Block) -> int | None:
    """The proven bound of a block at fixed inputs and upstream states, None where none is known."""
    if all(graph.closings[c].leg for c in block.closings):
        return _of_legs(graph, block)
    if len(block.closings) != 1 or block.equations != len(block.unknowns):
        return None
    freedoms = list(graph.closings[block.closings[0]].joint.type.chain)
    for number, freedom in block.unknowns:
        freedoms.append(graph.edges[number].joint.type.chain[freedom])
    found = Counter(freedom.motion for freedom in freedoms)
    turns, slides, spheres = found["turn"], found["slide"], found["ball"] // 3
    if len(freedoms) != 6 or turns + slides + 3 * spheres != 6:
        return None
    return (WITHOUT_SPHERE, WITH_SPHERE)[spheres].get(turns) if spheres <= 1 else None


def _of_legs(graph: SolverGraph, block: Block) -> int | None:
    joints = [graph.edges[number].joint for number, _ in block.unknowns]
    alone = len(joints) == len(block.closings) == 1
    if alone and [f.motion for f in joints[0].type.chain] in (["turn"], ["slide"]):
        return 2
    held = {joint.name for joint in joints}
    if len(block.closings) == 6 and len(held) == 1 and joints[0].type.is_free:
        return ON_SIX_LEGS
    return None
