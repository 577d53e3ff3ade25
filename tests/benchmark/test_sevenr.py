"""The 7R of the benchmark: its exact solution, its file, the yardstick's copy of it."""

import shutil
from math import pi

import numpy as np
import pytest
from benchmark.arithmetic import best, extended
from benchmark.exact import sevenr_specimen
from benchmark.kernel_case import BATCH
from benchmark.specimen import values
from benchmark.yardstick_kernel import Yardstick
from oracle import document, mp, newton_euler, read, solve
from properties.expected import expected

import mechkin_cli as mk
from benchmarks import sevenr

SEVENR = sevenr_specimen()
THETA1 = [0.75, 4.5]
SHOWN = ("J1.effort", "J1.force", "J4.moment", "J7.force", "J7.moment")


@pytest.fixture(scope="module")
def analysis():
    return mk.loads(sevenr.text()).analyze()


@pytest.fixture(scope="module")
def guess():
    near = mk.loads(sevenr.text(values(THETA1)))
    return [near.analyze([name])[name] for name in SEVENR.coordinates]


def test_exact_solution_is_that_of_the_oracle(guess):
    pytest.importorskip("mpmath")
    found = SEVENR.row_by_row(THETA1, guess, best())
    mechanism = read(document(sevenr.text()))
    for i, theta1 in enumerate(THETA1):
        inputs = {"J1.theta": (theta1, sevenr.RATE, mp.mpf("0.7"))}
        near = dict(zip(SEVENR.coordinates, (column[i] for column in guess), strict=True))
        solution = solve(mechanism, inputs, near)
        wanted = expected(mechanism, solution, newton_euler(mechanism, solution))
        wanted["J1.effort"] = wanted["J1.theta.effort"]
        for name in (*SEVENR.levels[1], *SHOWN):
            right = np.array([mp.in_mpmath(x) for x in wanted[name]], dtype=object)
            miss = np.atleast_1d(found[name][i]) - right
            # the oracle takes 0.505 as written, the matrices as the nearest double
            assert max(map(abs, miss)) < 1e-13 * max(map(abs, right)), name


def test_extended_precision_agrees_with_40_digits(guess):
    pytest.importorskip("mpmath")
    forty, found = SEVENR.row_by_row(THETA1, guess, best()), SEVENR.solution(THETA1, guess)
    for name in SEVENR.levels[2]:
        miss = np.asarray(found[name] - forty[name], dtype=np.float64)
        scale = np.max(np.abs(np.asarray(forty[name], dtype=np.float64)))
        assert np.max(np.abs(miss)) < 1e3 * extended().epsilon * scale, name


def test_the_file_makes_a_full_turn_and_returns(analysis):
    assert analysis.rows == 361
    assert set(analysis["row.status"]) == {"ok"}
    for name in SEVENR.coordinates:
        turns = (analysis[name][-1] - analysis[name][0]) / (2 * pi)
        assert turns == pytest.approx(round(turns), abs=1e-14)


def test_the_yardstick_runs_the_same_mechanism(analysis):
    if shutil.which("gcc") is None:
        pytest.skip("the yardstick needs gcc")
    with Yardstick() as yardstick:
        case = yardstick.case("sevenr")
        case.call(max(yardstick.widths), 2)()
    # its right-hand chain is walked from ground; angles are the same
    joints = (2, 3, 4, 7, 6, 5)
    rows = np.arange(BATCH) % 361
    unknowns = len(joints)
    for column, joint in zip(case.out[:unknowns], joints, strict=True):
        turn = (column - analysis[f"J{joint}.theta"][rows]) / (2 * pi)
        assert np.max(np.abs(turn - np.round(turn))) < 1e-14
    assert case.out[3 * unknowns] == pytest.approx(analysis["J1.effort"][rows], abs=1e-12)
