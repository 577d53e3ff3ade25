"""The oracle on mechanisms whose motion and forces are known in closed form."""

from __future__ import annotations

import pytest
from oracle import UnsolvableError, mp, newton_euler, read, solve
from oracle.numerics import mpmath_context

TINY = mp.mpf("1e-34")

PENDULUM = """
format: 1
links: {bob: {mass: 2, center_of_mass: [3, 0, 0], inertia: {xx: 1, yy: 2, zz: 0.5}}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 4]}}
loads: [{type: gravity, g: [0, -10, 0]}]
"""

SLIDER_CRANK = """
format: 1
links: {crank: {}, rod: {}, slider: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [3, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, slider], point: [8, 0, 0], axis: [0, 0, 1]}
  D: {type: P, links: [ground, slider], point: [8, 0, 0], axis: [1, 0, 0]}
"""

SCREW = """
format: 1
units: {length: mm, force: lbf, mass: lbm}
links: {nut: {mass: 1 lbm, center_of_mass: [0, 0, 1]}}
joints: {A: {type: H, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1], lead: -25.4}}
loads: [{type: force, link: nut, point: [0, 0, 7], force: [0, 0, 3]}]
"""

TWO_DRAWINGS = """
format: 1
links: {arm: {}}
joints:
  A:
    type: C
    links: [ground, arm]
    point: {ground: [1, 2, 3], arm: [0, 5, 0]}
    axis: {ground: [0, 0, 1], arm: [1, 0, 0]}
    zero: {ground: [1, 0, 0], arm: [0, 1, 0]}
points: {end: {link: arm, at: [2, 6, 0]}}
"""


def test_pendulum():
    """Effort = (I + m l^2) alpha + m g l cos(theta); the bearing carries m a - m g."""
    mechanism = read(PENDULUM)
    angle, rate, acceleration = mp.mpf("0.7"), mp.mpf("1.3"), mp.mpf("-0.4")
    loads = newton_euler(mechanism, solve(mechanism, {"A.theta": (angle, rate, acceleration)}))
    c, s = mp.cos_sin(angle)
    effort = (mp.mpf("0.5") + 18) * acceleration + 60 * c
    force = [6 * (-c * rate**2 - s * acceleration), 6 * (-s * rate**2 + c * acceleration) + 20, 0]
    assert abs(loads.effort["A.theta"] - effort) < TINY
    for value, expected in zip(loads.force["A"], force, strict=True):
        assert abs(value - expected) < TINY


@pytest.mark.parametrize("angle", ["0.3", "1.6", "-2.5"])
def test_slider_crank(angle):
    """x = r cos(theta) + sqrt(l^2 - r^2 sin^2(theta)), differentiated by mpmath.

    The mechanism is planar, so its closure has more equations than unknowns.
    """
    course = (angle, "0.8", "-1.1", "0.6")
    start, rate, acceleration, jerk = map(mpmath_context.mpf, course)

    def slide(time):
        turned = start + rate * time + acceleration * time**2 / 2 + jerk * time**3 / 6
        c, s = mpmath_context.cos_sin(turned)
        return 3 * c + mpmath_context.sqrt(25 - 9 * s * s) - 8

    found = solve(read(SLIDER_CRANK), {"A.theta": course})
    expected = [mp.mpf(mpmath_context.diff(slide, 0, order)) for order in range(4)]
    names = ["D.s", "D.s_dot", "D.s_ddot", "D.s_dddot"]
    for name, value in zip(names, expected, strict=True):
        assert abs(found[name] - value) < mp.mpf("1e-20")


def test_planar_reactions_are_not_unique():
    mechanism = read(SLIDER_CRANK)
    with pytest.raises(UnsolvableError):
        newton_euler(mechanism, solve(mechanism, {"A.theta": (mp.mpf("0.3"),)}))


def test_beyond_reach():
    with pytest.raises(UnsolvableError):
        solve(read(SLIDER_CRANK.replace("[8, 0, 0]", "[5, 0, 0]")), {"A.theta": (mp.mpf("1.5"),)})


def test_screw_in_si():
    """lbf with lbm is not coherent: the base is SI; effort = -force * lead / (2 pi) at rest."""
    mechanism = read(SCREW)
    found = solve(mechanism, {"A.theta": (4 * mp.pi,)})
    assert abs(found["A.s"] + mp.mpf("0.0508")) < TINY
    loads = newton_euler(mechanism, found)
    force = 3 * mp.mpf("0.45359237") * mp.mpf("9.80665")
    assert abs(loads.effort["A.theta"] - force * mp.mpf("0.0254") / (2 * mp.pi)) < TINY


def test_one_place_and_axis_per_link():
    """The arm's x lies on ground's z, its y on ground's x, its point (0, 5, 0) on (1, 2, 3 + s)."""
    mechanism = read(TWO_DRAWINGS)
    drawn = solve(mechanism, {"A.theta": (0,), "A.s": (0,)}).point("end")[0]
    turned = solve(mechanism, {"A.theta": (mp.pi / 2,), "A.s": (10,)}).point("end")[0]
    for values, expected in ((drawn, (2, 2, 5)), (turned, (1, 3, 15))):
        assert max(abs(a - b) for a, b in zip(values, expected, strict=True)) < TINY
