"""Inputs of small motions: forces and torques that the file names, and what programs for control
make of the state space."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.cli.vibrate import vibrate
from mechkin_cli.diagnostics import UsageError

CART = """
format: 1
plane: xy
name: cart with a pendulum
units: {length: m, force: N, angle: rad}
links:
  cart: {mass: 3, center_of_mass: [0, 0], inertia: 1}
  bob: {mass: 2, center_of_mass: [0, -0.5], inertia: 0.1}
joints:
  S: {type: P, links: [ground, cart], point: [0, 0], axis: [1, 0]}
  A: {type: R, links: [cart, bob], point: [0, 0]}
points:
  tip: {link: bob, at: [0, -0.8]}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: spring, joint: S, coordinate: s, stiffness: 70 N/m}
  - {type: damper, joint: A, coordinate: theta, damping: 0.3 N*m*s/rad}
  - {type: force, name: wind, link: bob, point: tip, force: [-6, 0]}
  - {type: force, name: jet, link: bob, point: tip, force: [0, 5], axes: link}
  - {type: torque, name: twist, link: bob, torque: -0.4}
  - {type: force, name: push, joint: S, value: "3 N/s*time"}
  - {type: torque, name: motor, joint: A, value: -2}
  - {type: force, name: odd, link: bob, point: tip, force: ["1 N/s*time", 1]}
  - {type: force, name: none, link: bob, point: tip, force: [0, 0]}
motion: {time: {from: 1, to: 1, count: 1}, inputs: {S.s: {at: 0.1}, A.theta: {at: 0.3}}}
"""
ANGLE = 0.3


def expected(name: str) -> list[float]:
    """Generalised forces along S.s and A.theta by the principle of virtual work; the tip is at
    s + 0.8 sin A, -0.8 cos A."""
    c, s = 0.8 * np.cos(ANGLE), 0.8 * np.sin(ANGLE)
    return {
        "wind": [-1.0, -c],
        # along (-sin A, cos A): the link's own y
        "jet": [-np.sin(ANGLE), -np.sin(ANGLE) * c + np.cos(ANGLE) * s],
        "twist": [0.0, -1.0],
        "push": [1.0, 0.0],
        "motor": [0.0, -1.0],
    }[name]


@pytest.mark.parametrize("name", ["wind", "jet", "twist", "push", "motor"])
def test_a_named_load_acts_along_its_own_direction(name: str) -> None:
    v = mk.loads(CART).vibration()
    assert v.coordinates == ("S.s", "A.theta")
    s = v.state_space([name], ["tip.position.x", "A.force"])
    force = np.array(expected(name))
    np.testing.assert_allclose(s.B[2:, 0], np.linalg.solve(v.mass, force), atol=1e-12)
    static = v.response([0.0, 0.7], name, ["S.s", "A.theta"]).values
    np.testing.assert_allclose(static[:, 0], np.linalg.solve(v.stiffness, force), atol=1e-11)
    w = 2 * np.pi * 0.7
    dynamic = v.stiffness - w * w * v.mass + 1j * w * v.damping
    np.testing.assert_allclose(static[:, 1], np.linalg.solve(dynamic, force), rtol=1e-9)


def test_what_a_named_load_does_to_reactions_at_once() -> None:
    """Newton's law of the bob alone: force at A = m a - what acts on it."""
    v = mk.loads(CART).vibration()
    for name, way in (("wind", [-1, 0]), ("twist", [0, 0]), ("motor", [0, 0])):
        s = v.state_space([name], ["A.force.x", "A.force.y"])
        first = s.B[2] + 0.5 * np.cos(ANGLE) * s.B[3], 0.5 * np.sin(ANGLE) * s.B[3]
        told = [2 * float(np.squeeze(a)) - f for a, f in zip(first, way, strict=True)]
        np.testing.assert_allclose(s.D[:, 0], told, atol=1e-11)


def test_what_has_no_direction_is_refused() -> None:
    v = mk.loads(CART).vibration()
    for name in ("odd", "none"):
        with pytest.raises(UsageError, match="no direction of its own"):
            v.response([1.0], name, ["S.s"])
    with pytest.raises(UsageError, match="no input gale"):
        v.response([1.0], "gale", ["S.s"])


def test_a_name_is_given_once() -> None:
    with pytest.raises(mk.InvalidFile, match="tip"):
        mk.loads(CART.replace("name: wind", "name: tip"))


def read(path: Path) -> tuple[list[str], list[str], np.ndarray]:
    """Names of rows and columns, and the numbers."""
    head, *rows = csv.reader(path.read_text(encoding="utf-8").splitlines())
    return [row[0] for row in rows], head[1:], np.array([row[1:] for row in rows], dtype=float)


def test_python_control_takes_the_files(tmp_path: Path) -> None:
    control = pytest.importorskip("control")
    file = tmp_path / "cart.yaml"
    file.write_text(CART, encoding="utf-8")
    vibrate(file, input_=["wind,S.s"], output=["tip.position.x,A.theta"], out=tmp_path, quiet=True)
    states, _, a = read(tmp_path / "A.csv")
    _, inputs, b = read(tmp_path / "B.csv")
    outputs, _, c = read(tmp_path / "C.csv")
    _, _, d = read(tmp_path / "D.csv")
    plain = [[name.replace(".", "_") for name in names] for names in (states, inputs, outputs)]
    system = control.ss(a, b, c, d, states=plain[0], inputs=plain[1], outputs=plain[2])
    assert system.input_labels == ["wind", "S_s"]
    v = mk.loads(CART).vibration()
    rates, ratios, _ = control.damp(system, doprint=False)
    told = sorted(2 * np.pi * v.frequencies), sorted(v.damping_ratios)
    # both of each pair of conjugate poles
    np.testing.assert_allclose(sorted(rates)[::2], told[0], rtol=1e-9)
    np.testing.assert_allclose(sorted(ratios)[::2], told[1], rtol=1e-8)
    frequencies = np.geomspace(0.1, 5, 7)
    answer = control.frequency_response(system, 2 * np.pi * frequencies)
    for k, name in enumerate(inputs):
        own = v.response(frequencies, name, outputs)
        np.testing.assert_allclose(answer.magnitude[:, k], own.amplitude, rtol=1e-8)
        turned = np.exp(1j * (answer.phase[:, k] - np.radians(own.phase)))
        np.testing.assert_allclose(turned, 1.0, atol=1e-8)
