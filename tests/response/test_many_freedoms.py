"""Responses of more freedoms than links are summed one by one for: trees, loops in series, and
driven pivots, against dense equations of motion."""

from __future__ import annotations

import numpy as np
import pytest
from oracle.dynamics.response import prepare
from response.motions import has_same_bits, off, respond
from response.points_on_bars import GRAVITY, points_on_bars

START = {
    "B.s": 0.1,
    "C.theta": 0.3,
    "D.theta1": 0.2,
    "D.theta2": -0.1,
    "E.theta": 0.4,
    "F.theta": 0,
    "F.s": 0.1,
    "G.theta1": 0.2,
    "G.theta2": 0,
    "H.theta": 0,
}


def tree(driven: bool) -> str:
    """Branches on a body that turns: of hinges, with a slide, a cross and a screw's axis, and a
    loop; eleven freedoms, or ten beside a drive."""
    given = "driven: {A.theta: {law: sine, amplitude: 0.5, frequency: 1 Hz, offset: 0}}"
    start = ", ".join(f"{name}: {value}" for name, value in START.items())
    start = f"start: {{{start}{'' if driven else ', A.theta: 0'}}}"
    return f"""format: 1
name: tree
units: {{angle: rad}}
links:
  base: {{mass: 2, center_of_mass: [0.1, 0, 0.2], inertia: {{xx: 0.1, yy: 0.2, zz: 0.15, xy: .02}}}}
  car: {{mass: 1, center_of_mass: [1, 0.1, 0]}}
  c: {{mass: 0.7, center_of_mass: [1, -0.3, 0.1], inertia: {{xx: 0.02, yy: 0.02, zz: 0.03}}}}
  d: {{mass: 0.3, center_of_mass: [1.2, -0.9, 0.1], inertia: {{xx: 0.01, yy: 0.02, zz: 0.01}}}}
  e: {{mass: 0.4, center_of_mass: [-0.5, -0.4, 0], inertia: {{xx: 0.02, yy: 0.01, zz: 0.02}}}}
  ball: {{mass: 0.5, center_of_mass: [0.2, -0.6, 0.3], inertia: {{xx: 0.03, yy: 0.02, zz: 0.02}}}}
  screw: {{mass: 0.6, center_of_mass: [-0.5, -1, 0.2], inertia: {{xx: 0.02, yy: 0.03, zz: 0.02}}}}
  crank: {{mass: 0.2, center_of_mass: [0, 0.1, 0.5], inertia: {{xx: 0.01, yy: 0.01, zz: 0.01}}}}
  coupler: {{mass: 0.3, center_of_mass: [0.3, 0.2, 0.5], inertia: {{xx: 0.01, yy: 0.01, zz: 0.01}}}}
  rocker: {{mass: 0.2, center_of_mass: [0.7, 0.2, 0.5], inertia: {{xx: 0.01, yy: 0.01, zz: 0.01}}}}
joints:
  A: {{type: R, links: [ground, base], point: [0, 0, 0], axis: [0, 0.3, 1]}}
  B: {{type: P, links: [base, car], point: [1, 0, 0], axis: [1, 0.2, 0]}}
  C: {{type: R, links: [car, c], point: [1, 0, 0], axis: [0, 0.2, 1]}}
  D: {{type: U, links: [c, d], point: [1, -0.6, 0.1], axis: [1, 0, 0], axis2: [0, 0, 1]}}
  E: {{type: R, links: [base, e], point: [-0.5, 0, 0], axis: [0.3, 0, 1]}}
  F: {{type: C, links: [e, screw], point: [-0.5, -0.8, 0], axis: [0, 0.1, 1]}}
  G: {{type: U, links: [base, ball], point: [0.2, -0.2, 0.3], axis: [1, 0, 0], axis2: [0, 0, 1]}}
  H: {{type: R, links: [base, crank], point: [0, 0, 0.5], axis: [0, 0, 1]}}
  I: {{type: S, links: [crank, coupler], point: [0, 0.3, 0.5]}}
  J: {{type: U, links: [coupler, rocker], point: [0.7, 0.4, .5], axis: [1, 0, 0], axis2: [0, 0, 1]}}
  K: {{type: R, links: [rocker, base], point: [0.7, 0, 0.5], axis: [0.1, 0, 1]}}
loads:
  - {{type: gravity, g: [0, -{GRAVITY}, 0]}}
  - {{type: damper, joint: C, coordinate: theta, damping: 0.05}}
  - {{type: spring, joint: F, coordinate: s, stiffness: 30, free: 0}}
responses:
  run:
    {start}
    {given if driven else ""}
    time: {{from: 0, to: 0.6, step: 0.1}}
    tolerance: 1e-12
"""


