"""What lies between rows counts: inputs under laws and inputs that move together."""

from __future__ import annotations

import pytest
from change_points.four_bars import PLANAR, FourBar, apart, file_of, joints_of
from mpmath import mp, mpf

import mechkin_cli as mk


def rocker(limit: str) -> FourBar:
    """A double rocker whose crank stops at a dead centre at the angle of the limit."""
    a, c, d = mpf("0.8"), mpf("0.9"), mpf("1")
    rod = mp.sqrt(a * a + d * d - 2 * a * d * mp.cos(mp.radians(mpf(limit)))) - c
    return FourBar("0.8", mp.nstr(rod, 25), "0.9", "1", 1)


@pytest.mark.parametrize("pairs", ["SS", "RR", "CS"])
@pytest.mark.parametrize("rows", [3, 5, 41])
def test_a_swing_meets_the_dead_centre_between_rows(rows: int, pairs: str) -> None:
    """The crank goes from 60 to 170 degrees and back within two rows; its dead centre is at 91.1:
    a row at 60 degrees again is on another way, and no row after the first is there."""
    bar = rocker("91.1")
    joints = joints_of(bar, "60", "0", pairs, "crank")
    last = rows - 1
    # x = v t - v t^2: at 0 with t = 0, 1, and 110 at t = 1/2; rows at whole times have x <= 0
    law = "{law: constant-acceleration, at: 0, rate: 440 deg/s, acceleration: -880 deg/s^2}"
    motion = f"{{time: {{from: 0, to: {last}, step: 1}}, inputs: {{A.theta: {law}}}}}"
    result = mk.loads(file_of(["crank", "rod0", "rocker0"], joints, motion)).analyze()
    assert result["row.status"][0] == "ok"
    assert not {"ok", "near-singular"} & set(result["row.status"][1:].tolist())
    (note,) = [d for d in result.diagnostics if d.code == "dead-centre"]
    assert any(abs(number.value - 31.1) < 1e-9 for number in note.numbers)


def five_bar(motion: str) -> str:
    """Cranks of 0.3 at 0 and at (1, 0), geared one to minus one, under two rods of 0.9."""
    half = mpf("0.5") - mpf("0.3")
    height = mp.sqrt(mpf("0.9") ** 2 - half**2)
    points = {"B": "[0.3, 0, 0]", "C": f"[0.5, {mp.nstr(height, 20)}, 0]", "D": "[0.7, 0, 0]"}
    rods = {"B": "crank, left", "C": "left, right", "D": "other, right"}
    joints = "".join(
        f"  {name}: {{type: R, links: [{rods[name]}], point: {points[name]}, {PLANAR}}}\n"
        for name in points
    )
    joints += f"  E: {{type: R, links: [ground, other], point: [1, 0, 0], {PLANAR}}}\n"
    inputs = f"{{inputs: {{A.theta: {motion}, E.theta: {{with: -A.theta}}}}}}"
    return file_of(["crank", "other", "left", "right"], joints, inputs)


@pytest.mark.parametrize("step", [1, 7, 30, 45, 90, 120, 180])
def test_a_five_bar_in_coarse_steps(step: int) -> None:
    """Mirrored cranks: the upper joint stays on the middle line, at a height in closed form."""
    result = mk.loads(five_bar(f"{{from: 0, to: 720, step: {step}}}")).analyze()
    assert set(result["row.status"].tolist()) == {"ok"}
    drawn = mp.acos(mpf("0.2") / mpf("0.9"))
    for turned, angle in zip(result["A.theta"], result["B.theta"], strict=True):
        t = mp.radians(mpf(float(turned)))
        direction = mp.acos((mpf("0.5") - mpf("0.3") * mp.cos(t)) / mpf("0.9"))
        want = float(mp.degrees(direction - drawn - t))
        assert apart(float(angle), want) < 1e-9
        assert abs(float(angle) - want) < 90
