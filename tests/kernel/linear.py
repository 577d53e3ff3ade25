"""The kernel's linear algebra, compiled alone in packs of four; matrices stand lane first."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from kernel.compiler import compile_with
from mpmath import mp

LANES = 4
EPSILON = 2.0**-52


def compiled(folder: Path) -> Linear:
    """Compiles the probe into a folder."""
    source = Path(__file__).with_name("linear_probe.cpp")
    target = folder / "linear_probe.so"
    options = "-O1", "-shared", f"-DMECHKIN_LANES={LANES}"
    return Linear(ctypes.CDLL(str(compile_with(source, target, *options))))


@dataclass(frozen=True)
class Linear:
    """Four systems at once: matrices (4, m, n), right sides (4, ...)."""

    library: ctypes.CDLL

    def square(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Solutions of A x = b and A^T y = b by LU with pivoting."""
        x, y = np.empty_like(b), np.empty_like(b)
        self.library.solve_square(a.shape[1], *map(_pointer, (a, b, x, y)))
        return x, y

    def tall(
        self, a: np.ndarray, b: np.ndarray, c: np.ndarray, shift: int = 0
    ) -> tuple[np.ndarray, np.ndarray]:
        """Least squares of A x = b; the shortest y with A^T y = c, then shifted."""
        x, y = np.empty_like(c), np.empty_like(b)
        before, after = map(_pointer, (a, b, c)), map(_pointer, (x, y))
        self.library.solve_tall(*a.shape[1:], *before, shift, *after)
        return x, y

    def least_singular_value(self, a: np.ndarray) -> np.ndarray:
        sigma = np.empty(LANES)
        self.library.least_singular_value(*a.shape[1:], _pointer(a), _pointer(sigma))
        return sigma

    def largest_inverse(self, a: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """Largest singular value of the inverse of diag(rows) A diag(columns), as estimated; of one
        pack of matrices, or of two together."""
        norm = np.empty(len(a))
        packs = len(a) // LANES
        self.library.largest_inverses(packs, a.shape[1], *map(_pointer, (a, rows, columns, norm)))
        return norm


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    assert array.flags.c_contiguous
    assert array.dtype == np.float64
    return ctypes.c_void_p(array.ctypes.data)


def exact_singular_values(a: np.ndarray, digits: int = 40) -> tuple[float, float]:
    """Smallest and largest."""
    with mp.workdps(digits):
        values = mp.svd_r(mp.matrix(a.tolist()), compute_uv=False)
        return float(min(values)), float(max(values))
