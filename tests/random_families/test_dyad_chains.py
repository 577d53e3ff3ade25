"""Rows of a few chains of dyads about dead centres and branch points; the command takes many."""

from __future__ import annotations

import os
from collections import Counter

import numpy as np
import pytest
from random_families.dyad_chains.case import Long
from random_families.dyad_chains.drawn import sweep
from random_families.dyad_chains.judge import judge
from random_families.dyad_chains.varied import judge_variants, varied

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
    """The judge says wrong where a coordinate of the file is off by 1e-5 of itself."""
    case = next(case for number in range(100) if (case := sweep(number, 40)))
    dyad = case.chain.dyads[0]
    x, y, z = dyad.start
    other = dyad._replace(start=(x + x / 10**5, y, z))
    chain = case.chain._replace(dyads=(other, *case.chain.dyads[1:]))
    assert judge(case._replace(chain=chain)).wrong


def test_what_hangs_on_a_short_arc_may_move_far() -> None:
    """A slide of a hundredth of a millimetre next to its dead centre turns an arm of the next dyad
    by a thousand times as much; its row, far from singular, was not converged."""
    case = sweep(1257, 400)
    assert case is not None
    values = (0.0, case.values[35])
    near = ", ".join(f"{case.chain.name(k + 1)}: 0" for k in range(len(case.chain.dyads)))
    text = case.chain.text(f"values: {list(values)}", near, straight=False)
    found = judge(case._replace(text=text, values=values, start=0.0))
    assert found.counts == {"right: ok": 2}


def test_a_branch_point_is_passed_by_a_walk_that_begins_next_to_it() -> None:
    """The next dyads hang on the one that folds."""
    case = sweep(1026, 30)
    assert case is not None
    (place,) = (one for one in case.places if not one.inward)
    side = 1 if case.values[0] > place.at else -1
    ways = (0.02, 0.002, 1e-4, 1e-6, 1e-8, -1e-8, -1e-6, -1e-4, -0.01)
    values = tuple(place.at + side * way for way in ways)
    known = case.chain.judged(np.array([Long(values[0])]))[0][:, 0]
    near = ", ".join(f"{case.chain.name(k + 1)}: {float(x)!r}" for k, x in enumerate(known))
    text = case.chain.text(f"values: {list(values)}", near, straight=True)
    start = values[0]
    found = judge(case._replace(text=text, values=values, start=start, straight=True))
    assert found.wrong == []
    assert found.counts["lost behind a branch point: branch-lost"] == 0
    assert found.counts["right, behind a branch point: ok"] >= 1


def test_variants_about_dead_centres_and_branch_points() -> None:
    cases = [case for number in range(CHAINS // 2) if (case := varied(number, 25))]
    judged = [judge_variants(case) for case in cases]
    assert [line for one in judged for line in one.wrong] == []
    assert [line for one in judged for line in one.lost] == []


@pytest.mark.parametrize("number", [5084, 20040, 20306])
def test_variants_of_a_base_at_a_dead_centre_go_out_on_its_own_side(number: int) -> None:
    """Rounding decides on which side of the fold the first place beside the base is closed."""
    case = varied(number, 60)
    assert case is not None
    found = judge_variants(case)
    assert found.wrong == []
    assert found.lost == []


def test_a_variant_does_not_go_over_to_a_branch_that_passes_by_little() -> None:
    """A rod too long by 1e-12 of itself: two branches pass at 3e-5 rad from one another."""
    case = varied(5128, 60)
    assert case is not None
    ways = (1e-1, 1e-3, 1e-5, 1e-7, 0.0, -1e-7, -1e-5, -1e-3, -1e-1)
    found = judge_variants(case._replace(values=(case.start, *(way * case.start for way in ways))))
    assert found.wrong == []
    assert found.lost == []
