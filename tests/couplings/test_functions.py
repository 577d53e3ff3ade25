"""Coordinates that are functions of others, by an expression or a table, against derivatives of
closed forms at 40 digits and forces by virtual work."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile

YOKE = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
parameters: {r: 0.2 m}
links:
  crank: {mass: 1, center_of_mass: [0, 0], inertia: 0.5}
  yoke: {mass: 2, center_of_mass: [0, 0], inertia: 1}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: P, links: [ground, yoke], point: [0, 0], axis: [1, 0]}
couplings:
  K: {type: function, of: A.theta, gives: B.s, value: "r*(1 - cos(theta))"}
"""
TURNING = """
motion:
  inputs: {A.theta: {from: 0.1, to: 12.7, count: 64, rate: 10 rad/s, acceleration: 3 rad/s^2,
           jerk: 7 rad/s^3}}
loads: [{type: force, joint: B, value: 5}]
"""
PUSHED = """
motion:
  inputs: {B.s: {from: 0.02, to: 0.38, count: 10, rate: 0.5 m/s, acceleration: 0.3 m/s^2}}
assembly: {near: {A.theta: 0.4}}
loads: [{type: torque, joint: A, value: 3}]
"""


def followed(g: Any, x: float, rates: tuple[float, float, float]) -> list[float]:
    """g and its first three derivatives by time at x, which moves at rates, at 40 digits."""
    with mp.workdps(40):
        v, a, j = map(mp.mpf, rates)
        d = [mp.diff(g, mp.mpf(x), k) for k in range(4)]
        found = [
            d[0],
            d[1] * v,
            d[2] * v**2 + d[1] * a,
            d[3] * v**3 + 3 * d[2] * v * a + d[1] * j,
        ]
        return [float(each) for each in found]


def expected(g: Any, places: Any, rates: tuple[float, float, float]) -> Any:
    """Those of all places, shape (4, rows)."""
    return np.array([followed(g, x, rates) for x in places]).T


