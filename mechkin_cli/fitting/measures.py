"""What is asked of unknowns: residuals to be small, magnitudes whose largest is to be small, and
margins not to be negative, all without units; and their derivatives.

Unknowns u lie in [0, 1], parts of their bounds. The cost is half the sum of the squares of the
residuals and of the largest magnitude of each group.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.tolerances import FIT_NARROW_STEP, FIT_STEP

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools, Floats


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
        found: Floats = np.maximum(-self.margins, 0.0).sum(axis=1)
        return found

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
        found = self._exact(unknowns)
        without = ~np.isfinite(found)
        self.entries, self.filled = found.size, int(without.sum())
        return np.where(without, self._differences(unknowns), found) if self.filled else found

    def _differences(self, unknowns: Floats) -> Floats:
        """Fourth-order differences, of all unknowns in one call; narrow or one-sided ones where
        those leave what has values."""
        count = len(unknowns)
        far, near = FIT_STEP, FIT_NARROW_STEP
        steps = np.array([-2 * far, -far, far, 2 * far])
        values, missing = self._beside(unknowns, steps)
        found = (values[0] - values[3] - 8.0 * (values[1] - values[2])) / (12.0 * far)
        bad = missing.any(axis=0) | ~np.isfinite(found).all(axis=1)
        if bad.any():
            values, missing = self._beside(unknowns, np.array([-near, 0.0, near]))
            low = np.where(missing[0], 1, 0)
            high = np.where(missing[2], 1, 2)
            of = np.arange(count)
            span = np.maximum(high - low, 1)[:, None] * near
            narrow = (values[high, of] - values[low, of]) / span
            found[bad] = np.nan_to_num(narrow[bad])
        slopes: Floats = found.T
        return slopes

    def _beside(self, unknowns: Floats, steps: Floats) -> tuple[Floats, Bools]:
        """`stacked` (steps, unknowns, all) one unknown moved at a time, and what is missing."""
        count = len(unknowns)
        moved = unknowns + steps[:, None, None] * np.eye(count)
        found = self.many(moved.reshape(-1, count).T)
        shape = (len(steps), count)
        return found.stacked.reshape(*shape, -1), found.missing.reshape(shape) > 0.0
