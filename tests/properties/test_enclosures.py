"""Every quantity of random mechanisms lies in its enclosure: against the oracle's many digits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracle.numerics import mp
from properties.boxes import boxes_of
from properties.cases import CASES, case
from properties.expected import expected

import mechkin_cli as mk
from mechkin_cli.mechanism.derived_quantities import DERIVED_KINDS
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.solver.enclosures import Enclosure, Given, enclose

DIGITS = mp.mpf(10) ** -40
"""What the oracle may be off."""


def enclosures(text: str) -> tuple[Any, dict[str, Enclosure]]:
    """All plain quantities up to accelerations and forces, in SI, over all rows."""
    model = mk.loads(text)
    problem = model.problem
    wanted = [
        q
        for q in problem.quantities().values()
        if q.owner != "row"
        and q.kind not in DERIVED_KINDS
        and not demand_of(problem.mechanism, [q]) & Demand.JERK
    ]
    result = model.analyze([q.name for q in wanted], tables=[]).result
    session = result.session
    rows = result.row_states
    given = Given.of(session)
    found = enclose(
        session, boxes_of(session, given, rows.states), given, wanted, turned=rows.turns
    )
    return model, dict(found)


@pytest.mark.parametrize("name", CASES[::4])
def test_all_quantities_are_enclosed(name: str) -> None:
    its = case(name)
    model, found = enclosures(its.text)
    assert model.problem.units.length.factor == 1  # and all others SI, as the oracle's are then
    known = 0
    for quantity, values in expected(its.mechanism, its.solution, its.reactions).items():
        if quantity not in found:
            continue
        parts = (part[:, its.row] for part in found[quantity])
        angle = quantity.endswith((".theta", ".theta1", ".theta2"))
        for value, high, low, r in zip(values, *parts, strict=True):
            off = value - mp.mpf(float(high)) - mp.mpf(float(low))
            if angle:
                off -= 2 * mp.pi * mp.nint(off / (2 * mp.pi))
            assert abs(off) <= r + DIGITS, (quantity, float(off), r)
            known += bool(np.isfinite(r))
    assert known > 50
