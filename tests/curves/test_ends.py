"""Where curves end: rows beyond are never told as ok, nor are assemblies there modes; splines
through points, and arcs, with their ends."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import CubicSpline

import mechkin_cli as mk

SLIDER = """
format: 1
plane: xy
units: {length: mm}
links: {slide: {}, follower: {}}
joints:
  S: {type: P, links: [ground, slide], point: [0, 0], axis: [1, 0]}
  F: {type: P, links: [ground, follower], point: [0, 30], axis: [0, 1]}
  D: {type: Ps, links: [pin, slide], point: [0, %s], curve: %s}
  W: {type: W, links: [follower, pin]}
motion: {inputs: {S.s: {from: %s, to: %s, step: %s, rate: 2, acceleration: 3, jerk: 4}}}
"""


def cam(height: str, curve: str, first: float, last: float, step: float) -> mk.Model:
    """A follower over a slide whose curve lifts it: at S.s the curve's place x = -S.s."""
    text = SLIDER % (height, curve, first, last, step)
    # a weld at the follower's end keeps the pin from turning: the slot takes no moment
    text = text.replace("pin, slide", "follower, slide").replace(
        "  W: {type: W, links: [follower, pin]}\n", ""
    )
    return mk.loads(text)


def test_rows_beyond_the_end_of_an_open_curve_are_not_ok() -> None:
    curve = "{at: ['u', '20 mm + u^2/(200 mm)'], from: -50 mm, to: 40 mm}"
    result = cam("20", curve, -60, 60, 10).analyze()
    u = -np.arange(-60.0, 61.0, 10.0)
    expected = ["ok" if -50.0 <= x <= 40.0 else "beyond-limit" for x in u]
    assert list(result["row.status"]) == expected
    inside = np.array(expected) == "ok"
    np.testing.assert_allclose(
        np.asarray(result["F.s"])[inside], u[inside] ** 2 / 200.0, atol=1e-10
    )
    np.testing.assert_allclose(1000.0 * np.asarray(result["D.u"]), u, atol=1e-10)


@pytest.mark.parametrize("way", ["slot: [1, 0]", "curve: {line: [[-50, 20], [40, 20]]}"])
def test_a_line_ends_where_it_is_drawn_to_end(way: str) -> None:
    text = (SLIDER % ("20", "{}", -60, 60, 10)).replace("curve: {}", way)
    text = text.replace("pin, slide", "follower, slide")
    text = text.replace("  W: {type: W, links: [follower, pin]}\n", "")
    status = list(mk.loads(text).analyze()["row.status"])
    if way.startswith("slot"):
        assert set(status) == {"ok"}
    else:
        assert status[:2] == ["beyond-limit", "beyond-limit"]
        assert status[-1] == "beyond-limit"
        assert set(status[2:-1]) == {"ok"}


POINTS = [[-60.0, 20.0], [-30.0, 26.0], [0.0, 20.0], [25.0, 14.0], [60.0, 22.0]]


def test_a_spline_through_points_is_that_of_its_chords() -> None:
    model = cam("20", f"{{points: {POINTS}}}", -55, 55, 10)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    points = np.array(POINTS)
    chords = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    spline = CubicSpline(chords, points)
    for row, u in enumerate(1000.0 * np.asarray(result["D.u"])):
        (x, y), (dx, dy), (ddx, ddy), _ = (spline(u, order) for order in range(4))
        assert -float(result["S.s"][row]) == pytest.approx(x, abs=1e-9)
        assert float(result["F.s"][row]) == pytest.approx(y - 20.0, abs=1e-9)
        rate = -2.0 / dx
        second = (-3.0 - ddx * rate * rate) / dx
        assert float(result["F.s_dot"][row]) == pytest.approx(dy * rate, abs=1e-9)
        expected = ddy * rate * rate + dy * second
        assert float(result["F.s_ddot"][row]) == pytest.approx(expected, abs=1e-8)


def test_a_closed_spline_goes_round() -> None:
    """A block on a crank's arm is guided round by a closed slot, twice."""
    angles = np.arange(8) * 2.0 * np.pi / 8
    points = np.stack([(60 + 8 * np.cos(2 * angles)) * np.cos(angles), 50 * np.sin(angles)], axis=1)
    text = f"""
format: 1
plane: xy
units: {{length: mm}}
links: {{arm: {{}}, block: {{}}}}
joints:
  A: {{type: R, links: [ground, arm], point: [0, 0]}}
  P: {{type: P, links: [arm, block], point: [68, 0], axis: [1, 0]}}
  D:
    type: Ps
    links: [block, ground]
    point: [68, 0]
    curve: {{points: {points.tolist()}, closed: true}}
motion: {{inputs: {{A.theta: {{from: 0, to: 720, step: 30}}}}}}
"""
    result = mk.loads(text).analyze()
    assert set(result["row.status"]) == {"ok"}
    closed = np.concatenate([points, points[:1]])
    chords = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    spline = CubicSpline(chords, closed, bc_type="periodic")
    u = 1000.0 * np.asarray(result["D.u"])
    np.testing.assert_allclose(u[24] - u[0], 2.0 * chords[-1], rtol=1e-12)
    place = spline(u % chords[-1])
    far = 68.0 + np.asarray(result["P.s"])
    theta = np.radians(result["A.theta"])
    np.testing.assert_allclose(
        place, np.stack([far * np.cos(theta), far * np.sin(theta)], 1), atol=1e-9
    )


