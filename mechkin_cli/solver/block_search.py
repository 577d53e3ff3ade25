"""The search of one block's assemblies: Levenberg-Marquardt from random starts (fixed seed).

A block is searched once for each *place* of the blocks before it, as far as its own loops depend
on them; the starts of all places share the kernel's calls. A place's search ends when all
assemblies are proven to be found (`loop_count`, `block_bounds`), or when the chance that one more
start finds another is small.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.width import threads_for, width
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.block_bounds import most_of_block
from mechkin_cli.solver.clusters import Clusters
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.start_box import (
    Within,
    most_turn,
    randomise,
    thread_states,
)

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.loop_count import Count
    from mechkin_cli.solver.random_starts import RandomStarts


class Request(NamedTuple):
    """What is searched: at `inputs` (inputs,), threads within `turns` to either side of those in
    `middle` (states,), starts `within` a box; `thorough`: for all assemblies, else for one."""

    layout: Layout
    plan: Plan
    inputs: Floats
    turns: int
    middle: Floats
    within: Within | None
    thorough: bool


class PlaceSearch:
    """The search of a block at one place (column of `bases`).

    `doubt` is the chance that its bound of what is left may fail; `limits` its most starts where
    none closes, and where some do; `goal` the chance of another assembly that ends it.
    """

    def __init__(
        self,
        clusters: Clusters,
        doubt: float,
        limits: tuple[int, int],
        most: int | None,
        goal: float,
        thorough: bool,
    ) -> None:
        self.clusters = clusters
        self.doubt, self.limits, self.most, self.goal = doubt, limits, most, goal
        self.thorough = thorough
        self.real: int | None = None

    def learn(self, count: Count | None) -> None:
        """Takes the loop's own number of assemblies."""
        if count is not None:
            self.real = count.real
            self.most = count.most if self.most is None else min(count.most, self.most)

    @property
    def is_complete(self) -> bool:
        """Whether all assemblies are proven to be found."""
        found = self.clusters.number
        if self.real is not None:
            return found == self.real
        # a motion that is left ends everywhere, but nowhere twice
        return found == self.most and int(self.clusters.met.min()) > 1

    @property
    def rest(self) -> float:
        """Bound of the chance that one more start that closes finds another assembly."""
        return 0.0 if self.is_complete else self.clusters.rest(self.doubt)

    @property
    def is_settled(self) -> bool:
        """Whether more starts are not worth it."""
        if self.is_complete:
            return True
        if not self.clusters.closed:
            return self.clusters.tried >= self.limits[0]
        chance = self.clusters.rest(self.doubt) if self.thorough else self.clusters.estimate
        return chance < self.goal

    @property
    def is_over(self) -> bool:
        """Whether the search ends, or gives up."""
        crowded = self.clusters.number > tolerances.SEARCH_MOST_MODES
        return crowded or self.clusters.tried >= self.limits[1] or self.is_settled


