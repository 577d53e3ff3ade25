"""From nowhere to the best unknowns: differential evolution over whole populations, then a local
search from the best of it; the same seed gives the same answer.

Unknowns u lie in [0, 1], parts of their bounds. Residuals should be small, magnitudes have a
largest that should be small, margins should not be negative, all without units. The cost is half
the sum of the squares of the residuals and of the largest magnitude of each group.

The local search is least squares by a trust region within bounds; where constraints do not hold by
themselves, or a largest magnitude should be small, sequential quadratic programming. A largest
magnitude s is an unknown of its own, above all magnitudes of its group: s >= |v| in every row,
which is smooth where the maximum is not (Nocedal & Wright, Numerical Optimization, section 12.1).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.record import NamedTuple
from mechkin_cli.tolerances import FIT_ENDED, FIT_HELD, FIT_NARROW_STEP, FIT_STEP

if TYPE_CHECKING:
    from mechkin_cli.show import Bools, Floats


class Measures(NamedTuple):
    """Of a population of S.

    Attributes:
        residuals: (S, m).
        peaks: groups of magnitudes, each (S, rows) with its sign.
        margins: (S, c), negative where a constraint does not hold.
        missing: (S,) the part of what is asked for that has no value: 0 where all has one.
    """

    residuals: Floats
    peaks: tuple[Floats, ...]
    margins: Floats
    missing: Floats

    @property
    def costs(self) -> Floats:
        """(S,); what is missing does not count."""
        with np.errstate(invalid="ignore", over="ignore"):
            found = 0.5 * np.square(self.residuals).sum(axis=1)
            for group in self.peaks:
                found = found + 0.5 * np.square(np.abs(group).max(axis=1))
        costs: Floats = found
        return costs

    @property
    def excess(self) -> Floats:
        """(S,) the sum of what the margins lack."""
        return np.asarray(np.maximum(-self.margins, 0.0).sum(axis=1))

    @property
    def ranks(self) -> Floats:
        """(S,) by which a population is ordered: in [0, 1) by cost where everything holds, in
        [1, 2) by excess where a margin does not, from 2 on by what is missing."""
        costs, excess = self.costs, self.excess
        with np.errstate(invalid="ignore"):
            held = np.where(excess > 0.0, 1.0 + excess / (1.0 + excess), costs / (1.0 + costs))
        return np.where(self.missing > 0.0, 2.0 + self.missing, held)

    @property
    def stacked(self) -> Floats:
        """(S, all): residuals, peaks, margins side by side."""
        return np.concatenate([self.residuals, *self.peaks, self.margins], axis=1)


Measure = Callable[["Floats"], Measures]
"""From (unknowns, S) to their measures."""

Exact = Callable[["Floats"], "Floats"]
"""From (unknowns,) to the derivatives of `stacked` (all, unknowns), nan where it has none."""


class Measured:
    """Measures with their derivatives, and how many variants they took.

    Args:
        measure: the measures of a population.
        exact: their exact derivatives; many times dearer than differences.

    Attributes:
        evaluations: variants computed.
        slopes_taken, exact_taken: Jacobians by differences alone, and exact ones.
        entries, filled: numbers of the last exact Jacobian, and those that are differences, as
            there was no exact one.
    """

    def __init__(self, measure: Measure, exact: Exact) -> None:
        self._measure, self._exact = measure, exact
        self.evaluations = 0
        self.slopes_taken = self.exact_taken = 0
        self.entries = self.filled = 0
        self._last: tuple[bytes, Measures] | None = None

    def many(self, unknowns: Floats) -> Measures:
        """Of a population (unknowns, S)."""
        self.evaluations += unknowns.shape[1]
        return self._measure(unknowns)

    def one(self, unknowns: Floats) -> Measures:
        """Of one (unknowns,); the last is remembered."""
        key = np.ascontiguousarray(unknowns).tobytes()
        if self._last is None or self._last[0] != key:
            self._last = key, self.many(unknowns[:, None])
        return self._last[1]

    def differences(self, unknowns: Floats) -> Floats:
        """Derivatives of `stacked` (all, unknowns), the quick ones."""
        self.slopes_taken += 1
        return self._differences(unknowns)

    def exact_slopes(self, unknowns: Floats) -> Floats:
        """Derivatives of `stacked` (all, unknowns), exact to rounding; differences where something
        has no exact one."""
        self.exact_taken += 1
        slopes = self._exact(unknowns)
        without = ~np.isfinite(slopes)
        self.entries, self.filled = slopes.size, int(without.sum())
        return np.where(without, self._differences(unknowns), slopes) if self.filled else slopes

    def _differences(self, unknowns: Floats) -> Floats:
        """Fourth-order differences, of all unknowns in one call; narrow or one-sided ones where
        those reach places without values."""
        count = len(unknowns)
        far, near = FIT_STEP, FIT_NARROW_STEP
        steps = np.array([-2 * far, -far, far, 2 * far])
        values, missing = self._beside(unknowns, steps)
        slopes = (values[0] - values[3] - 8.0 * (values[1] - values[2])) / (12.0 * far)
        bad = missing.any(axis=0) | ~np.isfinite(slopes).all(axis=1)
        if bad.any():
            values, missing = self._beside(unknowns, np.array([-near, 0.0, near]))
            low = np.where(missing[0], 1, 0)
            high = np.where(missing[2], 1, 2)
            of = np.arange(count)
            span = np.maximum(high - low, 1)[:, None] * near
            narrow = (values[high, of] - values[low, of]) / span
            slopes[bad] = np.nan_to_num(narrow[bad])
        return np.asarray(slopes.T)

    def _beside(self, unknowns: Floats, steps: Floats) -> tuple[Floats, Bools]:
        """`stacked` (steps, unknowns, all) one unknown moved at a time, and what is missing."""
        count = len(unknowns)
        moved = unknowns + steps[:, None, None] * np.eye(count)
        measures = self.many(moved.reshape(-1, count).T)
        shape = (len(steps), count)
        return measures.stacked.reshape(*shape, -1), measures.missing.reshape(shape) > 0.0


def optimizer() -> Any:
    """scipy.optimize.

    Raises:
        UsageError: scipy is not installed.
    """
    try:
        import scipy.optimize
    except ImportError:
        raise UsageError("fit needs scipy: pip install 'mechkin[fit]'") from None
    return scipy.optimize


MOST_STEPS = 200
"""Steps of a local search."""

LAST_STEPS = 8
"""Steps with exact derivatives from where a search has ended: one or two move it to where the
gradient vanishes but for rounding; into a corner of the bounds it would creep on for fifty."""

WORSE = 10.0
"""Times the start's cost: what a step counts that leads to where something is missing."""


