"""Blocks that rub and stop while forces jump and bend."""

from __future__ import annotations

import pytest
from random_families.pushed_blocks import judge


@pytest.mark.parametrize("first", [10, 20])
def test_ten_blocks_against_closed_accelerations(first: int) -> None:
    for seed in range(first, first + 10):
        judged = judge(seed)
        assert judged.word in ("ok", "unclear"), (seed, judged)