def search_block(
    request: Request, number: int, bases: Floats, generator: RandomStarts, doubts: list[float]
) -> list[PlaceSearch]:
    """Searches a block at all places (columns of `bases`, (states, places))."""
    searches = _searches(request, number, doubts)
    active = list(range(len(searches)))
    while active:
        tried = searches[active[0]].clusters.tried
        first = min(tolerances.SEARCH_STARTS, searches[0].limits[0])
        share = max(first // len(active), tolerances.SEARCH_LEAST_STARTS)
        if request.thorough:
            share = max(share, min(tried, tolerances.SEARCH_MOST_ROUND // len(active)))
        at_once = max(tolerances.SEARCH_MOST_COLUMNS // share, 1)
        for first in range(0, len(active), at_once):
            places = active[first : first + at_once]
            states = np.repeat(bases[:, places], share, axis=1)
            search_round(request, number, states, generator, [searches[i] for i in places])
        if not tried and request.within is None:
            # a box has a part of them, whose number nothing tells
            _count(request, number, bases, searches)
        active = [i for i in active if not searches[i].is_over]
        if _is_hopeless(searches):
            break
    return searches


def _is_hopeless(searches: list[PlaceSearch]) -> bool:
    """Whether not one start of any place closed, of as many as one place alone would have."""
    all_clusters = [search.clusters for search in searches]
    tried = sum(clusters.tried for clusters in all_clusters)
    return tried >= searches[0].limits[0] and not any(c.closed + c.free for c in all_clusters)


def _searches(request: Request, number: int, doubts: list[float]) -> list[PlaceSearch]:
    layout = request.layout
    block, places = layout.graph.blocks[number], len(doubts)
    work = tolerances.SEARCH_ITERATIONS * _work(block.equations, len(block.unknowns))
    none = min(tolerances.SEARCH_HOPELESS_WORK / work, tolerances.SEARCH_HOPELESS_STARTS)
    none = max(none, tolerances.SEARCH_LEAST_HOPELESS_STARTS)
    most: float = tolerances.SEARCH_MOST_QUICK_STARTS
    if request.thorough:
        most = max(most, min(tolerances.SEARCH_MOST_WORK / work, tolerances.SEARCH_MOST_STARTS))
    most = max(most / places, tolerances.SEARCH_HOPELESS_STARTS)
    goal = min(
        tolerances.SEARCH_NEW_MODE_CHANCE * places, tolerances.SEARCH_NEW_MODE_CHANCE_OF_MANY
    )
    bound = most_of_block(layout.graph, block)
    limits = int(none), int(most)
    numbers = sorted({layout.carrier_of(*unknown)[0] for unknown in block.unknowns})
    own = [layout.carriers[k] for k in numbers]
    return [
        PlaceSearch(Clusters(layout, own), doubt, limits, bound, goal, request.thorough)
        for doubt in doubts
    ]


def _work(equations: int, unknowns: int) -> float:
    """Multiplications of one step of a start, about: normal equations, their solution, screws."""
    return unknowns * (unknowns * equations + unknowns * unknowns / 3.0 + 100.0)


def _count(request: Request, number: int, bases: Floats, searches: list[PlaceSearch]) -> None:
    from mechkin_cli.solver.loop_count import count_assemblies, state_error

    error = state_error(number)
    for i, search in enumerate(searches):
        if not search.is_complete:
            search.learn(count_assemblies(request.layout, number, bases[:, i], error))


def search_round(
    request: Request,
    number: int,
    states: Floats,
    generator: RandomStarts,
    searches: list[PlaceSearch],
) -> None:
    """The same number of starts from each place, columns of `states`, place by place."""
    layout, middle = request.layout, request.middle
    randomise(layout, number, states, generator, request.turns, middle, request.within)
    values = np.repeat(request.inputs[:, None], states.shape[1], axis=1)
    residual, closed = ends(request.plan, number, values, states)
    threads = thread_states(layout, number)
    turned = np.abs(states[threads] - middle[threads, None]) <= most_turn(request.turns)
    good = closed & turned.all(axis=0)
    share = states.shape[1] // len(searches)
    for i, search in enumerate(searches):
        part = slice(i * share, (i + 1) * share)
        clusters = search.clusters
        clusters.closest = min(clusters.closest, float(np.min(residual[part])))
        clusters.tried += share
        clusters.add(
            states[:, part][:, good[part]], lambda ended: _isolated(request, number, ended)
        )


def _isolated(request: Request, number: int, states: Floats) -> tuple[Floats, Bools, Floats, int]:
    """The isolated assemblies of a block among end points of its search, the conditions of all
    points, and how many assemblies are not isolated: places where the block moves with all else
    held, or singular ones."""
    count = states.shape[1]
    if count == 0:
        return states, np.ones(count, dtype=bool), np.zeros(count), 0
    values = np.repeat(request.inputs[:, None], count, axis=1)
    batch = run(request.plan, values, states, demand=Demand.CONDITION, iterations=20, only=number)
    assert batch.condition is not None
    regular = batch.condition < tolerances.SEARCH_CONDITION
    free = int(np.count_nonzero(batch.good & ~regular))
    return batch.states, batch.good & regular, batch.condition, free


def ends(plan: Plan, number: int, values: Floats, states: Floats) -> tuple[Floats, Bools]:
    """Takes the starts `states` (states, starts) of a block to their ends, in place; residuals and
    which of them closed."""
    size = states.shape[1]
    residual, flags = np.empty(size), np.empty(size, dtype=np.uint8)
    plan.search(
        block=number,
        inputs=values,
        states=states,
        residual=residual,
        flags=flags,
        iterations=tolerances.SEARCH_ITERATIONS,
        tests=(tolerances.SEARCH_RESIDUAL,),
        lanes=width(),
        # an iteration of a start costs as much as a row or more
        threads=threads_for(size * tolerances.SEARCH_ITERATIONS),
    )
    return residual, flags == 0
