"""A loop of helical joints alone is closed through a cut link.

With equal leads on parallel axes it moves as the plane four-bar does, each link raised by its turn.
"""

from __future__ import annotations

import math

import numpy as np

import mechkin_cli as mk

FOUR_HELICAL = """
format: 1
units: {length: mm, angle: deg}
links: {crank: {}, coupler: {}, rocker: {}}
joints:
  A: {type: H, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1], lead: 10}
  B: {type: H, links: [crank, coupler], point: [20, 0, 5], axis: [0, 0, 1], lead: 10}
  C: {type: H, links: [coupler, rocker], point: [70, 40, 0], axis: [0, 0, 1], lead: 10}
  D: {type: H, links: [rocker, ground], point: [60, 0, 0], axis: [0, 0, 1], lead: 10}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 15, rate: 1}}}
loads: [{type: torque, joint: D, value: 1}]
"""


def rocker_angle(theta: float) -> float:
    """The rocker's turn from the drawing: intersection of two circles."""
    crank = (20 * math.cos(theta), 20 * math.sin(theta))
    dx, dy = crank[0] - 60, crank[1]
    square = dx * dx + dy * dy
    arm = math.hypot(10, 40)
    share = (square + arm * arm - (50 * 50 + 40 * 40)) / (2 * square)
    height = math.sqrt(arm * arm / square - share * share)
    side = (share * dx + height * dy, share * dy - height * dx)
    return math.atan2(side[1], side[0]) - math.atan2(40, 10)


def test_it_is_closed_through_a_link() -> None:
    (closing,) = mk.loads(FOUR_HELICAL).graph.closings
    assert (closing.joint.name, closing.equations) == ("coupler (cut)", 6)
    assert closing.joint.letter == "W"


TWO_LOOPS = FOUR_HELICAL.replace("rocker: {}}", "rocker: {}, rod: {}, arm: {}}").replace(
    "motion:",
    """\
  E: {type: H, links: [rocker, rod], point: [65, 20, 0], axis: [0, 0, 1], lead: 10}
  F: {type: H, links: [rod, arm], point: [120, 50, 0], axis: [0, 0, 1], lead: 10}
  G: {type: H, links: [arm, ground], point: [110, 0, 0], axis: [0, 0, 1], lead: 10}
motion:""",
)


def test_every_loop_of_helical_joints_has_its_own_cut() -> None:
    model = mk.loads(TWO_LOOPS)
    cuts = [closing.joint.name for closing in model.graph.closings]
    assert cuts == ["coupler (cut)", "rod (cut)"]
    result = model.analyze(["D.theta", "G.theta", "G.s"])
    one = mk.loads(FOUR_HELICAL).analyze(["D.theta"])
    assert np.abs(result["D.theta"] - one["D.theta"]).max() < 1e-11
    assert np.abs(result["G.s"] - 10 * result["G.theta"] / 360).max() < 1e-12


def test_four_helical_joints_with_equal_leads() -> None:
    result = mk.loads(FOUR_HELICAL).analyze(["D.theta", "D.s", "B.theta", "C.theta", "A.effort"])
    assert set(result["row.status"]) == {"ok"}
    expected = np.array([-math.degrees(rocker_angle(math.radians(t))) for t in result["A.theta"]])
    assert np.abs(result["D.theta"] - expected).max() < 1e-11
    assert np.abs(result["D.s"] - 10 * expected / 360).max() < 1e-12
    total = sum(result[f"{joint}.theta"] for joint in "ABCD")
    assert np.abs(total).max() < 1e-11
    # torque on D turns the rocker by -D.theta against ground
    ratio = np.gradient(expected, np.radians(15), edge_order=2) * math.pi / 180
    assert np.abs(result["A.effort"] + ratio)[1:-1].max() < 0.05
