"""Rows at a dead centre and a hair before it, in any order and alone: verdicts, signs of what is
infinite, and numbers beside it; the same for single positions (`Model.solve`).

The mechanisms are RSSR loops and slider-cranks drawn in line, whose closure is one equation; it is
solved to 50 digits here, and the input's effort is that of virtual power.
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
BEFORE = (1.0, 1e-3, 1e-6, 1e-9, 1e-11)
"""Distances of the driven coordinate from its dead centre, in degrees or mm."""


CLOSEST = tuple(part / 10**k for k in range(10, 15) for part in (1.0, 0.3))
"""The same where rates lose their last digit."""


def bent(gap: Callable[[Any, Any], Any]) -> tuple[Any, Any]:
    """Of the closure's error at the dead centre: the slope by the driven coordinate, and what goes
    with the square of the crank's angle."""
    return mp.diff(lambda x: gap(0, x), 0), mp.diff(lambda t: gap(t, 0), 0, 2) / 2


def inward(gap: Callable[[Any, Any], Any]) -> int:
    """The sign of the driven coordinate where the loop closes."""
    slope, bend = bent(gap)
    return 1 if -slope / bend > 0 else -1


def _swapped(gap: Callable[[Any, Any], Any], driven: Any, crank: Any) -> Any:
    return gap(crank, driven)


class Case(NamedTuple):
    """A mechanism whose drawing is a dead centre of its input, and what is exact about it."""

    file: dict[str, Any]
    driven: str
    effort: str
    unit: Any
    """Of the driven coordinate, in rad or m."""
    side: int
    """Sign of the crank's angle on the branch that is meant."""
    inward: int
    """Sign of the driven coordinate where the loop closes."""
    gap: Callable[[Any, Any], Any]
    """The closure's error by crank angle and driven coordinate, in rad and m."""
    rate: Any
    torque: Any

    def crank(self, driven: Any) -> Any:
        """The crank's angle at a driven coordinate, rad."""
        slope, bend = bent(self.gap)
        start = self.side * mp.sqrt(-slope / bend * driven)
        return mp.findroot(partial(_swapped, self.gap, driven), start)

    def speed(self, driven: Any) -> Any:
        """The crank's rate, rad/s."""
        at = self.crank(driven)
        by_crank = mp.diff(lambda t: self.gap(t, driven), at)
        return -mp.diff(lambda x: self.gap(at, x), driven) / by_crank * self.rate

    def swept(self, places: list[float]) -> mk.Analysis:
        """The sweep through some distances from the dead centre, on the branch that is meant."""
        values = [f"{self.inward * one!r}" for one in places]
        unit = "rad/s" if self.driven == "D.theta" else "m/s"
        inputs = {self.driven: {"values": values, "rate": f"{float(self.rate)!r} {unit}"}}
        assembly = {"near": {"A.theta": 2 * self.side}}
        return mk.load(self.file | {"motion": {"inputs": inputs}, "assembly": assembly}).analyze()


def rssr(seed: int) -> Case | None:
    """A crank about z with its rod in the plane of crank and axis, and a rocker anyhow."""
    draw = random.Random(seed)

    def between(low: float, high: float) -> float:
        return round(draw.uniform(low, high), 2)

    crank, rod = between(0.3, 1), between(1.5, 3)
    along, across = draw.choice([(0.6, 0.8), (0.8, 0.6), (0.28, 0.96)])
    far = [round(crank + draw.choice([-1, 1]) * rod * along, 6), 0.0, round(rod * across, 6)]
    pivot = [between(-2, 2), between(-2, 2), between(-1, 1)]
    axis = [between(-1, 1), between(-1, 1), between(0.2, 1)]
    torque, rate, side = between(1, 5), draw.choice([1, -2]), draw.choice([1, -1])
    b, p, n = ([mp.mpf(str(x)) for x in given] for given in (far, pivot, axis))
    a = mp.mpf(str(crank))
    length = sum((x - y) ** 2 for x, y in zip(b, [a, 0, 0], strict=True))
    norm = mp.sqrt(sum(x * x for x in n))
    k, arm = [x / norm for x in n], [x - y for x, y in zip(b, p, strict=True)]
    cross = [k[1] * arm[2] - k[2] * arm[1], k[2] * arm[0] - k[0] * arm[2], 0]
    cross[2] = k[0] * arm[1] - k[1] * arm[0]
    dot = sum(x * y for x, y in zip(k, arm, strict=True))

    def gap(turn: Any, rocker: Any) -> Any:
        c, s = mp.cos(rocker), mp.sin(rocker)
        ball = [p[i] + arm[i] * c + cross[i] * s + k[i] * dot * (1 - c) for i in range(3)]
        pin = [a * mp.cos(turn), a * mp.sin(turn), 0]
        return sum((x - y) ** 2 for x, y in zip(ball, pin, strict=True)) - length

    slope, bend = bent(gap)
    if not 0.05 < abs(bend / slope) < 20:  # too flat or too sharp to be within reach at 1 degree
        return None
    file = {
        "format": 1,
        "units": {"length": "m"},
        "links": {"crank": {}, "rod": {}, "rocker": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]},
            "B": {"type": "S", "links": ["crank", "rod"], "point": [crank, 0, 0]},
            "C": {"type": "S", "links": ["rod", "rocker"], "point": far},
            "D": {"type": "R", "links": ["ground", "rocker"], "point": pivot, "axis": axis},
        },
        "loads": [{"type": "torque", "joint": "A", "value": torque}],
    }
    known = (mp.mpf(rate), mp.mpf(str(torque)))
    return Case(file, "D.theta", "D.effort", mp.pi / 180, side, inward(gap), gap, *known)


