"""A coordinate that holds an idle freedom may have dead centres that the mechanism does not have:
the message blames what is held, at a place that closed forms know, and only then."""

from __future__ import annotations

from math import acos, asin, degrees, sqrt

import numpy as np
import pytest

import mechkin_cli as mk

LIMIT = 1e-6

ROD_AND_PAD = """
format: 1
links: {{L1: {{}}, L2: {{}}, L3: {{}}}}
joints:
  P: {{type: P, links: [ground, L1], point: [0, 0, 0], axis: {way}}}
  S1: {{type: S, links: [L1, L2], point: [0, 0, {height}]}}
  S2: {{type: S, links: [L2, L3], point: [{x}, {y}, 0]}}
  E: {{type: E, links: [ground, L3], point: [{x}, {y}, 0], normal: [0, 0, 1], x: [1, 0, 0]}}
motion: {{inputs: {{P.s: {{from: 0, to: 3, step: 0.25, rate: 1}}}}}}
"""

SPHERE_ON_PLANE = """
format: 1
links: {L1: {}, L2: {}, L3: {}}
joints:
  A: {type: R, links: [ground, L1], point: [0, 0, 0], axis: [0, 0, 1]}
  K: {type: Sp, links: [L1, L2], point: [1, 0, 0], normal: [0, 0, 1]}
  S: {type: S, links: [L2, L3], point: [3, 0, 0.5]}
  B: {type: R, links: [ground, L3], point: [3, 1, 0], axis: [0, 0.2, 1]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10, rate: 1}, B.theta: {at: 0}}}
"""

TWO_PLANES = """
format: 1
links: {L1: {}, L2: {}, L3: {}}
joints:
  A: {type: R, links: [ground, L1], point: [0, 0, 0], axis: [0, 0, 1]}
  E1: {type: E, links: [L1, L2], point: [1, 0, 0], normal: [1, 0, 0.5], x: [0, 1, 0]}
  S: {type: S, links: [L2, L3], point: [1, 0.2, 0.6]}
  E2: {type: E, links: [L3, ground], point: [1, 1, 0.8], normal: [0, 0.3, 1], x: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10, rate: 1}}}
"""

FOUR_BAR = """
  A: {type: R, links: [ground, a], point: [5, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [6, 1, 0], axis: [0, 0, 1]}
  C: {type: S, links: [b, c], point: [7, 1, 0]}
  D: {type: C, links: [ground, c], point: [7, 0, 0], axis: [0, 0, 1]}
"""


def ended(text: str) -> tuple[mk.Diagnostic, mk.Analysis]:
    analysis = mk.loads(text).analyze()
    codes = ("hold-ends", "dead-centre", "branch-point", "unbounded", "branch-lost")
    (found,) = [d for d in analysis.diagnostics if d.code in codes]
    return found, analysis


def test_a_held_pad_ends_where_the_rod_stands_across_its_slide() -> None:
    """The pad keeps y = 0.3 while the rod's upper end goes along y: its reach in the plane is
    sqrt(0.6^2 + 0.3^2)."""
    text = ROD_AND_PAD.format(way=[0, 1, 0], height=0.5, x=0.6, y=0.3)
    found, analysis = ended(text)
    assert found.code == "hold-ends"
    assert "E.y" in found.message
    assert "E.y" in (found.hint or "")
    assert abs(found.numbers[0].value - (0.3 + sqrt(0.6**2 + 0.3**2))) < LIMIT
    assert [str(s) for s in analysis["row.status"]] == ["ok"] * 4 + ["beyond-dead-centre"] * 9


@pytest.mark.parametrize("seed", range(4))
def test_random_pads(seed: int) -> None:
    """The upper end goes anywhere in the plane: the pad's held coordinate ends where the end is as
    far from it, across, as the rod reaches."""
    random = np.random.default_rng(seed)
    x, y = (float(v) for v in random.uniform(0.2, 0.6, 2).round(3))
    angle = float(random.uniform(-0.5, 0.5))
    way = [round(float(np.sin(angle)), 6), round(float(np.cos(angle)), 6), 0]
    found, _ = ended(ROD_AND_PAD.format(way=way, height=0.5, x=x, y=y))
    assert found.code == "hold-ends"
    held = "xy"["E.y" in found.message]
    reach, unit = sqrt(x * x + y * y), way["xy".index(held)] / sqrt(way[0] ** 2 + way[1] ** 2)
    drawn = {"x": x, "y": y}[held]
    ends = [(drawn + side * reach) / unit for side in (-1.0, 1.0)]
    assert abs(found.numbers[0].value - max(ends)) < LIMIT


