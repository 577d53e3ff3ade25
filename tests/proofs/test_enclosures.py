"""Rates up to jerks of proven rows lie in their enclosures, at 60 digits; forces of random
mechanisms: tests/properties/test_enclosures.py."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracle import solve
from proofs.test_boxes import DEGREE, ROWS, certificate, mechanism
from references import MECHANISMS, RCSR

import mechkin_cli as mk

DOUBLES = 1e-13
"""Of the largest of a quantity: what doubles leave, and what bounds in doubles are apart."""


def solution(name: str, row: int) -> Any:
    analysis, guess = certificate(name).analysis, {}
    for joint, its in mechanism(name).joints.items():
        for coordinate in its.coordinates:
            value = float(analysis[f"{joint}.{coordinate}"][row])
            guess[f"{joint}.{coordinate}"] = value * (DEGREE if coordinate == "theta" else 1)
    return solve(mechanism(name), mechanism(name).row(row), guess)


@pytest.mark.parametrize("name", ["rcsr", "sevenr", "rchch", "rcrcr", "rprhrrr"])
def test_true_rates_up_to_jerks_are_enclosed(name: str) -> None:
    proofs = certificate(name)
    found = {
        f"{joint}.{coordinate}{suffix}": proofs.enclosure(f"{joint}.{coordinate}{suffix}")
        for joint, its in mechanism(name).joints.items()
        for coordinate in its.coordinates
        for suffix in ("_dot", "_ddot", "_dddot")
    }
    for row in ROWS:
        true = solution(name, row)
        for quantity, (low, high) in found.items():
            assert low[row] <= true[quantity] <= high[row], (row, quantity)
            assert high[row] - low[row] <= DOUBLES * max(abs(high[row]), 1e-3)


def test_vectors_and_efforts_have_bounds() -> None:
    proofs = mk.load(RCSR).certify()
    for name, shape in (("O2.force", (27, 3)), ("O1.effort", (27,)), ("O4.theta", (27,))):
        low, high = proofs.enclosure(name)
        assert low.shape == high.shape == shape
        off = DOUBLES * np.abs(low).max()
        assert (low <= proofs.analysis[name] + off).all()
        assert (proofs.analysis[name] <= high + off).all()
        assert (high - low <= DOUBLES * np.abs(high)).all()


def test_reactions_that_are_not_unique_have_none() -> None:
    low, high = mk.load(MECHANISMS / "bennett.yaml").certify().enclosure("A.force")
    assert np.isnan(low).all()
    assert np.isnan(high).all()


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("no.such", "is no quantity"),
        ("row.condition", "not enclosed: a verdict"),
        ("row.proof", "is no quantity"),
        ("coupler.screw_pitch", "not enclosed: computed from other quantities"),
    ],
)
def test_what_is_not_enclosed_is_refused_with_the_reason(name: str, why: str) -> None:
    with pytest.raises(mk.UsageError, match=why):
        certificate("rcsr").enclosure(name)


@pytest.mark.parametrize(
    ("addition", "why"),
    [
        ("loads:\n  - {type: friction, joint: O4, coefficient: 0.1, radius: 5 mm}", "friction"),
        ("actuators: [O4.theta]\nloads:", "actuators"),
    ],
)
def test_forces_that_are_decided_in_doubles_are_refused_with_the_reason(
    addition: str, why: str
) -> None:
    text = RCSR.read_text(encoding="utf-8").split("\ntables:")[0]
    proofs = mk.loads(text.replace("\nloads:", f"\n{addition}", 1)).certify()
    with pytest.raises(mk.UsageError, match=why):
        proofs.enclosure("O2.force")
    assert np.isfinite(proofs.enclosure("O2.theta_dddot")[0]).all()
