"""A limit on what a well-formed file may ask for: equations of one block.

A file within all limits of the reader can still ask for more than a machine has: the work grows
with the cube of the equations that must be solved together.
"""

from __future__ import annotations

from mechkin_cli.building.fields import Fields
from mechkin_cli.diagnostics import Number
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.solver.graph.errors import listed
from mechkin_cli.tolerances import MOST_EQUATIONS


def check_blocks(fields: Fields, graph: SolverGraph) -> bool:
    """Whether every block is small enough; if not, the first that is not is noted."""
    for block in graph.blocks:
        if block.equations <= MOST_EQUATIONS:
            continue
        closings = [graph.closings[c] for c in block.closings]
        members = {graph.edges[k].joint.name for closing in closings for k, _ in closing.loop}
        joints = sorted(members | {closing.joint.name for closing in closings})
        fields.error(
            "block-too-large",
            ("joints",),
            f"{len(closings)} loops through {len(joints)} joints must be solved together: "
            f"{listed(joints)}",
            "drive a coordinate inside, or write parts that do not act on each other in files of "
            "their own",
            measured=f"{block.equations} closing equations",
            limit=f"{MOST_EQUATIONS} closing equations",
            numbers=(Number("closing equations", block.equations, limit=MOST_EQUATIONS),),
        )
        return False
    return True
