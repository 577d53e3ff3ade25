"""Loops of R, P, C, H and S against the closure and dense Newton-Euler at 40 digits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from mechanisms.runs import model, run
from oracle import document, mp, newton_euler, read, solve, to_text
from references import FILE_OF

LIMIT = 1e-12
NAMES = (
    "sevenr",
    "rcrcr",
    "phchc",
    "rchch",
    "rcsr_csr",
    "rccc",
    "rprhrrr",
    "rrrrrrh",
    "rprrhc",
)
ROWS = (1, 10)
CASES = [(name, row) for name in NAMES for row in ROWS]
DEGREE = mp.pi / 180


COHERENT = {"length": "in", "angle": "deg", "mass": "lbm", "force": "lbm*in/s^2"}


@cache
def mechanism(name):
    """In coherent units; without masses the bare numbers of loads and reactions stay the same."""
    return read(to_text(document(FILE_OF[name]) | {"units": COHERENT}))


@cache
def solution(name, row):
    """The oracle's row, sought from the coordinates of the row under test."""
    guess = {}
    for joint, its in mechanism(name).joints.items():
        for coordinate in its.coordinates:
            value = float(run(name)[f"{joint}.{coordinate}"][row])
            guess[f"{joint}.{coordinate}"] = value * (DEGREE if coordinate == "theta" else 1)
    return solve(mechanism(name), mechanism(name).row(row), guess)


@cache
def reactions(name, row):
    return newton_euler(mechanism(name), solution(name, row))


def errors(pairs):
    """The largest error in parts of the largest expected value; pairs of arrays."""
    found, expected = (np.concatenate([np.ravel(p[i]) for p in pairs]) for i in (0, 1))
    expected = expected.astype(float)
    return np.max(np.abs(found - expected)) / np.max(np.abs(expected))


@pytest.mark.parametrize(("name", "row"), CASES)
@pytest.mark.parametrize("suffix", ["", "_dot", "_ddot"])
def test_coordinates(name, row, suffix):
    """Angles together and slides together."""
    pairs = {"theta": [], "s": []}
    for joint, its in mechanism(name).joints.items():
        for coordinate in its.coordinates:
            quantity = f"{joint}.{coordinate}{suffix}"
            expected = solution(name, row)[quantity]
            in_degrees = coordinate == "theta" and not suffix
            value = expected / DEGREE if in_degrees else expected
            pairs[coordinate].append((run(name)[quantity][row], value))
    for each in filter(None, pairs.values()):
        assert errors(each) <= LIMIT


@pytest.mark.parametrize(("name", "row"), CASES)
def test_links(name, row):
    links = mechanism(name).links
    expected = solution(name, row)
    assert errors([(run(name)[f"{k}.omega"][row], expected.omega(k)) for k in links]) <= LIMIT
    assert errors([(run(name)[f"{k}.alpha"][row], expected.alpha(k)) for k in links]) <= LIMIT


@pytest.mark.parametrize(("name", "row"), CASES)
def test_wrenches(name, row):
    """Forces of all joints together, moments about their points together."""
    joints = mechanism(name).joints
    expected = reactions(name, row)
    forces = [(run(name)[f"{j}.force"][row], expected.force[j]) for j in joints]
    moments = [(run(name)[f"{j}.moment"][row], expected.moment[j]) for j in joints]
    assert errors(forces) <= LIMIT
    assert errors(moments) <= LIMIT


@pytest.mark.parametrize(("name", "row"), CASES)
def test_effort(name, row):
    joint, coordinate = model(name).graph.driven[0]
    expected = float(reactions(name, row).effort[f"{joint}.{coordinate}"])
    assert abs(run(name)[f"{joint}.effort"][row] - expected) <= LIMIT * abs(expected)