Slopes = Callable[["Floats"], "Floats"]
"""From (unknowns,) to the derivatives of `Measures.stacked` (all, unknowns)."""


def refined(
    measured: Measured, start: Floats, slopes: Slopes, steps: int = MOST_STEPS
) -> tuple[Floats, bool, str]:
    """The unknowns in [0, 1] that a search from `start` ends at, whether it ended by itself, and
    why it ended; `steps`: the most it takes."""
    at_start = measured.one(start)
    if at_start.missing[0] > 0.0:
        return start, False, "something has no value at the start of this search"
    unknowns, ended, reason = start, True, ""
    # a search that has ended at a bound would only leave it without the bound
    binds = np.abs(at_start.margins).min(initial=1.0) <= FIT_HELD
    if not at_start.peaks and not binds:
        unknowns, ended, reason = _least_squares(measured, start, slopes, steps)
        if measured.one(unknowns).margins.min(initial=1.0) >= -FIT_HELD:
            return unknowns, ended, reason
    programmed = _constrained(measured, unknowns, slopes, steps)
    if programmed[0] is not unknowns and measured.one(programmed[0]).missing[0] > 0.0:
        return unknowns, False, "the constrained search left what has values"
    return programmed


def finished(measured: Measured, end: Floats, ended: bool, reason: str) -> tuple[Floats, bool, str]:
    """`refined` once more from its `end`, a few steps with exact derivatives; that end itself
    where they find nothing better."""
    better, of_itself, why = refined(measured, end, measured.exact_slopes, LAST_STEPS)
    if measured.one(better).ranks[0] <= measured.one(end).ranks[0]:
        return better, ended or of_itself, why if of_itself else reason
    return end, ended, reason


def _least_squares(
    measured: Measured, start: Floats, slopes: Slopes, steps: int
) -> tuple[Floats, bool, str]:
    count = measured.one(start).residuals.shape[1]
    worse = WORSE * (1.0 + np.abs(measured.one(start).residuals).max(initial=0.0))

    def residuals(unknowns: Floats) -> Floats:
        measures = measured.one(unknowns)
        return measures.residuals[0] if measures.missing[0] == 0.0 else np.full(count, worse)

    end = optimizer().least_squares(
        residuals,
        np.clip(start, FIT_HELD, 1.0 - FIT_HELD),
        lambda unknowns: slopes(unknowns)[:count],
        bounds=(0.0, 1.0),
        xtol=FIT_ENDED,
        ftol=FIT_ENDED,
        gtol=FIT_ENDED,
        max_nfev=steps,
    )
    return np.clip(end.x, 0.0, 1.0), end.status > 0, str(end.message).rstrip(".")


