"""Motions prescribed at poses and points, efforts at actuators, ties: by closed forms and by the
same motion prescribed elsewhere."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mechanisms.actuated import ARM, FIVE_BAR, GEARED, LEGS, POSE, SLIDER_CRANK, platform
from oracle.numerics import mpmath_context as mp

import mechkin_cli as mk
from mechkin_cli.kernel import _kernel

NEAR = 1e-11
POSE_COURSES = {
    "x": (0.05, 0.2),
    "y": (-0.04, 0.1),
    "z": (0.06, -0.3),
    "rz": (0.1, 0.4),
    "ry": (-0.2, 0.3),
    "rx": (0.15, 0.2),
}


def worst(found: Any, wanted: Any) -> float:
    """The largest difference in parts of the largest value."""
    scale = float(np.max(np.abs(wanted))) or 1.0
    return float(np.max(np.abs(np.asarray(found) - np.asarray(wanted)))) / scale


def by_pose() -> mk.Analysis:
    units = {name: "m/s" if name in "xyz" else "rad/s" for name in POSE}
    inputs = "".join(
        f"    pose.{name}: {{from: 0, to: {to}, count: 4, rate: {rate} {units[name]}}}\n"
        for name, (to, rate) in POSE_COURSES.items()
    )
    return mk.loads(platform(inputs, f"actuators: [{', '.join(LEGS)}]\n")).analyze()


QUANTITIES = [
    *(f"{leg[:2]}.effort" for leg in LEGS),
    *(f"{joint}{k}.{word}" for k in range(1, 7) for joint in "AB" for word in ("force",)),
    *(f"L{k}.total_force" for k in range(1, 7)),
    "ground.shaking_force",
    "ground.shaking_moment",
    *(f"pose.{name}{order}" for name in POSE for order in ("", "_dot", "_ddot")),
]


def test_a_platform_in_both_directions() -> None:
    """The legs as inputs, at the values, rates and accelerations that the pose gave."""
    names = [*LEGS, *(f"{leg}_dot" for leg in LEGS), *(f"{leg}_ddot" for leg in LEGS)]
    inverse = by_pose()
    given = {name: inverse[name] for name in [*names, *QUANTITIES]}
    for row in range(4):
        inputs = (
            "".join(
                f"    {leg}: {{at: {given[leg][row]!r}, rate: {given[leg + '_dot'][row]!r}, "
                f"acceleration: {given[leg + '_ddot'][row]!r}}}\n"
                for leg in LEGS
            )
            .replace("np.float64(", "")
            .replace(")", "")
        )
        near = ", ".join(f"pose.{name}: {given['pose.' + name][row]}" for name in POSE)
        text = platform(inputs) + f"assembly: {{near: {{{near}}}}}\n"
        forward = mk.loads(text).analyze(QUANTITIES)
        for name in QUANTITIES:
            assert worst(forward[name][0], given[name][row]) <= NEAR, name


def test_a_pose_holds_nothing() -> None:
    analysis = by_pose()
    for word in ("force", "moment", "moment_about_origin", "total_force", "total_moment"):
        assert not analysis[f"pose.{word}"].any()
    assert (analysis["row.power_error"] <= 1e-12).all()


def test_without_actuators_the_pose_is_driven() -> None:
    """The efforts are the total wrench on the coordinates; legs pull nothing."""
    inputs = "".join(f"    pose.{name}: {{at: 0}}\n" for name in POSE)
    analysis = mk.loads(platform(inputs)).analyze()
    assert analysis["pose.z.effort"][0] == pytest.approx(60 * 9.81, rel=1e-13)
    assert analysis["pose.total_force"][0] == pytest.approx([0, 0, 60 * 9.81], abs=1e-10)
    assert analysis["L1.total_force"][0] == pytest.approx([0, 0, 0], abs=1e-10)


def test_an_arm_along_a_path() -> None:
    """The tip's coordinates as inputs against angles and torques by elementary mechanics."""
    text = ARM + (
        "motion: {inputs: {tip.position.x: {values: [1.4, 1.3, 1.2], rate: 0.3 m/s},"
        " tip.position.y: {values: [0.4, 0.5, 0.55], rate: 0.2 m/s, acceleration: 1 m/s^2}}}\n"
        "actuators: [A.theta, B.theta]\n"
    )
    analysis = mk.loads(text).analyze()
    x, y = analysis["tip.position.x"], analysis["tip.position.y"]
    assert x.tolist() == [1.4, 1.3, 1.2]
    cosine = (x * x + y * y - 1 - 0.64) / 1.6
    bend = np.arccos(cosine)
    reach = np.arctan2(y, x) - np.arctan2(0.8 * np.sin(bend), 1 + 0.8 * np.cos(bend))
    assert worst(analysis["B.theta"], bend) <= NEAR
    assert worst(analysis["A.theta"], reach) <= NEAR
    assert np.abs(analysis["tip.velocity"] - [0.3, 0.2, 0]).max() <= NEAR
    assert np.abs(analysis["tip.acceleration"] - [0, 1, 0]).max() <= NEAR
    for row in range(3):
        inputs = ", ".join(
            f"{joint}.theta: {{at: {float(analysis[f'{joint}.theta'][row])!r}, "
            f"rate: {float(analysis[f'{joint}.theta_dot'][row])!r}, "
            f"acceleration: {float(analysis[f'{joint}.theta_ddot'][row])!r}}}"
            for joint in "AB"
        )
        direct = mk.loads(f"{ARM}motion: {{inputs: {{{inputs}}}}}\n").analyze()
        for name in ("A.effort", "B.effort", "A.force", "B.force", "A.moment", "A.total_moment"):
            assert worst(analysis[name][row], direct[name][0]) <= NEAR, name


