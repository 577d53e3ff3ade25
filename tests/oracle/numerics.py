"""Numbers of 60 digits in a context of their own, and linear equations by elimination.

The context is private, so neither the default precision of mpmath nor another test changes a digit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mpmath import MPContext

mp = MPContext()
mp.dps = 60

Number = Any  # an mpf of `mp`


class UnsolvableError(ArithmeticError):
    """No solution, more than one, or Newton's method did not reach it."""


def linear_solve(matrix: Sequence[Sequence[Number]], right: Sequence[Number]) -> list[Number]:
    """Solve `matrix` x = `right`; with more equations than unknowns in the sense of least squares.

    Least squares go through the normal equations: half of the 60 digits remain, and consistent
    equations are solved exactly by the Newton steps around them.
    """
    unknowns = len(matrix[0]) if matrix else 0
    if len(matrix) < unknowns:
        raise UnsolvableError(f"{len(matrix)} equations for {unknowns} unknowns")
    if len(matrix) > unknowns:
        columns = list(zip(*matrix, strict=True))
        right = [mp.fsum(a * b for a, b in zip(c, right, strict=True)) for c in columns]
        matrix = [
            [mp.fsum(a * b for a, b in zip(c, d, strict=True)) for d in columns] for c in columns
        ]
    return _eliminate([[*row, value] for row, value in zip(matrix, right, strict=True)])


def _eliminate(rows: list[list[Number]]) -> list[Number]:
    """Gaussian elimination with partial pivoting on rows scaled by their largest entry."""
    count = len(rows)
    for row in rows:
        largest = max((abs(value) for value in row[:count]), default=mp.zero)
        if largest == 0:
            raise UnsolvableError("an equation without unknowns: the matrix is singular")
        row[:] = [value / largest for value in row]
    for k in range(count):
        pivot = max(range(k, count), key=lambda i: abs(rows[i][k]))
        if abs(rows[pivot][k]) < mp.mpf(10) ** (-mp.dps * 3 // 4):
            raise UnsolvableError("the matrix is singular")
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, count):
            if rows[i][k] != 0:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    solution = [mp.zero] * count
    for k in reversed(range(count)):
        known = mp.fsum(rows[k][j] * solution[j] for j in range(k + 1, count))
        solution[k] = (rows[k][count] - known) / rows[k][k]
    return solution