def _constrained(
    measured: Measured, start: Floats, stacked_slopes: Slopes, steps: int
) -> tuple[Floats, bool, str]:
    count, first = len(start), measured.one(start)
    residuals = first.residuals.shape[1]
    sizes = [group.shape[1] for group in first.peaks]
    tops = np.array([np.abs(group).max() for group in first.peaks])
    # costs near one, as the programme's own tolerance is absolute
    scale = 1.0 / max(float(first.costs[0]), FIT_ENDED)
    worse = WORSE * (1.0 + float(first.costs[0])) * scale

    def cost(all_unknowns: Floats) -> float:
        measures = measured.one(all_unknowns[:count])
        if measures.missing[0] > 0.0:
            return worse
        own = float(np.square(measures.residuals).sum() + np.square(all_unknowns[count:]).sum())
        return 0.5 * scale * own

    def gradient(all_unknowns: Floats) -> Floats:
        unknowns = all_unknowns[:count]
        own = np.nan_to_num(measured.one(unknowns).residuals[0]) @ slopes(unknowns)[:residuals]
        return np.asarray(scale * np.concatenate([own, all_unknowns[count:]]))

    last: dict[bytes, Floats] = {}

    def slopes(unknowns: Floats) -> Floats:
        key = unknowns.tobytes()
        if key not in last:
            last.clear()
            last[key] = stacked_slopes(unknowns)
        return last[key]

    def above(all_unknowns: Floats) -> Floats:
        """Each top above the magnitudes of its group, and the margins."""
        measures, parts = measured.one(all_unknowns[:count]), []
        for top, group in zip(all_unknowns[count:], measures.peaks, strict=True):
            parts += [top - group[0], top + group[0]]
        return np.asarray(np.nan_to_num(np.concatenate([*parts, measures.margins[0]]), nan=-1.0))

    def above_slopes(all_unknowns: Floats) -> Floats:
        rows = slopes(all_unknowns[:count])[residuals:]
        blocks, begin = [], 0
        for number, size in enumerate(sizes):
            top = np.zeros((size, len(sizes)))
            top[:, number] = 1.0
            own = rows[begin : begin + size]
            blocks += [np.hstack([-own, top]), np.hstack([own, top])]
            begin += size
        rest = rows[begin:]
        blocks.append(np.hstack([rest, np.zeros((len(rest), len(sizes)))]))
        return np.vstack(blocks)

    end = optimizer().minimize(
        cost,
        np.concatenate([start, tops]),
        jac=gradient,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * count + [(0.0, None)] * len(sizes),
        constraints=[{"type": "ineq", "fun": above, "jac": above_slopes}],
        options={"ftol": FIT_ENDED, "maxiter": steps},
    )
    return np.clip(end.x[:count], 0.0, 1.0), bool(end.status in (0, 8)), str(end.message)


Progress = Callable[[int, int], None]
"""Called with how many steps are done, and of how many."""

POPULATION = 12
"""Members for each unknown, at least `LEAST` of them."""

LEAST = 48


class SearchResult(NamedTuple):
    """The best unknowns (n,), their measures, whether a local search ended there and why; the
    costs that the local searches reached, with those that hold nothing as nan."""

    unknowns: Floats
    measures: Measures
    ended: bool
    reason: str
    costs: tuple[float, ...]


def best_of(
    measured: Measured,
    own: Floats,
    seed: int,
    starts: int,
    generations: int,
    progress: Progress | None,
) -> SearchResult:
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
    best: SearchResult | None = None
    costs = []
    for number, start in enumerate(_different(own, population, ranks, starts)):
        unknowns, ended, reason = refined(measured, start, measured.differences)
        measures = measured.one(unknowns)
        rank = float(measures.ranks[0])
        costs.append(float(measures.costs[0]) if rank < 2.0 else np.nan)
        if best is None or rank < best.measures.ranks[0]:
            best = SearchResult(unknowns, measures, ended, reason, ())
        tell(generations + number + 1)
    assert best is not None
    if best.measures.missing[0] == 0.0:
        unknowns, ended, reason = finished(measured, best.unknowns, best.ended, best.reason)
        best = SearchResult(unknowns, measured.one(unknowns), ended, reason, ())
    return best._replace(costs=tuple(costs))


def _evolved(
    measured: Measured, own: Floats, seed: int, generations: int, tell: Callable[[int], None]
) -> tuple[Floats, Floats]:
    count = len(own)
    random = np.random.default_rng(seed)
    size = max(LEAST, POPULATION * count)
    # a Latin hypercube, and the own values as one of its members
    first = (np.argsort(random.random((count, size)), axis=1) + random.random((count, size))) / size
    first[:, 0] = np.clip(own, 0.0, 1.0)
    if not generations:
        return first, measured.many(first).ranks
    done = 0

    def advance(intermediate_result: object) -> None:
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
        callback=advance,
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
