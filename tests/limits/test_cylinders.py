"""Cylinders: a boom by the law of cosines and the balance of moments, a platform on six of them by
its pose and the balance of forces, and a lift under a given force by its reduced inertia."""

from __future__ import annotations

import random
from math import atan2, cos, hypot, pi, sin
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk

FOOT, GRIP, CENTRE, MASS, INERTIA = (0.8, -0.3), 1.0, 1.25, 150.0, 80.0
HEAD = f"""
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{boom: {{mass: {MASS}, center_of_mass: [{CENTRE}, 0], inertia: {INERTIA}}}}}
joints: {{O: {{type: R, links: [ground, boom], point: [0, 0]}}}}
points: {{P: {{link: ground, at: [0.8, -0.3]}}, Q: {{link: boom, at: [1, 0]}}}}
loads: [{{type: gravity, g: [0, -9.80665]}}]
"""
BOOM = (
    HEAD
    + """
cylinders: {C: {from: P, to: Q, stroke: [0.3, 1.05], bore: 50 mm, rod: 28 mm}}
"""
)
SPATIAL = (
    BOOM.replace("plane: xy\n", "")
    .replace("inertia: 80.0", "inertia: {xx: 60, yy: 80, zz: 80}")
    .replace("[1.25, 0]", "[1.25, 0, 0]")
    .replace("point: [0, 0]", "point: [0, 0, 0], axis: [0, 0, 1]")
    .replace("[0.8, -0.3]", "[0.8, -0.3, 0]")
    .replace("at: [1, 0]", "at: [1, 0, 0]")
    .replace("[0, -9.80665]", "[0, -9.80665, 0]")
)
BASE, DROP = hypot(*FOOT), atan2(0.3, 0.8)


