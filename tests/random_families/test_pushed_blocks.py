"""Blocks that rub and stop while forces jump and bend."""

from __future__ import annotations

import pytest
from random_families.pushed_blocks import judge


@pytest.mark.parametrize("first", [10, 20])
def test_ten_blocks_against_closed_accelerations(first: int) -> None:
    for seed in range(first, first + 10):
        judged = judge(seed)
        assert judged.word in ("ok", "unclear"), (seed, judged)


@pytest.mark.parametrize("seed", [47, 58, 142, 262])
def test_blocks_that_were_held_on_the_wrong_side_of_a_kink(seed: int) -> None:
    assert judge(seed).word == "ok"
