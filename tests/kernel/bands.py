"""The kernel's bands, compiled alone in packs of four; arrays stand lane first.

A `Shape` is found here by itself, from the entries that may be there: rows of the kernel's band are
unknowns, columns equations, and the border stands last.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from kernel.compiler import compile_with

LANES = 4


def compiled(folder: Path) -> Bands:
    """Compiles the probe into a folder."""
    source = Path(__file__).with_name("band_probe.cpp")
    options = "-O1", "-shared", f"-DMECHKIN_LANES={LANES}"
    return Bands(ctypes.CDLL(str(compile_with(source, folder / "band_probe.so", *options))))


@dataclass(frozen=True, eq=False)
class Shape:
    """Which equations (rows) hold which unknowns (columns); the last `border` hold all."""

    holds: np.ndarray
    border: int

    @property
    def size(self) -> int:
        return len(self.holds)

    @cached_property
    def rows(self) -> np.ndarray:
        """begin, end, at, reach, swaps, last of each unknown."""
        n, inner = self.size, self.size - self.border
        reach = np.zeros(n, int)
        for k in range(n):
            held = np.flatnonzero(self.holds[: k + 1].any(axis=0))
            reach[k] = max(k + 1, held.max(initial=0) + 1) if k < inner else n
        end = np.zeros(n, int)
        for k in range(n):
            columns = np.flatnonzero(self.holds[:inner, : reach[k]].any(axis=1))
            end[k] = min(max(k + 1, columns.max(initial=0) + 1), inner)
        begin = [min(int(np.argmax(reach > u)), inner) for u in range(n)]
        widths = end - begin + self.border
        at = np.concatenate([[0], np.cumsum(widths)[:-1]])
        swaps = np.cumsum(reach - np.arange(n) - 1)
        held = self.holds[:inner]
        last = np.where(held.any(axis=0), inner - np.argmax(held[::-1], axis=0), 0)
        return np.ascontiguousarray(
            np.stack([begin, end, at, reach, swaps, last], axis=1), np.int32
        )

    @property
    def entries(self) -> int:
        begin, end = self.rows[:, 0], self.rows[:, 1]
        return int(np.sum(end - begin + self.border))

    def packed(self, matrices: np.ndarray) -> np.ndarray:
        """Entries of matrices (lanes, n, n) where the kernel has them."""
        inner = self.size - self.border
        found = np.zeros((len(matrices), self.entries))
        for u, (begin, end, at, *_) in enumerate(self.rows):
            found[:, at : at + end - begin] = matrices[:, begin:end, u]
            found[:, at + end - begin : at + end - begin + self.border] = matrices[:, inner:, u]
        return found


def chain(loops: int, border: int, generator: np.random.Generator) -> Shape:
    """Loops in a row: each holds a coordinate of that before, some of its own, and as many are left
    as the border has equations."""
    equations = [int(generator.integers(1, 4)) for _ in range(loops)]
    n = sum(equations) + border
    holds = np.zeros((n, n), bool)
    row, spare = 0, list(range(border))
    column = border
    for count in equations:
        own = [*spare, *range(column, column + count)]
        holds[row : row + count, own] = True
        row, column = row + count, column + count
        spare = sorted(generator.choice(own, border, replace=False))
    holds[n - border :] = True
    return Shape(holds, border)


def random_matrices(shape: Shape, generator: np.random.Generator) -> np.ndarray:
    """Matrices (lanes, n, n) with entries where the shape has them."""
    n = shape.size
    return np.where(shape.holds, generator.uniform(-1, 1, (LANES, n, n)), 0.0)


@dataclass(frozen=True)
class Bands:
    """Four matrices of one shape at once."""

    library: ctypes.CDLL

    def _call(self, name: str, shape: Shape, *arrays: np.ndarray | float) -> None:
        given = [
            ctypes.c_double(a) if isinstance(a, float) else ctypes.c_void_p(a.ctypes.data)
            for a in arrays
        ]
        rows = ctypes.c_void_p(shape.rows.ctypes.data)
        getattr(self.library, name)(shape.size, shape.border, shape.entries, rows, *given)

    def solved(self, shape: Shape, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, ...]:
        """x of J x = b, y of J^T y = b, signs of the determinants, least pivots."""
        entries = shape.packed(a)
        found = np.empty_like(b), np.empty_like(b), np.empty(LANES), np.empty(LANES)
        self._call("solve_band", shape, entries, b, *found)
        return found

    def in_doubles(self, shape: Shape, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, ...]:
        """x, y and z = J b by doubles alone."""
        entries = shape.packed(a)
        found = np.empty_like(b), np.empty_like(b), np.empty_like(b)
        self._call("solve_doubles", shape, entries, b, *found)
        return found

    def is_joined(
        self, shape: Shape, a: np.ndarray, origin: np.ndarray, limit: float
    ) -> np.ndarray:
        """Whether J is told to be joined with that of the origin by regular matrices."""
        entries, before, found = shape.packed(a), shape.packed(origin), np.empty(LANES)
        self._call("is_joined", shape, entries, before, limit, found)
        return found == 1.0

    def largest_inverse(
        self, shape: Shape, a: np.ndarray, rows: np.ndarray, columns: np.ndarray
    ) -> np.ndarray:
        """The largest singular values of diag(1 / columns) J^-1 diag(rows), as estimated."""
        entries, found = shape.packed(a), np.empty(LANES)
        self._call("largest_inverse", shape, entries, rows, columns, found)
        return found