def boom_at(length: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The boom's angle by the law of cosines, and the lever of the cylinder about its bearing."""
    inner = np.arccos((BASE**2 + GRIP**2 - length**2) / (2.0 * BASE * GRIP))
    return inner - DROP, BASE * GRIP * np.sin(inner) / length


@pytest.mark.parametrize("text", [BOOM, SPATIAL], ids=["plane", "space"])
def test_a_boom_stands_by_the_law_of_cosines_and_its_moments(text: str) -> None:
    motion = "motion: {inputs: {C.s: {from: 0.4, to: 1.2, step: 0.1}}}\n"
    result = mk.loads(text + motion).analyze()
    length = np.linspace(0.4, 1.2, 9)
    angle, lever = boom_at(length)
    np.testing.assert_allclose(result["O.theta"], angle, rtol=0, atol=2e-15)
    force = MASS * 9.80665 * CENTRE * np.cos(angle) / lever
    np.testing.assert_allclose(result["C.force"], force, rtol=1e-13)
    np.testing.assert_allclose(result["C.pressure"], force / (pi / 4 * 0.05**2), rtol=1e-13)
    np.testing.assert_allclose(result["C.length"], length, rtol=1e-15)
    assert [w == "beyond-limit" for w in result["row.status"]] == [v > 1.05 for v in length]


def test_a_pulling_cylinder_has_its_pressure_at_the_rods_side() -> None:
    motion = "motion: {inputs: {C.s: {from: 0.4, to: 1, step: 0.1}}}\n"
    text = BOOM.replace("[0, -9.80665]", "[0, 9.80665]")
    result = mk.loads(text + motion).analyze()
    angle, lever = boom_at(np.linspace(0.4, 1.0, 7))
    force = -MASS * 9.80665 * CENTRE * np.cos(angle) / lever
    ring = pi / 4 * (0.05**2 - 0.028**2)
    np.testing.assert_allclose(result["C.pressure"], force / ring, rtol=1e-13)


def test_a_cylinder_that_is_moved_has_length_rate_and_stroke() -> None:
    motion = "motion: {inputs: {O.theta: {from: 0, to: 1.2, step: 0.1, rate: 2 rad/s}}}\n"
    result = mk.loads(BOOM + motion).analyze()
    inner = np.linspace(0.0, 1.2, 13) + DROP
    length = np.sqrt(BASE**2 + GRIP**2 - 2.0 * BASE * GRIP * np.cos(inner))
    np.testing.assert_allclose(result["C.s"], length, rtol=2e-15)
    rate = 2.0 * BASE * GRIP * np.sin(inner) / length
    np.testing.assert_allclose(result["C.s_dot"], rate, rtol=1e-14)
    assert [w == "beyond-limit" for w in result["row.status"]] == (length > 1.05).tolist()


@pytest.mark.parametrize("text", [BOOM, SPATIAL], ids=["plane", "space"])
def test_a_force_lifts_the_boom_by_the_reduced_inertia_up_to_its_stroke(text: str) -> None:
    run = "responses: {lift: {start: {O.theta: 0}, efforts: {C.s: 3 kN}, "
    result = mk.loads(text + run + "time: {from: 0, to: 2, step: 0.1}}}\n").respond("lift")
    angle, length = result["O.theta"], result["C.s"]
    expected, lever = boom_at(length)
    np.testing.assert_allclose(angle, expected, rtol=0, atol=1e-14)
    about_bearing = INERTIA + MASS * CENTRE**2
    moment = 3000.0 * lever - MASS * 9.80665 * CENTRE * np.cos(angle)
    np.testing.assert_allclose(result["O.theta_ddot"], moment / about_bearing, rtol=1e-12)
    # by energy: the force's work less what is lifted
    work = 3000.0 * (length - length[0]) - MASS * 9.80665 * CENTRE * np.sin(angle)
    np.testing.assert_allclose(result["O.theta_dot"] ** 2 * about_bearing / 2.0, work, atol=1e-7)
    assert result["C.s"][-1] == pytest.approx(1.05, rel=1e-12)
    assert result["row.event"][-1] == "C.s at its limit 1.05 m"


def test_a_platform_on_six_cylinders_stands_and_is_carried() -> None:
    rng = random.Random(7)
    around = [2.0 * pi * (k // 2) / 3.0 + (0.3 if k % 2 else -0.3) for k in range(6)]
    base = np.array([[2 * cos(a), 2 * sin(a), rng.uniform(-0.1, 0.1)] for a in around])
    above = [a + (pi / 3 - 0.5) * (1 if k % 2 else -1) for k, a in enumerate(around)]
    top = np.array([[cos(a), sin(a), 1.5 + rng.uniform(-0.1, 0.1)] for a in above])

    def moved(t: float) -> np.ndarray:
        turn = np.array([[cos(t), -sin(t), 0.0], [sin(t), cos(t), 0.0], [0.0, 0.0, 1.0]])
        return np.asarray(top @ turn.T + np.array([0.2 * t, -0.1 * t, 0.5 * t]))

    times = np.linspace(0.0, 0.4, 5)
    lengths = np.array([np.linalg.norm(moved(float(t)) - base, axis=1) for t in times])
    lines = [
        "format: 1",
        "units: {length: m, angle: rad, mass: kg, force: N}",
        "links: {top: {mass: 20, center_of_mass: [0.1, 0.2, 1.6], inertia: {xx: 1, yy: 1, zz: 1}}}",
        "loads: [{type: gravity, g: [0, 0, -9.80665]}]",
        "points:",
    ]
    for k in range(6):
        lines.append(f"  P{k}: {{link: ground, at: {base[k].tolist()}}}")
        lines.append(f"  Q{k}: {{link: top, at: {top[k].tolist()}}}")
    lines.append("  M: {link: top, at: [0.1, 0.2, 1.6]}")
    lines.append("cylinders:")
    lines += [f"  C{k}: {{from: P{k}, to: Q{k}}}" for k in range(6)]
    lines.append("motion:")
    lines.append("  inputs:")
    lines += [f"    C{k}.s: {{values: {lengths[:, k].tolist()}}}" for k in range(6)]
    result = mk.loads("\n".join(lines) + "\n").analyze()
    assert set(result["row.status"]) == {"ok"}
    for row, t in enumerate(times):
        now = moved(float(t))
        for k in range(6):
            np.testing.assert_allclose(result[f"Q{k}.position"][row], now[k], atol=1e-13)
        along = (now - base) / lengths[row][:, None]
        lever = np.cross(now, along)
        weight = np.array([0.0, 0.0, -20.0 * 9.80665])
        at = result["M.position"][row]
        loads = np.concatenate([weight, np.cross(at, weight)])
        forces = np.linalg.solve(np.vstack([along.T, lever.T]), -loads)
        told = [result[f"C{k}.force"][row] for k in range(6)]
        np.testing.assert_allclose(told, forces, rtol=1e-11, atol=1e-10)


@pytest.mark.parametrize("text", [BOOM, SPATIAL], ids=["plane", "space"])
def test_a_cylinder_is_drawn_and_its_rows_are_proven(text: str, tmp_path: Path) -> None:
    motion = "motion: {inputs: {C.s: {from: 0.4, to: 1, step: 0.1}}}\n"
    tables = "tables: [{name: lift, columns: [C.s, O.theta, C.force, C.pressure]}]\n"
    model = mk.loads(text + motion + tables)
    page = tmp_path / "view.html"
    model.view(page)
    assert '"kind":"cylinder"' in page.read_text(encoding="utf-8")
    assert set(model.analyze().result.proof) == {2}


@pytest.mark.parametrize(
    ("cylinder", "code"),
    [
        ("{from: P, to: R}", "unknown-point"),
        ("{from: P, to: P}", "same-point"),
        ("{from: P, to: G}", "same-link"),
        ("{from: P, to: N}", "no-length"),
        ("{from: P, to: Q, rod: 10 mm}", "rod-alone"),
        ("{from: P, to: Q, bore: 0}", "no-diameter"),
        ("{from: P, to: Q, bore: 10 mm, rod: 20 mm}", "thick-rod"),
        ("{from: P, to: Q, stroke: [2, 1]}", "no-room"),
        ("{from: P, to: Q, stroke: [1, 2], bore: 5 kg}", "expression"),
    ],
)
def test_cylinders_that_are_none_are_refused(cylinder: str, code: str) -> None:
    points = "G: {link: ground, at: [3, 0]}, N: {link: boom, at: [0.8, -0.3]}"
    text = HEAD.replace("Q: {", f"{points}, Q: {{")
    with pytest.raises(mk.InvalidFile) as refused:
        mk.loads(text + f"cylinders: {{C: {cylinder}}}\n")
    assert [d.code for d in refused.value.diagnostics] == [code]


def test_a_stroke_and_a_limit_of_one_length_are_refused() -> None:
    with pytest.raises(mk.InvalidFile) as refused:
        mk.loads(BOOM + "limits: {C.s: {max: 2}}\n")
    assert [d.code for d in refused.value.diagnostics] == ["two-choices"]


def test_named_expressions_may_read_a_cylinder() -> None:
    motion = "motion: {inputs: {C.s: {from: 0.4, to: 1, step: 0.1}}}\n"
    text = BOOM + motion + "quantities: {half: C.length/2, load: C.pressure/(1 MPa)}\n"
    result = mk.loads(text).analyze(["half", "load", "C.pressure"])
    np.testing.assert_allclose(result["half"], np.linspace(0.2, 0.5, 7), rtol=1e-15)
    np.testing.assert_allclose(result["load"], result["C.pressure"] / 1e6, rtol=1e-15)
