"""Answers do not depend on what was asked before, on mechanisms written from the pages alone.

`MECHKIN_RANDOM` multiplies the number of mechanisms;
`python -P tests/random_families/same_answers 1000 0` asks as many.
"""

from __future__ import annotations

import os

import pytest
from random_families.same_answers.orders import differences

COUNT = 6 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(COUNT))
def test_an_answer_does_not_depend_on_what_was_asked_before(seed: int) -> None:
    found, _, _ = differences(seed)
    assert found == []


@pytest.mark.parametrize("seed", [1045, 156])
def test_an_answer_does_not_depend_on_what_freed_memory_holds(seed: int) -> None:
    """Rows whose rank is unclear at once, whose turns were read before they were written."""
    found, _, _ = differences(seed, spoil=True)
    assert found == []
