"""All ways of assembling a mechanism at given inputs that random starts find.

Block by block: Levenberg-Marquardt from random starts (fixed seed), side conditions, clustering by
the poses. Starts go on until one more is unlikely to find a new mode (Good-Turing estimate).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import functions
from mechkin_cli.mechanism.joint_types import tree_types
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.random_starts import RandomStarts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Plan

    Floats = NDArray[np.float64]

SLIDE_RANGE = 2.0
"""Bound of random slides in sizes of the home drawing: a chain of links reaches no farther."""


class Found(NamedTuple):
    """Assemblies (columns of `states`), their condition, and how the search went.

    `closed` starts of `starts` ended on an assembly; `chance` estimates that one more start finds
    a new one; `closest` is the least closing residual of any start.
    """

    states: Floats
    residual: Floats
    condition: Floats
    starts: int
    closed: int
    chance: float
    closest: float

    @property
    def number(self) -> int:
        """Number of assemblies."""
        return int(self.states.shape[1])


@dataclass
class _Clusters:
    """Representatives found so far and how often each was met."""

    states: list[Floats]
    keys: list[Floats]
    met: list[int]
    closest: float = float("inf")

    def add(self, state: Floats, key: Floats) -> None:
        for i, known in enumerate(self.keys):
            if np.max(np.abs(known - key)) < tolerances.SAME_MODE:
                self.met[i] += 1
                return
        self.states.append(state)
        self.keys.append(key)
        self.met.append(1)

    @property
    def chance(self) -> float:
        total = sum(self.met)
        return sum(1 for m in self.met if m == 1) / total if total else 1.0


def assemblies(layout: Layout, plan: Plan, inputs: Floats, turns: int = 1) -> Found:
    """The assemblies at one set of inputs.

    Args:
        layout: the mechanism in the kernel.
        plan: its plan.
        inputs: (inputs,) in kernel units.
        turns: turns of helical joints to either side.
    """
    generator = RandomStarts()
    partial: list[Floats] = [np.zeros((plan.states, 1))]
    partial[0][_quaternion_scalars(layout), 0] = 1.0
    starts = closed = 0
    chance = closest = 0.0
    for number in range(len(layout.graph.blocks)):
        continued: list[Floats] = []
        for base in partial:
            clusters, tried = _search_block(layout, plan, number, inputs, base, generator, turns)
            continued.extend(state[:, None] for state in clusters.states)
            starts, closed = starts + tried, closed + sum(clusters.met)
            chance = max(chance, clusters.chance if clusters.met else 0.0)
            closest = max(closest, clusters.closest)
        partial = continued
    return _polished(layout, plan, inputs, partial, (starts, closed, chance, closest))


def _search_block(
    layout: Layout,
    plan: Plan,
    number: int,
    inputs: Floats,
    base: Floats,
    generator: RandomStarts,
    turns: int,
) -> tuple[_Clusters, int]:
    clusters = _Clusters([], [], [])
    tried = 0
    size = tolerances.SEARCH_STARTS
    values = np.repeat(inputs[:, None], size, axis=1)
    while tried < tolerances.SEARCH_MOST_STARTS:
        states = np.repeat(base, size, axis=1)
        _randomise(layout, number, states, generator, turns)
        residual, flags = np.empty(size), np.empty(size, dtype=np.uint8)
        limits = (tolerances.SEARCH_ITERATIONS, tolerances.SEARCH_RESIDUAL)
        plan.search(number, values, states, residual, flags, *limits, 0)
        clusters.closest = min(clusters.closest, float(np.min(residual)))
        good = np.flatnonzero(flags == 0)
        keys = pose_keys(layout, states[:, good])
        for i, column in enumerate(good):
            clusters.add(states[:, column].copy(), keys[:, i])
        tried += size
        if clusters.chance < tolerances.SEARCH_NEW_MODE_CHANCE or not clusters.met:
            break
    return clusters, tried


def _randomise(
    layout: Layout, number: int, states: Floats, generator: RandomStarts, turns: int
) -> None:
    """Fills the unknown states of a block with random starts."""
    rows = states.shape[1]
    reach = SLIDE_RANGE * layout.mechanism.box_diagonal() / layout.length
    for edge, freedom in layout.graph.blocks[number].unknowns:
        k, local = layout.carrier_of(edge, freedom)
        carrier = layout.carriers[k]
        state = carrier.state + local
        if carrier.part.letter == "S":
            if local == 0:
                states[state : state + 4] = generator.quaternions(rows)
        elif tree_types()[carrier.part.letter].slides[local]:
            states[state] = generator.between(reach, rows)
        else:
            half = pi * (2 * turns + 1) if carrier.part.letter == "H" else pi
            states[state] = generator.between(half, rows)


def _quaternion_scalars(layout: Layout) -> list[int]:
    return [carrier.state for carrier in layout.carriers if carrier.part.letter == "S"]


def pose_keys(layout: Layout, states: Floats) -> Floats:
    """What tells assemblies apart: cosines and sines of turns, slides, products of quaternions."""
    keys: list[Floats] = []
    for carrier in layout.carriers:
        state = carrier.state
        if carrier.part.letter == "S":
            q = states[state : state + 4]
            keys.extend(q[i] * q[j] for i in range(4) for j in range(i, 4))
            continue
        for freedom, slide in enumerate(tree_types()[carrier.part.letter].slides):
            value = np.ascontiguousarray(states[state + freedom])
            if slide or carrier.part.letter == "H":
                keys.append(value)
            else:
                keys.extend((functions.cos(value), functions.sin(value)))
    return np.stack(keys) if keys else np.zeros((0, states.shape[1]))


def _polished(
    layout: Layout,
    plan: Plan,
    inputs: Floats,
    partial: list[Floats],
    how: tuple[int, int, float, float],
) -> Found:
    """Newton on the whole mechanism, singular ends and doubles dropped, angles wrapped."""
    empty = np.empty(0)
    if not partial:
        return Found(np.empty((plan.states, 0)), empty, empty, *how)
    states = np.concatenate(partial, axis=1)
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
    chosen: list[int] = []
    for i in range(states.shape[1]):
        if all(np.max(np.abs(keys[:, i] - keys[:, j])) >= tolerances.SAME_MODE for j in chosen):
            chosen.append(i)
    return Found(states[:, chosen], residual[chosen], condition[chosen], *how)


def wrap_angles(layout: Layout, states: Floats) -> None:
    """Brings the angles of unknown turns into (-pi, pi], in place; threads keep their turns."""
    driven = {layout.state(edge, freedom) for edge, freedom in layout.graph.inputs}
    for carrier in layout.carriers:
        if carrier.part.letter not in "RC" or carrier.state in driven:
            continue
        row = states[carrier.state]
        turns = np.ceil((row - pi) / (2.0 * pi))
        row -= turns * (2.0 * pi)
