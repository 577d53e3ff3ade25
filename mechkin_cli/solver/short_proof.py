"""Whether a short search can prove that it knows all assemblies.

It does where a block's real solutions are counted (`loop_count`), or where it finds as many as such
a block has at most (`block_bounds`). Of loops that are not counted those with a large bound reach
it in exceptional dimensions alone, and a search that does not is spent for nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli import tolerances
from mechkin_cli.solver.block_bounds import most_of_block

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout


def is_in_reach(layout: Layout, state: Floats) -> bool:
    """Whether a short search may prove the number of assemblies at the inputs of one of them,
    `state` (states,)."""
    blocks = range(len(layout.graph.blocks))
    return all(_is_small(layout, number) or _is_counted(layout, number, state) for number in blocks)


def _is_small(layout: Layout, number: int) -> bool:
    most = most_of_block(layout.graph, layout.graph.blocks[number])
    return most is not None and most <= tolerances.SEARCH_REACHED_BOUND


def _is_counted(layout: Layout, number: int, state: Floats) -> bool:
    from mechkin_cli.solver.loop_count import count_assemblies, state_error

    count = count_assemblies(layout, number, state, state_error(number))
    if count is None:
        return False
    return count.real is not None or count.most <= tolerances.SEARCH_REACHED_BOUND