def test_a_rod_out_of_reach_is_a_dead_centre_of_the_mechanism() -> None:
    """The upper end rises from 0.5 to the rod's length."""
    text = ROD_AND_PAD.format(way=[0, 0, 1], height=0.5, x=0.6, y=0)
    found, _ = ended(text)
    assert found.code == "dead-centre"
    assert abs(found.numbers[0].value - (sqrt(0.6**2 + 0.5**2) - 0.5)) < LIMIT


def test_a_pad_that_is_driven_goes_on() -> None:
    text = ROD_AND_PAD.format(way=[0, 1, 0], height=0.5, x=0.6, y=0.3)
    driven = text.replace("rate: 1}", "rate: 1}, E.y: {from: 0, to: 3, step: 0.25}")
    assert set(mk.loads(driven).analyze()["row.status"]) == {"ok"}


def test_a_plane_held_at_its_ball_ends_at_a_branch_point_of_its_own() -> None:
    found, _ = ended(SPHERE_ON_PLANE)
    assert found.code == "hold-ends"
    assert "the turns of K" in found.message
    assert abs(found.numbers[0].value - degrees(acos(1.0 / 3.0))) < LIMIT


@pytest.mark.parametrize(("to", "half_turns"), [(360, 0), (-360, -1)])
def test_a_held_slide_between_two_planes_runs_away(to: int, half_turns: int) -> None:
    """The line of both planes comes to stand across the slide that is held: its direction is that
    of n1 x n3, and x of the fixed plane is along [1, 0, 0], so that sin(theta) = 0.5 0.3. The slide
    is thousands of times as long as the drawing before it, where following stops."""
    found, _ = ended(TWO_PLANES.replace("to: 360", f"to: {to}"))
    assert found.code == "hold-ends"
    assert "E2.x" in found.message
    place = 180 * half_turns + (-1) ** half_turns * degrees(asin(0.15))
    assert abs(found.numbers[0].value - place) < 1e-2


def test_the_dead_centre_of_another_loop_is_that_of_the_mechanism() -> None:
    """Beside the pad, whose input rests, a four-bar comes to its dead centre."""
    pad = ROD_AND_PAD.format(way=[0, 1, 0], height=0.5, x=0.6, y=0.3)
    text = pad.replace("L3: {}}", "L3: {}, a: {}, b: {}, c: {}}")
    text = text.replace("motion:", FOUR_BAR.strip("\n") + "\nmotion:")
    text = text.replace(
        "P.s: {from: 0, to: 3, step: 0.25, rate: 1}",
        "P.s: {at: 0}, D.s: {at: 0}, A.theta: {from: 0, to: 180, step: 5}",
    )
    found, _ = ended(text)
    assert found.code == "dead-centre"


def test_ranges_end_where_the_hold_does() -> None:
    """They say so; the ends of the pad that is held are where the rod stands across its slide."""
    found = mk.loads(ROD_AND_PAD.format(way=[0, 1, 0], height=0.5, x=0.6, y=0.3)).ranges()
    reach = sqrt(0.6**2 + 0.3**2)
    for item in found.ranges:
        assert (item.lower.kind, item.upper.kind) == ("hold-ends", "hold-ends")
        assert abs(item.lower.value - (0.3 - reach)) < LIMIT
        assert abs(item.upper.value - (0.3 + reach)) < LIMIT
    (note,) = [d for d in found.diagnostics if d.code == "hold-ends"]
    assert "E.y" in note.message
    assert "drive it" in (note.hint or "")


def test_ranges_of_the_mechanism_itself_end_at_its_dead_centres() -> None:
    """The upper end rises from 0.5 to the rod's length, and falls as far below the plane."""
    found = mk.loads(ROD_AND_PAD.format(way=[0, 0, 1], height=0.5, x=0.6, y=0)).ranges()
    reach = sqrt(0.6**2 + 0.5**2)
    for item in found.ranges:
        assert (item.lower.kind, item.upper.kind) == ("dead-centre", "dead-centre")
        assert abs(item.lower.value - (-0.5 - reach)) < LIMIT
        assert abs(item.upper.value - (-0.5 + reach)) < LIMIT
    assert "hold-ends" not in {d.code for d in found.diagnostics}
