"""Stops whose values swing many times: `python -m random_families.swinging_stops 0:1000` takes
more."""

from __future__ import annotations

import pytest
from random_families.swinging_stops import judge


def test_passages_of_swinging_values_are_counted() -> None:
    wrong = {seed: judged for seed in range(40) if (judged := judge(seed)).word != "ok"}
    assert wrong == {}


@pytest.mark.parametrize("seed", [88, 155, 267, 289, 472, 525])
def test_both_passages_beside_a_kink_are_counted(seed: int) -> None:
    """Up and down near the top of abs(sin), in a step that ends beyond its next zero."""
    assert judge(seed).word == "ok"
