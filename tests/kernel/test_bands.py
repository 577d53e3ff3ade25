"""Bands of many loops: factors, solutions and conditions against dense matrices; the test of
branches against eigenvalues."""

from __future__ import annotations

import numpy as np
import pytest
from kernel.bands import LANES, Bands, Shape, chain, compiled, random_matrices
from kernel.compiler import COMPILER

EPSILON = 2.0**-52
LIMIT = 0.5
"""tolerances.SPECTRAL_RADIUS."""

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C++ compiler on this machine")


@pytest.fixture(scope="module")
def bands(tmp_path_factory: pytest.TempPathFactory) -> Bands:
    return compiled(tmp_path_factory.mktemp("bands"))


def shapes() -> list[Shape]:
    generator = np.random.default_rng(7)
    return [chain(loops, border, generator) for loops in (1, 3, 8, 14) for border in (1, 2, 3)]


SHAPES = shapes()


@pytest.mark.parametrize("number", range(len(SHAPES)))
def test_solutions_are_those_of_full_matrices(bands: Bands, number: int) -> None:
    shape, generator = SHAPES[number], np.random.default_rng(number)
    a = random_matrices(shape, generator)
    b = generator.uniform(-1, 1, (LANES, shape.size))
    x, y, sign, least = bands.solved(shape, a, b)
    again = bands.in_doubles(shape, a, b)
    for lane in range(LANES):
        inverse = np.abs(np.linalg.inv(a[lane]))
        for matrix, found in ((a[lane], x[lane]), (a[lane].T, y[lane])):
            exact = np.linalg.solve(matrix, b[lane])
            size = inverse if matrix is a[lane] else inverse.T
            # Higham 2002, section 9.3, and numpy's own rounding
            bound = 16 * shape.size * EPSILON * size @ (np.abs(matrix) @ np.abs(exact))
            assert np.all(np.abs(found - exact) <= bound)
        assert sign[lane] == np.linalg.slogdet(a[lane])[0]
        assert least[lane] > 0.0
        assert np.allclose(again[2][lane], a[lane] @ b[lane], rtol=0, atol=1e-14)
    # what is done is the same, whatever the numbers are packed in
    assert again[0].tobytes() == x.tobytes()
    assert again[1].tobytes() == y.tobytes()


def test_a_lane_does_not_depend_on_its_neighbours(bands: Bands) -> None:
    shape, generator = SHAPES[-1], np.random.default_rng(3)
    a, b = random_matrices(shape, generator), generator.uniform(-1, 1, (LANES, shape.size))
    a_other, b_other = a.copy(), b.copy()
    a_other[1:], b_other[1:] = np.nan, np.inf
    pairs = zip(bands.solved(shape, a, b), bands.solved(shape, a_other, b_other), strict=True)
    for together, alone in pairs:
        assert together[0].tobytes() == alone[0].tobytes()


def test_dead_centres_of_single_unknowns_do_no_harm(bands: Bands) -> None:
    """Zeros where pivots would be without exchange."""
    shape = chain(8, 1, np.random.default_rng(11))
    generator = np.random.default_rng(5)
    a = random_matrices(shape, generator)
    for lane in range(LANES):
        np.fill_diagonal(a[lane], 0.0)
    b = generator.uniform(-1, 1, (LANES, shape.size))
    x, *_ = bands.solved(shape, a, b)
    for lane in range(LANES):
        condition = np.linalg.cond(a[lane])
        assert np.allclose(x[lane], np.linalg.solve(a[lane], b[lane]), rtol=1e-13 * condition)


def steps(shape: Shape, size: float, generator: np.random.Generator) -> tuple[np.ndarray, ...]:
    """Matrices, and others some way off, each entry in parts of its own and of the largest."""
    a = random_matrices(shape, generator)
    way = size * np.where(shape.holds, generator.uniform(-1, 1, a.shape), 0.0)
    way[:, shape.size - shape.border :] = 0.0  # a chart's equations are those of the origin
    return a, a + way


def is_regular_way(a: np.ndarray, origin: np.ndarray) -> bool:
    """Whether no matrix of the segment is singular: no real eigenvalue of J^-1 J_0 - I from -1
    down."""
    values = np.linalg.eigvals(np.linalg.solve(a, origin) - np.eye(len(a)))
    real = values.real[np.abs(values.imag) < 1e-9]
    return not np.any(real <= -1.0)


