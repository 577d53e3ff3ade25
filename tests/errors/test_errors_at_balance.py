"""True errors and sensitivities of places at which loads balance, against roots of 40 digits of the
same text."""

from __future__ import annotations

import random
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from random_families.four_bars import cases
from random_families.sprung_loops import rssr

import mechkin_cli as mk

mp.mp.dps = 40

ARM: dict[str, Any] = {
    "format": 1,
    "plane": "xy",
    "units": {"length": "m", "angle": "rad", "force": "N"},
    "parameters": {"k": "12.3 N*m", "far": "0.37 m", "weight": "1.7 kg", "lift": "0.3 N*m"},
    "links": {
        "a": {"mass": "weight", "center_of_mass": ["far", 0]},
        "b": {"mass": 0.9, "center_of_mass": [1.13, 0]},
    },
    "joints": {
        "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
        "B": {"type": "R", "links": ["a", "b"], "point": [0.71, 0]},
    },
    "loads": [
        {"type": "gravity", "g": [0, -9.81]},
        {"type": "spring", "joint": "A", "coordinate": "theta", "stiffness": "k/(1 rad)"},
        {"type": "spring", "joint": "B", "coordinate": "theta", "stiffness": "4.1 N*m/rad"},
        {"type": "torque", "joint": "B", "value": "lift/(1 s)*time"},
    ],
}
"""Two arms on springs of torsion under their weights; the second is lifted over time."""

GIVEN = {"k": "12.3", "far": "0.37", "weight": "1.7", "lift": "0.3"}


def angles(time: str, begin: tuple[float, float], **given: Any) -> mp.matrix:
    """Where both moments vanish."""
    k, far, weight, lift = (mp.mpf(str(given.get(name, GIVEN[name]))) for name in GIVEN)
    g, t = mp.mpf("9.81"), mp.mpf(time)

    def moments(a: Any, b: Any) -> list[Any]:
        second = mp.mpf("0.9") * g * mp.mpf("0.42") * mp.cos(a + b)
        first = (weight * far + mp.mpf("0.9") * mp.mpf("0.71")) * g * mp.cos(a) + second
        return [k * a + first, mp.mpf("4.1") * b + second - lift * t]

    return mp.findroot(moments, begin, tol=1e-36)


def slopes(time: str, begin: tuple[float, float], name: str) -> mp.matrix:
    """How they change with a parameter."""
    own, h = mp.mpf(GIVEN[name]), mp.mpf(10) ** -10

    def at(steps: int) -> mp.matrix:
        return angles(time, begin, **{name: own + steps * h})

    return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)


def swept() -> dict[str, Any]:
    return ARM | {
        "motion": {
            "time": {"from": 0, "to": 2.1, "step": 0.7},
            "rest": ["A.theta", "B.theta"],
        }
    }


def near() -> dict[str, Any]:
    return ARM | {
        "equilibria": {"one": {"near": {"A.theta": 0, "B.theta": 0}, "time": "1.4 s"}},
    }


def test_equilibria_are_off_by_what_is_told() -> None:
    r = mk.load(near()).equilibrium("one")
    exact = angles("1.4", (r["A.theta"][0], r["B.theta"][0]))
    for number, name in enumerate(("A.theta", "B.theta")):
        off = float(mp.mpf(float(r[name][0])) - exact[number])
        assert abs(off) < 1e-14
        assert r.errors[name][0] == pytest.approx(abs(off), abs=1e-25)


def test_rows_at_rest_are_off_by_what_is_told() -> None:
    r = mk.load(swept()).analyze()
    for row, time in enumerate(("0", "0.7", "1.4", "2.1")):
        exact = angles(time, (r["A.theta"][row], r["B.theta"][row]))
        for number, name in enumerate(("A.theta", "B.theta")):
            off = float(mp.mpf(float(r[name][row])) - exact[number])
            assert abs(off) < 1e-13
            assert r.errors[name][row] == pytest.approx(abs(off), abs=1e-25)