def test_scotch_yoke() -> None:
    """The yoke moves as r (1 - cos theta), and the crank feels its force by virtual work."""
    result = mk.loads(YOKE + TURNING).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(0.1, 12.7, 64)
    moves = expected(lambda x: mp.mpf("0.2") * (1 - mp.cos(x)), turn, (10.0, 3.0, 7.0))
    for order, name in enumerate(("s", "s_dot", "s_ddot", "s_dddot")):
        scale = np.abs(moves[order]).max()
        np.testing.assert_allclose(
            result[f"B.{name}"], moves[order], rtol=1e-14, atol=3e-15 * scale
        )
    force = 2.0 * moves[2] - 5.0
    np.testing.assert_allclose(result["K.force"], force, rtol=1e-13, atol=1e-13)
    by_turn = 0.2 * np.sin(turn)
    effort = 0.5 * 3.0 + force * by_turn
    np.testing.assert_allclose(result["A.effort"], effort, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(result["K.torque"], -force * by_turn, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(result["K.power"], force * moves[1], rtol=1e-12, atol=1e-13)


def test_the_follower_may_drive_up_to_its_dead_centres() -> None:
    model = mk.loads(YOKE + PUSHED)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    way = np.linspace(0.02, 0.38, 10)

    def of_way(s: Any) -> Any:
        return mp.acos(1 - s / mp.mpf("0.2"))

    turn = expected(of_way, way, (0.5, 0.3, 0.0))
    for order, name in enumerate(("theta", "theta_dot", "theta_ddot")):
        np.testing.assert_allclose(result[f"A.{name}"], turn[order], rtol=1e-12)
    by_way = expected(of_way, way, (1.0, 0.0, 0.0))[1]
    effort = 2.0 * 0.3 + (0.5 * turn[2] - 3.0) * by_way
    np.testing.assert_allclose(result["B.effort"], effort, rtol=1e-12)
    ends = [(r.lower.value, r.upper.value) for r in model.ranges().ranges]
    np.testing.assert_allclose(ends, [(0.0, 0.4)] * len(ends), atol=1e-9)
    # two ways to stand at each place
    turns = sorted(abs(float(mode.coordinates["A.theta"])) for mode in model.modes().modes)
    first = float(of_way(mp.mpf("0.02")))
    np.testing.assert_allclose(turns, [first, first], rtol=1e-9)


CAM = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {shaft: {}, crank: {mass: 2, center_of_mass: [0.1, 0], inertia: 0.3}, rod: {}, rocker: {}}
joints:
  I: {type: R, links: [ground, shaft], point: [-1, 0]}
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [0, 0.3]}
  C: {type: R, links: [rod, rocker], point: [1, 0.8]}
  D: {type: R, links: [ground, rocker], point: [0.9, 0]}
motion:
  inputs: {I.theta: {from: 0, to: 6, count: 25, rate: 2 rad/s, acceleration: 3 rad/s^2,
           jerk: 5 rad/s^3}}
loads: [{type: torque, link: rocker, torque: 4}]
couplings:
"""
LAW = 'K: {type: function, of: I.theta, gives: A.theta, value: "theta + 0.3 rad*sin(2*theta)"}'


def test_a_function_before_a_loop_drives_it_as_its_crank_would_be() -> None:
    """The four-bar alone, its crank prescribed by the values and rates of the law."""
    places = np.linspace(0.0, 6.0, 25)
    turn = expected(lambda x: x + mp.mpf("0.3") * mp.sin(2 * x), places, (2.0, 3.0, 5.0))
    result = mk.loads(CAM + "  " + LAW).analyze()
    assert set(result["row.status"]) == {"ok"}
    alone = CAM.replace("  I: {type: R, links: [ground, shaft], point: [-1, 0]}\n", "")
    alone = alone.replace("shaft: {}, ", "").replace("couplings:", "")
    for row in range(25):
        value, rate, acceleration, jerk = map(float, turn[:, row])
        motion = (
            f"inputs: {{A.theta: {{at: {value!r}, rate: {rate!r} rad/s, "
            f"acceleration: {acceleration!r} rad/s^2, jerk: {jerk!r} rad/s^3}}}}\n"
        )
        start, rest = alone.split("inputs:")[0], alone.split("rad/s^3}}\n")[1]
        single = mk.loads(start + motion + rest).analyze()
        for name in ("D.theta_dot", "D.theta_ddot", "D.theta_dddot", "C.force", "A.force"):
            np.testing.assert_allclose(
                result[name][row], single[name][0], rtol=1e-10, atol=1e-10, err_msg=name
            )
        by_shaft = rate / 2.0
        effort = single["A.effort"][0]
        np.testing.assert_allclose(result["K.torque"][row], effort, rtol=1e-10, atol=1e-11)
        np.testing.assert_allclose(
            result["I.effort"][row], effort * by_shaft, rtol=1e-9, atol=1e-10
        )


def test_rows_are_proven_their_errors_known_and_their_slopes_exact() -> None:
    for text in (YOKE + TURNING, YOKE + PUSHED, CAM + "  " + LAW):
        model = mk.loads(text)
        certificate = model.certify()
        assert set(certificate.status) == {"proven"}
        assert certificate.is_one_branch
    model = mk.loads(YOKE + TURNING)
    errors = model.analyze(errors=True).errors
    assert errors.digits is not None
    assert errors.digits >= 13
    slopes = model.sensitivities(["B.s"], ["r"])
    turn = np.linspace(0.1, 12.7, 64)
    np.testing.assert_allclose(slopes["B.s", "r"], 1.0 - np.cos(turn), rtol=1e-12, atol=1e-14)


def test_mobility_counts_a_function_as_one_equation() -> None:
    found = mk.loads(CAM + "  " + LAW).mobility()
    assert found.mobility == 1
    # where the slope is zero the follower rests to first order, and moves all the same
    assert mk.loads(YOKE + TURNING).mobility().mobility == 1


def test_variants_and_lanes_give_the_same_bits() -> None:
    model = mk.loads(YOKE + TURNING)
    names = ["B.s", "B.s_ddot", "A.effort"]
    radii = ["0.1 m", "0.2 m", "0.3 m", "0.45 m", "0.7 m"]
    table = model.vary({"r": radii}, names)
    for number, radius in enumerate(radii):
        alone = model.with_parameters({"r": radius}).analyze()
        narrow = model.with_parameters({"r": radius}).analyze(lanes=2, threads=1)
        for name in names:
            np.testing.assert_array_equal(table[name][number], alone[name])
            np.testing.assert_array_equal(narrow[name], alone[name])


TABLE = YOKE.replace(
    'K: {type: function, of: A.theta, gives: B.s, value: "r*(1 - cos(theta))"}',
    "K: {type: table, table: lift.csv, over: A.theta, gives: B.s}",
).replace("parameters: {r: 0.2 m}\n", "")


def tabled(folder: Path, text: str, rows: list[tuple[float, float]]) -> mk.Model:
    """The model of a text whose table has rows."""
    lines = [f"{x!r},{y!r}" for x, y in rows]
    (folder / "lift.csv").write_text("\n".join(["turn,lift", *lines]) + "\n")
    (folder / "m.yaml").write_text(text)
    return mk.load(folder / "m.yaml")


def test_a_table_of_a_cubic_is_that_cubic(tmp_path: Path) -> None:
    """A spline meets a cubic exactly, up to its third derivative."""

    def cubic(x: Any) -> Any:
        return (x - 3) * (x - 8) * x / 100

    rows = [(float(x), float(cubic(x))) for x in (0, 1, 2.5, 4, 7, 13)]
    result = tabled(tmp_path, TABLE + TURNING, rows).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(0.1, 12.7, 64)
    moves = expected(cubic, turn, (10.0, 3.0, 7.0))
    for order, name in enumerate(("s", "s_dot", "s_ddot", "s_dddot")):
        scale = np.abs(moves[order]).max()
        np.testing.assert_allclose(result[f"B.{name}"], moves[order], atol=1e-12 * scale)
    force = 2.0 * moves[2] - 5.0
    by_turn = moves[1] / 10.0
    np.testing.assert_allclose(result["A.effort"], 1.5 + force * by_turn, atol=1e-10)


def test_a_table_of_a_whole_turn_holds_for_every_turn(tmp_path: Path) -> None:
    """Seven turns on and one back it is the same; the spline goes on smoothly over its end."""
    places = [2.0 * np.pi * k / 40 for k in range(41)]
    lifts = [0.2 * (1.0 - float(np.cos(x))) for x in places]
    lifts[-1] = lifts[0]
    moved = TURNING.replace("from: 0.1, to: 12.7", "from: -7.4, to: 50.3")
    result = tabled(tmp_path, TABLE + moved, list(zip(places, lifts, strict=True))).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(-7.4, 50.3, 64)
    # of fourth order in the spacing, and the curvature of second
    np.testing.assert_allclose(result["B.s"], 0.2 * (1.0 - np.cos(turn)), atol=1e-6)
    bend = 0.2 * (100.0 * np.cos(turn) + 3.0 * np.sin(turn))
    np.testing.assert_allclose(result["B.s_ddot"], bend, atol=0.06)


WRONG = {
    "no expression of it": ("r*(1 - cos(theta))", "r", "this value never changes"),
    "an angle": ("r*(1 - cos(theta))", "theta", "expected a length, found an angle"),
    "unknown name": ("cos(theta)", "cos(phi)", "phi"),
    "itself": ("gives: B.s", "gives: A.theta", "are one freedom"),
    "no coordinate": ("of: A.theta", "of: A.s", "has no coordinate s"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_what_is_wrong_is_told_at_its_place(before: str, after: str, words: str) -> None:
    with pytest.raises(InvalidFile) as told:
        mk.loads((YOKE + TURNING).replace(before, after))
    errors = [d for d in told.value.diagnostics if d.severity == "error"]
    assert len(errors) == 1
    assert words in str(errors[0])
    assert errors[0].place is not None


RISES = {
    "harmonic": lambda u: (1 - mp.cos(mp.pi * u)) / 2,
    "cycloidal": lambda u: u - mp.sin(2 * mp.pi * u) / (2 * mp.pi),
    "3-4-5": lambda u: 10 * u**3 - 15 * u**4 + 6 * u**5,
    "4-5-6-7": lambda u: 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7,
}


@pytest.mark.parametrize("name", RISES)
def test_laws_of_cams_over_an_angle(name: str) -> None:
    """Rest before and after; a rise of 20 mm over 60 deg, with the rates of the cam's."""
    law = f"law: {{law: {name}, from: 0 m, to: 20 mm, start: 30 deg, duration: 60 deg}}"
    text = (YOKE + TURNING).replace('value: "r*(1 - cos(theta))"', law)
    text = text.replace("from: 0.1, to: 12.7", "from: -1.3, to: 3.25")
    result = mk.loads(text).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(-1.3, 3.25, 64)

    def rise(x: Any) -> Any:
        u = (x - mp.pi / 6) / (mp.pi / 3)
        return mp.mpf("0.02") * RISES[name](u)

    rising = (turn > np.pi / 6) & (turn < np.pi / 2)
    moves = np.zeros((4, 64))
    moves[:, rising] = expected(rise, turn[rising], (10.0, 3.0, 7.0))
    moves[0, turn > np.pi / 2] = 0.02
    for order, word in enumerate(("s", "s_dot", "s_ddot", "s_dddot")):
        scale = np.abs(moves[order]).max()
        np.testing.assert_allclose(result[f"B.{word}"], moves[order], atol=1e-13 * scale)


SEGMENTS = """law: {law: sequence, start: 0.5, segments: [
      {for: 60 deg, to: 20 mm, law: cycloidal}, {for: 90 deg, law: dwell},
      {for: 120 deg, to: 0 m, law: 3-4-5}, {for: 90 deg, law: dwell}]}"""


def cam(x: Any) -> Any:
    """Its lift in m, over any turn."""
    u = (x - mp.mpf("0.5")) / mp.pi * 180 % 360
    if u < 60:
        return mp.mpf("0.02") * RISES["cycloidal"](u / 60)
    if u < 150:
        return mp.mpf("0.02")
    return mp.mpf("0.02") * (1 - RISES["3-4-5"]((u - 150) / 120)) if u < 270 else mp.mpf(0)


def test_a_cam_whose_segments_span_a_turn_lifts_in_every_turn() -> None:
    text = (YOKE + TURNING).replace('value: "r*(1 - cos(theta))"', SEGMENTS)
    model = mk.loads(text.replace("from: 0.1, to: 12.7", "from: -9.1, to: 12.7"))
    assert [str(d) for d in model.diagnostics if d.code != "unused-parameter"] == []
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(-9.1, 12.7, 64)
    moves = expected(cam, turn, (10.0, 3.0, 7.0))
    for order, word in enumerate(("s", "s_dot", "s_ddot", "s_dddot")):
        scale = np.abs(moves[order]).max()
        np.testing.assert_allclose(result[f"B.{word}"], moves[order], atol=2e-13 * scale)
    by_turn = np.array([float(mp.diff(cam, mp.mpf(x))) for x in turn])
    effort = 0.5 * 3.0 + (2.0 * moves[2] - 5.0) * by_turn
    np.testing.assert_allclose(result["A.effort"], effort, atol=1e-11 * np.abs(effort).max())
    assert set(model.certify().status) == {"proven"}


def test_what_jumps_between_the_segments_of_a_cam_is_said() -> None:
    text = (YOKE + TURNING).replace('value: "r*(1 - cos(theta))"', SEGMENTS)
    said = [str(d) for d in mk.loads(text.replace("cycloidal", "constant-rate")).diagnostics]
    (warning,) = (line for line in said if "warning" in line)
    # 20 mm over 60 deg from where the sequence begins to where it dwells
    assert "the rate of this sequence jumps at 0.5 rad, the largest of 2 such jumps" in warning
    assert f"{0.02 / (np.pi / 3):.6g} m/rad" in warning


def test_a_cam_that_is_left_open_is_refused() -> None:
    text = (YOKE + TURNING).replace('value: "r*(1 - cos(theta))"', SEGMENTS)
    with pytest.raises(InvalidFile, match=r"does not end where it began: 0\.01 m"):
        mk.loads(text.replace("to: 0 m,", "to: 10 mm,"))


def test_a_law_as_an_expression_is_the_value() -> None:
    law = 'law: {law: expression, value: "r*(1 - cos(A.theta))"}'
    text = YOKE + TURNING
    found = mk.loads(text.replace('value: "r*(1 - cos(theta))"', law)).analyze()
    alike = mk.loads(text).analyze()
    np.testing.assert_array_equal(found["B.s_dddot"], alike["B.s_dddot"])
    np.testing.assert_array_equal(found["K.force"], alike["K.force"])


def test_a_textbooks_digits_of_a_rise() -> None:
    """Cycloidal, h = 20 mm, beta = 60 deg, 5 deg behind its begin."""
    law = "law: {law: cycloidal, from: 0 m, to: 20 mm, duration: 60 deg}"
    text = YOKE.replace('value: "r*(1 - cos(theta))"', law)
    motion = "motion: {inputs: {A.theta: {at: 5 deg, rate: 1 rad/s}}}"
    result = mk.loads(text + motion).analyze()
    found = [1000.0 * float(result[f"B.{word}"][0]) for word in ("s", "s_dot", "s_ddot")]
    np.testing.assert_allclose(found, [0.0751172, 2.558726, 57.2957795], rtol=1e-6)


def test_a_law_is_recorded_alike_whatever_its_numbers_are() -> None:
    """Proofs and variants record anew what was built with a zero."""
    laws = (
        'value: "lift + r*(1 - cos(theta))"',
        "law: {law: cycloidal, from: lift, to: 0.3 m, start: 0, duration: 2}",
        "law: {law: polynomial, coefficients: [lift, 0 m/rad, 1 m/rad^2]}",
    )
    for law in laws:
        text = (YOKE + TURNING).replace('value: "r*(1 - cos(theta))"', law)
        model = mk.loads(text.replace("{r: 0.2 m}", "{r: 0.2 m, lift: 0 m}"))
        assert set(model.certify().status) == {"proven"}
        table = model.vary({"lift": ["0 m", "0.1 m"]}, ["B.s", "B.s_ddot"])
        for number, lift in enumerate(("0 m", "0.1 m")):
            alone = model.with_parameters({"lift": lift}).analyze()
            np.testing.assert_array_equal(table["B.s"][number], alone["B.s"])
            np.testing.assert_array_equal(table["B.s_ddot"][number], alone["B.s_ddot"])


SEQUENCE = (
    "law: {law: sequence, from: 0 m, segments: [{for: 90 deg, law: modified-sine, to: 20 mm}, "
    "{for: 90 deg, law: dwell}, {for: 120 deg, law: 3-4-5, to: 0 m}, {for: 60 deg, law: dwell}]}"
)


def test_a_sequence_of_a_turn_is_proven_and_its_errors_known_in_every_turn() -> None:
    """Rows on the joints of its segments, too; proofs go on over them."""
    text = (YOKE + TURNING).replace('value: "r*(1 - cos(theta))"', SEQUENCE)
    model = mk.loads(
        text.replace("from: 0.1, to: 12.7, count: 64", "from: 0, to: 800 deg, count: 81")
    )
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.arange(0.0, 801.0, 10.0) % 360.0
    lift = result["B.s"]
    np.testing.assert_allclose(lift[(turn >= 90.0) & (turn <= 180.0)], 0.02, rtol=1e-13)
    np.testing.assert_allclose(lift[turn >= 300.0], 0.0, atol=1e-16)
    u = (turn - 180.0) / 120.0
    back = 0.02 * (1.0 - u**3 * (10.0 - 15.0 * u + 6.0 * u**2))
    falling = (turn >= 180.0) & (turn <= 300.0)
    np.testing.assert_allclose(lift[falling], back[falling], atol=1e-15)
    certificate = model.certify()
    assert set(certificate.status) == {"proven"}
    assert certificate.is_one_branch
    assert (result.errors.digits or 0) >= 13


def test_tables_are_proven_and_their_errors_known(tmp_path: Path) -> None:
    """Of a whole turn over its end, and of a part up to both ends; against the exact curves in
    tests/proofs/test_knots.py."""
    places = [2.0 * np.pi * k / 24 for k in range(25)]
    turned = [
        (x, 0.2 - 0.2 * float(np.cos(2.0 * np.pi * (k % 24) / 24))) for k, x in enumerate(places)
    ]
    part = [(0.0, 0.0), (1.0, 0.1), (2.0, 0.3), (3.0, 0.2), (5.0, 0.0)]
    for rows, range_of in ((turned, "from: -4, to: 9"), (part, "from: 0, to: 5")):
        moved = TURNING.replace("from: 0.1, to: 12.7", range_of)
        model = tabled(tmp_path, TABLE + moved, rows)
        assert set(model.analyze()["row.status"]) == {"ok"}
        certificate = model.certify()
        assert set(certificate.status) == {"proven"}
        assert certificate.is_one_branch
        assert (model.analyze().errors.digits or 0) >= 13


def test_a_table_whose_slope_would_jump_is_refused(tmp_path: Path) -> None:
    linear = TABLE.replace("gives: B.s}", "gives: B.s, interpolation: linear}")
    with pytest.raises(InvalidFile, match="write interpolation: monotone"):
        tabled(tmp_path, linear + TURNING, [(0.0, 0.0), (13.0, 1.0)])


def test_a_response_under_forces_follows_the_law() -> None:
    """Reduced to the crank: (I + m g'^2) theta'' + m g' g'' theta'^2 = M + F g', by an integrator
    of its own at 30 digits."""
    text = YOKE + (
        "loads: [{type: force, joint: B, value: 5}, {type: torque, joint: A, value: 1}]\n"
        "responses: {r: {start: {A.theta: 0.3, A.theta_dot: 1}, time: {from: 0, to: 2, count: 5}}}"
    )
    result = mk.loads(text).respond("r")
    assert set(result["row.status"]) == {"ok"}

    def slopes(_: Any, y: Any) -> Any:
        turn, rate = y
        one, two = mp.mpf("0.2") * mp.sin(turn), mp.mpf("0.2") * mp.cos(turn)
        return [rate, (1 + 5 * one - 2 * one * two * rate**2) / (0.5 + 2 * one**2)]

    with mp.workdps(20):
        path = mp.odefun(slopes, 0, [mp.mpf("0.3"), mp.mpf(1)], tol=mp.mpf("1e-13"))
        turns = [float(path(t)[0]) for t in result["time"]]
    np.testing.assert_allclose(result["A.theta"], turns, rtol=1e-8)
    np.testing.assert_allclose(result["B.s"], 0.2 * (1.0 - np.cos(turns)), rtol=1e-8)


def test_rows_beyond_a_table_are_named_as_beyond_its_ends(tmp_path: Path) -> None:
    """They are solved, straight on from its ends, and never told as ok."""
    rows = [(0.0, 0.0), (1.0, 0.1), (2.0, 0.3), (3.0, 0.2), (5.0, 0.0)]
    model = tabled(
        tmp_path,
        TABLE + TURNING.replace("from: 0.1, to: 12.7, count: 64", "from: -2, to: 7, count: 10"),
        rows,
    )
    result = model.analyze()
    status = result["row.status"].tolist()
    assert status == ["beyond-limit"] * 2 + ["ok"] * 6 + ["beyond-limit"] * 2
    told = [str(d) for d in result.diagnostics if d.code == "beyond-limit"]
    assert len(told) == 2
    assert "A.theta" in told[0]
    assert "(limit 0 rad)" in told[0]
    assert "(limit 5 rad)" in told[1]


@pytest.mark.parametrize("to", ["theta", "s"])
@pytest.mark.parametrize("by", ["theta", "s"])
def test_what_is_transmitted_is_told_at_the_follower(by: str, to: str) -> None:
    """b = f(a), f = sin(2 a)/2, with an effort of -2 on B: K holds it with Q = 2 there, and puts
    in Q f' a'; on A it applies -f' Q, which the drive there holds."""
    joints = {
        "theta": "{type: R, links: [ground, LINK], point: [0, 0]}",
        "s": "{type: P, links: [ground, LINK], point: [0, 0], axis: [1, 0]}",
    }
    one = {"theta": "1 rad", "s": "1 m"}
    text = f"""
format: 1
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{a: {{}}, b: {{}}}}
joints:
  A: {joints[by].replace("LINK", "a")}
  B: {joints[to].replace("LINK", "b")}
couplings:
  K: {{type: function, of: A.{by}, gives: B.{to}, value: "{one[to]}*sin({by}/({one[by]})*2 rad)/2"}}
motion: {{inputs: {{A.{by}: {{from: 0.2, to: 0.4, count: 3, rate: 3}}}}}}
loads: [{{type: {"torque" if to == "theta" else "force"}, joint: B, value: -2}}]
"""
    result = mk.loads(text).analyze()
    slope = np.cos(2.0 * result[f"A.{by}"])
    words = {"theta": "K.torque", "s": "K.force"}
    np.testing.assert_allclose(result[words[to]], 2.0, rtol=1e-13)
    np.testing.assert_allclose(result["K.power"], 2.0 * slope * 3.0, rtol=1e-13)
    np.testing.assert_allclose(result["A.effort"], 2.0 * slope, rtol=1e-13)
    if by != to:
        np.testing.assert_allclose(result[words[by]], -2.0 * slope, rtol=1e-13)