@pytest.mark.parametrize("number", range(len(SHAPES)))
def test_nothing_singular_lies_on_a_way_that_is_told_to_be_regular(
    bands: Bands, number: int
) -> None:
    shape, generator = SHAPES[number], np.random.default_rng(100 + number)
    told = refused = singular = 0
    for size in (0.01, 0.03, 0.1, 0.3, 1.0):
        for _ in range(40):
            a, origin = steps(shape, size, generator)
            joined = bands.is_joined(shape, a, origin, LIMIT)
            for lane in range(LANES):
                is_regular = is_regular_way(a[lane], origin[lane])
                assert is_regular or not joined[lane]
                told, refused = told + bool(joined[lane]), refused + (not joined[lane])
                singular += not is_regular
    assert told > 50
    assert singular > 20
    assert refused > singular


def test_a_lost_branch_is_seen_where_the_sign_of_the_determinant_is_not(bands: Bands) -> None:
    """Two loops that change their sides together."""
    shape = Shape(np.eye(20, dtype=bool) | (np.arange(20) == 19)[:, None], 1)
    a = np.broadcast_to(np.eye(20), (LANES, 20, 20)).copy()
    a[:, -1] = 1.0
    origin = a.copy()
    origin[0, 3, 3] = origin[0, 7, 7] = -1.0
    origin[1, 3, 3] = 0.5001
    origin[2, 3, 3] = 1.9999
    origin[3, 3, 3] = 2.0001
    assert np.linalg.det(origin[0]) > 0.0
    assert bands.is_joined(shape, a, origin, LIMIT).tolist() == [False, True, True, False]


@pytest.mark.parametrize("loops", [4, 8, 16])
def test_small_steps_are_joined_whatever_the_number_of_loops(bands: Bands, loops: int) -> None:
    """Parallel cranks that turn by a fifth of a radian: what one loop allows, many do."""
    shape, a = parallel_cranks(loops, 0.9), cranks_at(loops, 0.9)
    assert bands.is_joined(shape, a, cranks_at(loops, 0.7), LIMIT).all()
    # all bars and cranks in one line, in between
    assert not bands.is_joined(shape, a, cranks_at(loops, -0.5), LIMIT).any()
    assert not bands.is_joined(shape, a, cranks_at(loops, 3.4), LIMIT).any()


def parallel_cranks(loops: int, angle: float) -> Shape:
    return Shape(cranks_at(loops, angle)[0] != 0.0, 1)


def cranks_at(loops: int, angle: float) -> np.ndarray:
    """Equations of bars of length 1 between cranks of length 1, each crank by itself: the angles of
    crank, bar, crank ..., and their sum."""
    n = 2 * loops + 1
    a = np.zeros((n, n))
    for k in range(loops):
        crank = -np.sin(angle), np.cos(angle)
        for row in range(2):
            a[2 * k + row, 2 * k] = crank[row]
            a[2 * k + row, 2 * k + 1] = (0.0, 1.0)[row]
            a[2 * k + row, 2 * k + 2] = -crank[row]
    a[-1] = 1.0 / np.sqrt(n)
    return np.broadcast_to(a, (LANES, n, n)).copy()


@pytest.mark.parametrize("number", range(len(SHAPES)))
def test_conditions_are_true_to_one_per_cent(bands: Bands, number: int) -> None:
    shape, generator = SHAPES[number], np.random.default_rng(200 + number)
    for _ in range(20):
        a = random_matrices(shape, generator)
        rows = generator.uniform(0.2, 5.0, shape.size)
        columns = generator.uniform(0.2, 5.0, shape.size)
        found = bands.largest_inverse(shape, a, rows, columns)
        for lane in range(LANES):
            weighted = a[lane] * columns / rows[:, None]
            exact = 1.0 / np.linalg.svd(weighted, compute_uv=False)[-1]
            assert 0.99 * exact <= found[lane] <= 1.001 * exact


def test_conditions_of_long_rows_of_equal_loops(bands: Bands) -> None:
    """Singular values in a cluster, as loops side by side have them."""
    loops = 30
    shape, a = parallel_cranks(loops, 1.0), cranks_at(loops, 1.0)
    ones = np.ones(shape.size)
    exact = 1.0 / np.linalg.svd(a[0], compute_uv=False)[-1]
    assert bands.largest_inverse(shape, a, ones, ones) == pytest.approx(exact, rel=0.01)
