"""Sweeps that begin, end or turn back at a dead centre of a few random linkages."""

from __future__ import annotations

import os

import pytest
from random_families.at_dead_centres.case import FAMILIES
from random_families.at_dead_centres.judge import judge

LINKAGES = 25 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("family", FAMILIES)
def test_rows_at_and_beside_dead_centres(family: str) -> None:
    cases = [case for number in range(LINKAGES) if (case := FAMILIES[family](number))]
    judged = [judge(case) for case in cases]
    assert len(judged) >= 8
    assert [line for one in judged for line in one.lost] == []
    assert [line for one in judged for line in one.wrong] == []
