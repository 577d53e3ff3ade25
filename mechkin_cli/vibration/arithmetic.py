"""Linear algebra of small matrices with the same bits on every machine: IEEE + - * / sqrt alone,
element by element; matrices may be many at once, in their first axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.statics import summed

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


def times(a: Floats, b: Floats) -> Floats:
    """The product (..., n, k) of matrices (..., n, m) and (..., m, k)."""
    terms = np.moveaxis(a[..., :, :, None] * b[..., None, :, :], -2, 0)
    return summed(terms)


def solved(a: Floats, b: Floats) -> Floats:
    """The solutions (..., n, k) of A x = B by elimination with row pivots; nan or infinite where A
    is singular."""
    count, shape = a.shape[-1], np.broadcast_shapes(a.shape[:-2], b.shape[:-2])
    width = b.shape[-1]
    parts = [np.broadcast_to(x, (*shape, count, x.shape[-1])) for x in (a, b)]
    rows = np.concatenate(parts, axis=-1).reshape(-1, count, count + width)
    every = np.arange(len(rows))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for k in range(count):
            pivot = k + np.argmax(np.abs(rows[:, k:, k]), axis=1)
            chosen, other = rows[every, pivot].copy(), rows[:, k].copy()
            rows[every, pivot], rows[:, k] = other, chosen
            factor = rows[:, k + 1 :, k] / rows[:, k, k][:, None]
            rows[:, k + 1 :, k:] -= factor[:, :, None] * rows[:, k, None, k:]
        found = rows[:, :, count:].copy()
        for k in reversed(range(count)):
            found[:, k] /= rows[:, k, k][:, None]
            found[:, :k] -= rows[:, :k, k][:, :, None] * found[:, k, None]
    return found.reshape(*shape, count, width)


def inverse(a: Floats) -> Floats:
    """Inverses (..., n, n); nan or infinite where there is none."""
    return solved(a, np.eye(a.shape[-1]))


def turned(a: Floats) -> Floats:
    """Transposed matrices."""
    return np.swapaxes(a, -1, -2)
