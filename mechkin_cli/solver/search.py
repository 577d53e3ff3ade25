"""All ways of assembling a mechanism at given inputs that random starts find.

Block by block: Levenberg-Marquardt from random starts (fixed seed), side conditions, clustering by
the poses. Starts go on until one more is unlikely to find a new mode: of C starts that closed, M
met a mode that no other met, so the next meets a new one with chance max(M, 1) / C (Good 1953;
with M = 0 the chance is known only to be of order 1 / C).
"""

from __future__ import annotations

from math import isfinite, pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.width import threads_for, width
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.clusters import Clusters, pose_keys, same_poses
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.random_starts import RandomStarts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan


class Within(NamedTuple):
    """A box of states: `radius` (states,) about `centre` (states,), infinite where any value will
    do."""

    centre: Floats
    radius: Floats


class Found(NamedTuple):
    """Assemblies (columns of `states`), their condition, and how the search went.

    `closed` starts of `starts` ended on an assembly; `chance` estimates that one more start finds
    a new one; `closest` is the least closing residual of any start; `stopped` tells that the search
    ended at its most starts while that chance was still high. `free` starts ended where the loops
    still move with the inputs held, or in a singular place: these are no isolated assemblies and
    are left out.
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

    @property
    def number(self) -> int:
        """Number of assemblies."""
        return int(self.states.shape[1])


def assemblies(
    layout: Layout,
    plan: Plan,
    inputs: Floats,
    turns: int = 1,
    within: Within | None = None,
    about: Floats | None = None,
) -> Found:
    """The assemblies at one set of inputs.

    Args:
        layout: the mechanism in the kernel.
        plan: its plan.
        inputs: (inputs,) in kernel units.
        turns: turns of helical joints to either side.
        within: where random starts are taken; None: everywhere.
        about: (states,) whose turns of threads are the middle of those searched; None: as drawn.
    """
    generator = RandomStarts()
    middle = np.zeros(plan.states) if about is None else about
    partial: list[Floats] = [np.zeros((plan.states, 1))]
    partial[0][_quaternion_scalars(layout), 0] = 1.0
    starts = closed = free = 0
    chance = closest = 0.0
    stopped = False
    for number in range(len(layout.graph.blocks)):
        continued: list[Floats] = []
        for base in partial:
            clusters = _search_block(
                layout, plan, number, inputs, base, generator, turns, within, middle
            )
            continued.extend(state[:, None] for state in clusters.states.T)
            starts, closed = starts + clusters.tried, closed + clusters.closed
            chance = max(chance, clusters.chance if clusters.closed else 0.0)
            closest, free = max(closest, clusters.closest), free + clusters.free
            stopped = stopped or not clusters.settled
        partial = continued
    every = np.concatenate([np.empty((plan.states, 0)), *partial], axis=1)
    states, residual, condition = _closed(layout, plan, inputs, every)
    return Found(states, residual, condition, starts, closed, chance, closest, stopped, free)


def single_assembly(layout: Layout, plan: Plan, inputs: Floats, state: Floats) -> Floats:
    """Where one start (states,) ends, block by block; closed or not."""
    values, states = np.ascontiguousarray(inputs[:, None]), state[:, None].copy()
    for number in range(len(layout.graph.blocks)):
        _ends(plan, number, values, states)
    found: Floats = states[:, 0].copy()
    return found


def _ends(
    plan: Plan, number: int, values: Floats, states: Floats
) -> tuple[Floats, NDArray[np.uint8]]:
    """Takes the starts `states` (states, starts) of a block to their ends, in place; residuals and
    flags."""
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
    return residual, flags


def _search_block(
    layout: Layout,
    plan: Plan,
    number: int,
    inputs: Floats,
    base: Floats,
    generator: RandomStarts,
    turns: int,
    within: Within | None,
    middle: Floats,
) -> Clusters:
    clusters = Clusters(layout)
    size = tolerances.SEARCH_STARTS
    values = np.repeat(inputs[:, None], size, axis=1)
    threads = _threads(layout, number)
    while not (clusters.settled or clusters.exhausted):
        states = np.repeat(base, size, axis=1)
        _randomise(layout, number, states, generator, turns, middle)
        if within is not None:
            _bring_within(layout, number, states, generator, within)
        residual, flags = _ends(plan, number, values, states)
        clusters.closest = min(clusters.closest, float(np.min(residual)))
        turned = np.abs(states[threads] - middle[threads, None]) <= _most_turn(turns)
        states, free = _isolated(layout, plan, values, states[:, (flags == 0) & turned.all(axis=0)])
        clusters.add(states)
        clusters.free += free
        clusters.tried += size
    return clusters


def _isolated(layout: Layout, plan: Plan, values: Floats, states: Floats) -> tuple[Floats, int]:
    """The isolated assemblies among end points of the search, and how many others there were; with
    several blocks only the last knows."""
    count = states.shape[1]
    if count == 0 or len(layout.graph.blocks) > 1:
        return states, 0
    batch = run(plan, values[:, :count], states, demand=Demand.CONDITION, iterations=20)
    assert batch.condition is not None
    regular = batch.condition < tolerances.SEARCH_CONDITION
    free = int(np.count_nonzero(batch.good & ~regular))
    return batch.states[:, batch.good & regular], free


def _threads(layout: Layout, number: int) -> list[int]:
    """States of a block that are turns of threads."""
    unknowns = (layout.carrier_of(*u)[0] for u in layout.graph.blocks[number].unknowns)
    return [layout.carriers[k].state for k in unknowns if layout.carriers[k].part.type.is_thread]


def _most_turn(turns: int) -> float:
    return pi * (2 * turns + 1)


def _randomise(
    layout: Layout,
    number: int,
    states: Floats,
    generator: RandomStarts,
    turns: int,
    middle: Floats,
) -> None:
    """Fills the unknown states of a block with random starts."""
    rows = states.shape[1]
    reach = tolerances.SEARCH_SLIDES * layout.mechanism.box_diagonal() / layout.length
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        carrier = layout.carriers[k]
        state = carrier.state + local
        if carrier.part.type.is_ball:
            if local == 0:
                states[state : state + 4] = generator.quaternions(rows)
        elif carrier.part.type.slides[local]:
            states[state] = generator.between(reach, rows)
        else:
            thread = carrier.part.type.is_thread
            half = _most_turn(turns) if thread else pi
            states[state] = generator.between(half, rows)
            if thread:
                states[state] += middle[state]


def _bring_within(
    layout: Layout, number: int, states: Floats, generator: RandomStarts, within: Within
) -> None:
    """Takes the starts of a block from a box, where it is bounded."""
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        state = layout.carriers[k].state + local
        radius = float(within.radius[state])
        if isfinite(radius):
            states[state] = within.centre[state] + generator.between(radius, states.shape[1])


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
    keys = pose_keys(layout, states)
    chosen = np.flatnonzero(~np.triu(same_poses(keys, keys), 1).any(axis=0))
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
