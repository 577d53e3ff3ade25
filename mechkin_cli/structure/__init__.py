"""The solver graph: spanning tree, cut joints, and blocks in the order of solution.

By structure first (components, Assur groups by matching), by rank where structure counts too many
equations. Neither order nor names of a file change the result; the work is nearly linear in the
number of loops.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.structure.build import *
    from mechkin_cli.structure.graph import *
    from mechkin_cli.structure.network import *
    from mechkin_cli.structure.rank import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "build": "build_graph",
        "graph": "Block Loop SolverGraph TreeEdge UnsolvableGraph charted exchanged graph_of "
        "holding is_redundant is_too_large listed most_equations structure_of",
        "network": "connections_of reduce whole_link",
        "rank": "Rates middle_and_size",
    },
)
