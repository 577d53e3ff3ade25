"""Eigenvalues of the kernel against mpmath's and closed forms."""

from __future__ import annotations

from math import cos, pi, sqrt

import mpmath
import numpy as np
import pytest

from mechkin_cli.kernel import _kernel

SIZES = [1, 2, 3, 5, 8, 12]


@pytest.mark.parametrize("n", SIZES)
def test_symmetric_pairs(n: int) -> None:
    random = np.random.default_rng(n)
    a = random.normal(size=(n, n))
    a = a + a.T
    b = random.normal(size=(n, n))
    b = b @ b.T + 0.1 * np.eye(n)
    found = _kernel.symmetric_eigen(a, b)
    assert found is not None
    values, vectors = found
    with mpmath.workdps(40):
        factor = mpmath.cholesky(mpmath.matrix(b.tolist()))
        inverse = factor**-1
        expected = mpmath.eigsy(inverse * mpmath.matrix(a.tolist()) * inverse.T, eigvals_only=True)
        expected = np.array([float(value) for value in expected])
    size = np.abs(expected).max()
    np.testing.assert_allclose(values, expected, rtol=0.0, atol=1e-12 * size)
    np.testing.assert_allclose(vectors.T @ b @ vectors, np.eye(n), rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(a @ vectors, b @ vectors * values, rtol=0.0, atol=1e-11 * size)
    # the largest entry of each vector is positive
    assert (vectors[np.abs(vectors).argmax(axis=0), np.arange(n)] > 0.0).all()


def test_chain_of_masses() -> None:
    n = 60
    a = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    found = _kernel.symmetric_eigen(1e6 * a, np.eye(n))
    assert found is not None
    expected = [2e6 * (1.0 - cos(pi * k / (n + 1))) for k in range(1, n + 1)]
    np.testing.assert_allclose(found[0], expected, rtol=1e-12)


def test_indefinite_inertia_is_refused() -> None:
    assert _kernel.symmetric_eigen(np.eye(2), np.diag([1.0, -1.0])) is None
    assert _kernel.symmetric_eigen(np.eye(2), np.diag([1.0, 0.0])) is None
    assert _kernel.symmetric_eigen(np.full((2, 2), np.nan), np.eye(2)) is None
    assert _kernel.eigen(np.full((2, 2), np.inf)) is None
    with pytest.raises(ValueError, match="not square"):
        _kernel.eigen(np.zeros((2, 3)))


@pytest.mark.parametrize("n", SIZES)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_general_pairs(n: int, seed: int) -> None:
    random = np.random.default_rng(100 * n + seed)
    a = random.normal(size=(n, n))
    if seed == 1 and n % 2 == 0:  # a stiff vibration with a little damping
        half = n // 2
        spring = random.normal(size=(half, half))
        spring = 1e6 * (spring @ spring.T)
        a = np.block([[np.zeros((half, half)), np.eye(half)], [-spring, -a[:half, :half]]])
    found = _kernel.eigen(a)
    assert found is not None
    values, vectors = found[0] + 1j * found[1], found[2] + 1j * found[3]
    with mpmath.workdps(40):
        expected = mpmath.eig(mpmath.matrix(a.tolist()), left=False, right=False)
        expected = [complex(value) for value in expected]
    size = max(abs(value) for value in expected)
    for value in values:  # each is one of them, and takes it away
        nearest = min(expected, key=lambda other: abs(other - value))
        assert abs(nearest - value) < 1e-12 * size
        expected.remove(nearest)
    assert not expected
    np.testing.assert_allclose(np.linalg.norm(vectors, axis=0), 1.0, rtol=1e-12)
    off = np.abs(a @ vectors - vectors * values).max(axis=0)
    assert (off <= 1e-12 * (np.abs(a) @ np.abs(vectors)).max(axis=0)).all()
    complex_ones = np.flatnonzero(values.imag)
    firsts, seconds = complex_ones[::2], complex_ones[1::2]
    assert (values[firsts] == values[seconds].conj()).all()
    assert (values[firsts].imag > 0.0).all()
    assert (vectors[:, firsts] == vectors[:, seconds].conj()).all()


def test_damped_oscillator() -> None:
    found = _kernel.eigen(np.array([[0.0, 1.0], [-1e8, -20.0]]))
    assert found is not None
    np.testing.assert_allclose(found[0], [-10.0, -10.0], rtol=1e-12)
    exact = sqrt(1e8 - 100.0)
    np.testing.assert_allclose(found[1], [exact, -exact], rtol=1e-15)
