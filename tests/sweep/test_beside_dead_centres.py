"""Rows at a dead centre and a hair before it, in any order and alone: verdicts, signs of what is
infinite, and numbers beside it; the same for single positions (`Model.solve`).

What is exact is their closure, solved to 50 digits (`dead_centre_cases`), and the input's effort by
virtual power.
"""

from __future__ import annotations

from collections.abc import Iterator

import mpmath as mp
import numpy as np
import pytest
from dead_centre_cases import CASES, Case, slider_crank

import mechkin_cli as mk

BEFORE = (1.0, 1e-3, 1e-6, 1e-9, 1e-11)
"""Distances of the driven coordinate from its dead centre, in degrees or mm."""


CLOSEST = tuple(part / 10**k for k in range(10, 15) for part in (1.0, 0.3))
"""The same where rates lose their last digit."""


@pytest.fixture(autouse=True)
def _fifty_digits() -> Iterator[None]:
    with mp.workdps(50):
        yield


def check_exact(case: Case, status: str, speed: float, effort: float) -> None:
    """A position at the dead centre, on the branch that is meant; the rounding of the file's
    dimensions may put it a hair beyond."""
    if status == "beyond-dead-centre":
        assert np.isnan(speed)
        return
    assert status == "dead-centre"
    beside = case.speed(mp.mpf("1e-20") * case.unit * case.inward)
    assert speed == np.copysign(np.inf, float(beside))
    assert effort == np.copysign(np.inf, float(-case.torque * beside / case.rate))


def check_beside(case: Case, place: float, speed: float, effort: float, condition: float) -> None:
    """A position before it, to what the square of its condition leaves."""
    known = case.speed(mp.mpf(repr(place)) * case.unit * case.inward)
    load = -case.torque * known / case.rate
    within = 1e-14 * condition**2 + 1e-12
    assert speed == pytest.approx(float(known), rel=within)
    assert effort == pytest.approx(float(load), rel=within)


@pytest.mark.parametrize("order", ["last", "first"])
@pytest.mark.parametrize("case", CASES)
def test_sweeps_that_end_or_begin_at_a_dead_centre(case: Case, order: str) -> None:
    places = [*BEFORE, 0.0] if order == "last" else [0.0, *BEFORE[::-1]]
    r = case.swept(places)
    # which branch is near is another question
    case = case._replace(side=int(np.sign(r["A.theta"][places.index(1e-3)])))
    speeds, efforts = r["A.theta_dot"], r["D.effort"]
    for row, place in enumerate(places):
        told = r["row.status"][row]
        if place == 0.0:
            check_exact(case, told, speeds[row], efforts[row])
        elif told == "dead-centre":
            assert place < 1e-8
        elif place < 1.0:  # there the crank is far from where its root begins
            assert told in ("ok", "near-singular")
            check_beside(case, place, speeds[row], efforts[row], r["row.condition"][row])


@pytest.mark.parametrize("case", CASES)
def test_a_row_alone_at_a_dead_centre(case: Case) -> None:
    r = case.swept([0.0])
    (told,) = r["row.status"]
    assert told == "dead-centre"
    (speed,), (effort,) = r["A.theta_dot"], r[case.effort]
    assert np.isnan(speed) == np.isnan(effort)
    if not np.isnan(speed):  # two branches meet there; which is near may stay open
        check_exact(case, told, speed, effort)


@pytest.mark.parametrize("case", CASES)
def test_a_row_alone_beside_a_dead_centre(case: Case) -> None:
    """On the branch that is near, or with no number."""
    for place in (1e-6, 1e-8, *CLOSEST[::2]):
        r = case.swept([place])
        (told,), (speed,) = r["row.status"], r["A.theta_dot"]
        driven = mp.mpf(repr(place)) * case.unit * case.inward
        if told in ("ok", "near-singular"):
            assert speed == pytest.approx(float(case.speed(driven)), rel=0.15)
        else:  # the rounding of the file's dimensions may put it beyond
            assert told in ("dead-centre", "not-assembled")
            assert abs(case.gap(0, driven)) < 300 * np.spacing(1.0)


