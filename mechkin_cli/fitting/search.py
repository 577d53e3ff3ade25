"""From nowhere to the best unknowns: differential evolution over whole populations, then a local
search from the best of it; the same seed gives the same answer."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.fitting.local import finished, refined
from mechkin_cli.fitting.measures import Measured, Measures
from mechkin_cli.fitting.scipy_there import optimizer

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

Progress = Callable[[int, int], None]
"""Told how many steps are done, and of how many."""

POPULATION = 12
"""Members for each unknown, at least `LEAST` of them."""

LEAST = 48


class Found(NamedTuple):
    """The best unknowns (n,), their measures, whether a local search ended there and why; the
    costs that the local searches reached, with those that hold nothing as nan."""

    unknowns: Floats
    measures: Measures
    ended: bool
    reason: str
    costs: tuple[float, ...]


def found(
    measured: Measured,
    own: Floats,
    seed: int,
    starts: int,
    generations: int,
    progress: Progress | None,
) -> Found:
    """The best of `starts` local searches: from the own values, and from the best and most
    different of a population after some generations. They go by differences, which cost a
    twentieth of exact derivatives and lead to the same ends; the best is finished with exact ones.

    Raises:
        UsageError: scipy is not installed.
    """
    optimizer()  # before anything else is done
    steps = generations + starts

    def tell(done: int) -> None:
        if progress is not None:
            progress(done, steps)

    population, ranks = own[:, None], measured.many(own[:, None]).ranks
    if starts > 1:
        population, ranks = _evolved(measured, own, seed, generations, tell)
    best: Found | None = None
    costs = []
    for number, start in enumerate(_different(own, population, ranks, starts)):
        unknowns, ended, reason = refined(measured, start, measured.differences)
        measures = measured.one(unknowns)
        rank = float(measures.ranks[0])
        costs.append(float(measures.costs[0]) if rank < 2.0 else np.nan)
        if best is None or rank < best.measures.ranks[0]:
            best = Found(unknowns, measures, ended, reason, ())
        tell(generations + number + 1)
    assert best is not None
    if best.measures.missing[0] == 0.0:
        unknowns, ended, reason = finished(measured, best.unknowns, best.ended, best.reason)
        best = Found(unknowns, measured.one(unknowns), ended, reason, ())
    return best._replace(costs=tuple(costs))


def _evolved(
    measured: Measured, own: Floats, seed: int, generations: int, tell: Callable[[int], None]
) -> tuple[Floats, Floats]:
    """A population (unknowns, S) and its ranks after some generations."""
    count = len(own)
    random = np.random.default_rng(seed)
    size = max(LEAST, POPULATION * count)
    # a Latin hypercube, and the own values as one of its members
    first = (np.argsort(random.random((count, size)), axis=1) + random.random((count, size))) / size
    first[:, 0] = np.clip(own, 0.0, 1.0)
    if not generations:
        return first, measured.many(first).ranks
    done = 0

    def told(intermediate_result: object) -> None:
        nonlocal done
        done += 1
        tell(done)

    end = optimizer().differential_evolution(
        lambda unknowns: measured.many(np.atleast_2d(unknowns)).ranks,
        [(0.0, 1.0)] * count,
        init=first.T,
        maxiter=generations,
        tol=0.0,
        atol=0.0,
        polish=False,
        vectorized=True,
        updating="deferred",
        seed=random,
        callback=told,
    )
    return end.population.T, end.population_energies


def _different(own: Floats, population: Floats, ranks: Floats, starts: int) -> list[Floats]:
    """The own values, then the best of the population that are not near each other (a tenth of the
    bounds, as long as there are such), best first."""
    chosen = [np.clip(own, 0.0, 1.0)]
    order = [population[:, k] for k in np.argsort(ranks, kind="stable")]
    for apart in (0.1, 0.01, 0.0):
        for member in order:
            if len(chosen) >= starts:
                return chosen
            if min(np.abs(member - other).max() for other in chosen) > apart:
                chosen.append(member)
    return chosen
