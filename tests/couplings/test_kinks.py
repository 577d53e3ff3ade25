"""Functions of coordinates whose slope jumps, against their closed forms on either side."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

FOLLOWED = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  crank: {mass: 1, center_of_mass: [0, 0], inertia: 0.5}
  rod: {mass: 2, center_of_mass: [0, 0], inertia: 1}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: P, links: [ground, rod], point: [0, 0], axis: [1, 0]}
couplings:
  K: {type: function, of: A.theta, gives: B.s, LAW}
motion:
  inputs: {A.theta: {from: FIRST, to: LAST, count: 17, rate: 3 rad/s, acceleration: 2 rad/s^2}}
"""
SEQUENCE = """law: {law: sequence, start: -0.75, from: -0.3 m, segments: [
      {for: 0.5, to: 0.4 m, law: constant-rate}, {for: 0.6, to: -1 m, law: constant-rate},
      {for: 0.4, law: dwell}, {for: 0.3, to: 2 m, law: constant-rate}]}"""


def line(x: float, *points: tuple[float, float]) -> tuple[float, float]:
    """Value and slope of a polygon, behind a corner those behind it; level beyond its ends."""
    if x < points[0][0]:
        return points[0][1], 0.0
    for (a, y), (b, z) in pairwise(points):
        if x < b:
            return y + (x - a) * (z - y) / (b - a), (z - y) / (b - a)
    return points[-1][1], 0.0


LAWS: dict[str, tuple[str, Any, tuple[float, ...]]] = {
    "v": ('value: "0.7 m/rad*abs(theta)"', lambda x: (0.7 * abs(x), 0.7 if x >= 0 else -0.7), (0,)),
    "between rows": (
        'value: "0.7 m/rad*abs(theta - 0.03 rad)"',
        lambda x: (0.7 * abs(x - 0.03), 0.7 if x >= 0.03 else -0.7),
        (0.03,),
    ),
    "of two lines": (
        'value: "min(2 m/rad*theta, 0.3 m - 4 m/rad*theta)"',
        lambda x: (2.0 * x, 2.0) if x < 0.05 else (0.3 - 4.0 * x, -4.0),
        (0.05,),
    ),
    "bent twice": (
        'value: "0.2 m/rad*(theta + abs(theta - 0.25 rad) - 3*abs(theta + 0.25 rad))"',
        lambda x: (
            0.2 * (x + abs(x - 0.25) - 3 * abs(x + 0.25)),
            0.2 * (1 + (1 if x >= 0.25 else -1) - 3 * (1 if x >= -0.25 else -1)),
        ),
        (-0.25, 0.25),
    ),
    "sequence": (
        SEQUENCE,
        lambda x: line(x, (-0.75, -0.3), (-0.25, 0.4), (0.35, -1.0), (0.75, -1.0), (1.05, 2.0)),
        (-0.75, -0.25, 0.35, 0.75),
    ),
}


@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize("name", LAWS)
def test_sweeps_go_over_kinks(name: str, backward: bool) -> None:
    """On a kink the place is right, and the rates are those of one of its sides."""
    law, true, kinks = LAWS[name]
    ends = ("1", "-1") if backward else ("-1", "1")
    text = FOLLOWED.replace("LAW", law).replace("FIRST", ends[0]).replace("LAST", ends[1])
    result = mk.loads(text).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(float(ends[0]), float(ends[1]), 17)
    for row, x in enumerate(turn):
        value, slope = true(x)
        slopes = [slope]
        if min(abs(x - kink) for kink in kinks) < 1e-9:
            slopes = [true(x - 1e-6)[1], true(x + 1e-6)[1]]
        np.testing.assert_allclose(result["B.s"][row], value, atol=1e-14)
        found = [result[f"B.{order}"][row] for order in ("s_dot", "s_ddot")]
        off = min(abs(found[0] - 3.0 * s) + abs(found[1] - 2.0 * s) for s in slopes)
        assert off < 1e-12, (row, x)
        (side,) = {s for s in slopes if abs(found[0] - 3.0 * s) < 1e-12}
        effort = 0.5 * 2.0 + 2.0 * found[1] * side
        np.testing.assert_allclose(result["A.effort"][row], effort, atol=1e-11)


def test_lanes_and_threads_give_the_same_bits() -> None:
    law = LAWS["bent twice"][0]
    text = FOLLOWED.replace("LAW", law).replace("FIRST", "-1").replace("LAST", "1")
    model = mk.loads(text)
    result, narrow = model.analyze(), model.analyze(lanes=2, threads=1)
    for name in ("B.s", "B.s_dot", "A.effort"):
        np.testing.assert_array_equal(result[name], narrow[name])


