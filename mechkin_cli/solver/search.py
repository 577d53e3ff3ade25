"""All ways of assembling a mechanism at given inputs that random starts find.

Block by block (`block_search`): a block is searched once for each place of the blocks that its
loops hang from, and blocks that do not depend on each other multiply their assemblies.
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.block_bounds import most_of_block
from mechkin_cli.solver.block_search import (
    PlaceSearch,
    Request,
    Within,
    ends,
    search_block,
    unknown_states,
    upstream_states,
)
from mechkin_cli.solver.clusters import first_of_each, pose_keys
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.random_starts import RandomStarts

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan

__all__ = ["Found", "Within", "assemblies", "single_assembly", "with_assemblies", "wrap_angles"]


class Found(NamedTuple):
    """Assemblies (columns of `states`), their condition, and how the search went.

    `closed` starts of `starts` ended on an assembly; `chance` bounds the chance that one more that
    closes finds a new one (it may fail with `SEARCH_DOUBT`); where none of a block's starts closed,
    that one more does. `complete` says that there is none, proven by `bound`, the most that such
    loops have, or by a count of the loops' own real roots. `closest` is the least closing residual
    of any start of the last block searched; `stopped` tells that the search ended at its most
    starts. `free` starts ended where the loops still move with the inputs held, or in a singular
    place: these are no isolated assemblies and are left out. `failed` is the first block of which
    none of `tried` starts closed, at none of the `places` of the blocks before.
    """

    states: Floats
    residual: Floats
    condition: Floats
    starts: int
    closed: int
    chance: float
    closest: float
    stopped: bool
    free: int
    complete: bool
    bound: int | None
    failed: int | None
    tried: int
    places: int

    @property
    def number(self) -> int:
        """Number of assemblies."""
        return int(self.states.shape[1])


class _Tally:
    """What the searches of all blocks amount to."""

    def __init__(self) -> None:
        self.searches = self.starts = self.closed = self.free = 0
        self.chance = self.closest = 0.0
        self.stopped, self.complete = False, True
        self.bound: int | None = 1
        self.failed: int | None = None
        self.tried = self.places = 0

    def doubts(self, count: int) -> list[float]:
        """Shares of `SEARCH_DOUBT` for the next searches; those of all together are all of it."""
        first = self.searches + 1
        self.searches += count
        return [tolerances.SEARCH_DOUBT / (s * (s + 1)) for s in range(first, first + count)]

    def add(self, number: int, searches: list[PlaceSearch]) -> None:
        """Takes in a block's searches."""
        all_clusters = [search.clusters for search in searches]
        self.starts += sum(clusters.tried for clusters in all_clusters)
        self.closed += sum(clusters.closed for clusters in all_clusters)
        self.free += sum(clusters.free for clusters in all_clusters)
        self.chance = max(self.chance, *(search.rest for search in searches))
        self.stopped = self.stopped or not all(search.is_settled for search in searches)
        self.complete = self.complete and all(search.is_complete for search in searches)
        self.closest = max(clusters.closest for clusters in all_clusters)
        self.tried = sum(clusters.tried for clusters in all_clusters)
        if not any(clusters.number for clusters in all_clusters):
            self.failed, self.places = number, len(searches)
            self.complete = all(search.is_complete for search in searches)

    def multiply(self, bounds: list[int | None]) -> None:
        """Takes in bounds of blocks, None where none is known."""
        for bound in bounds:
            self.bound = None if self.bound is None or bound is None else self.bound * bound


def assemblies(
    layout: Layout,
    plan: Plan,
    inputs: Floats,
    turns: int = 1,
    within: Within | None = None,
    about: Floats | None = None,
    thorough: bool = True,
) -> Found:
    """The assemblies at one set of inputs.

    Args:
        layout: the mechanism in the kernel.
        plan: its plan.
        inputs: (inputs,) in kernel units.
        turns: turns of helical joints to either side.
        within: where random starts are taken; None: everywhere.
        about: (states,) whose turns of threads are the middle of those searched; None: as drawn.
        thorough: whether all are wanted, or one among the most of them.
    """
    generator, tally = RandomStarts(), _Tally()
    middle = np.zeros(plan.states) if about is None else about
    request = Request(layout, plan, inputs, turns, middle, within, thorough)
    partial = _unknown_zero(layout, inputs)
    for number in range(len(layout.graph.blocks)):
        upstream = upstream_states(layout, number)
        firsts, place = _different(partial[upstream])
        doubts = tally.doubts(len(firsts))
        searches = search_block(request, number, partial[:, firsts], generator, doubts)
        tally.add(number, searches)
        tally.multiply(list({search.most for search in searches}))
        if tally.failed is not None:
            rest = layout.graph.blocks[number + 1 :]
            tally.multiply([most_of_block(layout.graph, block) for block in rest])
            partial = partial[:, :0]
            break
        partial, cut = _continued(layout, number, partial, place, searches)
        tally.stopped, tally.complete = tally.stopped or cut, tally.complete and not cut
    states, residual, condition = _closed(layout, plan, inputs, partial)
    complete = tally.complete and states.shape[1] == partial.shape[1]
    return Found(
        states,
        residual,
        condition,
        starts=tally.starts,
        closed=tally.closed,
        chance=tally.chance,
        closest=tally.closest,
        stopped=tally.stopped,
        free=tally.free,
        complete=complete,
        bound=tally.bound if layout.graph.blocks else None,
        failed=tally.failed,
        tried=tally.tried,
        places=tally.places,
    )


