"""Belts and chains: the turn of pulleys, the tensions of both strands and what bearings take of
them, against the geometry of common tangents and statics by hand (Shigley, Mechanical Engineering
Design, flexible mechanical elements)."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.kernel.functions import widths

DRIVE = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0]}
  B: {type: R, links: [ground, w2], point: [160, 120]}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
loads: [{type: torque, joint: B, value: LOAD N*m}]
couplings: {K: {type: belt, joints: [A, B], radii: [30, 50]MORE}}
"""


def drive(load: float, more: str) -> str:
    return DRIVE.replace("LOAD", str(load)).replace("MORE", more)


def tangents(
    radii: tuple[float, float], centre: complex, crossed: bool
) -> list[tuple[complex, complex]]:
    """Where strands touch the two pulleys, the first of which is about 0: on the left of the line
    of centres, then on its right."""
    found = []
    for side in (1.0, -1.0):
        # the normal of a common tangent: its part along the line of centres is the difference of
        # the distances of both centres from the tangent
        far = -radii[1] if crossed else radii[1]
        angle = np.arccos((radii[0] - far) / abs(centre))
        normal = centre / abs(centre) * np.exp(1j * side * angle)
        found.append((radii[0] * normal, centre + far * normal))
    return found


@pytest.mark.parametrize("load", [-4.0, 4.0])
@pytest.mark.parametrize("pretension", [None, 100.0])
@pytest.mark.parametrize("crossed", [False, True])
def test_both_strands_pull_at_both_bearings(
    load: float, pretension: float | None, crossed: bool
) -> None:
    more = "" if pretension is None else f", pretension: {pretension} N"
    more += ", crossed: true" if crossed else ""
    result = mk.loads(drive(load, more)).analyze()
    assert set(result["row.status"]) == {"ok"}
    sense = -1.0 if crossed else 1.0
    np.testing.assert_allclose(result["B.theta"], sense * 0.6 * np.array([0.0, 45.0, 90.0]))
    np.testing.assert_allclose(result["A.effort"], -sense * load * 600.0, rtol=1e-12)
    differ = abs(load) / 0.05
    tight, slack = (differ, 0.0) if pretension is None else (100.0 + differ / 2, 100.0 - differ / 2)
    np.testing.assert_allclose(result["K.tight"], tight, rtol=1e-12)
    np.testing.assert_allclose(result["K.slack"], slack, rtol=1e-12, atol=1e-12)
    # the strand that turns the second pulley against its load is the tight one
    centre = 160.0 + 120.0j
    pulls = []
    for one, other in tangents((30.0, 50.0), centre, crossed):
        toward = (one - other) / abs(one - other)
        turns = ((other - centre).conjugate() * toward).imag
        pulls.append((tight if turns * load < 0.0 else slack) * toward)
    total = sum(pulls)
    for row in range(3):
        force = np.array([total.real, total.imag])
        np.testing.assert_allclose(result["B.force"][row], -force, rtol=1e-11, atol=1e-9)
        np.testing.assert_allclose(result["A.force"][row], force, rtol=1e-11, atol=1e-9)


def test_a_strand_that_would_push_is_named() -> None:
    """10 N m by the radius of 50 mm are twice the pretension of 100 N."""
    text = drive(-10.0, ", pretension: T").replace(
        "links: {w1", "parameters: {T: 100 N}\nlinks: {w1"
    )
    model = mk.loads(text)
    assert set(model.analyze()["row.status"]) == {"ok"}  # nothing asks for forces
    exact = model.analyze(["K.slack", "row.status"])
    np.testing.assert_allclose(exact["K.slack"], 0.0, atol=1e-12)
    assert set(exact["row.status"]) == {"ok"}
    less = model.with_parameters({"T": "99 N"}).analyze(["K.slack", "K.tight", "row.status"])
    assert set(less["row.status"]) == {"slack"}
    np.testing.assert_allclose(less["K.slack"], -1.0, rtol=1e-11)
    np.testing.assert_allclose(less["K.tight"], 199.0, rtol=1e-12)
    (said,) = (d for d in less.diagnostics if d.code == "slack")
    assert "a strand of K goes slack in all rows" in said.message
    varied = model.vary({"T": ["99 N", "101 N"]}, ["A.effort"])
    assert varied.status.tolist() == [["slack"] * 3, ["ok"] * 3]


CHAIN = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0, 0], axis: [0, 1, 0]}
  B: {type: R, links: [w2, ground], point: [300, 40, 0], axis: [0, 1, 0]}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