def test_a_driven_point_carries_a_force() -> None:
    """Without actuators the input's effort is the force on the point, along its axis."""
    still = ARM + "motion: {inputs: {tip.position.x: {at: 1.4}, tip.position.y: {at: 0.4}}}\n"
    text = still.replace("{type: gravity, g: [0, -9.81, 0]}", "{type: gravity, g: [0, 0, 0]}")
    analysis = mk.loads(text).analyze()
    assert analysis["tip.position.x.effort"][0] == pytest.approx(-3, abs=1e-12)
    assert analysis["tip.position.y.effort"][0] == pytest.approx(20, abs=1e-12)


@pytest.mark.parametrize(("point", "axis"), [("wrist", "x"), ("pin", "y"), ("pin", "x")])
def test_one_coordinate_of_a_point_is_an_input(point: str, axis: str) -> None:
    """The same motion as by the crank: rates, efforts at the crank, and reactions."""
    crank = "motion: {inputs: {A.theta: {from: 20, to: 70, count: 6, rate: 3 rad/s}}}\n"
    by_crank = mk.loads(SLIDER_CRANK + crank).analyze()
    names = [f"{point}.{word}" for word in ("position", "velocity", "acceleration")]
    place, speed, rate = (by_crank[name][:, "xyz".index(axis)] for name in names)
    wanted = ("A.theta", "A.theta_dot", "A.theta_ddot", "D.s", "A.effort", "ground.shaking_force")
    for row in range(6):
        name = f"{point}.position.{axis}"
        text = SLIDER_CRANK + (
            f"motion: {{inputs: {{{name}: {{at: {float(place[row])!r}, "
            f"rate: {float(speed[row])!r} m/s, acceleration: {float(rate[row])!r} m/s^2}}}}}}\n"
            f"assembly: {{near: {{A.theta: {20 + 10 * row}}}}}\nactuators: [A.theta]\n"
        )
        found = mk.loads(text).analyze()
        for each in wanted:
            assert worst(found[each][0], by_crank[each][row]) <= NEAR, each


