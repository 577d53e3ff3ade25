"""The slider-crank with friction at all joints against the oracle at 40 digits, row by row."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from friction.slider_crank import TEXT
from oracle import mp, read, solve
from oracle.friction import rub, rubbings, without_friction

import mechkin_cli as mk

JOINTS = ("A", "B", "C", "D")
ROWS = (0, 4, 9, 13, 18)


@cache
def run() -> mk.Analysis:
    words = ("force", "moment", "friction_force", "friction_moment", "friction_power")
    names = [f"{joint}.{word}" for joint in JOINTS for word in (*words, "normal_load")]
    return mk.loads(TEXT).analyze([*names, "A.effort", "B.theta", "D.s"], tables=[])


@pytest.mark.parametrize("row", ROWS)
def test_every_force(row):
    mechanism = read(without_friction(TEXT))
    guess = {"B.theta": run()["B.theta"][row] * float(mp.pi / 180), "D.s": run()["D.s"][row]}
    solution = solve(mechanism, mechanism.row(row), guess)
    found = rub(mechanism, solution, rubbings(TEXT))
    reactions = found.reactions
    pairs = [(run()["A.effort"][row], reactions.effort["A.theta"], 40.0)]
    for joint in JOINTS:
        pairs += [
            (run()[f"{joint}.force"][row], reactions.force[joint], 1.0),
            (run()[f"{joint}.moment"][row], reactions.moment[joint], 40.0),
            (run()[f"{joint}.normal_load"][row], found.normal[joint], 1.0),
            (run()[f"{joint}.friction_force"][row], found.force[joint], 1.0),
            (run()[f"{joint}.friction_moment"][row], found.moment[joint], 40.0),
            (run()[f"{joint}.friction_power"][row], found.power[joint], 1000.0),
        ]
    largest = max(float(mp.norm(force)) for force in reactions.force.values())
    for value, wanted, unit in pairs:
        expected = np.ravel(np.array(wanted, dtype=object)).astype(float)
        assert np.abs(np.ravel(value) - expected).max() <= 2e-14 * unit * largest


def test_the_powers_balance():
    analysis = mk.loads(TEXT).analyze(["A.effort", "row.power_error"], tables=[])
    assert (analysis["row.power_error"] <= 1e-14).all()
    assert all((run()[f"{joint}.friction_power"] > 0.0).all() for joint in JOINTS)
