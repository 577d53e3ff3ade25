"""Loops without a joint to close them at, or with all unknowns there, are closed through a link.

Helical joints with equal leads on parallel axes move as the plane four-bar does, each link raised
by its turn.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

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


def hinged(hinges: int, others: str = "R") -> str:
    """A door of 4 kg on hinges along x, of which the first is driven; two turns."""
    joints = "".join(
        f"  H{k}: {{type: {others if k else 'R'}, links: [ground, door], "
        f"point: [{0.3 * k:.12g}, 0, 0], axis: [1, 0, 0]}}\n"
        for k in range(hinges)
    )
    return (
        "format: 1\nunits: {length: m, angle: deg}\n"
        "links: {door: {mass: 4, center_of_mass: [0.5, 0.8, 0]}}\n"
        f"joints:\n{joints}"
        "motion: {inputs: {H0.theta: {from: 0, to: 720, step: 40, rate: 1 rad/s}}}\n"
        "loads: [{type: gravity, g: [0, 0, -9.81]}]\n"
    )


@pytest.mark.parametrize("others", ["R", "C"])
@pytest.mark.parametrize("hinges", [2, 3, 5])
def test_a_door_that_is_driven_at_one_of_its_hinges(hinges: int, others: str) -> None:
    """Nothing but the turns of the other hinges is unknown, and they follow."""
    model = mk.loads(hinged(hinges, others))
    turns = [f"H{k}.theta" for k in range(hinges)]
    rates = [f"{turn}_dot" for turn in turns]
    result = model.analyze([*turns, *rates, "H0.effort"])
    assert set(result["row.status"]) == {"ok"}
    angle = result["H0.theta"]
    for turn, rate in zip(turns, rates, strict=True):
        off = (result[turn] - angle + 180.0) % 360.0 - 180.0
        assert np.abs(off).max() < 1e-11
        assert np.abs(result[rate] - result["H0.theta_dot"]).max() < 1e-11
    # gravity's moment about the hinges
    expected = 4 * 9.81 * 0.8 * np.cos(np.radians(angle))
    assert np.abs(result["H0.effort"] - expected).max() < 1e-11


def test_a_door_tilted_on_its_hinges_is_not_cut() -> None:
    tilted = hinged(3).replace(
        "point: [0.6, 0, 0], axis: [1, 0, 0]", "point: [0.6, 0, 1], axis: [1, 0, 0]"
    )
    with pytest.raises(mk.InvalidFile, match="nothing is left to close the loop"):
        _ = mk.loads(tilted).graph


IN_LINE = """
format: 1
units: {length: m, angle: deg}
links: {crank: {}, ring: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, ring], point: [0, 0, 1], axis: [0, 0, 1]}
  C: {type: C, links: [ring, ground], point: [0, 0, 2], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 30}}}
"""
SLIDE_IN_PLANE = IN_LINE.replace(
    "B: {type: R, links: [crank, ring], point: [0, 0, 1], axis: [0, 0, 1]}",
    "B: {type: E, links: [crank, ring], point: [0, 0, 1], normal: [0, 0, 1], x: [1, 0, 0]}",
).replace(
    "C: {type: C, links: [ring, ground], point: [0, 0, 2], axis: [0, 0, 1]}",
    "C: {type: P, links: [ring, ground], point: [0, 0, 2], axis: [1, 0, 0]}",
)


@pytest.mark.parametrize("text", [IN_LINE, SLIDE_IN_PLANE])
def test_what_is_left_beside_idle_freedoms_is_solved(text: str) -> None:
    """One freedom is driven, one idle; the closing joint has all that is unknown."""
    model = mk.loads(text)
    assert len(model.mobility().idle) == 1
    turn = "C.theta" if text is IN_LINE else "B.theta"
    result = model.analyze([turn])
    assert set(result["row.status"]) == {"ok"}
    off = (result[turn] + result["A.theta"] + 180.0) % 360.0 - 180.0
    assert np.abs(off).max() < 1e-11


def test_the_cure_that_the_note_names_is_solved_too() -> None:
    both = IN_LINE.replace("step: 30}", "step: 30}, B.theta: {from: 0, to: 720, step: 60}")
    result = mk.loads(both).analyze(["C.theta"])
    assert set(result["row.status"]) == {"ok"}
    off = (result["C.theta"] + 3 * result["A.theta"] + 180.0) % 360.0 - 180.0
    assert np.abs(off).max() < 1e-11
