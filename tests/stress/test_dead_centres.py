"""Rows from 1 to 1e-11 degrees before a dead centre, against the oracle.

At a distance d the branch goes as q = q0 + c sqrt(d), so the condition k of the closure grows as
1 / sqrt(d), and so does dq/dx. An error e of the input, some eps because it is rounded to radians,
- moves a coordinate by k e,
- changes every rate, 1 / sqrt(d) and 1 / sqrt(d)^3, by parts e / d, that is k^2 e, of itself;
- and so the loads, which follow the accelerations.
So positions err by at most POSITION eps k, and the others by VELOCITY, ACCELERATION and LOAD times
eps k^2, relative. No algorithm in double precision does better than a constant. Measured: 1.1,
0.07, 0.18 and 0.24.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from oracle import fold, mp, newton_euler, read, solve
from stress.cases import DEAD_CENTRES, DISTANCES, towards

import mechkin_cli as mk
from mechkin_cli.verdict import Status

ENDS = tuple(DEAD_CENTRES)
DEGREE = mp.pi / 180
EPS = mp.mpf(2) ** -52
COORDINATES = ("O2.theta", "O2.s", "O4.theta")
ROWS = range(1, len(DISTANCES) + 1)
POSITION, VELOCITY, ACCELERATION, LOAD = 2.0, 0.25, 0.5, 0.5


@cache
def analysis(end: str):
    return mk.loads(towards(end)).analyze()


@cache
def dead_centre(end: str):
    first = oracle_row(end, 0)
    return fold(read(towards(end)), "O1.theta", first.coordinates)


@cache
def oracle_row(end: str, row: int):
    """A row of the oracle, sought on the first row's side of the dead centre."""
    mechanism = read(towards(end))
    if row == 0:
        return solve(mechanism, mechanism.row(0), mechanism.near)
    limit, there = dead_centre(end)
    before = oracle_row(end, row - 1)
    law = mechanism.row(row)
    shrink = mp.sqrt((law["O1.theta"][0] - limit) / (before["O1.theta"] - limit))
    guess = {n: there[n] + shrink * (before[n] - there[n]) for n in COORDINATES}
    return solve(mechanism, law, guess)


def unit(name: str):
    return DEGREE if name.endswith(".theta") else mp.one


@pytest.mark.parametrize("end", ENDS)
def test_the_place_that_the_rows_count_from(end):
    assert abs(dead_centre(end)[0] / DEGREE - mp.mpf(DEAD_CENTRES[end])) < mp.mpf("1e-18")


@pytest.mark.parametrize("end", ENDS)
def test_verdicts(end):
    """All rows are there and closed; the nearest ones are called near-singular."""
    found = analysis(end)
    wanted = np.where(found["row.condition"] > 1e7, Status.near_singular, Status.ok)
    assert np.array_equal(found.result.status, wanted)
    assert wanted[0] == Status.ok
    assert wanted[-1] == Status.near_singular
    assert np.all(found["row.residual"] <= 1e-14)
    assert np.all(found["row.power_error"] <= 1e-12)


@pytest.mark.parametrize("end", ENDS)
def test_the_branch_stays(end):
    there = dead_centre(end)[1]
    for name in COORDINATES:
        side = np.sign(analysis(end)[name] - float(there[name] / unit(name)))
        assert np.all(side == side[0])


@pytest.mark.parametrize("end", ENDS)
def test_condition_grows_as_one_by_root_of_the_distance(end):
    """From 1e-2 degrees on; the last distance is uncertain by the rounding of the input."""
    condition = analysis(end)["row.condition"][3:]
    ratios = condition[1:] / condition[:-1]
    assert np.all(np.abs(ratios / np.sqrt(10.0) - 1.0) < 0.003)


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("end", ENDS)
def test_positions(end, row):
    condition = analysis(end)["row.condition"][row]
    for name in COORDINATES:
        expected = oracle_row(end, row)[name]
        error = abs(mp.mpf(float(analysis(end)[name][row])) * unit(name) - expected)
        assert error <= POSITION * EPS * condition, name


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("end", ENDS)
def test_rates(end, row):
    condition = analysis(end)["row.condition"][row]
    for name in COORDINATES:
        for suffix, limit in (("_dot", VELOCITY), ("_ddot", ACCELERATION)):
            expected = oracle_row(end, row)[name + suffix]
            error = abs(mp.mpf(float(analysis(end)[name + suffix][row])) - expected)
            assert error <= limit * EPS * condition**2 * abs(expected), name + suffix


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("end", ENDS)
def test_loads(end, row):
    condition = analysis(end)["row.condition"][row]
    loads = newton_euler(read(towards(end)), oracle_row(end, row))
    pairs = [(analysis(end)["O1.effort"][row : row + 1], [loads.effort["O1.theta"]])]
    for joint in ("O1", "O2", "O3", "O4"):
        pairs.append((analysis(end)[f"{joint}.force"][row], loads.force[joint]))
    for found, expected in pairs:
        error = max(abs(mp.mpf(float(f)) - e) for f, e in zip(found, expected, strict=True))
        assert error <= LOAD * EPS * condition**2 * max(map(abs, expected))
