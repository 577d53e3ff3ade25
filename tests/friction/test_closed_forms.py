"""Friction against closed forms: screws, journals, wedges, a guide that tips."""

from __future__ import annotations

from math import atan, cos, exp, hypot, pi, radians, sin, tan

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.verdict import Status

ROUNDING = 1e-13


def screw(rate: str) -> str:
    return f"""
format: 1
name: screw
units: {{length: mm, angle: deg, mass: kg, force: N}}
links: {{nut: {{}}}}
joints: {{N: {{type: H, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1], lead: 5}}}}
motion: {{inputs: {{N.theta: {{from: 0, to: 90, step: 30, rate: {rate}}}}}}}
loads:
  - {{type: force, link: nut, point: [0, 0, 0], force: [0, 0, -1000]}}
  - {{type: friction, joint: N, coefficient: 0.08, radius: 10, flank: 15 deg}}
"""


def test_a_screw_lifts_and_lowers():
    """T = F r tan(lead angle +- friction angle), tan(friction angle) = mu / cos(flank)."""
    lead_angle, friction_angle = atan(5 / (20 * pi)), atan(0.08 / cos(radians(15)))
    lifted = mk.loads(screw("2 rad/s")).analyze(["N.effort", "N.friction_power"], tables=[])
    lowered = mk.loads(screw("-2 rad/s")).analyze(["N.effort"], tables=[])
    up = 1000 * 10 * tan(lead_angle + friction_angle)
    down = 1000 * 10 * tan(lead_angle - friction_angle)
    assert lifted["N.effort"] == pytest.approx(np.full(4, up), rel=ROUNDING)
    assert lowered["N.effort"] == pytest.approx(np.full(4, down), rel=1e-11)
    lossless = 1000 * 5 / (2 * pi)
    assert round(lossless / lifted["N.effort"][0], 4) == 0.4868
    assert round(lowered["N.effort"][0] / lossless, 4) == -0.0405
    assert lifted["N.friction_power"] == pytest.approx(np.full(4, 2 * (up - lossless)))
    assert [d.code for d in lifted.diagnostics] == []
    assert [d.code for d in lowered.diagnostics] == ["self-locking"]


JOURNAL = """
format: 1
name: journal
units: {{length: mm, angle: deg, mass: kg, force: N}}
links: {{shaft: {{}}}}
joints: {{A: {{type: R, links: [ground, shaft], point: [0, 0, 0], axis: [0, 0, 1]}}}}
motion: {{inputs: {{A.theta: {{from: 0, to: 90, step: 45, rate: {rate} rad/s}}}}}}
loads:
  - {{type: force, link: shaft, point: [0, 0, 50], force: [300, 400, -200]}}
  - {{type: friction, joint: A, {friction}}}
"""


def journal(friction: str, rate: float = 3.0) -> mk.Analysis:
    text = JOURNAL.format(friction=friction, rate=rate)
    return mk.loads(text).analyze(["A.effort", "A.normal_load", "A.friction_moment"], tables=[])


def test_a_journal_bearing():
    found = journal("coefficient: 0.1, radius: 8")
    assert found["A.effort"] == pytest.approx(np.full(3, 0.1 * 8 * 500), rel=ROUNDING)
    assert found["A.friction_moment"][0] == pytest.approx([0, 0, -400.0], abs=1e-9)
    messages = [(d.code, d.hint.split()[2]) for d in found.diagnostics]
    assert messages == [("friction-uncounted", "length"), ("friction-uncounted", "collar")]


def test_two_bearings_and_a_collar():
    """The load hangs 30 mm beyond the upper of two bearings 40 mm apart."""
    found = journal("coefficient: 0.1, radius: 8, length: 40, collar: 12")
    upper, lower = 500 * 70 / 40, 500 * 30 / 40
    moment = 0.1 * (8 * (upper + lower) + 12 * 200)
    assert found["A.effort"] == pytest.approx(np.full(3, moment), rel=ROUNDING)
    assert found["A.normal_load"] == pytest.approx(np.full(3, moment / 0.1 / 8), rel=ROUNDING)
    assert found.diagnostics == ()


@pytest.mark.parametrize("rate", [0.01, 1.0, 40.0])
def test_the_coefficient_falls_with_speed(rate):
    coefficient = "coefficient: {static: 0.2, sliding: 0.1, speed: 10 mm/s}"
    found = journal(f"{coefficient}, radius: 8", rate)
    expected = 0.1 + 0.1 * exp(-((8 * rate / 10) ** 2))
    assert found["A.effort"] == pytest.approx(np.full(3, expected * 8 * 500), rel=ROUNDING)


def test_the_coefficient_falls_at_once():
    found = journal("coefficient: {static: 0.2, sliding: 0.1}, radius: 8")
    assert found["A.effort"] == pytest.approx(np.full(3, 0.1 * 8 * 500), rel=ROUNDING)


def test_a_shaft_that_starts_has_the_coefficient_of_rest():
    text = JOURNAL.format(friction="coefficient: {static: 0.2, sliding: 0.1}, radius: 8", rate=0)
    text = text.replace("rate: 0 rad/s", "acceleration: -1 rad/s^2")
    found = mk.loads(text).analyze(["A.effort", "A.friction_power"], tables=[])
    assert found["A.effort"] == pytest.approx(np.full(3, -0.2 * 8 * 500), rel=ROUNDING)
    assert (found["A.friction_power"] == 0.0).all()