def test_rows_on_both_sides_and_the_way_over_a_kink_are_proven() -> None:
    text = FOLLOWED.replace("LAW", LAWS["between rows"][0])
    certificate = mk.loads(text.replace("FIRST", "-1").replace("LAST", "1")).certify()
    assert set(certificate.status) == {"proven"}
    assert certificate.is_one_branch


def test_the_follower_may_drive_over_a_kink() -> None:
    """The inverse of a polygon that rises."""
    law = 'value: "max(0.2 m/rad*(theta - 0.1 rad), 0.5 m/rad*(theta - 0.1 rad))"'
    text = FOLLOWED.replace("LAW", law).split("motion:")[0]
    text += "motion: {inputs: {B.s: {from: -0.2, to: 0.4, count: 13, rate: 0.5 m/s}}}\n"
    result = mk.loads(text + "assembly: {near: {A.theta: -1}}").analyze()
    assert set(result["row.status"]) == {"ok"}
    way = np.linspace(-0.2, 0.4, 13)
    turn = 0.1 + np.where(way < 0.0, way / 0.2, way / 0.5)
    np.testing.assert_allclose(result["A.theta"], turn, atol=1e-13)
    off = np.abs(way) > 1e-9
    np.testing.assert_allclose(
        result["A.theta_dot"][off], np.where(way < 0.0, 0.5 / 0.2, 0.5 / 0.5)[off], rtol=1e-12
    )


def test_no_follower_drives_beyond_the_tip_of_a_v() -> None:
    """There the two sides lead back from one another: nothing is given for what does not exist."""
    text = FOLLOWED.replace("LAW", LAWS["v"][0]).split("motion:")[0]
    text += "motion: {inputs: {B.s: {from: 0.2, to: -0.1, step: 0.04}}}\n"
    result = mk.loads(text + "assembly: {near: {A.theta: -1}}").analyze()
    way = 0.2 - 0.04 * np.arange(8)
    np.testing.assert_allclose(result["A.theta"][:5], -way[:5] / 0.7, atol=1e-13)
    assert set(result["row.status"][:5]) == {"ok"}
    assert np.isnan(result["A.theta"][6:]).all()
    assert set(result["row.status"][6:]) == {"beyond-dead-centre"}
    (said,) = [str(d) for d in result.diagnostics if d.code == "dead-centre"]
    assert (
        "turns back where the slope of K changes its sign with a jump, at A.theta = 0 rad" in said
    )


FOUR_BAR = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {shaft: {}, crank: {}, rod: {}, rocker: {}}
joints:
  I: {type: R, links: [ground, shaft], point: [-1, 0]}
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [0, 0.3]}
  C: {type: R, links: [rod, rocker], point: [1, 0.8]}
  D: {type: R, links: [ground, rocker], point: [0.9, 0]}
couplings:
  K: {type: function, of: I.theta, gives: A.theta, value: "theta + 0.6*abs(theta - 1.1 rad)"}
motion: {inputs: {I.theta: {from: 0, to: 2.2, count: 12, rate: 2 rad/s}}}
"""


def test_a_loop_is_followed_behind_a_kink_of_what_drives_it() -> None:
    result = mk.loads(FOUR_BAR).analyze()
    assert set(result["row.status"]) == {"ok"}
    with mp.workdps(30):
        rod = mp.hypot(mp.mpf(1), mp.mpf("0.5"))

        def apart(crank: Any, rocker: Any) -> Any:
            x = mp.mpf("0.9") + mp.cos(rocker) / 10 - 8 * mp.sin(rocker) / 10
            y = mp.sin(rocker) / 10 + 8 * mp.cos(rocker) / 10
            return mp.hypot(x + 3 * mp.sin(crank) / 10, y - 3 * mp.cos(crank) / 10) - rod

        # branches are told apart along finer steps than the rows'
        rocker, fine = mp.mpf(0), 20
        slope = mp.mpf(0)
        shaft = mp.mpf(0)
        start = shaft + mp.mpf("0.6") * abs(shaft - mp.mpf("1.1"))
        for k in range(1, fine + 1):
            rocker = mp.findroot(lambda r, k=k: apart(start * k / fine, r), rocker)
        for row in range(12):
            for k in range(1, fine + 1):
                shaft = mp.mpf("2.2") * (row - 1 + mp.mpf(k) / fine) / 11
                if row == 0:
                    shaft = mp.mpf(0)
                crank = shaft + mp.mpf("0.6") * abs(shaft - mp.mpf("1.1"))
                rocker = mp.findroot(lambda r, c=crank: apart(c, r), rocker)
            by_crank = -mp.diff(lambda c, r=rocker: apart(c, r), crank) / mp.diff(
                lambda r, c=crank: apart(c, r), rocker
            )
            slope = 1 + mp.mpf("0.6") * (1 if shaft > mp.mpf("1.1") else -1)
            np.testing.assert_allclose(result["D.theta"][row], float(rocker), atol=1e-12)
            rate = float(2 * slope * by_crank)
            np.testing.assert_allclose(result["D.theta_dot"][row], rate, atol=1e-11)


GROOVE = """
format: 1
plane: xy
units: {length: m, angle: rad}
links: {slide: {}, bead: {}}
joints:
  S: {type: P, links: [ground, slide], point: [-1, 0.5], axis: [1, 0]}
  T: {type: P, links: [slide, bead], point: [-1, 0.5], axis: [0, 1]}
  D:
    type: Ps
    links: [bead, ground]
    point: [-1, 0.5]
    curve: {at: [u, '0.5*abs(u) - 2*max(u - 0.35 m, 0 m)'], from: -2 m, to: 2 m}
