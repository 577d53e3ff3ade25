"""A local search: least squares by a trust region within bounds; where constraints do not hold by
themselves, or a largest magnitude is to be small, sequential quadratic programming.

A largest magnitude s is an unknown of its own, above all magnitudes of its group: s >= |v| in
every row, which is smooth where the maximum is not (Nocedal & Wright, Numerical Optimization,
section 12.1).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.fitting.measures import Measured, Measures
from mechkin_cli.fitting.scipy_there import optimizer
from mechkin_cli.tolerances import FIT_ENDED, FIT_HELD

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

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
    found, of_itself, why = refined(measured, end, measured.exact_slopes, LAST_STEPS)
    if measured.one(found).ranks[0] <= measured.one(end).ranks[0]:
        return found, ended or of_itself, why if of_itself else reason
    return end, ended, reason


def _least_squares(
    measured: Measured, start: Floats, slopes: Slopes, steps: int
) -> tuple[Floats, bool, str]:
    least_squares = optimizer().least_squares

    count = measured.one(start).residuals.shape[1]
    worse = WORSE * (1.0 + np.abs(measured.one(start).residuals).max(initial=0.0))

    def residuals(unknowns: Floats) -> Floats:
        found = measured.one(unknowns)
        return found.residuals[0] if found.missing[0] == 0.0 else np.full(count, worse)

    end = least_squares(
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
    minimize = optimizer().minimize

    count, first = len(start), measured.one(start)
    residuals = first.residuals.shape[1]
    sizes = [group.shape[1] for group in first.peaks]
    tops = np.array([np.abs(group).max() for group in first.peaks])
    # costs near one, as the programme's own tolerance is absolute
    scale = 1.0 / max(float(first.costs[0]), FIT_ENDED)
    worse = WORSE * (1.0 + float(first.costs[0])) * scale

    def cost(all_unknowns: Floats) -> float:
        found = measured.one(all_unknowns[:count])
        if found.missing[0] > 0.0:
            return worse
        own = float(np.square(found.residuals).sum() + np.square(all_unknowns[count:]).sum())
        return 0.5 * scale * own

    def gradient(all_unknowns: Floats) -> Floats:
        unknowns = all_unknowns[:count]
        found = measured.one(unknowns).residuals[0]
        own = np.nan_to_num(found) @ slopes(unknowns)[:residuals]
        result: Floats = scale * np.concatenate([own, all_unknowns[count:]])
        return result

    kept: dict[bytes, Floats] = {}

    def slopes(unknowns: Floats) -> Floats:
        key = unknowns.tobytes()
        if key not in kept:
            kept.clear()
            kept[key] = stacked_slopes(unknowns)
        return kept[key]

    def above(all_unknowns: Floats) -> Floats:
        found = measured.one(all_unknowns[:count])
        return np.nan_to_num(_above(found, all_unknowns[count:]), nan=-1.0)

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

    end = minimize(
        cost,
        np.concatenate([start, tops]),
        jac=gradient,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * count + [(0.0, None)] * len(sizes),
        constraints=[{"type": "ineq", "fun": above, "jac": above_slopes}],
        options={"ftol": FIT_ENDED, "maxiter": steps},
    )
    return np.clip(end.x[:count], 0.0, 1.0), bool(end.status in (0, 8)), str(end.message)


def _above(found: Measures, tops: Floats) -> Floats:
    """What must not be negative: each top above the magnitudes of its group, and the margins."""
    parts = []
    for top, group in zip(tops, found.peaks, strict=True):
        parts += [top - group[0], top + group[0]]
    return np.concatenate([*parts, found.margins[0]])