def test_a_driven_point_has_dead_centres_modes_and_ranges() -> None:
    """The slider runs from 0.25 to 0.45 m."""
    text = SLIDER_CRANK + (
        "motion: {inputs: {wrist.position.x: {from: 0.4, to: 0.5, count: 11}}}\n"
        "assembly: {near: {A.theta: 40}}\n"
    )
    model = mk.loads(text)
    analysis = model.analyze()
    ok = [status == "ok" for status in analysis["row.status"]]
    assert ok == [True] * 5 + [False] * 6
    assert "beyond-dead-centre" in analysis["row.status"][6]
    assert len(model.modes().modes) == 2
    ranges = model.ranges().ranges
    ends = sorted((float(one.lower.value), float(one.upper.value)) for one in ranges)
    assert ends[0] == pytest.approx((0.25, 0.45), abs=1e-9)


def test_inputs_follow_points() -> None:
    text = ARM + (
        "motion: {inputs: {tip.position.x: {values: [1.4, 1.3], rate: 1 m/s},"
        " tip.position.y: {with: 2*tip.position.x - 2.4 m}}}\n"
    )
    analysis = mk.loads(text).analyze()
    assert analysis["tip.position"][:, 1] == pytest.approx([0.4, 0.2], abs=1e-12)
    assert analysis["tip.velocity"][:, 1] == pytest.approx([2, 2], abs=1e-11)


def test_a_five_bar_with_motors_elsewhere() -> None:
    """Virtual work: the efforts at A and E are the transposed rates times those at B and D."""
    plain = mk.loads(FIVE_BAR).analyze()
    moved = mk.loads(FIVE_BAR + "actuators: [B.theta, D.theta]\n").analyze()
    rates = []
    for name in ("A.theta", "E.theta"):
        other = {"A.theta": "E.theta", "E.theta": "A.theta"}[name]
        text = FIVE_BAR.replace("rate: 2 rad/s", "rate: 0 rad/s").replace(
            "rate: -1 rad/s", "rate: 0 rad/s"
        )
        start = text.index(f"    {name}:")
        line = text[start:].split("\n", 1)[0]
        unit = mk.loads(text.replace(line, line.replace("rate: 0 rad/s", "rate: 1 rad/s")))
        found = unit.analyze(["B.theta_dot", "D.theta_dot", f"{other}_dot"])
        rates.append([found["B.theta_dot"], found["D.theta_dot"]])
    at_b, at_d = moved["B.effort"], moved["D.effort"]
    for (rate_b, rate_d), joint in zip(rates, "AE", strict=True):
        assert worst(rate_b * at_b + rate_d * at_d, plain[f"{joint}.effort"]) <= NEAR
    assert not moved["A.moment"][:, 2].any()
    assert worst(moved["ground.shaking_force"], plain["ground.shaking_force"]) <= NEAR
    assert (moved["row.power_error"] <= 1e-12).all()


def test_other_names_and_order_have_the_same_efforts() -> None:
    one = mk.loads(FIVE_BAR + "actuators: [B.theta, D.theta]\n").analyze()
    renamed = FIVE_BAR.replace("  B:", "  Knee:").replace("  A:", "  Zeta:")
    renamed = renamed.replace("A.theta", "Zeta.theta") + "actuators: [D.theta, Knee.theta]\n"
    other = mk.loads(renamed).analyze()
    assert worst(other["Knee.effort"], one["B.effort"]) <= 1e-12
    assert worst(other["D.effort"], one["D.effort"]) <= 1e-12