@pytest.mark.parametrize("name", list(GIVEN))
def test_sensitivities_of_places_are_those_of_the_implicit_function(name: str) -> None:
    m = mk.load(near() | swept())
    wanted = ["A.theta", "B.theta"]
    row = m.sensitivities(wanted, [name], run="one")
    rows = m.sensitivities(wanted, [name], run="sweep")
    for s, number in ((row, 0), (rows, 2)):
        begin = tuple(float(s.value(text)[number]) for text in wanted)
        exact = slopes("1.4", begin, name)
        for text, slope in zip(wanted, exact, strict=True):
            assert s[text, name][number] == pytest.approx(float(slope), rel=1e-11)
            assert s.verdict(text, name)[number] == "ok"


def test_held_coordinates_and_windows_are_repeated() -> None:
    text = ARM | {
        "equilibria": {
            "held": {"near": {"A.theta": 0}, "driven": {"B.theta": {"at": 0.1}}, "time": 1},
            "all": {
                "window": {"A.theta": {"from": -2, "to": 2}},
                "driven": {"B.theta": {"at": 0.1}},
            },
        }
    }
    m = mk.load(text)
    k, far, weight, g = (mp.mpf(x) for x in ("12.3", "0.37", "1.7", "9.81"))
    held = mp.mpf("0.1")

    def moment(a: Any) -> Any:
        first = (weight * far + mp.mpf("0.9") * mp.mpf("0.71")) * g * mp.cos(a)
        return k * a + first + mp.mpf("0.9") * g * mp.mpf("0.42") * mp.cos(a + held)

    for name in ("held", "all"):
        r = m.equilibrium(name)
        for row, angle in enumerate(r["A.theta"].tolist()):
            exact = mp.findroot(moment, angle, tol=1e-36)
            off = float(mp.mpf(angle) - exact)
            assert r.errors["A.theta"][row] == pytest.approx(abs(off), abs=1e-25)
            # what holds B
            effort = mp.mpf("0.9") * g * mp.mpf("0.42") * mp.cos(exact + held)
            effort += mp.mpf("4.1") * held - (mp.mpf("0.3") if name == "held" else 0)
            off = float(mp.mpf(float(r["B.effort"][row])) - effort)
            assert r.errors["B.effort"][row] == pytest.approx(abs(off), abs=1e-24)


def test_what_balances_all_along_has_no_place_of_its_own() -> None:
    wheel = {
        "format": 1,
        "plane": "xy",
        "links": {"a": {"mass": 1, "center_of_mass": [0, 0]}},
        "joints": {"A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]}},
        "loads": [{"type": "gravity", "g": [0, -9.81]}],
        "equilibria": {"e": {"near": {"A.theta": 20}}},
    }
    r = mk.load(wheel).equilibrium("e")
    assert r["row.event"][0].startswith("indifferent")
    assert np.isnan(r.errors["A.theta"]).all()


@pytest.mark.parametrize("rng", [*cases(821, 3)])
def test_places_of_loops_with_balls_change_as_differences_say(rng: random.Random) -> None:
    text = rssr(rng).text.replace("loads:", "parameters: {more: 0 N}\nloads:", 1)
    text += '  - {type: force, link: crank, point: one, force: [0, 0, "more"]}\n'
    m = mk.loads(text + "equilibria: {e: {window: {A.theta: {from: -3.14, to: 3.14}}}}\n")
    s = m.sensitivities(["A.theta", "D.theta"], ["more"], run="e")
    ends = [m.with_parameters({"more": at}).equilibrium("e", tables=[]) for at in (1e-4, -1e-4)]
    for name in ("A.theta", "D.theta"):
        slope = (ends[0][name] - ends[1][name]) / 2e-4
        assert s[name, "more"] == pytest.approx(slope, rel=1e-6, abs=1e-9)
