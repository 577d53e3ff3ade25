"""A four-bar whose coupler's end lies on the crank's pivot: the rocker rests while the crank turns.

With crank and coupler of one length that motion meets the parallelogram's where crank and ground
are in line, at 0 and 180 degrees; no branch of the linkage has a dead centre of the crank.
"""

from __future__ import annotations

import pytest

import mechkin_cli as mk

TEXT = """\
format: 1
name: rhombus
units: {{length: m, angle: deg}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [crank, coupler], point: [1, 0, 0]}}
  C: {{type: S, links: [coupler, rocker], point: [2, 0, 0]}}
  D: {{type: R, links: [ground, rocker], point: [1, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{from: 10, to: 100, step: 30}}}}}}
{assembly}
"""


@pytest.mark.parametrize("angle", [10, 180])
def test_a_rocker_at_rest_makes_no_dead_centre(angle: int) -> None:
    ranges = mk.loads(TEXT.format(assembly=f"assembly: {{near: {{D.theta: {angle}}}}}")).ranges()
    assert len(ranges.ranges) == 2
    for one in ranges.ranges:
        assert (one.lower.kind, one.upper.kind) == ("branch-point", "branch-point")
        assert abs(one.lower.value) <= 1e-9
        assert abs(one.upper.value - 180) <= 1e-9


def test_a_drawing_at_a_branch_point_goes_on_in_the_motion_in_which_the_crank_turns() -> None:
    """The parallelogram's; in the other one coupler and rocker turn and the crank rests."""
    analysis = mk.loads(TEXT.format(assembly="")).analyze(["D.theta"])
    assert analysis["row.status"].tolist() == ["ok"] * 4
    assert analysis["D.theta"] == pytest.approx([10, 40, 70, 100], abs=1e-9)
    assert [d.code for d in analysis.diagnostics] == ["motions-meet"]
