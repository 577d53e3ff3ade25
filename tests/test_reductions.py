"""Means over the way, against their definition and against themselves."""

import numpy as np
import pytest
from means import mean_over_the_way, rms_over_the_way

from mechkin_cli.tables.summary import REDUCTIONS, mean, root_mean_square


def some_rows(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Values of six variants with gaps at the end, at the start, between, and infinite ones; and
    places."""
    rng = np.random.default_rng(seed)
    rows = int(rng.integers(1, 30))
    values = rng.normal(size=(6, rows)) * 10.0 ** rng.integers(-200, 200)
    for row in values:
        kind = rng.integers(6)
        if kind == 1:
            row[rng.integers(rows) :] = np.nan
        elif kind == 2:
            row[: rng.integers(rows)] = np.nan
        elif kind == 3:
            row[rng.random(rows) < 0.5] = np.nan
        elif kind == 4:
            row[:] = np.nan
        elif kind == 5:
            row[rng.random(rows) < 0.3] *= np.inf
    at = np.cumsum(rng.uniform(-0.2, 1.0, rows) * (rng.random(rows) < 0.9))
    return values, at


@pytest.mark.parametrize("seed", range(60))
def test_means_are_those_of_the_definition(seed: int) -> None:
    values, at = some_rows(seed)
    size = np.abs(values).max(initial=1e-300, where=np.isfinite(values))
    for own, other in ((mean, mean_over_the_way), (root_mean_square, rms_over_the_way)):
        found = own(values, at)
        expected = np.array([other(row / size, at) for row in values]) * size
        assert np.allclose(found, expected, rtol=0.0, atol=1e-13 * size, equal_nan=True)
        # the same bits where every variant has places of its own, and for one variant alone
        assert found.tobytes() == own(values, np.tile(at, (6, 1))).tobytes()
        assert np.concatenate([own(row[None], at) for row in values]).tobytes() == found.tobytes()


@pytest.mark.parametrize("seed", range(20))
def test_rows_without_values_at_the_end_are_as_if_they_were_not_asked_for(seed: int) -> None:
    """A branch that ends before its last row has the mean of a run that ends there."""
    values, at = some_rows(seed)
    values = np.where(np.isfinite(values), values, 1.0)
    for rows in range(1, at.size):
        cut = values.copy()
        cut[:, rows:] = [[np.nan], [np.inf], [-np.inf]] * 2
        assert mean(cut, at).tobytes() == mean(values[:, :rows], at[:rows]).tobytes()


def test_a_row_with_no_way_to_a_neighbour_counts_for_nothing_beside_a_stretch() -> None:
    at = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    values = np.array([[1.0, 3.0, np.nan, 50.0, np.nan], [7.0, np.nan, 9.0, np.nan, 5.0]])
    assert mean(values, at).tolist() == [2.0, 7.0]
    values[0, 3] = np.inf
    assert mean(values, at)[0] == 2.0


def test_the_other_way_round_and_with_rows_in_between_means_are_the_same() -> None:
    at = np.array([0.0, 2.0, 3.0, 7.0, 8.0, 12.0])
    values = np.array([[1.0, 5.0, np.nan, 2.0, 4.0, 1.0]])
    more = np.linspace(0.0, 12.0, 97)
    dense = np.interp(more, at[[0, 1, 3, 4, 5]], values[0, [0, 1, 3, 4, 5]])
    dense[(more > 2.0) & (more < 7.0)] = np.nan
    expected = (2.0 * 3.0 + 1.0 * 3.0 + 4.0 * 2.5) / 7.0
    assert mean(values, at)[0] == pytest.approx(expected, rel=1e-15)
    assert mean(values[:, ::-1], at[::-1])[0] == pytest.approx(expected, rel=1e-15)
    assert mean(dense[None], more)[0] == pytest.approx(expected, rel=1e-14)


def test_what_is_infinite_is_the_extreme_and_no_part_of_a_mean() -> None:
    at = np.array([0.0, 1.0, 3.0, 4.0])
    values = np.array([[1.0, 3.0, 5.0, np.inf], [np.inf, 3.0, 5.0, -np.inf], [np.inf] * 4])
    found = {word: reduce(values).tolist() for word, reduce in REDUCTIONS.items()}
    inf, nan = np.inf, np.nan
    assert found["max"] == [inf, inf, inf]
    assert found["min"] == [1.0, -inf, inf]
    assert found["peak"] == [inf, inf, inf]
    np.testing.assert_array_equal(found["range"], [inf, inf, nan])
    # 1*(1+3)/2 + 2*(3+5)/2 = 10 over 3; 2*(3+5)/2 over 2
    np.testing.assert_allclose(mean(values, at), [10.0 / 3.0, 4.0, nan], rtol=1e-15)
    # 1*(1+9)/2 + 2*(9+25)/2 = 39 over 3; 2*(9+25)/2 over 2
    expected = [13.0**0.5, 17.0**0.5, nan]
    np.testing.assert_allclose(root_mean_square(values, at), expected, rtol=1e-15)
