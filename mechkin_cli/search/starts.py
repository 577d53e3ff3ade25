"""The states of a block, its random starts, and whether a short search can prove its assemblies.

It can where a block's real solutions are counted (`loop_equation`), or where it finds as many as
such a block has at most (`chain`). Of loops that are not counted those with a large bound reach it
for exceptional dimensions alone, and a search that does not is wasted.
"""

from __future__ import annotations

from math import isfinite, pi
from typing import TYPE_CHECKING

from mechkin_cli import tolerances
from mechkin_cli.record import NamedTuple
from mechkin_cli.search.chain import most_of_block
from mechkin_cli.search.loop_equation import count_assemblies

if TYPE_CHECKING:
    from mechkin_cli.plan import Layout
    from mechkin_cli.show import Floats
    from mechkin_cli.structure import RandomStarts


class Within(NamedTuple):
    """A box of states: `radius` (states,) about `centre` (states,), infinite where any value will
    do."""

    centre: Floats
    radius: Floats


def thread_states(layout: Layout, number: int) -> list[int]:
    """States of a block that are turns of threads."""
    unknowns = (layout.carrier_of(*u)[0] for u in layout.graph.blocks[number].unknowns)
    return [layout.carriers[k].state for k in unknowns if layout.carriers[k].part.type.is_thread]


def most_turn(turns: int) -> float:
    """Angle of a thread within so many turns, and half a turn, to either side."""
    return pi * (2 * turns + 1)


def unknown_states(layout: Layout, number: int) -> list[int]:
    """The states of a block's unknowns, each once."""
    states: dict[int, None] = {}
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        carrier = layout.carriers[k]
        if carrier.part.type.is_ball:
            states.update(dict.fromkeys(range(carrier.state, carrier.state + 4)))
        else:
            states[carrier.state + local] = None
    return list(states)


def upstream_states(layout: Layout, number: int) -> list[int]:
    """States of other blocks on which a block's loops depend: of the joints on their paths."""
    graph = layout.graph
    loops = (graph.closings[c].loop for c in graph.blocks[number].closings)
    edges = {edge for loop in loops for edge, _ in loop}
    own = set(unknown_states(layout, number))
    if any(edge >= 0 and graph.edges[edge].hung for edge in edges):
        # a hung body stands where its ends are
        return [state for state in range(layout.states) if state not in own]
    return [
        state
        for carrier in layout.carriers
        if carrier.edge in edges
        for state in range(carrier.state, carrier.state + carrier.part.type.states)
        if state not in own
    ]


def randomise(
    layout: Layout,
    number: int,
    states: Floats,
    generator: RandomStarts,
    turns: int,
    middle: Floats,
    within: Within | None = None,
) -> None:
    """Fills the unknown states of a block with random starts, threads about `middle`; those that a
    box bounds lie in it."""
    rows = states.shape[1]
    reach = tolerances.SEARCH_SLIDES * layout.mechanism.box_diagonal() / layout.length
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        carrier = layout.carriers[k]
        state = carrier.state + local
        if carrier.part.type.is_ball:
            if local == 0:
                states[state : state + 4] = generator.quaternions(rows)
        elif within is not None and isfinite(within.radius[state]):
            generator.skip(rows)
        elif carrier.part.type.slides[local]:
            states[state] = generator.between(reach, rows)
        else:
            thread = carrier.part.type.is_thread
            half = most_turn(turns) if thread else pi
            states[state] = generator.between(half, rows)
            if thread:
                states[state] += middle[state]
    if within is None:
        return
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        state = layout.carriers[k].state + local
        radius = float(within.radius[state])
        if isfinite(radius):
            states[state] = within.centre[state] + generator.between(radius, rows)


def is_in_reach(layout: Layout, state: Floats) -> bool:
    """Whether a short search may prove the number of assemblies at the inputs of one of them,
    `state` (states,)."""
    for number, block in enumerate(layout.graph.blocks):
        most = most_of_block(layout.graph, block)
        if most is not None and most <= tolerances.SEARCH_REACHED_BOUND:
            continue
        count = count_assemblies(layout, number, state)
        if count is None or (count[0] is None and count[1] > tolerances.SEARCH_REACHED_BOUND):
            return False
    return True
