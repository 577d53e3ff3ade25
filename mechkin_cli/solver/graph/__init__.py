"""The solver graph: a spanning tree from ground, closing joints, and blocks in the order of
solution.

By structure: biconnected components (components.py), in each the Assur groups by matching
(assur.py) and, where that counts too many equations, by rank (determined.py), in each group the
closing joints (trees.py), over all the order (blocks.py). Neither the order nor the names in which
a mechanism is written change verdict or blocks, and the work is nearly linear in the number of
loops. RCSR: closed at S, 3 unknowns.
"""

from mechkin_cli.solver.graph.build import build_graph
from mechkin_cli.solver.graph.records import (
    Block,
    Closing,
    SolverGraph,
    TreeEdge,
    UnsolvableGraph,
    is_redundant,
)

__all__ = [
    "Block",
    "Closing",
    "SolverGraph",
    "TreeEdge",
    "UnsolvableGraph",
    "build_graph",
    "is_redundant",
]