def test_at_rest_friction_has_no_direction():
    text = JOURNAL.format(friction="coefficient: 0.1, radius: 8", rate=0)
    found = mk.loads(text).analyze(["A.effort", "A.theta"], tables=[])
    assert (found.result.status == Status.friction_undecided).all()
    assert np.isnan(found["A.effort"]).all()
    assert found["A.theta"].tolist() == [0, 45, 90]
    assert "A" in found.diagnostics[0].message
    assert not found.result.complete


@pytest.mark.parametrize("slide", [0.0, 4.0, -7.0])
def test_a_cylinder_has_one_force_against_turn_and_slide(slide):
    text = f"""
format: 1
name: cylinder
units: {{length: mm, angle: deg, mass: kg, force: N}}
links: {{shaft: {{}}}}
joints: {{A: {{type: C, links: [ground, shaft], point: [0, 0, 0], axis: [0, 0, 1]}}}}
motion:
  inputs:
    A.theta: {{from: 0, to: 90, step: 45, rate: 2 rad/s}}
    A.s: {{at: 0, rate: {slide} mm/s}}
loads:
  - {{type: force, link: shaft, point: [0, 0, 0], force: [300, 400, 0]}}
  - {{type: friction, joint: A, coefficient: 0.1, radius: 8, length: 40}}
"""
    found = mk.loads(text).analyze(["A.theta.effort", "A.s.effort"], tables=[])
    speed = hypot(8 * 2, slide)
    turn, along = 50 * 8 * 16 / speed, 50 * slide / speed
    assert found["A.theta.effort"] == pytest.approx(np.full(3, turn), rel=ROUNDING)
    assert found["A.s.effort"] == pytest.approx(np.full(3, along), rel=ROUNDING)


def guide(arm: float, rate: float = 10.0) -> mk.Analysis:
    """A slider pushed `arm` beside its guide of length 100 against a force of 50 along it."""
    text = f"""
format: 1
name: guide that tips
units: {{length: mm, angle: deg, mass: kg, force: N}}
links: {{pusher: {{}}, slider: {{}}}}
joints:
  D: {{type: P, links: [ground, pusher], point: [0, {arm}, 0], axis: [1, 0, 0]}}
  G: {{type: P, links: [ground, slider], point: [0, 0, 0], axis: [1, 0, 0]}}
  K: {{type: Sp, links: [pusher, slider], point: [0, {arm}, 0], normal: [1, 0, 0]}}
motion: {{inputs: {{D.s: {{from: 0, to: 20, step: 10, rate: {rate}}}}}}}
loads:
  - {{type: force, link: slider, point: [0, 0, 0], force: [-50, 0, 0]}}
  - {{type: friction, joint: G, coefficient: 0.25, length: 100, width: 30}}
"""
    return mk.loads(text).analyze(["D.effort", "G.normal_load"], tables=[])


def test_a_guide_that_tips():
    """Q = W / (1 - 2 mu arm / length): a fixed point would need 2749 iterations."""
    found = guide(198.0)
    assert found["D.effort"] == pytest.approx(np.full(3, 50 / 0.01), rel=1e-11)
    assert found["G.normal_load"] == pytest.approx(np.full(3, 2 * 5000 * 198 / 100), rel=1e-11)


@pytest.mark.parametrize("arm", [200.0, 230.0])
def test_a_guide_that_jams(arm):
    found = guide(arm)
    assert (found.result.status == Status.friction_undecided).all()
    assert np.isnan(found["D.effort"]).all()
    assert found.diagnostics[0].message.startswith("friction of G may jam")


def test_a_guide_pushed_back_is_another():
    """Backwards the load pulls: Q = W / (1 + 2 mu arm / length) holds it."""
    found = guide(198.0, -10.0)
    assert found["D.effort"] == pytest.approx(np.full(3, 50 / 1.99), rel=1e-12)


@pytest.mark.parametrize("rate", [5.0, -5.0])
@pytest.mark.parametrize(("angle", "mu"), [(20.0, 0.1), (12.0, 0.3), (35.0, 0.05)])
def test_a_wedge(angle, mu, rate):
    """F = W tan(angle + 2 phi) with friction at base, face and guide; backwards - 2 phi.

    Where the wedge locks, the block leans on the other side of its guide as it is pulled away:
    F = W sin(angle - 2 phi) / cos(angle).
    """
    slope, phi = radians(angle), atan(mu)
    normal = f"[{sin(slope)!r}, {cos(slope)!r}, 0]"
    text = f"""
format: 1
name: wedge
units: {{length: mm, angle: deg, mass: kg, force: N}}
links: {{wedge: {{}}, block: {{}}}}
joints:
  B: {{type: P, links: [ground, wedge], point: [0, 0, 0], axis: [1, 0, 0]}}
  V: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [0, 1, 0]}}
  K: {{type: Sp, links: [block, wedge], point: [0, 0, 0], normal: {normal}}}
motion: {{inputs: {{B.s: {{from: 0, to: 5, step: 5, rate: {rate}}}}}}}
loads:
  - {{type: force, link: block, point: [0, 0, 0], force: [0, -80, 0]}}
  - {{type: friction, joint: B, coefficient: {mu}}}
  - {{type: friction, joint: V, coefficient: {mu}}}
  - {{type: friction, joint: K, coefficient: {mu}}}
"""
    found = mk.loads(text).analyze(["B.effort"], tables=[])
    effort = 80 * tan(slope + 2 * phi) if rate > 0 else 80 * tan(slope - 2 * phi)
    if rate < 0 and slope < phi:
        effort = 80 * sin(slope - 2 * phi) / cos(slope)
    assert found["B.effort"][0] == pytest.approx(effort, rel=1e-12, abs=1e-10)
