"""Gaussian elimination in any numbers that numpy can hold, rows of a batch at once."""

from __future__ import annotations

from typing import Any

import numpy as np


def eliminate(matrix: Any, right: Any) -> Any:
    """Solutions (rows, n) of systems (rows, n, n) by elimination with partial pivoting."""
    a = np.concatenate([matrix, right[:, :, None]], axis=2)
    rows, n = right.shape
    every = np.arange(rows)
    for k in range(n):
        pivot = k + np.argmax(np.abs(a[:, k:, k]), axis=1)
        a[every, pivot], a[:, k] = a[:, k].copy(), a[every, pivot]
        a[:, k] /= a[:, k, k][:, None]
        factors = a[:, :, k].copy()
        factors[:, k] = 0
        a -= factors[:, :, None] * a[:, k][:, None, :]
    return a[:, :, n]
