"""Rank of a Jacobian by singular values, with the motions that it allows and the stresses."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


class Rank(NamedTuple):
    """Rank of the loops' closing: `motions` (freedoms, count) are what it allows, `stresses`
    (equations, redundant) the wrenches that hold each other; `gap` is the ratio of singular values
    at the rank."""

    motions: Floats
    stresses: Floats
    gap: float

    @property
    def clear(self) -> bool:
        """Whether the gap decides the rank."""
        return self.gap >= tolerances.RANK_GAP

    @property
    def doubt(self) -> str:
        """Why the rank is not clear, in words."""
        return f"a gap of {self.gap:.3g} between singular values"


def rank_of(matrix: Floats, zero: float) -> Rank:
    """Rank, motions and stresses; singular values below `zero` of the largest are none."""
    rows, columns = matrix.shape
    if not matrix.any():  # nothing closes, or welds alone
        return Rank(np.eye(columns), np.eye(rows), np.inf)
    left, values, right = np.linalg.svd(matrix)
    least = tolerances.RANK_ROUNDING * values[0]
    values = np.maximum(values, least)
    rank = int(np.count_nonzero(values > zero * values[0]))
    below = values[rank] if rank < len(values) else least
    return Rank(right[rank:].T, left[:, rank:], float(values[rank - 1] / below))
