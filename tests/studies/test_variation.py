"""Which variants a study has, against `itertools.product`."""

import itertools

import numpy as np
import pytest

from mechkin_cli.studies.plan import StudyVariation
from mechkin_cli.variants.design import draws


def lines(variation: StudyVariation, begin: int, end: int) -> list[tuple[float, ...]]:
    found = variation.values(begin, end)
    return list(zip(*(found[name].tolist() for name in variation.names), strict=True))


@pytest.mark.parametrize("seed", range(6))
def test_lists_tables_and_samples_are_crossed(seed: int) -> None:
    generator = np.random.default_rng(seed)
    lists = {f"l{k}": generator.random(generator.integers(1, 5)) for k in range(seed % 4)}
    length = int(generator.integers(1, 4))
    table = {f"t{k}": generator.random(length) for k in range(seed % 3)}
    drawn = {f"d{k}": (lambda u: u) for k in range((seed + 1) % 3)}
    count = int(generator.integers(1, 7))
    samples = (count, draws("random", count, len(drawn), seed), drawn) if drawn else None
    variation = StudyVariation(lists, False, table, samples)
    points = draws("random", count, len(drawn), seed)(0, count) if drawn else [()]
    expected = [
        (*listed, *row, *point)
        for listed in itertools.product(*(values.tolist() for values in lists.values()))
        for row in (zip(*(v.tolist() for v in table.values()), strict=True) if table else [()])
        for point in map(tuple, points)
    ]
    assert len(variation) == len(expected)
    assert lines(variation, 0, len(variation)) == expected
    for cut in range(len(expected)):
        assert lines(variation, cut, len(expected)) == expected[cut:]


def test_lists_that_go_together() -> None:
    lists = {"a": np.array([1.0, 2.0, 3.0]), "b": np.array([4.0, 5.0, 6.0])}
    variation = StudyVariation(lists, True, {"c": np.array([7.0, 8.0])})
    assert lines(variation, 0, 6) == [(a, a + 3, c) for a in (1.0, 2.0, 3.0) for c in (7.0, 8.0)]