def test_assemblies_beyond_the_end_are_no_modes() -> None:
    """An arm of 30 mm about the origin, its pin in half of a circle about (40, 0): one of two."""
    text = """
format: 1
plane: xy
units: {length: mm}
links: {arm: {}}
joints:
  A: {type: R, links: [ground, arm], point: [0, 0]}
  D: {type: Ps, links: [arm, ground], point: [18, 24], curve: %s}
"""
    full = mk.loads(text % "{center: [40, 0]}").modes()
    half = "{at: ['40 mm + r*cos(u)', 'r*sin(u)'], from: 0 deg, to: 180 deg}"
    parameters = "parameters: {r: 'sqrt(22^2 + 24^2)*1 mm'}\n"
    upper = mk.loads(parameters + text.lstrip() % half).modes()
    angle = np.degrees(2.0 * np.arctan2(24.0, 18.0))
    found = sorted(mode.coordinates["A.theta"] for mode in full.modes)
    np.testing.assert_allclose(found, [-angle, 0.0], atol=1e-9)
    (only,) = upper.modes
    assert only.coordinates["A.theta"] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("curve", "words"),
    [
        ("{arc: [[0, 0], [1, 1], [2, 2]]}", "the three places of an arc lie on a line"),
        ("{points: [[0, 0], [0, 0], [2, 2]]}", "this point is the one before it"),
        ("{line: [[0, 0], [0, 0]]}", "the line has no length"),
        ("{at: [u, 'u^2'], from: 0, to: 1 mm}", "expected a length"),
        ("{at: [u, u], from: 1 mm, to: 0}", "the parameter ends before it begins"),
        ("{at: [u, u], from: 1 mm, to: 20 deg}", "begin and end must be alike"),
        ("{center: [0, 0], closed: true}", "closed goes with at or points"),
        ("{center: [0, 0], points: [[0, 0], [1, 0], [2, 2]]}", "are two choices"),
        ("{at: [u, u]}", "says where its parameter begins and ends"),
        ("{center: [0, 20]}", "the radius is not positive"),
    ],
)
def test_curves_that_are_none_are_refused_with_words(curve: str, words: str) -> None:
    with pytest.raises(mk.InvalidFile) as error:
        cam("20", curve, 0, 10, 10)
    assert words in str(error.value)


@pytest.mark.parametrize(
    "curve",
    [
        "{center: [0, 60]}",
        "{arc: [[-40, 30], [0, 20], [40, 30]]}",
        "{at: [u, 20 mm], from: -1, to: 1}",
    ],
)
def test_rows_on_curves_with_zeros_in_them_are_proven(curve: str) -> None:
    """What is computed is the same whatever its numbers are: it is so of exact ones, too."""
    model = cam("20", curve.replace("-1, to: 1", "-40 mm, to: 40 mm"), 2, 22, 5)
    assert set(model.certify().status) == {"proven"}
    errors = model.analyze(errors=True).errors
    assert errors.digits is not None
    assert errors.digits >= 12


def test_rows_on_a_spline_are_proven() -> None:
    """Against the exact curve in tests/proofs/test_knots.py."""
    model = cam("20", f"{{points: {POINTS}}}", -6, 6, 5)
    assert set(model.certify().status) == {"proven"}


def test_loads_and_drives_work_on_the_parameter() -> None:
    """A couple of Q on u does Q u' of work: of a follower over y(x), the drive's force is that of
    Q du/dx, and of a drive at u the effort that holds a force F on the slide -F du/dx."""
    curve = "{at: ['u^2/(40 mm) + u', '20 mm + u^2/(200 mm)'], from: -9 mm, to: 60 mm}"
    text = SLIDER % ("20", curve, -40, 0, 10)
    text = text.replace("pin, slide", "follower, slide")
    text = text.replace("  W: {type: W, links: [follower, pin]}\n", "")
    loaded = mk.loads(text + "loads: [{type: force, joint: S, value: 3 N}]\n")
    result = loaded.analyze()
    np.testing.assert_allclose(result["S.effort"], -3.0, rtol=1e-12)
    inputs = "D.u: {from: 0.001, to: 0.031, step: 0.01, rate: 2}"
    start = text.index("motion:")
    driven = mk.loads(
        f"{text[:start]}motion: {{inputs: {{{inputs}}}}}\n"
        "loads: [{type: force, joint: S, value: 3 N}]\n"
    ).analyze()
    assert set(driven["row.status"]) == {"ok"}
    u = np.asarray(driven["D.u"])
    slope = u / 0.020 + 1.0
    np.testing.assert_allclose(driven["S.s_dot"], -1000.0 * slope * 2.0, rtol=1e-12)
    # told in N*mm, u in m
    np.testing.assert_allclose(driven["D.effort"], 1000.0 * 3.0 * slope, rtol=1e-11)


