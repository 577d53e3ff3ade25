"""Which rows are shown where there are more than a page holds: even steps, and what must not be
missed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Numbers = NDArray[np.intp]


def thinned(rows: ArrayLike, most: int, keep: ArrayLike = ()) -> Numbers:
    """At most `most` (two or more) of rising row numbers: all if there are no more; else the first
    and the last, those of them to `keep`, up to half of what is left, and others in even steps.

    Example:
        >>> thinned(range(100), 5, keep=[60]).tolist()
        [0, 33, 60, 66, 99]
    """
    numbers = np.asarray(rows, dtype=np.intp)
    if numbers.size <= most:
        return numbers
    kept = np.intersect1d(np.asarray(keep, dtype=np.intp), numbers)[: (most - 2) // 2]
    steps = np.linspace(0, numbers.size - 1, most - kept.size)
    even = numbers[steps.round().astype(np.intp)]
    return np.union1d(even, kept)


def turning_points(codes: ArrayLike) -> Numbers:
    """The rows on both sides of every change of a code.

    Example:
        >>> turning_points([0, 0, 0, 2, 2]).tolist()
        [2, 3]
    """
    changed = np.flatnonzero(np.diff(np.asarray(codes)))
    return np.union1d(changed, changed + 1).astype(np.intp)