motion: {inputs: {S.s: {from: 0, to: 2, count: 9, rate: 3 m/s}}}
"""


def test_a_bead_goes_round_the_corners_of_its_groove() -> None:
    result = mk.loads(GROOVE).analyze()
    assert set(result["row.status"]) == {"ok"}
    x = np.linspace(-1.0, 1.0, 9)
    y = 0.5 * np.abs(x) - 2.0 * np.maximum(x - 0.35, 0.0)
    np.testing.assert_allclose(result["T.s"], y - 0.5, atol=1e-14)
    slope = np.where(x < 0.0, -0.5, 0.5) - np.where(x > 0.35, 2.0, 0.0)
    off = np.abs(x) > 1e-9
    np.testing.assert_allclose(result["T.s_dot"][off], 3.0 * slope[off], rtol=1e-12)


def warnings(result: mk.Result) -> list[str]:
    return [str(d) for d in result.diagnostics if d.code == "slope-jump"]


def test_where_a_slope_jumps_and_which_rows_stand_there_is_said() -> None:
    text = FOLLOWED.replace("LAW", LAWS["bent twice"][0])
    (said,) = warnings(mk.loads(text.replace("FIRST", "-1").replace("LAST", "1")).analyze())
    # -3 times twice the slope of 0.2 m/rad
    assert "the slope of K jumps at A.theta = -0.25 rad, the largest of 2 such jumps" in said
    assert "rows 7 and 11 stand there and have the rates of one side: 1.2 m/rad" in said
    (said,) = warnings(mk.loads(text.replace("FIRST", "-0.2").replace("LAST", "0.9")).analyze())
    assert "jumps at A.theta = 0.25 rad: 0.4 m/rad" in said
    assert "row" not in said
    assert not warnings(mk.loads(text.replace("FIRST", "0.3").replace("LAST", "0.9")).analyze())


@pytest.mark.parametrize("law", ["theta*abs(theta)/(1 rad)", "if(theta > 0.1 rad, theta, theta)"])
def test_choices_without_a_jump_of_the_slope_are_not_told(law: str) -> None:
    text = FOLLOWED.replace("LAW", f'value: "0.2 m/rad*({law})"')
    assert not warnings(mk.loads(text.replace("FIRST", "-1").replace("LAST", "1")).analyze())


def test_a_corner_of_a_groove_is_told() -> None:
    (said,) = warnings(mk.loads(GROOVE).analyze())
    assert "the slope of D jumps at D.u = 0.35, the largest of 2 such jumps" in said


PUSHED = (
    FOLLOWED.split("motion:")[0].replace("LAW", 'value: "VALUE"')
    + """