def test_more_actuators_have_the_least_norm() -> None:
    """Against the least norm by normal equations of 40 digits, moments taken by the size."""
    plain = mk.loads(FIVE_BAR).analyze()
    joints = ("A", "B", "D", "E")
    shared = mk.loads(FIVE_BAR + "actuators: [A.theta, B.theta, D.theta, E.theta]\n")
    analysis = shared.analyze()
    assert [d.code for d in shared.diagnostics] == ["shared-effort"]
    rates = {}
    for joint in "AE":
        text = FIVE_BAR.replace("rate: 2 rad/s", "rate: 0 rad/s")
        text = text.replace("rate: -1 rad/s", "rate: 0 rad/s")
        line = text[text.index(f"    {joint}.theta:") :].split("\n", 1)[0]
        unit = mk.loads(text.replace(line, line.replace("rate: 0 rad/s", "rate: 1 rad/s")))
        rates[joint] = unit.analyze([f"{j}.theta_dot" for j in joints])
    for row in range(5):
        jacobian = mp.matrix(
            [[mp.mpf(float(rates[i][f"{j}.theta_dot"][row])) for i in "AE"] for j in joints]
        )
        efforts = mp.matrix([mp.mpf(float(plain[f"{i}.effort"][row])) for i in "AE"])
        least = jacobian * mp.lu_solve(jacobian.T * jacobian, efforts)
        found = [analysis[f"{j}.effort"][row] for j in joints]
        assert worst(found, [float(x) for x in least]) <= NEAR
    assert worst(analysis["ground.shaking_force"], plain["ground.shaking_force"]) <= NEAR


def test_forces_are_weighed_by_the_size_beside_moments() -> None:
    """A rack: a slide and a wheel on one freedom share in the ratio that the size says."""
    text = """
format: 1
units: {length: LENGTH, angle: rad, mass: kg, force: N}
links:
  one: {}
joints:
  A: {type: H, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1], lead: 0.5 m}
points: {p: {link: one, at: [0, 0, 1 m]}}
loads:
  - {type: force, link: one, point: [0, 0, 0], force: [0, 0, -10]}
motion: {inputs: {A.theta: {at: 0}}}
actuators: [A.theta, A.s]
"""
    found = {}
    for unit, per in (("m", 1.0), ("mm", 1000.0)):
        analysis = mk.loads(text.replace("LENGTH", unit)).analyze()
        size = analysis.result.session.plan.size
        pitch = 0.5 / (2 * np.pi)
        moment = 10 * pitch / (1 + (pitch / size) ** 2)
        force = moment * pitch / size**2
        assert analysis["A.theta.effort"][0] == pytest.approx(moment * per, rel=1e-12)
        assert analysis["A.s.effort"][0] == pytest.approx(force, rel=1e-12)
        found[unit] = analysis["A.s.effort"][0]
    assert found["m"] == pytest.approx(found["mm"], rel=1e-13)


def test_a_singular_set_is_named_with_its_rows() -> None:
    """A slide cannot turn its crank at the dead centres; the other rows keep their cells."""
    text = SLIDER_CRANK + (
        "motion: {inputs: {A.theta: {from: 0, to: 360, step: 45, rate: 1 rad/s}}}\n"
        "actuators: [D.s]\n"
    )
    analysis = mk.loads(text).analyze(["D.effort", "A.force", "D.s", "ground.shaking_force"])
    empty = np.isnan(analysis["D.effort"])
    assert np.flatnonzero(empty).tolist() == [0, 4, 8]
    assert np.isnan(analysis["A.force"][:, 0]).tolist() == empty.tolist()
    assert not np.isnan(analysis["D.s"]).any()
    assert not np.isnan(analysis["ground.shaking_force"]).any()
    (said,) = [d for d in analysis.diagnostics if d.code == "singular-actuators"]
    assert "D.s" in said.message
    assert "rows 1, 5 and 9" in said.message
    assert not analysis.result.complete


def test_a_locked_pose_is_told_from_its_actuators() -> None:
    """With ry at a quarter turn, rz and rx turn about one axis: the set seems singular."""
    inputs = "".join(
        f"    pose.{name}: {{at: {1.5707963267948966 if name == 'ry' else 0}}}\n" for name in POSE
    )
    actuators = f"actuators: [{', '.join(LEGS)}]\n"
    analysis = mk.loads(platform(inputs, actuators)).analyze(["L1.effort"])
    (said,) = [d for d in analysis.diagnostics if d.code == "singular-actuators"]
    assert "pose.ry" in said.message


