"""Dead centres proven of a few random linkages; the command takes many."""

from __future__ import annotations

import os

import pytest
from random_families.dead_centres.case import FAMILIES, linkage
from random_families.dead_centres.judge import judge

LINKAGES = 6 * len(FAMILIES) * int(os.environ.get("MECHKIN_RANDOM", "1"))


def test_enclosures_hold_the_dead_centres():
    judged = [judge(linkage(number)) for number in range(LINKAGES)]
    assert [line for one in judged for line in one.false] == []
    met, proven = (sum(one[k] for one in judged) for k in (0, 1))
    assert met > LINKAGES
    assert proven >= 0.99 * met
    assert max(one.radius for one in judged) < 1e-10


@pytest.mark.parametrize("number", range(len(FAMILIES)))
def test_a_linkage_of_other_dimensions_is_found_out(number: int):
    """The judge says false where a coordinate in the closed form is off by 1e-9."""
    case = linkage(number)
    other = case.points[0][0] + "000001"
    points = ((other, *case.points[0][1:]), *case.points[1:])
    assert judge(case).met > 0
    assert judge(case._replace(points=points)).false
