"""Finite and first-order freedom of linkages whose mobility is known, each from its published
construction."""

from __future__ import annotations

import pytest
from classics import osculating, planes, platforms, rings, robots, sheets
from classics.drawing import Classic

import mechkin_cli as mk

MODULES = (rings, planes, platforms, robots, osculating, sheets)
CASES = [case for module in MODULES for case in module.CASES]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_both_orders(case: Classic) -> None:
    found = mk.loads(case.text).mobility()
    assert found.diagnostics == ()
    assert (found.dimensions, found.first_order) == (case.dimensions, case.first_order)
    assert found.mobility == case.dimensions[0]
    assert len(found.idle) == case.idle


def test_no_case_has_the_name_of_another() -> None:
    assert len({case.name for case in CASES}) == len(CASES) >= 100
