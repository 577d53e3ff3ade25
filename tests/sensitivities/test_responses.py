"""Sensitivities of motions under forces against closed forms at 40 digits."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np

import mechkin_cli as mk

RIGHT = 1e-10
"""In parts of the largest of a column."""

PENDULUM = """
format: 1
plane: xy
units: {length: m, angle: deg, mass: kg, force: N}
parameters: {l: 0.5 m, from: -30 deg, pull: 20 N}
links:
  bob: {mass: 2, center_of_mass: [l, 0], inertia: 0.1}
joints:
  A: {type: R, links: [ground, bob], point: [0, 0]}
loads:
  - {type: force, link: bob, force: [0, -pull], point: [l, 0]}
responses:
  swing:
    start: {A.theta: from}
    time: {from: 0, to: 1, step: 0.25}
"""
OSCILLATOR = """
format: 1
units: {length: m, mass: kg, force: N}
parameters: {c: 300 N/m, d: 2 N*s/m, mu: 1.5 kg, x0: 40 m}
links:
  slider: {mass: mu, center_of_mass: [0, 0, 0]}
joints:
  P: {type: P, links: [ground, slider], point: [0, 0, 0], axis: [1, 0, 0]}
loads:
  - {type: spring, joint: P, coordinate: s, stiffness: c, free: 0}
  - {type: damper, joint: P, coordinate: s, damping: d}
responses:
  swing:
    start: {P.s: x0}
    time: {from: 0, to: 0.5, step: 0.1}
"""


def off(found: np.ndarray, true: list[float]) -> float:
    """How far from the true ones, in parts of the largest."""
    return float(np.abs(found - true).max() / np.abs(true).max())


def derivatives(function: Any, own: dict[str, str], name: str, times: np.ndarray) -> list[float]:
    with mp.workdps(40):
        here = {key: mp.mpf(value) for key, value in own.items()}
        return [
            float(mp.diff(lambda v, t=t: function(mp.mpf(t), {**here, name: v}), here[name]))
            for t in times
        ]


def angle(t: Any, p: dict[str, Any]) -> Any:
    """Of a pendulum let go at rest, in degrees: its angle from hanging, phi, has
    sin(phi/2) = k cd(w t, k) with k the sine of half of where it begins (Whittaker, Analytical
    Dynamics, section 44)."""
    w = mp.sqrt(p["pull"] * p["l"] / (2 * p["l"] ** 2 + mp.mpf("0.1")))
    k = mp.sin((mp.radians(p["from"]) + mp.pi / 2) / 2)
    return mp.degrees(2 * mp.asin(k * mp.ellipfun("cd", w * t, m=k**2))) - 90


def place(t: Any, p: dict[str, Any]) -> Any:
    """Of a damped oscillator let go at rest,."""
    decay = p["d"] / (2 * p["mu"])
    w = mp.sqrt(p["c"] / p["mu"] - decay**2)
    return p["x0"] * mp.exp(-decay * t) * (mp.cos(w * t) + decay / w * mp.sin(w * t))


def test_a_pendulum() -> None:
    own = {"l": "0.5", "from": "-30", "pull": "20"}
    s = mk.loads(PENDULUM).sensitivities(["A.theta", "A.theta_dot"], run="swing")
    for name in own:
        true = derivatives(angle, own, name, s.place)
        assert off(s["A.theta", name], true) < RIGHT, name
        assert s.verdict("A.theta", name).tolist() == ["ok"] * 5

    def rate(t: Any, p: dict[str, Any]) -> Any:
        return mp.radians(mp.diff(lambda at: angle(at, p), t))

    unit = s.unit_of("A.theta_dot")
    assert unit == "rad/s"
    assert off(s["A.theta_dot", "l"], derivatives(rate, own, "l", s.place)) < RIGHT


def test_a_damped_oscillator() -> None:
    own = {"c": "300", "d": "2", "mu": "1.5", "x0": "40"}
    s = mk.loads(OSCILLATOR).sensitivities(["P.s"], run="swing")
    for name in own:
        assert off(s["P.s", name], derivatives(place, own, name, s.place)) < RIGHT, name


def test_a_varied_model_keeps_the_values_that_were_given() -> None:
    varied = mk.loads(PENDULUM).with_parameters({"l": 0.6})
    s = varied.sensitivities(["A.theta"], ["l", "from"], run="swing")
    for name in ("l", "from"):
        true = derivatives(angle, {"l": "0.6", "from": "-30", "pull": "20"}, name, s.place)
        assert off(s["A.theta", name], true) < RIGHT, name


def test_the_row_of_a_stop_is_not_repeated() -> None:
    """It has a value, but moves along time with the parameter."""
    text = PENDULUM.replace("step: 0.25}", "step: 0.25}\n    stop: [{dead_centre: A.theta}]")
    s = mk.loads(text).sensitivities(["A.theta"], ["l"], run="swing")
    assert s.verdict("A.theta", "l").tolist() == ["ok"] * 4 + ["not-repeated"]
    assert np.isnan(s["A.theta", "l"]).tolist() == [False] * 4 + [True]
    assert np.isfinite(s.value("A.theta")).all()
