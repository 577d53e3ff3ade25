"""Sweeps that begin, end or turn back at a dead centre of a few random linkages."""

from __future__ import annotations

import os

import pytest
from oracle import mp
from random_families.at_dead_centres.case import DIGITS, FAMILIES, sweep
from random_families.at_dead_centres.judge import judge

import mechkin_cli as mk

LINKAGES = 8 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("family", FAMILIES)
def test_rows_at_and_beside_dead_centres(family: str) -> None:
    cases = [case for number in range(LINKAGES) if (case := FAMILIES[family](number))]
    judged = [judge(case) for case in cases]
    assert len(judged) >= 4
    assert [line for one in judged for line in one.lost] == []
    assert [line for one in judged for line in one.wrong] == []


@pytest.mark.parametrize("number", [19, 29, 39, 59])
def test_variants_of_a_short_arm_come_beside_its_dead_centre(number: int) -> None:
    """What moves an arm of a thousandth of the rod is lost in rounding farther from it."""
    case = sweep(number, "alone")
    assert case is not None
    ((end,), unit) = case.values, "rad" if "theta" in case.linkage.driver else "m"
    parameter = f"parameters: {{p: {0.9 * end!r} {unit}}}\nlinks:"
    text = case.linkage.swept("values: [p]").replace("links:", parameter, 1)
    inward = -1 if end > 0 else 1
    places = [end + inward * way for way in (1e-9, 1e-10, 1e-11, 3e-12, 1e-12)]
    name = case.linkage.output
    found = mk.loads(text).vary({"p": [f"{place!r} {unit}" for place in places]}, [name])
    assert set(found.status[:, 0]) <= {"ok", "near-singular"}
    for place, value in zip(places, found[name][:, 0].tolist(), strict=True):
        with mp.workdps(DIGITS):
            at = case._replace(values=(place,))
            left, roundings = case.linkage.discriminant(mp.mpf(place)), at.roundings(0)
            within = mp.sqrt(left + roundings) - mp.sqrt(left) + mp.mpf("1e-9")
            assert abs(mp.sin((mp.mpf(value) - at.output(0)) / 2)) * 2 < within
