"""What the families have found, in the smallest files that show it."""

from __future__ import annotations

import re
from math import acos, atan2, cos, degrees, hypot, radians, sin

import pytest

import mechkin_cli as mk
from benchmarks.stress.block import run_block

FOUR_BAR = """\
format: 1
name: four-bar
units: {{length: m, angle: deg}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [crank, coupler], point: [2, 0, 0]}}
  C: {{type: S, links: [coupler, rocker], point: {{coupler: [3.5, 0, 0], rocker: [5.5, 0, 0]}}}}
  D: {{type: R, links: [ground, rocker], point: [4, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{values: {values}}}}}}}
assembly: {{near: {{D.theta: {near!r}}}}}
"""
FOLD = degrees(acos(11 / 16))
"""The crank at the dead centre, where coupler and rocker of one length 1.5 are in line."""


def rocker(crank: float, side: int) -> float:
    """Angle of the rocker in degrees in either assembly."""
    x, y = 2 * cos(radians(crank)) - 4, 2 * sin(radians(crank))
    return degrees(atan2(y, x) + side * acos(min(hypot(x, y) / 3, 1.0)))


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("distance", [1e-6, 1e-9, 1e-11, 1e-12])
def test_near_tells_assemblies_apart_that_nearly_coincide(distance: float, side: int) -> None:
    values = [FOLD - distance, FOLD - 0.05, FOLD - 1.0]
    text = FOUR_BAR.format(values=values, near=rocker(values[0], side))
    found = mk.loads(text).analyze(["D.theta"])
    assert "nearest-unclear" not in {note.code for note in found.diagnostics}
    for crank, angle in list(zip(values, found["D.theta"], strict=True))[1:]:
        assert abs((angle - rocker(crank, side) + 180) % 360 - 180) < 1e-9


SPINDLE = """\
format: 1
name: spindle
units: {{length: m, angle: deg}}
links: {{spindle: {{}}, nut: {{}}, rod: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, spindle], point: [0, 0, 0], axis: [1, 0, 0]}}
  H: {{type: H, links: [spindle, nut], point: [0, 0, 0], axis: [1, 0, 0], lead: 1e-4}}
  P: {{type: P, links: [ground, nut], point: [0, 0, 0], axis: [1, 0, 0]}}
  B: {{type: S, links: [nut, rod], point: [0, 0, 0]}}
  C: {{type: S, links: [rod, rocker], point: [1, 1, 0.5]}}
  D: {{type: R, links: [ground, rocker], point: [2, 0, 0.3], axis: [0, 0.3, 1]}}
motion: {{inputs: {{A.theta: {{values: [0, {last!r}]}}}}}}
"""


@pytest.mark.parametrize("rest", [0.0, 1.2e-10, -1.2e-10, 3.5e-10, 1e-8])
@pytest.mark.parametrize("turns", [1, 500, 2000, 3000])
def test_a_thread_comes_to_rows_a_rounding_beyond_whole_turns(turns: int, rest: float) -> None:
    last = 360.0 * turns + rest
    found = mk.loads(SPINDLE.format(last=last)).analyze(["P.s", "D.theta"])
    assert found["row.status"].tolist() == ["ok", "ok"]
    assert abs(found["P.s"][1] + 1e-4 * last / 360.0) < 1e-14


COUPLING = """\
format: 1
name: coupling
units: {{length: m, angle: deg}}
links: {{one: {{}}, rod: {{}}, two: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [one, rod], point: [0.1, 0.8, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [rod, two], point: [0.1, {end!r}, 0], axis: [0, 0, 1]}}
  D: {{type: R, links: [ground, two], point: [{foot!r}, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{values: [0]}}}}}}
"""


@pytest.mark.parametrize(
    ("apart", "noted"), [(0.0, False), (2e-14, False), (2e-8, True), (5e-8, True), (1e-3, False)]
)
def test_joints_that_are_taken_for_coinciding_are_told(apart: float, noted: bool) -> None:
    """Whatever is asked for: also what does not depend on where the rod is held is off by that."""
    text = COUPLING.format(end=0.8 + apart, foot=apart / 2)
    for columns in (["D.theta"], ["B.theta"], ["row.condition"]):
        notes = [
            n for n in mk.loads(text).analyze(columns).diagnostics if n.code == "nearly-common"
        ]
        assert len(notes) == noted
        for note in notes:
            (told,) = re.findall(r"[\d.e+-]+(?= rad)", note.measured or "")
            # the diagonal of the box of the points is the size
            size = hypot(0.1, 0.8)
            assert 0.3 * apart / size < float(told) < 3 * apart / size


@pytest.mark.parametrize(("seed", "number"), [(7, 70), (11, 38)])
def test_a_correction_by_rounding_is_no_other_branch(seed: int, number: int) -> None:
    """Couplings whose assemblies are 1e-8 apart, where rounding moves a position by as much."""
    verdicts = run_block("coincident points", seed, [number]).verdicts
    assert set(verdicts) <= {"right_warned", "rightly_none"}
    assert verdicts["right_warned"] >= 38