def slider_crank(seed: int) -> Case:
    """In a plane, or the same in space with more constraints than it needs; the slide drives."""
    draw = random.Random(seed)
    r, rod = draw.choice([0.5, 0.25, 1.5]), draw.choice([1.0, 2.0, 3.5])
    inner, plane = draw.random() < 0.5, draw.random() < 0.5
    reach = rod - r if inner else r + rod
    ends = {"A": (0, 0), "B": (-r if inner else r, 0), "C": (reach, 0), "D": (reach, 0)}
    pairs = [("ground", "crank"), ("crank", "rod"), ("rod", "block"), ("ground", "block")]
    joints: dict[str, Any] = {}
    for (name, place), links in zip(ends.items(), pairs, strict=True):
        joints[name] = {"type": "R", "links": list(links), "point": list(place)}
        if not plane:
            joints[name] |= {"point": [*place, 0], "axis": [0, 0, 1]}
    joints["D"] |= {"type": "P", "axis": [1, 0] if plane else [1, 0, 0]}
    torque, rate, side = draw.randint(1, 5), draw.choice([20, -30]), draw.choice([1, -1])
    file = {
        "format": 1,
        "units": {"length": "mm"},
        "links": {"crank": {}, "rod": {}, "block": {}},
        "joints": {
            name: joint | {"point": [1000 * x for x in joint["point"]]}
            for name, joint in joints.items()
        },
        "loads": [{"type": "torque", "joint": "A", "value": f"{torque} N*m"}],
    } | ({"plane": "xy"} if plane else {})

    def gap(turn: Any, slide: Any) -> Any:
        x = reach + slide - (-r if inner else r) * mp.cos(turn)
        return x**2 + (r * mp.sin(turn)) ** 2 - mp.mpf(rod) ** 2

    millimetre = mp.mpf("1e-3")
    rates = (rate * millimetre, mp.mpf(torque))
    return Case(file, "D.s", "D.effort", millimetre, side, inward(gap), gap, *rates)


def cases(count: int) -> list[Any]:
    found = []
    for seed in range(count):
        loop = rssr(seed)
        found += [] if loop is None else [pytest.param(loop, id=f"rssr-{seed}")]
        found.append(pytest.param(slider_crank(seed), id=f"slider-{seed}"))
    return found


with mp.workdps(50):
    CASES = cases(4 * TIMES)


@pytest.fixture(autouse=True)
def _fifty_digits() -> Iterator[None]:
    with mp.workdps(50):
        yield


def is_in_doubt(r: mk.Analysis) -> bool:
    """Whether the search for the first assembly met a singular one alone, and says so."""
    said = "in a singular position" in str([found.measured for found in r.diagnostics])
    return said and set(r["row.status"]) == {"not-assembled"}


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
    if is_in_doubt(r):
        return
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
    if is_in_doubt(r):
        return
    assert told == "dead-centre"
    # two branches meet there; which is meant may stay open, but no number is told
    assert not np.isfinite(r["A.theta_dot"]).any()
    assert not np.isfinite(r["D.effort"]).any()


@pytest.mark.parametrize("case", CASES)
def test_a_rate_has_a_right_digit_or_none_is_told(case: Case) -> None:
    """Down to the roundings of the place itself; a row that says it stands at the dead centre is as
    far from it as roundings are in the loop's squared lengths, some ten each."""
    places = [1e-3, *CLOSEST]
    r = case.swept(places)
    case = case._replace(side=int(np.sign(r["A.theta"][0])))
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
        if found.status == "not-converged":  # told, if not why
            assert place == 0.0
            assert np.isnan(found["A.theta_dot"])
        elif place == 0.0:
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