NAMES = ("B.s", "C.theta", "D.theta1", "E.theta", "F.s", "H.theta", "C.theta_ddot", "H.theta_ddot")


def sine(t: float) -> tuple[float, float, float]:
    w = 2.0 * np.pi
    return 0.5 * np.sin(w * t), 0.5 * w * np.cos(w * t), -0.5 * w * w * np.sin(w * t)


@pytest.mark.parametrize("driven", [False, True])
def test_a_tree_with_a_loop(driven: bool) -> None:
    text = tree(driven)
    found = respond(text)
    exact = prepare(text, courses={"A.theta": sine} if driven else None).run()
    for name in (*NAMES, "A.theta"):
        assert off(found[name], exact[name]) < 1e-9, name


def parallelograms(count: int) -> str:
    """In series: each hangs on the coupler of the one before, which does not turn, so that couplers
    of 1 kg on cranks without mass move as points on bars of 1 m / count do."""
    length = 1.0 / count
    links, joints = [], []
    for k in range(count):
        x, y, before = 0.0, -k * length, f"c{k - 1}" if k else "ground"
        links += [f"  a{k}: {{}}", f"  b{k}: {{}}"]
        links.append(f"  c{k}: {{mass: 1, center_of_mass: [{x}, {y - length!r}], inertia: 0.1}}")
        joints += [
            f"  A{k}: {{type: R, links: [{before}, a{k}], point: [{x}, {y!r}]}}",
            f"  B{k}: {{type: R, links: [{before}, b{k}], point: [{x + 0.3!r}, {y!r}]}}",
            f"  C{k}: {{type: R, links: [a{k}, c{k}], point: [{x}, {y - length!r}]}}",
            f"  D{k}: {{type: R, links: [b{k}, c{k}], point: [{x + 0.3!r}, {y - length!r}]}}",
        ]
    starts = ", ".join(f"A{k}.theta: {start(k)!r}" for k in range(count))
    lines = ["format: 1", "plane: xy", "units: {length: m, angle: rad}", "links:", *links]
    lines += ["joints:", *joints, f"loads: [{{type: gravity, g: [0, -{GRAVITY}]}}]", "responses:"]
    lines += ["  run:", f"    start: {{{starts}}}", "    tolerance: 1e-11"]
    return "\n".join([*lines, "    time: {from: 0, to: 0.5, step: 0.1}\n"])


def start(k: int) -> float:
    return 0.3 - 0.07 * k


@pytest.mark.parametrize("count", [3, 8, 14])
def test_parallelograms_in_series(count: int) -> None:
    """From 7 on by composite bodies, before link by link."""
    found = respond(parallelograms(count))
    begin = [start(k) for k in range(count)]
    exact = points_on_bars(begin, np.linspace(0.0, 0.5, 6), 1e-12)
    for k in range(count):
        assert off(found[f"A{k}.theta"], exact[:, k]) < 1e-9, k


@pytest.mark.parametrize("text", [tree(True), parallelograms(8)])
def test_no_bit_depends_on_lanes_or_threads(text: str) -> None:
    has_same_bits(text, ["C.theta" if " A:" in text else "A7.theta", "row.energy_error"])