loads: [{type: torque, joint: A, value: 1}]
responses: {r: {start: {A.theta: -1, A.theta_dot: 1}, time: {from: 0, to: 2, count: 9}}}
"""
)


@pytest.mark.parametrize(
    ("value", "kink", "slope", "size"),
    [
        ("max(0.2 m/rad*(theta - 0.1 rad), 0.4 m/rad*(theta - 0.1 rad))", 0.1, 0.2, "0.2 m/rad"),
        ("0.2 m/rad*abs(theta)", 0.0, -0.2, "0.4 m/rad"),
        ("k*abs(theta + 0.3 rad)", -0.3, -0.3, "0.6 m/rad"),
    ],
)
def test_a_motion_ends_where_a_slope_jumps(
    value: str, kink: float, slope: float, size: str
) -> None:
    """Up to there with a constant inertia I + m g'^2; behind it rates would jump, and how is not
    known. It went on with other rates, as if nothing were."""
    text = PUSHED.replace("VALUE", value)
    if "k*" in value:
        text = text.replace("couplings:", "parameters: {k: 0.3 m/rad}\ncouplings:")
    result = mk.loads(text).respond("r")
    acceleration = 1.0 / (0.5 + 2.0 * slope * slope)
    way = kink + 1.0
    moment = (np.sqrt(1.0 + 2.0 * acceleration * way) - 1.0) / acceleration
    times = np.linspace(0.0, 2.0, 9)
    before = times < moment
    turn = -1.0 + times + 0.5 * acceleration * times**2
    np.testing.assert_allclose(result["A.theta"][before], turn[before], atol=1e-9)
    assert set(result["row.status"][before]) == {"ok"}
    assert set(result["row.status"][~before]) == {"step-limit"}
    assert np.isnan(result["A.theta"][~before]).all()
    (said,) = [d for d in result.diagnostics if d.severity == "error"]
    assert said.code == "slope-jump"
    assert f"ends at {moment:.6g} s: the slope of K jumps at A.theta = {kink:g} rad" in str(said)
    assert size in str(said)


def test_variants_end_where_their_own_slope_jumps() -> None:
    text = PUSHED.replace("VALUE", "0.3 m/rad*abs(theta + d)")
    model = mk.loads(text.replace("couplings:", "parameters: {d: 0.3 rad}\ncouplings:"))
    table = model.vary({"d": [0.2, 0.3, 0.4]}, ["A.theta"], run="r")
    acceleration = 1.0 / (0.5 + 2.0 * 0.09)
    times = np.linspace(0.0, 2.0, 9)
    for number, kink in enumerate((-0.2, -0.3, -0.4)):
        before = -1.0 + times + 0.5 * acceleration * times**2 < kink
        np.testing.assert_array_equal(np.isfinite(table["A.theta"][number]), before)


def test_a_motion_goes_on_where_a_choice_bends_no_slope() -> None:
    """By energy: (I + m g'^2) w^2 / 2 grows by the torque's work."""
    result = mk.loads(PUSHED.replace("VALUE", "0.2 m/rad^2*theta*abs(theta)")).respond("r")
    assert set(result["row.status"]) == {"ok"}
    turn, rate = result["A.theta"], result["A.theta_dot"]
    energy = (0.25 + (0.4 * turn) ** 2) * rate**2 - turn
    np.testing.assert_allclose(energy, energy[0], atol=1e-8)


def test_a_stop_before_a_jump_ends_a_motion_as_it_did() -> None:
    text = PUSHED.replace("VALUE", "0.2 m/rad*abs(theta)")
    text = text.replace("count: 9}}}", "count: 9}, stop: [{value: A.theta, at: -0.5}]}}")
    result = mk.loads(text).respond("r")
    assert set(result["row.status"]) == {"ok"}
    np.testing.assert_allclose(result["A.theta"][-1], -0.5, atol=1e-12)


SLIDING = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  slide: {}
  bead: {mass: 2, center_of_mass: [-1, 0.5], inertia: 1}
joints:
  S: {type: P, links: [ground, slide], point: [-1, 0.5], axis: [1, 0]}
  T: {type: P, links: [slide, bead], point: [-1, 0.5], axis: [0, 1]}
  D: {type: Ps, links: [bead, ground], point: [-1, 0.5],
      curve: {at: [u, '0.5*abs(u)'], from: -2 m, to: 2 m}}
loads: [{type: gravity, g: [0, -9.81]}]
responses: {r: {start: {S.s: 0, S.s_dot: 0}, time: {from: 0, to: 1.2, count: 13}}}
"""


def test_a_bead_that_falls_into_a_corner_ends_there() -> None:
    """Along the slope of 1/2 with g sin a; horizontally that is g sin a cos a = 2 g / 5."""
    result = mk.loads(SLIDING).respond("r")
    times, pull = np.linspace(0.0, 1.2, 13), 0.4 * 9.81
    moment = np.sqrt(2.0 / pull)
    before = times < moment
    np.testing.assert_allclose(result["S.s"][before], 0.5 * pull * times[before] ** 2, atol=1e-9)
    assert set(result["row.status"][~before]) == {"step-limit"}
    (said,) = [d for d in result.diagnostics if d.severity == "error"]
    assert f"ends at {moment:.6g} s: the slope of D jumps at D.u = 0" in str(said)