def _unknown_zero(layout: Layout, inputs: Floats) -> Floats:
    """The one place before the first block: inputs as given, unknowns zero, (states, 1)."""
    state = np.zeros((layout.states, 1))
    state[_quaternion_scalars(layout), 0] = 1.0
    for (edge, freedom), value in zip(layout.graph.inputs, inputs, strict=True):
        if edge >= 0:
            state[layout.state(edge, freedom), 0] = value
    return state


def _different(states: Floats) -> tuple[list[int], list[int]]:
    """The first column of each kind, and for each column which of these it is equal to."""
    firsts: list[int] = []
    kinds: dict[bytes, int] = {}
    place = []
    for number, column in enumerate(np.ascontiguousarray(states.T)):
        key = column.tobytes()
        if key not in kinds:
            kinds[key] = len(firsts)
            firsts.append(number)
        place.append(kinds[key])
    return firsts, place


def _continued(
    layout: Layout, number: int, partial: Floats, place: list[int], searches: list[PlaceSearch]
) -> tuple[Floats, bool]:
    """Every assembly so far with each of the block's own there; whether some were left out."""
    own = unknown_states(layout, number)
    repeats = np.array([searches[k].clusters.number for k in place])
    cut = np.cumsum(repeats) > tolerances.SEARCH_MOST_PRODUCTS
    kept = np.flatnonzero(~cut)
    states = np.repeat(partial[:, kept], repeats[kept], axis=1)
    states[own] = np.concatenate(
        [np.empty((len(own), 0)), *(searches[place[k]].clusters.states[own] for k in kept)], axis=1
    )
    return states, bool(cut.any())


def single_assembly(layout: Layout, plan: Plan, inputs: Floats, state: Floats) -> Floats:
    """Where one start (states,) ends, block by block; closed or not."""
    values, states = np.ascontiguousarray(inputs[:, None]), state[:, None].copy()
    for number in range(len(layout.graph.blocks)):
        ends(plan, number, values, states)
    found: Floats = states[:, 0].copy()
    return found


def _quaternion_scalars(layout: Layout) -> list[int]:
    return [carrier.state for carrier in layout.carriers if carrier.part.type.is_ball]


def with_assemblies(
    layout: Layout, plan: Plan, inputs: Floats, found: Found, states: Floats
) -> Found:
    """`found` with the assemblies among `states` (states, count) that it lacks."""
    every = np.concatenate([found.states, states], axis=1)
    states, residual, condition = _closed(layout, plan, inputs, every)
    return found._replace(states=states, residual=residual, condition=condition)


def _closed(
    layout: Layout, plan: Plan, inputs: Floats, states: Floats
) -> tuple[Floats, Floats, Floats]:
    """Newton on the whole mechanism, singular ends and doubles dropped, angles wrapped: states,
    residual, condition."""
    if states.shape[1] == 0:
        return states, np.empty(0), np.empty(0)
    values = np.repeat(inputs[:, None], states.shape[1], axis=1)
    batch = run(plan, values, states, demand=Demand.CONDITION, iterations=20)
    assert batch.condition is not None
    keep = batch.good & (batch.condition < tolerances.SEARCH_CONDITION)
    states, residual, condition = (
        batch.states[:, keep],
        batch.residual[keep],
        batch.condition[keep],
    )
    wrap_angles(layout, states)
    chosen = first_of_each(pose_keys(layout, states))
    return states[:, chosen], residual[chosen], condition[chosen]


def wrap_angles(layout: Layout, states: Floats) -> None:
    """Brings the angles of unknown turns into (-pi, pi], in place; threads keep their turns."""
    driven = {layout.state(edge, freedom) for edge, freedom in layout.graph.inputs}
    for carrier in layout.carriers:
        for number, freedom in enumerate(carrier.part.type.freedoms, start=carrier.state):
            if freedom.is_cyclic and number not in driven:
                row = states[number]
                turns = np.ceil((row - pi) / (2.0 * pi))
                row -= turns * (2.0 * pi)
