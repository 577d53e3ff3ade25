"""Limits on a well-formed file: equations of one block, and how small a mechanism may be.

A file within all limits of the reader can still ask for more than a machine has: the work grows
with the cube of the equations that must be solved together. And it can be drawn so small that
what is divided by its size squared, such as inertias, is no number any more.
"""

from __future__ import annotations

from math import inf

from mechkin_cli.building.fields import Fields
from mechkin_cli.diagnostics import Number
from mechkin_cli.mechanism.model import Mechanism
from mechkin_cli.solver.graph import SolverGraph
from mechkin_cli.solver.graph.errors import listed
from mechkin_cli.tolerances import MOST_EQUATIONS, SMALLEST_SIZE


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


def check_size(fields: Fields, mechanism: Mechanism) -> bool:
    """Whether the mechanism as drawn is large enough to compute with; if not, that is noted."""
    size = mechanism.box_diagonal()
    if SMALLEST_SIZE <= size < inf:
        return True
    size = 0.0 if size == inf else size  # of numbers whose inverses overflow
    fields.error(
        "too-small",
        ("joints",),
        "the mechanism as drawn is too small to compute with",
        "check exponents and units of its lengths",
        measured=f"all joints within {size:.4g} m",
        limit=f"{SMALLEST_SIZE:g} m",
        numbers=(Number("size", size, "m", limit=SMALLEST_SIZE),),
    )
    return False
