"""Rows of a few chains of dyads about dead centres and branch points; the command takes many."""

from __future__ import annotations

import os
from collections import Counter

import numpy as np
import pytest
from random_families.dyad_chains.case import Long
from random_families.dyad_chains.drawn import sweep
from random_families.dyad_chains.judge import judge

CHAINS = 60 * int(os.environ.get("MECHKIN_RANDOM", "1"))

pytestmark = pytest.mark.skipif(
    np.finfo(Long).eps > 1e-18, reason="the closed form needs long doubles of 64 bits"
)


def test_rows_about_dead_centres_and_branch_points() -> None:
    cases = [case for number in range(CHAINS) if (case := sweep(number, 40))]
    judged = [judge(case) for case in cases]
    assert [line for one in judged for line in one.wrong] == []
    assert [line for one in judged for line in one.lost] == []
    counts = sum((one.counts for one in judged), Counter[str]())
    right = sum(n for word, n in counts.items() if word.startswith("right"))
    assert right > 0.5 * counts.total()


def test_a_chain_of_other_dimensions_is_found_out() -> None:
    """The judge says wrong where a coordinate of the file is off by 1e-7 of itself."""
    case = next(case for number in range(100) if (case := sweep(number, 40)))
    dyad = case.chain.dyads[0]
    x, y, z = dyad.start
    other = dyad._replace(start=(x + x / 10**7, y, z))
    chain = case.chain._replace(dyads=(other, *case.chain.dyads[1:]))
    assert judge(case._replace(chain=chain)).wrong