loads: [{type: torque, joint: B, value: 9 N*m}]
couplings: {K: {type: chain, joints: [A, B], teeth: [17, 38], pitch: 12.7 mm}}
"""


def test_a_chain_pulls_by_its_power_over_its_speed() -> None:
    """F = P/v with v = z p n; the tight strand lies in the plane of the first wheel's point."""
    result = mk.loads(CHAIN).analyze()
    # B counts the turn of the ground against its wheel
    np.testing.assert_allclose(result["B.theta"], -17.0 / 38.0 * np.array([0.0, 45.0, 90.0]))
    radii = 17 * 12.7 / (2 * np.pi), 38 * 12.7 / (2 * np.pi)
    force = 9000.0 / radii[1]
    speed = 17 * 12.7 * 10.0 / (2 * np.pi)
    np.testing.assert_allclose(result["K.tight"], force, rtol=1e-12)
    np.testing.assert_allclose(np.abs(result["A.effort"]) * 10.0, force * speed, rtol=1e-12)
    sine = (radii[0] - radii[1]) / 300.0
    away = force * np.sqrt(1.0 - sine * sine)
    on_wheel = result["B.force"][0]  # what pulls at the wheel is what it hands on to the ground
    np.testing.assert_allclose(
        np.abs(on_wheel), [away, 0.0, force * abs(sine)], rtol=1e-12, atol=1e-9
    )
    assert on_wheel[0] < 0.0
    # 40 mm beside the point of its joint
    tilt = np.cross([0.0, -40.0, 0.0], on_wheel)
    found = result["B.moment"][0]
    np.testing.assert_allclose(found[[0, 2]], tilt[[0, 2]], rtol=1e-12, atol=1e-8)


ARM = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  arm: {mass: 2, center_of_mass: [0.3, 0], inertia: 0.2}
  hand: {mass: 3, center_of_mass: [0.6, 0.1], inertia: 0.5}
joints:
  A: {type: R, links: [ground, arm], point: [0, 0]}
  B: {type: R, links: [arm, hand], point: [0.6, 0]}
