"""Counts of real roots against the eigenvalues of the companion matrix (numpy)."""

from __future__ import annotations

import random

import numpy as np

from mechkin_cli.search.loop_equation import Trigonometric, count_polynomial_roots, count_roots


def companion(g: Trigonometric) -> np.ndarray:
    """Roots z = exp(i q) of z^2 g."""
    high, low = (g.a2 - 1j * g.b2) / 2, (g.a1 - 1j * g.b1) / 2
    return np.roots([high, low, g.a0, np.conj(low), np.conj(high)])


def test_simple_roots_of_random_trigonometric_polynomials() -> None:
    rng, counts = random.Random(1), set()
    for _ in range(400):
        g = Trigonometric(*(rng.gauss(0, 1) for _ in range(5)))
        away = np.abs(np.abs(companion(g)) - 1.0)
        if np.any((away > 1e-9) & (away < 1e-3)):
            continue
        found = count_roots(g)
        assert found == int(np.count_nonzero(away < 1e-9))
        counts.add(found)
    assert counts == {0, 2, 4}


def test_simple_roots_of_random_polynomials() -> None:
    rng = random.Random(2)
    for degree in (1, 2, 3, 4):
        for _ in range(100):
            coefficients = tuple(rng.gauss(0, 1) for _ in range(degree + 1))
            roots = np.roots(coefficients[::-1])
            size = np.abs(np.imag(roots))
            if np.any((size > 1e-9) & (size < 1e-3)):
                continue
            padded = coefficients + (0.0,) * (4 - degree)
            assert count_polynomial_roots(padded) == np.count_nonzero(size < 1e-9)


def test_roots_that_errors_could_join_or_part_stay_undecided() -> None:
    """1 + cos q has a double root; moved by a part of the error it has two, or none."""
    for shift in (0.0, 1e-9, -1e-9):
        assert count_roots(Trigonometric(1.0 + shift, 1.0), 1e-8) is None
    assert count_roots(Trigonometric(1.0 + 1e-6, 1.0), 1e-8) == 0
    assert count_roots(Trigonometric(1.0 - 1e-6, 1.0), 1e-8) == 2
    assert count_roots(Trigonometric()) is None
    assert count_roots(Trigonometric(float("nan"), 1.0)) is None
    assert count_polynomial_roots((0.0, 0.0, 0.0)) is None
    assert count_polynomial_roots((1.0, 0.0, 0.0)) == 0