@pytest.mark.parametrize("u_rate", [False, True])
def test_lengths_along_curves_have_rates(u_rate: bool) -> None:
    """Of a parabola y = u^2/(200 mm), along which u = -S.s: s' = sqrt(1 + (u/100 mm)^2). Written at
    another speed of its parameter it has the same."""
    parabola = "{at: [u, '20 mm + u^2/(200 mm)'], from: -50 mm, to: 40 mm}"
    if u_rate:
        parabola = "{at: ['10 mm*sinh(u)', '20 mm + (10 mm*sinh(u))^2/(200 mm)'], from: -3, to: 3}"
    result = cam("20", parabola, -35, 35, 5).analyze()
    assert set(result["row.status"]) == {"ok"}
    u = -np.asarray(result["S.s"])
    # by rates of S.s of 2, 3 and 4 mm
    v, a, j = -2.0, -3.0, -4.0
    w = np.sqrt(1.0 + (u / 100.0) ** 2)
    w1, w2 = u / 1e4 / w, 1e-4 / w**3
    np.testing.assert_allclose(result["D.s_dot"], w * v, rtol=1e-12)
    np.testing.assert_allclose(result["D.s_ddot"], w1 * v**2 + w * a, rtol=1e-11)
    jerk = w2 * v**3 + 3.0 * w1 * v * a + w * j
    np.testing.assert_allclose(result["D.s_dddot"], jerk, rtol=1e-11)


def test_a_response_has_rates_of_lengths_but_no_jerk() -> None:
    text = """
format: 1
plane: xy
units: {length: mm}
links: {bead: {mass: 1, center_of_mass: [20, 0], inertia: 1}}
joints: {D: {type: Ps, links: [bead, ground], point: [20, 0], curve: {center: [0, 0]}}}
loads: [{type: gravity, g: standard, direction: [0, -1]}]
responses:
  fall: {start: {D.u: 0, D.theta: 0}, time: {from: 0, to: 0.1, step: 0.02}}
"""
    result = mk.loads(text).respond("fall")
    turn = np.asarray(result["D.u"])
    # of a bead that falls along a circle of 20 mm from its side
    speed = -np.sqrt(2.0 * 9806.65 * 20.0 * -np.sin(turn))
    np.testing.assert_allclose(result["D.s_dot"], speed, rtol=1e-9)
    np.testing.assert_allclose(result["D.s_ddot"], -9806.65 * np.cos(turn), rtol=1e-9)
    with pytest.raises(mk.MechkinError, match="a response has none"):
        result["D.s_dddot"]


def test_rates_of_lengths_along_a_spline_are_those_of_its_point() -> None:
    """On a slide under a follower that only rises: s. = |(S.s., F.s.)|."""
    result = cam("20", f"{{points: {POINTS}}}", -55, 55, 10).analyze()
    x, y = (np.asarray(result[name]) for name in ("S.s_dot", "F.s_dot"))
    np.testing.assert_allclose(np.abs(result["D.s_dot"]), np.hypot(x, y), rtol=1e-11)
    ddot = (x * result["S.s_ddot"] + y * result["F.s_ddot"]) / np.hypot(x, y)
    np.testing.assert_allclose(
        np.sign(result["D.s_dot"]) * result["D.s_ddot"], ddot, rtol=1e-9, atol=1e-9
    )


def test_lengths_along_curves_are_their_integrals() -> None:
    """Of a parabola in closed form, of a circle by its angle, of a spline by quadrature."""
    parabola = "{at: [u, '20 mm + u^2/(200 mm)'], from: -50 mm, to: 40 mm}"
    result = cam("20", parabola, -35, 35, 5).analyze()
    u = 1000.0 * np.asarray(result["D.u"])
    slope = u / 100.0
    expected = 50.0 * (slope * np.sqrt(1.0 + slope**2) + np.arcsinh(slope))
    np.testing.assert_allclose(result["D.s"], expected, atol=1e-11)
    ring = cam("20", "{center: [0, 60]}", -30, 30, 5).analyze()
    np.testing.assert_allclose(ring["D.s"], 40.0 * np.asarray(ring["D.u"]), atol=1e-11)
    points = cam("20", f"{{points: {POINTS}}}", -55, 55, 10).analyze()
    chords = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(np.array(POINTS), axis=0).T))])
    rate = CubicSpline(chords, np.array(POINTS)).derivative()
    for s, at in zip(points["D.s"], 1000.0 * np.asarray(points["D.u"]), strict=True):
        breaks = [*(x for x in chords if x < at), at]
        known = sum(
            quad(lambda x: float(np.hypot(*rate(x))), a, b, epsabs=1e-12)[0]
            for a, b in pairwise(breaks)
        )
        assert float(s) == pytest.approx(known, abs=1e-8)
