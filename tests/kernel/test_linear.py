"""Factors, solutions and smallest singular values of the kernel against 40 digits."""

from __future__ import annotations

import numpy as np
import pytest
from kernel.compiler import COMPILER
from kernel.linear import EPSILON, LANES, Linear, compiled, exact_singular_values
from mpmath import mp

SIZES = [1, 2, 3, 4, 5, 6, 7, 9, 12]

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C++ compiler on this machine")


@pytest.fixture(scope="module")
def linear(tmp_path_factory: pytest.TempPathFactory) -> Linear:
    return compiled(tmp_path_factory.mktemp("linear"))


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
def test_solutions(linear: Linear, n: int, transposed: bool) -> None:
    a, b = matrices(n)
    found = linear.square(a, b)[transposed]
    for lane in range(LANES):
        matrix = a[lane].T if transposed else a[lane]
        expected = exact(matrix, b[lane])
        # forward error of elimination with partial pivoting (Higham 2002, section 9.3)
        bound = 4 * n * EPSILON * np.abs(np.linalg.inv(matrix)) @ np.abs(matrix) @ np.abs(expected)
        assert np.all(np.abs(found[lane] - expected) <= bound)


@pytest.mark.parametrize("n", SIZES)
def test_smallest_singular_values(linear: Linear, n: int) -> None:
    a, _ = matrices(n)
    sigma = linear.least_singular_value(a)
    for lane in range(3):
        least, most = exact_singular_values(a[lane])
        assert sigma[lane] == pytest.approx(least, rel=0, abs=8 * n * EPSILON * most)


@pytest.mark.parametrize("n", [2, 3, 6, 9])
def test_singular_values_keep_their_digits_under_column_scaling(linear: Linear, n: int) -> None:
    """One-sided rotations are accurate to the condition of the matrix with its columns scaled."""
    generator = np.random.default_rng(n)
    a = generator.uniform(-1, 1, (LANES, n, n)) + n * np.eye(n)
    a *= 10.0 ** np.linspace(0, -40, n)
    sigma = linear.least_singular_value(a)
    for lane in range(LANES):
        least, _ = exact_singular_values(a[lane], digits=120)
        assert sigma[lane] == pytest.approx(least, rel=1e-13)


def test_a_matrix_without_full_rank_has_a_singular_value_of_rounding_size(linear: Linear) -> None:
    a = np.ones((LANES, 3, 3))
    a[1] = 0.0
    a[2, :, 1] = 0.0
    a[3] = [[1, 2, 3], [4, 5, 6], [7, 8, 9]]
    sigma = linear.least_singular_value(a)
    assert np.all(sigma <= [4 * EPSILON, 0.0, 0.0, 16 * 4 * EPSILON])


@pytest.mark.parametrize("n", SIZES)
def test_a_lane_does_not_depend_on_its_neighbours(linear: Linear, n: int) -> None:
    """Other pivots, more rotations or nonsense next door leave a lane's bits alone."""
    a, b = matrices(n)
    a_other, b_other = a.copy(), b.copy()
    a_other[1:], b_other[1:] = np.nan, np.inf
    for together, alone in zip(linear.square(a, b), linear.square(a_other, b_other), strict=True):
        assert together[0].tobytes() == alone[0].tobytes()
    together, alone = linear.least_singular_value(a), linear.least_singular_value(a_other)
    assert together[0].tobytes() == alone[0].tobytes()
