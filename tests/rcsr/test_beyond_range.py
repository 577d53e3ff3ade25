"""Sweeps past the dead centres of the branch, at 133.944 and 205.144 degrees of the crank."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from oracle import fold, mp, read, solve
from oracle.document import document, to_text
from references import RCSR, exact

import mechkin_cli as mk
from mechkin_cli.verdict import Status

DEGREE = mp.pi / 180
NEAR = {"O2.theta": "theta2", "O2.s": "s2", "O4.theta": "theta4"}
SWEEPS = {"up": (190, 210, "0.5", 204.5), "down": (150, 130, "0.5", 134.5)}
"""First and last row, step, and a row just before the fold."""


@cache
def swept(direction: str):
    first, last, step, _ = SWEEPS[direction]
    data = document(RCSR)
    law = data["motion"]["inputs"]["O1.theta"]
    law |= {"from": str(first), "to": str(last), "step": step}
    row = [float(x) for x in exact("rcsr")["theta1"]].index(first)
    data["assembly"] = {"near": {name: exact("rcsr")[column][row] for name, column in NEAR.items()}}
    return mk.loads(to_text(data)).analyze()


@cache
def dead_centre(direction: str):
    """The oracle's fold, in degrees, sought from the branch just before it."""
    return fold(read(RCSR), "O1.theta", last_solution(direction).coordinates)[0] / DEGREE


@cache
def last_solution(direction: str):
    return oracle_row(direction, SWEEPS[direction][3])


def oracle_row(direction: str, degrees: float):
    """The oracle on the branch, stepped from the first row by its velocities."""
    mechanism = read(RCSR)
    first = SWEEPS[direction][0]
    row = [float(x) for x in exact("rcsr")["theta1"]].index(first)
    units = {"O2.theta": DEGREE, "O2.s": 1, "O4.theta": DEGREE}
    guess = {n: mp.mpf(exact("rcsr")[c][row]) * units[n] for n, c in NEAR.items()}
    found = solve(mechanism, {"O1.theta": (first * DEGREE, 1)}, guess)
    steps = 12
    for k in range(1, steps + 1):
        x = (first + (mp.mpf(degrees) - first) * k / steps) * DEGREE
        time = x - found["O1.theta"]
        guess = found.coordinates | {
            n: found[n] + time * (found[f"{n}_dot"] + time * found[f"{n}_ddot"] / 2) for n in NEAR
        }
        found = solve(mechanism, {"O1.theta": (x, 1)}, guess)
    return found


@pytest.mark.parametrize("direction", SWEEPS)
def test_rows_beyond_are_kept_empty(direction):
    analysis = swept(direction)
    first, last, _, _ = SWEEPS[direction]
    sign = 1 if last > first else -1
    inputs = analysis["O1.theta"]
    assert inputs.tolist() == (first + 0.5 * sign * np.arange(41)).tolist()
    beyond = sign * inputs > sign * float(dead_centre(direction))
    assert 5 < beyond.sum() < 20
    assert np.all(analysis.result.status[beyond] == Status.beyond_dead_centre)
    assert np.all(analysis.result.status[~beyond] == Status.ok)
    for table in analysis.tables:
        for column in table.columns:
            if column.label != "theta1":
                assert np.isnan(column.values[beyond]).all()
                assert np.isfinite(column.values[~beyond]).all()


@pytest.mark.parametrize("direction", SWEEPS)
def test_the_place_of_the_dead_centre(direction):
    (note,) = [d for d in swept(direction).diagnostics if d.code == "dead-centre"]
    name, _, measured = note.measured.partition(" = ")
    degrees, unit = measured.split()
    assert (name, unit) == ("O1.theta", "deg")
    assert abs(mp.mpf(degrees) - dead_centre(direction)) <= mp.mpf("1e-9")


@pytest.mark.parametrize("direction", SWEEPS)
def test_the_oracle_finds_the_known_dead_centres(direction):
    known = {"up": "205.1439659451948", "down": "133.94397788381472"}[direction]
    assert abs(dead_centre(direction) - mp.mpf(known)) <= mp.mpf("1e-13")


@pytest.mark.parametrize("direction", SWEEPS)
def test_the_branch_never_changes(direction):
    """The two branches differ by which side of the fold's coordinate they are on."""
    analysis = swept(direction)
    there = fold(read(RCSR), "O1.theta", last_solution(direction).coordinates)[1]
    solved = np.isfinite(analysis["O4.theta"])
    side = np.sign(analysis["O4.theta"][solved] - float(there["O4.theta"] / DEGREE))
    wanted = np.sign(float(last_solution(direction)["O4.theta"] - there["O4.theta"]))
    assert np.all(side == wanted)


@pytest.mark.parametrize("direction", SWEEPS)
def test_a_row_just_before_the_dead_centre(direction):
    analysis, expected = swept(direction), last_solution(direction)
    row = analysis["O1.theta"].tolist().index(SWEEPS[direction][3])
    error = abs(mp.mpf(float(analysis["O4.theta"][row])) * DEGREE - expected["O4.theta"])
    assert error <= 8 * analysis["row.condition"][row] * mp.mpf(2) ** -52


@pytest.mark.parametrize("direction", SWEEPS)
def test_rows_without_solution_keep_the_input_and_not_its_rate(direction: str) -> None:
    analysis = swept(direction)
    solved = analysis.result.status <= int(Status.near_singular)
    assert not np.isnan(analysis["O1.theta"]).any()
    for name, written in (("O1.theta_dot", 0.1), ("O1.theta_ddot", 0.2), ("2*O1.theta_dot", 0.2)):
        assert (analysis[name][solved] == written).all()
        assert np.isnan(analysis[name][~solved]).all()
    assert 0 < solved.sum() < solved.size
