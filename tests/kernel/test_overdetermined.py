"""Matrices with more rows than columns: least squares, shortest multipliers, singular values."""

from __future__ import annotations

import numpy as np
import pytest
from kernel.compiler import COMPILER
from kernel.linear import EPSILON, LANES, Linear, compiled, exact_singular_values
from mpmath import mp

SIZES = [(2, 1), (3, 1), (3, 2), (5, 3), (5, 4), (6, 5), (8, 8), (10, 6), (12, 8)]
SHIFTS = [1, 2]

pytestmark = [
    pytest.mark.skipif(COMPILER is None, reason="no C++ compiler on this machine"),
    pytest.mark.parametrize(("m", "n"), SIZES),
]


@pytest.fixture(scope="module")
def linear(tmp_path_factory: pytest.TempPathFactory) -> Linear:
    return compiled(tmp_path_factory.mktemp("linear"))


def systems(m: int, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A random matrix, one with zeros on the diagonal, one that needs its last row, one with a
    negative first column; right sides of m and of n entries."""
    generator = np.random.default_rng([m, n])
    a = generator.uniform(-1, 1, (LANES, m, n))
    a[1, np.arange(n), np.arange(n)] = 0.0
    a[2, : m - 1, -1] = 0.0
    a[3, :, 0] = -np.abs(a[3, :, 0])
    return a, generator.uniform(-1, 1, (LANES, m)), generator.uniform(-1, 1, (LANES, n))


def tolerance(a: np.ndarray, solution: np.ndarray) -> float:
    """Householder solutions of systems of moderate size (Higham 2002, section 20.2): the square of
    the condition stands for the residual that no column reaches."""
    least, most = exact_singular_values(a)
    condition = most / least
    return float(16 * a.size * EPSILON * condition**2 * (1 + np.abs(solution).max()))


def normal_equations(a: np.ndarray, right: object) -> object:
    """(A^T A)^-1 times a vector, at 60 digits."""
    matrix = mp.matrix(a.tolist())
    return mp.lu_solve(matrix.T * matrix, right)


def numbers(vector: object) -> np.ndarray:
    return np.array([float(c) for c in vector])


def test_least_squares(linear: Linear, m: int, n: int) -> None:
    a, b, c = systems(m, n)
    found, _ = linear.tall(a, b, c)
    for lane in range(LANES):
        with mp.workdps(60):
            right = mp.matrix(a[lane].tolist()).T * mp.matrix(b[lane].tolist())
            expected = numbers(normal_equations(a[lane], right))
        np.testing.assert_allclose(found[lane], expected, rtol=0, atol=tolerance(a[lane], expected))


def test_unshifted_multipliers_are_the_shortest(linear: Linear, m: int, n: int) -> None:
    """y = A (A^T A)^-1 c."""
    a, b, c = systems(m, n)
    _, found = linear.tall(a, b, c)
    for lane in range(LANES):
        with mp.workdps(60):
            inner = normal_equations(a[lane], mp.matrix(c[lane].tolist()))
            expected = numbers(mp.matrix(a[lane].tolist()) * inner)
        np.testing.assert_allclose(found[lane], expected, rtol=0, atol=tolerance(a[lane], expected))


@pytest.mark.parametrize("shift", SHIFTS)
def test_shifted_multipliers_solve_the_same_equations(
    linear: Linear, m: int, n: int, shift: int
) -> None:
    a, b, c = systems(m, n)
    _, plain = linear.tall(a, b, c)
    _, shifted = linear.tall(a, b, c, shift)
    for lane in range(LANES):
        size = np.abs(shifted[lane]).max() * np.abs(a[lane]).max()
        np.testing.assert_allclose(
            a[lane].T @ shifted[lane], c[lane], rtol=0, atol=64 * m * EPSILON * (1 + size)
        )
        moved = np.linalg.norm(shifted[lane] - plain[lane])
        assert moved == 0 if m == n else moved > 0.1 * np.linalg.norm(plain[lane]) / m


def test_the_shifts_differ(linear: Linear, m: int, n: int) -> None:
    """In any null space, and not by a mere factor where it has room for more."""
    a, b, c = systems(m, n)
    (_, plain), (_, one), (_, two) = (linear.tall(a, b, c, shift) for shift in (0, *SHIFTS))
    for lane in range(LANES):
        parts = np.array([one[lane] - plain[lane], two[lane] - plain[lane]])
        found = np.linalg.svd(parts, compute_uv=False)
        assert np.sum(found > 0.01 * np.abs(plain[lane]).max()) == min(2, m - n)


def test_smallest_singular_values(linear: Linear, m: int, n: int) -> None:
    a, _, _ = systems(m, n)
    sigma = linear.least_singular_value(a)
    for lane in range(LANES):
        least, most = exact_singular_values(a[lane])
        assert sigma[lane] == pytest.approx(least, rel=0, abs=8 * m * EPSILON * most)


@pytest.mark.parametrize("shift", [0, *SHIFTS])
def test_a_lane_does_not_depend_on_its_neighbours(
    linear: Linear, m: int, n: int, shift: int
) -> None:
    a, b, c = systems(m, n)
    others = a.copy(), b.copy(), c.copy()
    others[0][1], others[0][2], others[0][3] = 0.0, np.nan, 1e200
    for array in others[1:]:
        array[1:] = np.inf
    for together, alone in zip(
        linear.tall(a, b, c, shift), linear.tall(*others, shift), strict=True
    ):
        assert together[0].tobytes() == alone[0].tobytes()
    together, alone = linear.least_singular_value(a), linear.least_singular_value(others[0])
    assert together[0].tobytes() == alone[0].tobytes()
