"""Samples: the same in any stretch, and of the distribution that was asked for."""

import numpy as np
import pytest
from scipy import stats

from mechkin_cli.variants.design import BLOCK, draws, normal, uniform

METHODS = ("random", "latin", "sobol")


@pytest.mark.parametrize("method", METHODS)
def test_any_stretch_is_a_part_of_the_whole(method: str) -> None:
    count = 3 * BLOCK + 17
    whole = draws(method, count, 3, 5)(0, count)
    assert whole.shape == (count, 3)
    generator = np.random.default_rng(0)
    for begin, end in np.sort(generator.integers(0, count + 1, (40, 2))).tolist():
        part = draws(method, count, 3, 5)(begin, end)
        assert np.array_equal(part, whole[begin:end])


@pytest.mark.parametrize("method", METHODS)
def test_another_seed_draws_other_samples(method: str) -> None:
    first, second = (draws(method, 64, 2, seed)(0, 64) for seed in (1, 2))
    assert not np.intersect1d(first, second).size


@pytest.mark.parametrize("method", METHODS)
def test_samples_are_even_in_every_dimension(method: str) -> None:
    found = draws(method, 4096, 4, 9)(0, 4096)
    for column in found.T:
        assert stats.kstest(column, "uniform").pvalue > 1e-3
    assert np.abs(np.corrcoef(found.T) - np.eye(4)).max() < 0.06


def test_a_latin_hypercube_has_one_sample_in_every_slice() -> None:
    found = draws("latin", 500, 3, 2)(0, 500)
    for column in found.T:
        assert np.array_equal(np.sort(np.floor(column * 500)), np.arange(500))


def test_a_sobol_sequence_is_balanced() -> None:
    found = draws("sobol", 256, 2, 3)(0, 256)
    # a net in base 2: each of the 256 boxes of any shape of area 1/256 has one point
    for halvings in range(9):
        boxes = np.floor(found * [2**halvings, 2 ** (8 - halvings)])
        assert len(np.unique(boxes, axis=0)) == 256


def test_independent_samples_do_not_depend_on_their_number() -> None:
    few, many = (draws("random", count, 2, 4)(0, 100) for count in (100, 10_000))
    assert np.array_equal(few, many)


def test_distributions_have_their_quantiles() -> None:
    # quantiles of the normal distribution to ten digits: tables of Abramowitz and Stegun 26.5
    levels = np.array([0.5, 0.8413447460685429, 0.9772498680518208])
    assert np.allclose(normal(levels, 2.0, 3.0), [2.0, 5.0, 8.0], rtol=0, atol=1e-12)
    assert np.allclose(uniform(np.array([0.25, 0.5]), -1.0, 3.0), [0.0, 1.0], rtol=0, atol=0)


def test_no_sample_gives_infinity() -> None:
    from mechkin_cli.variants.design import _inside

    assert np.isfinite(normal(_inside(np.array([0.0, 1.0])), 0.0, 1.0)).all()
