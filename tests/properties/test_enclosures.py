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
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism.derived import DERIVED_KINDS
from mechkin_cli.proofs.enclose import EnclosedInputs, Enclosure, enclose

DIGITS = mp.mpf(10) ** -40
"""What the oracle may be off."""


def enclosures(text: str) -> tuple[Any, dict[str, Enclosure]]:
    """All plain quantities, in SI, over all rows."""
    model = mk.loads(text)
    problem = model.problem
    wanted = [
        q for q in problem.quantities().values() if q.owner != "row" and q.kind not in DERIVED_KINDS
    ]
    result = model.analyze([q.name for q in wanted], tables=[]).result
    session = result.session
    rows = result.row_states
    given = EnclosedInputs.of(session)
    found = enclose(
        session, boxes_of(session, given, rows.states), given, wanted, turned=rows.turns
    )
    return model, dict(found)


def outside(
    true: dict[str, np.ndarray], found: dict[str, Enclosure], row: int
) -> tuple[list[tuple[str, float, float]], int]:
    """Quantities of a row whose true values are not in their enclosures, with how far these are
    from the middle and the radius; and how many numbers are enclosed."""
    wrong, known = [], 0
    for quantity, values in true.items():
        if quantity not in found:
            continue
        angle = quantity.endswith((".theta", ".theta1", ".theta2"))
        parts = (part[:, row] for part in found[quantity])
        for value, high, low, r in zip(values, *parts, strict=True):
            off = value - mp.mpf(float(high)) - mp.mpf(float(low))
            if angle:
                off -= 2 * mp.pi * mp.nint(off / (2 * mp.pi))
            if not abs(off) <= r + DIGITS:
                wrong.append((quantity, float(off), float(r)))
            known += bool(np.isfinite(r))
    return wrong, known


@pytest.mark.parametrize("name", CASES[::16])
def test_both_widths_enclose_to_the_same_bits(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    _, widest = enclosures(case(name).text)
    plain = _kernel.enclose
    monkeypatch.setattr(_kernel, "enclose", lambda plan, **given: plain(plan, lanes=2, **given))
    _, narrow = enclosures(case(name).text)
    for quantity, one in widest.items():
        assert np.array(one).tobytes() == np.array(narrow[quantity]).tobytes(), quantity


@pytest.mark.parametrize("name", CASES[::4])
def test_all_quantities_are_enclosed(name: str) -> None:
    its = case(name)
    model, found = enclosures(its.text)
    assert model.problem.units.length.factor == 1  # and all others SI, as the oracle's are then
    true = expected(its.mechanism, its.solution, its.reactions)
    wrong, known = outside(true, found, its.row)
    assert wrong == []
    assert known > 50
