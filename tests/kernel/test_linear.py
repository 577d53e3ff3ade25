"""Factors, solutions and smallest singular values of the kernel against 40 digits."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from kernel.compiler import COMPILER, compile_with
from mpmath import mp

LANES = 4
SIZES = [1, 2, 3, 4, 5, 6, 7, 9, 12]
EPSILON = 2.0**-52
Solved = tuple[np.ndarray, np.ndarray, np.ndarray]
Solver = Callable[[np.ndarray, np.ndarray], Solved]

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C++ compiler on this machine")


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Solver:
    """Solves four systems at once: matrices (4, n, n), right sides (4, n) -> x, y, sigma."""
    target = tmp_path_factory.mktemp("linear") / "linear_probe.so"
    source = Path(__file__).with_name("linear_probe.cpp")
    library = compile_with(source, target, "-O1", "-shared", f"-DMECHKIN_LANES={LANES}")
    probe = ctypes.CDLL(str(library)).linear_probe

    def call(a: np.ndarray, b: np.ndarray) -> Solved:
        a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
        x, y, sigma = np.empty_like(b), np.empty_like(b), np.empty(LANES)
        pointers = [ctypes.c_void_p(array.ctypes.data) for array in (a, b, x, y, sigma)]
        probe(ctypes.c_int(a.shape[1]), *pointers)
        return x, y, sigma

    return call


def matrices(n: int) -> tuple[np.ndarray, np.ndarray]:
    """A random one, one with zeros on the diagonal, one near rank n - 1, one of mixed scales."""
    generator = np.random.default_rng(n)
    a = generator.uniform(-1, 1, (LANES, n, n))
    if n > 1:
        np.fill_diagonal(a[1], 0.0)
        a[2, -1] = a[2, 0] + 1e-6 * a[2, -1]
    a[3] *= 10.0 ** generator.uniform(-3, 3, (n, 1))
    return a, generator.uniform(-1, 1, (LANES, n))


def exact(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    with mp.workdps(40):
        return np.array(
            [float(c) for c in mp.lu_solve(mp.matrix(a.tolist()), mp.matrix(b.tolist()))]
        )


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("transposed", [False, True], ids=["plain", "transposed"])
def test_solutions(solved: Solver, n: int, transposed: bool) -> None:
    a, b = matrices(n)
    found = solved(a, b)[transposed]
    for lane in range(LANES):
        matrix = a[lane].T if transposed else a[lane]
        expected = exact(matrix, b[lane])
        # forward error of elimination with partial pivoting (Higham 2002, section 9.3)
        bound = 4 * n * EPSILON * np.abs(np.linalg.inv(matrix)) @ np.abs(matrix) @ np.abs(expected)
        assert np.all(np.abs(found[lane] - expected) <= bound)


@pytest.mark.parametrize("n", SIZES)
def test_smallest_singular_values(solved: Solver, n: int) -> None:
    a, b = matrices(n)
    sigma = solved(a, b)[2]
    for lane in range(3):
        with mp.workdps(40):
            values = mp.svd_r(mp.matrix(a[lane].tolist()), compute_uv=False)
            least, most = float(min(values)), float(max(values))
        assert sigma[lane] == pytest.approx(least, rel=0, abs=8 * n * EPSILON * most)


@pytest.mark.parametrize("n", [2, 3, 6, 9])
def test_singular_values_keep_their_digits_under_column_scaling(solved: Solver, n: int) -> None:
    """One-sided rotations are accurate to the condition of the matrix with its columns scaled."""
    generator = np.random.default_rng(n)
    a = generator.uniform(-1, 1, (LANES, n, n)) + n * np.eye(n)
    a *= 10.0 ** np.linspace(0, -40, n)
    sigma = solved(a, np.ones((LANES, n)))[2]
    for lane in range(LANES):
        with mp.workdps(120):
            least = float(min(mp.svd_r(mp.matrix(a[lane].tolist()), compute_uv=False)))
        assert sigma[lane] == pytest.approx(least, rel=1e-13)


def test_a_matrix_without_full_rank_has_a_singular_value_of_rounding_size(solved: Solver) -> None:
    a = np.ones((LANES, 3, 3))
    a[1] = 0.0
    a[2, :, 1] = 0.0
    a[3] = [[1, 2, 3], [4, 5, 6], [7, 8, 9]]
    sigma = solved(a, np.ones((LANES, 3)))[2]
    assert np.all(sigma <= [4 * EPSILON, 0.0, 0.0, 16 * 4 * EPSILON])


@pytest.mark.parametrize("n", SIZES)
def test_a_lane_does_not_depend_on_its_neighbours(solved: Solver, n: int) -> None:
    """Other pivots, more rotations or nonsense next door leave a lane's bits alone."""
    a, b = matrices(n)
    together = solved(a, b)
    a_other, b_other = a.copy(), b.copy()
    a_other[1:], b_other[1:] = np.nan, np.inf
    alone = solved(a_other, b_other)
    for both, single in zip(together, alone, strict=True):
        assert both[0].tobytes() == single[0].tobytes()