motion: {inputs: {A.theta: {from: 0, to: 2, count: 5, rate: 3 rad/s, acceleration: 7 rad/s^2}}}
couplings: {K: {type: belt, joints: [A, B], radii: [0.05, 0.08], pretension: 900 N}}
"""


def test_a_pulley_held_by_ground_turns_the_hand_on_a_moving_arm() -> None:
    """The hand turns by 1 - 5/8 of the arm; Newton and Euler of both links."""
    result = mk.loads(ARM).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(0.0, 2.0, 5)
    np.testing.assert_allclose(result["B.theta"], -0.625 * turn, rtol=1e-14, atol=1e-15)
    part = 0.375
    for row, angle in enumerate(turn):
        arm, hand = np.exp(1j * angle), np.exp(1j * part * angle)
        at_arm = 0.3 * (7j - 9.0) * arm
        at_pin = 0.6 * (7j - 9.0) * arm
        at_hand = at_pin + 0.1j * hand * (7j * part - 9.0 * part * part)
        lever = 0.1j * hand
        # what turns the hand about its pin is the belt's moment on it
        moment = 0.5 * 7.0 * part + (lever.conjugate() * 3.0 * at_hand).imag
        tight, slack = (900.0 + s * abs(moment) / 0.16 for s in (1.0, -1.0))
        np.testing.assert_allclose(result["K.tight"][row], tight, rtol=1e-12)
        np.testing.assert_allclose(result["K.slack"][row], slack, rtol=1e-12)
        sine = (0.05 - 0.08) / 0.6
        cosine = np.sqrt(1.0 - sine * sine)
        # strands on the hand, in the arm's axes: the one at the left turns it in its sense
        left, right = (tight, slack) if moment > 0.0 else (slack, tight)
        pull = -(left * (cosine - 1j * sine) + right * (cosine + 1j * sine)) * arm
        pin = 3.0 * at_hand - pull
        np.testing.assert_allclose(result["B.force"][row], [pin.real, pin.imag], rtol=1e-11)
        # the belt's other end pulls at the ground
        bearing = 2.0 * at_arm + pin
        np.testing.assert_allclose(result["A.force"][row], [bearing.real, bearing.imag], rtol=1e-11)
        # by virtual power with the turn of the arm
        moves = 0.6j * arm + 1j * part * lever
        effort = (0.2 + 2.0 * 0.09) * 7.0 + 0.5 * 7.0 * part**2
        effort += 3.0 * (moves.conjugate() * at_hand).real
        np.testing.assert_allclose(result["A.effort"][row], effort, rtol=1e-12)
    assert np.nanmax(result["row.power_error"]) < 1e-13


def test_shafts_joined_by_a_belt_spin_up() -> None:
    """Inertias 2 and 3, radii 1 to 2, 7 N m: 7/(2 + 3/4) rad/s^2."""
    text = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  a: {mass: 1, inertia: 2, center_of_mass: [0, 0]}
  b: {mass: 1, inertia: 3, center_of_mass: [1, 0]}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [1, 0]}
loads: [{type: torque, joint: A, value: 7}]
couplings: {K: {type: belt, joints: [A, B], radii: [0.1, 0.2], crossed: true}}
responses: {spin: {start: {A.theta: 0}, time: {from: 0, to: 2, count: 5}}}
"""
    result = mk.loads(text).respond("spin")
    times = np.linspace(0.0, 2.0, 5)
    alpha = 7.0 / 2.75
    np.testing.assert_allclose(result["A.theta"], 0.5 * alpha * times**2, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(result["B.theta"], -0.25 * alpha * times**2, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(result["K.tight"], 3.0 * alpha / 2.0 / 0.2, rtol=1e-9)


def test_pretension_rubs_in_bearings() -> None:
    """Equal radii: both strands are parallel, and each bearing carries twice the pretension."""
    text = drive(0.0, ", pretension: 100 N").replace("[30, 50]", "[40, 40]")
    text = text.replace(
        "loads: [",
        "loads: [{type: friction, joint: A, coefficient: 0.1, radius: 8}, "
        "{type: friction, joint: B, coefficient: 0.1, radius: 8}, ",
    )
    result = mk.loads(text).analyze()
    np.testing.assert_allclose(result["A.normal_load"], 200.0, rtol=1e-12)
    np.testing.assert_allclose(result["A.effort"], 2 * 0.1 * 8.0 * 200.0, rtol=1e-12)


@pytest.mark.parametrize("load", [-4.0, 4.0])
def test_a_tight_strand_rubs_in_bearings(load: float) -> None:
    """Without pretension the slack one carries nothing: each bearing carries the tight one, whose
    moment at the second pulley holds the load and the friction, 0.1 (8 mm) of it, which brakes."""
    text = drive(load, "").replace("[30, 50]", "[40, 40]")
    text = text.replace(
        "loads: [",
        "loads: [{type: friction, joint: A, coefficient: 0.1, radius: 8}, "
        "{type: friction, joint: B, coefficient: 0.1, radius: 8}, ",
    )
    result = mk.loads(text).analyze()
    # a load that turns on with the belt is braked by its bearing
    tight = 4000.0 / (40.0 + np.sign(load) * 0.8)
    np.testing.assert_allclose(result["K.tight"], tight, rtol=1e-12)
    np.testing.assert_allclose(result["K.slack"], 0.0, atol=1e-12 * tight)
    np.testing.assert_allclose(result["B.normal_load"], tight, rtol=1e-12)
    effort = -np.sign(load) * tight * (40.0 - np.sign(load) * 0.8)
    np.testing.assert_allclose(result["A.effort"], effort, rtol=1e-12)
    assert set(result["row.status"]) == {"ok"}


WRONG = {
    "overlap": ("[30, 50]", "[30, 170]", "lie on one another"),
    "radius": ("[30, 50]", "[30, 0]", "the radii of a pulley are 0"),
    "pretension": ("radii: [30, 50]", "radii: [30, 50], pretension: 0 N", "the pretension is 0"),
    "dimension": ("radii: [30, 50]", "radii: [30, 50], pretension: 3 mm", "expected a force"),
    "teeth": ("radii: [30, 50]", "teeth: [30, 50]", "radii"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_belts_that_cannot_run_are_refused(before: str, after: str, words: str) -> None:
    text = drive(-4.0, "")
    assert before in text
    with pytest.raises(InvalidFile) as told:
        mk.loads(text.replace(before, after))
    assert any(words in str(d) for d in told.value.diagnostics)
    assert all(d.place is not None for d in told.value.diagnostics if d.severity == "error")


def test_oblique_axes_are_refused_where_they_are_drawn() -> None:
    other = CHAIN.replace(
        "point: [300, 40, 0], axis: [0, 1, 0]", "point: [300, 40, 0], axis: [0, 1, 1]"
    )
    with pytest.raises(InvalidFile, match="not parallel as drawn"):
        mk.loads(other)


SCREW = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {screw: {}, slide: {}}
joints:
  A: {type: R, links: [ground, screw], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, slide], point: [50, 0, 0], axis: [0, 0, SENSE]}
motion: {inputs: {A.theta: {from: 0, to: 720, count: 3, rate: 10 rad/s}}}
loads: [{type: force, joint: S, value: 80}]
couplings: {K: {type: screw, joints: [A, S], lead: LEAD mm}}
"""


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("lead", [5.0, -5.0])
def test_a_screw_moves_its_nut_and_bears_its_thrust(sense: int, lead: float) -> None:
    """A right-hand screw that turns about z draws its nut towards -z, as H between the two says."""
    text = SCREW.replace("SENSE", str(sense)).replace("LEAD", str(lead))
    result = mk.loads(text).analyze()
    np.testing.assert_allclose(result["S.s"], -sense * lead * np.array([0.0, 1.0, 2.0]), atol=1e-13)
    np.testing.assert_allclose(result["A.effort"], 80.0 * sense * lead / (2 * np.pi), rtol=1e-12)
    np.testing.assert_allclose(result["K.power"], -result["A.effort"] * 10.0, rtol=1e-12)
    # the load pushes the slide along sense z; the screw holds it at its own axis, 50 mm beside
    for row in range(3):
        np.testing.assert_allclose(result["A.force"][row], [0.0, 0.0, -80.0 * sense], atol=1e-10)
        np.testing.assert_allclose(result["S.force"][row], 0.0, atol=1e-10)
        np.testing.assert_allclose(
            result["S.moment"][row],
            [0.0, 50.0 * 80.0 * sense, -result["A.effort"][row]],
            rtol=1e-12,
            atol=1e-9,
        )


def test_slopes_by_the_lead_of_a_screw() -> None:
    """s = -h theta/(2 pi), and the torque is that of the load at its nut."""
    text = SCREW.replace("SENSE", "1").replace("LEAD mm", "h") + "parameters: {h: 5 mm}\n"
    slopes = mk.loads(text).sensitivities(["S.s", "A.effort"], ["h"])
    np.testing.assert_allclose(slopes["S.s", "h"], [0.0, -1.0, -2.0], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(slopes["A.effort", "h"], 80.0 / (2 * np.pi), rtol=1e-9)


def test_a_screw_agrees_with_a_helical_pair() -> None:
    """The same nut on H, which its guide keeps from turning: motion and torque."""
    text = SCREW.replace("SENSE", "1").replace("LEAD", "5")
    pair = text.replace("couplings: {K: {type: screw, joints: [A, S], lead: 5 mm}}", "")
    pair = pair.replace(
        "motion:",
        "  H: {type: H, links: [screw, slide], point: [0, 0, 0], axis: [0, 0, 1], lead: 5 mm}\n"
        "motion:",
    )
    own, other = mk.loads(text).analyze(), mk.loads(pair).analyze()
    for name in ("S.s", "S.s_dot", "A.effort"):
        np.testing.assert_allclose(own[name], other[name], rtol=1e-12, atol=1e-12)


WRONG_SCREW = {
    "oblique": ("axis: [0, 0, SENSE]", "axis: [0, 1, 1]", "does not slide along the axis"),
    "lead": ("LEAD mm", "0 mm", "a thread has a lead"),
    "joints": ("joints: [A, S]", "joints: [S, A]", "a screw is between the R or C joint"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG_SCREW.values(), ids=WRONG_SCREW.keys())
def test_screws_that_cannot_be_are_refused(before: str, after: str, words: str) -> None:
    text = SCREW.replace(before, after).replace("SENSE", "1").replace("LEAD", "5")
    with pytest.raises(InvalidFile) as told:
        mk.loads(text)
    assert any(words in str(d) for d in told.value.diagnostics)


def test_the_same_bits_on_all_lanes_and_threads() -> None:
    for text in (
        drive(-4.0, ", pretension: 100 N"),
        drive(-4.0, ""),
        SCREW.replace("SENSE", "1").replace("LEAD", "5"),
    ):
        model = mk.loads(text)
        rows = [model.analyze(lanes=n, threads=t)["A.force"] for n in widths() for t in (1, 2)]
        assert len({row.tobytes() for row in rows}) == 1
    assert set(mk.loads(ARM).certify().status) == {"proven"}