def test_rows_lost_by_the_turns_of_a_pose_are_said_to_be() -> None:
    """An arm that turns about y takes the pose through its quarter turn."""
    text = ARM.replace("axis: [0, 0, 1]", "axis: [0, 1, 0]").replace(
        "points:", "  T: {type: F, links: [ground, two], point: [2, 0, 0]}\npoints:"
    )
    swept = "A.theta: {from: 0, to: 3, count: 4}, B.theta: {at: 0}"
    analysis = mk.loads(f"{text.split('assembly')[0]}motion: {{inputs: {{{swept}}}}}\n").analyze()
    said = [d for d in analysis.diagnostics if d.code == "locked-pose"]
    assert ["T.ry" in d.message for d in said] == [True]


def test_a_tied_motor_carries_what_the_tie_transmits() -> None:
    own = mk.loads(GEARED.replace("DRIVE", "own")).analyze()
    tied = mk.loads(GEARED.replace("DRIVE", "tie")).analyze()
    ratio = 2 + 0.1 * np.cos(own["A.theta"])
    assert worst(tied["A.effort"], own["A.effort"] + ratio * own["B.effort"]) <= 1e-13
    assert worst(tied["B.effort"], own["B.effort"]) <= 1e-13
    for name in ("A.force", "B.total_moment"):
        # teeth would push the bearings, a belt would pull them
        with pytest.raises(mk.MechkinError, match="what transmits that is not said"):
            tied[name]


def test_a_tie_with_an_actuator_elsewhere() -> None:
    """One freedom: an actuator at the tied arm alone carries everything through the tie."""
    tied = mk.loads(GEARED.replace("DRIVE", "tie")).analyze()
    moved = mk.loads(GEARED.replace("DRIVE", "tie") + "actuators: [B.theta]\n").analyze()
    ratio = 2 + 0.1 * np.cos(tied["A.theta"])
    assert worst(moved["B.effort"] * ratio, tied["A.effort"]) <= 1e-12
    assert (moved["row.power_error"] <= 1e-12).all()


def test_whose_motor_is_said() -> None:
    silent = mk.loads(GEARED.replace(", drive: DRIVE", ""))
    assert [d.code for d in silent.diagnostics] == ["own-motor"]
    for word in ("own", "tie"):
        assert mk.loads(GEARED.replace("DRIVE", word)).diagnostics == ()


def test_variants_keep_their_actuators() -> None:
    text = FIVE_BAR.replace("links:", "parameters: {m: 2 kg}\nlinks:", 1)
    text = text.replace("two: {mass: 2", "two: {mass: m") + "actuators: [B.theta, D.theta]\n"
    model = mk.loads(text)
    varied = model.vary({"m": [2, 3]}, ["B.effort"])
    alone = model.with_parameters({"m": 3}).analyze(["B.effort"])
    assert varied["B.effort"][1].tolist() == alone["B.effort"].tolist()
    place = model.solve({"A.theta": -10, "E.theta": 15}, ["B.effort"])
    assert place["B.effort"] == pytest.approx(model.analyze(["B.effort"])["B.effort"][0], rel=1e-12)


def test_lanes_do_not_matter() -> None:
    text = FIVE_BAR + "actuators: [A.theta, B.theta, D.theta, E.theta]\n"
    model = mk.loads(text)
    wide = [
        model.analyze(["B.effort", "C.force"], lanes=lanes)
        for lanes in (2, 4, 8)
        if lanes <= _kernel.widest
    ]
    for other in wide[1:]:
        assert other["B.effort"].tolist() == wide[0]["B.effort"].tolist()
        assert other["C.force"].tolist() == wide[0]["C.force"].tolist()