@pytest.mark.parametrize("order", ["to", "from"])
@pytest.mark.parametrize("case", CASES)
def test_a_rate_has_a_right_digit_or_none_is_told(case: Case, order: str) -> None:
    """Down to the roundings of the place itself; a row that says it stands at the dead centre is as
    far from it as roundings are in the loop's squared lengths, some ten each."""
    places = [1e-3, *CLOSEST][:: 1 if order == "to" else -1]
    r = case.swept(places)
    case = case._replace(side=int(np.sign(r["A.theta"][places.index(1e-3)])))
    for row, place in enumerate(places):
        told, speed = r["row.status"][row], r["A.theta_dot"][row]
        driven = mp.mpf(repr(place)) * case.unit * case.inward
        is_one = abs(case.gap(0, driven)) < 300 * np.spacing(1.0)
        if told == "dead-centre":
            assert is_one
            assert not np.isfinite(speed)
        elif told in ("ok", "near-singular"):
            assert speed == pytest.approx(float(case.speed(driven)), rel=0.15)
        else:  # the rounding of the file's dimensions may put it beyond
            assert told == "beyond-dead-centre"
            assert is_one


@pytest.mark.parametrize("case", CASES)
def test_single_positions(case: Case) -> None:
    r = case.swept([1.0, 1e-3, 0.0])
    model, case = r.model, case._replace(side=int(np.sign(r["A.theta"][1])))
    names = ["A.theta_dot", case.effort]
    for place in (0.0, *BEFORE[1:4]):
        given = float(f"{case.inward * place!r}")
        found = model.solve({case.driven: given}, names)
        if place == 0.0:
            check_exact(case, found.status, found["A.theta_dot"], found[case.effort])
        elif found.status == "ok":
            condition = 10.0 / np.sqrt(place * float(case.unit))
            check_beside(case, place, found["A.theta_dot"], found[case.effort], condition)
        else:
            assert found.status in ("near-singular", "dead-centre")
            assert place < 1e-6


def test_a_product_with_what_may_vanish_is_empty() -> None:
    """theta_dot sin theta has the limit s_dot/(r + r^2/l); the cosine is one there."""
    case = slider_crank(0)
    r = case.swept([1.0, 1e-3, 0.0])
    assert r["row.status"][2] == "dead-centre"
    assert np.isinf(r["A.theta_dot"][2])
    assert np.isnan(r["A.theta_dot*sin(A.theta)"][2])
    assert np.isnan(r["sin(A.theta)*A.theta_dot + A.theta_dot/1e9 - A.theta_dot/1e9"][2])
    at = mp.mpf("1e-3") * case.unit * case.inward
    known = case.speed(at) * mp.sin(case.crank(at))
    assert r["A.theta_dot*sin(A.theta)"][1] == pytest.approx(float(known), rel=1e-6)
    assert r["2*A.theta_dot*cos(A.theta)"][2] == r["A.theta_dot"][2]


def test_a_law_that_comes_to_rest_in_a_dead_centre() -> None:
    """Along it the crank's rate has a finite limit, so nothing is infinite that is not."""
    case = slider_crank(0)
    law = {"law": "harmonic", "from": f"{case.inward * 20} mm", "to": "0 mm"}
    motion = {"time": {"from": 0, "to": 1, "count": 5}, "inputs": {"D.s": law}}
    near = {"near": {"A.theta": 2 * case.side}}
    r = mk.load(case.file | {"motion": motion, "assembly": near}).analyze()
    assert r["row.status"].tolist() == ["ok"] * 4 + ["dead-centre"]
    for name in ("A.theta_dot", "A.theta_ddot", "D.effort"):
        assert np.isfinite(r[name][:4]).all()
        assert np.isnan(r[name][4])
