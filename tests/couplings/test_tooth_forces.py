"""Forces between teeth at the pitch point, and what bearings take of them, against statics by
hand (Shigley, Mechanical Engineering Design, force analysis of spur and helical gears)."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile

HEAD = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
"""
SPUR = (
    HEAD
    + """
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0]}
  B: {type: R, links: [ground, w2], point: [60, 0]}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
"""
)
ANGLES = {"none": ("", 0.0), "20 deg": (", pressure_angle: 20", np.tan(np.radians(20.0)))}


@pytest.mark.parametrize(("words", "slope"), ANGLES.values(), ids=ANGLES.keys())
@pytest.mark.parametrize("load", [-4.0, 4.0])
def test_a_spur_pair_pushes_its_bearings(words: str, slope: float, load: float) -> None:
    """4 N m on a wheel of 40 mm radius are 100 N at its teeth; both flanks push apart."""
    text = f"{SPUR}loads: [{{type: torque, joint: B, value: {load} N*m}}]\n"
    text += f"couplings: {{G: {{type: gear, joints: [A, B], teeth: [20, 40]{words}}}}}"
    result = mk.loads(text).analyze()
    # at the arm (-40 mm, 0) from the wheel's axis: -0.04 m F + load = 0
    tangential = load / 0.04
    for row in range(3):
        force = result["G.tooth_force"][row]
        np.testing.assert_allclose(
            force, [slope * abs(tangential), tangential], rtol=1e-12, atol=1e-10
        )
        # what ground exerts on the wheel holds that, and on the pinion its opposite
        np.testing.assert_allclose(result["B.force"][row], -force, rtol=1e-12, atol=1e-10)
        np.testing.assert_allclose(result["A.force"][row], force, rtol=1e-12, atol=1e-10)
    np.testing.assert_allclose(result["A.effort"], load * 500.0, rtol=1e-12)


def test_a_pinion_in_a_ring() -> None:
    """Ring 60, pinion 20 teeth, axes 20 mm apart: radii 30 and 10 mm; both are pushed apart."""
    text = (
        HEAD
        + """
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0]}
  B: {type: R, links: [ground, w2], point: [0, 20]}
motion: {inputs: {A.theta: {at: 0}}}
loads: [{type: torque, joint: B, value: -6 N*m}]
couplings: {G: {type: gear, joints: [A, B], teeth: [60, 20], internal: true, pressure_angle: 25}}
"""
    )
    result = mk.loads(text).analyze()
    # the pitch point lies at (0, 30): the pinion, above the ring's axis, is driven along -x there
    tangential = -6.0 / 0.01
    radial = -abs(tangential) * np.tan(np.radians(25.0))
    np.testing.assert_allclose(result["G.tooth_force"][0], [tangential, radial], rtol=1e-12)
    np.testing.assert_allclose(result["A.effort"], 18000.0, rtol=1e-12)


HELICAL = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {w1: {}, w2: {}}
joints:
  A: {type: TYPE, links: [ground, w1], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [ground, w2], point: [60, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}MORE}}
loads: [{type: torque, joint: B, value: -4 N*m}]
couplings:
  G: {type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: 20, helix: 30}
"""


def test_helical_wheels_have_thrust() -> None:
    """Right hand on the first wheel: 100 N tangential, by tan 20/cos 30 apart, by tan 30 along."""
    result = mk.loads(HELICAL.replace("TYPE", "R").replace("MORE", "")).analyze()
    thrust, apart = 100.0 * np.tan(np.pi / 6), 100.0 * np.tan(np.pi / 9) / np.cos(np.pi / 6)
    # the pinion drives clockwise: its right-hand teeth push it towards +z, and the wheel to -z
    force = result["G.tooth_force"][1]
    np.testing.assert_allclose(np.abs(force), [apart, 100.0, thrust], rtol=1e-12)
    np.testing.assert_allclose(result["B.force"][1], -force, rtol=1e-12)
    # the thrust at the rim tilts the wheel, and the pinion half as much, about y
    for joint, radius in (("A", 20.0), ("B", 40.0)):
        moment = result[f"{joint}.moment"][1]
        np.testing.assert_allclose(
            np.abs(moment), [0.0, radius * thrust, 0.0], rtol=1e-12, atol=1e-9
        )


def test_a_helical_wheel_that_slides_turns_its_mate_and_takes_thrust_as_effort() -> None:
    """Its rim moves by tan 30 of the slide."""
    slid = HELICAL.replace("TYPE", "C").replace("MORE", ", A.s: {with: A.theta*0.1 mm/deg}")
    result = mk.loads(slid).analyze()
    turn, slide = np.array([0.0, 45.0, 90.0]), np.array([0.0, 4.5, 9.0])
    by_slide = np.degrees(np.tan(np.pi / 6) / 20.0) * slide
    np.testing.assert_allclose(result["B.theta"], -(turn - by_slide) / 2.0, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(np.abs(result["A.s.effort"]), 100.0 * np.tan(np.pi / 6), rtol=1e-12)
    power = result["A.theta.effort"] * result["A.theta_dot"]
    power = power + result["A.s.effort"] * result["A.s_dot"]
    # the load takes 4 N m by the wheel's rate
    np.testing.assert_allclose(power, 4000.0 * result["B.theta_dot"], rtol=1e-12)


def test_a_rack_pushes_its_guide() -> None:
    text = (
        HEAD
        + """
links: {p: {}, r: {}}
joints:
  P: {type: R, links: [ground, p], point: [0, 0]}
  S: {type: P, links: [ground, r], point: [0, -20], axis: [1, 0]}
motion: {inputs: {P.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
loads: [{type: force, joint: S, value: -50}]
couplings: {K: {type: rack, joints: [P, S], radius: 20 mm, pressure_angle: 20}}
"""
    )
    result = mk.loads(text).analyze()
    np.testing.assert_allclose(result["S.s"], 20.0 * np.radians([0.0, 45.0, 90.0]), rtol=1e-12)
    np.testing.assert_allclose(result["P.effort"], 1000.0, rtol=1e-12)
    apart = -50.0 * np.tan(np.pi / 9)
    for row in range(3):
        np.testing.assert_allclose(result["K.tooth_force"][row], [50.0, apart], rtol=1e-12)
        np.testing.assert_allclose(result["S.force"][row], [0.0, -apart], rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(result["P.force"][row], [50.0, apart], rtol=1e-12)


def test_the_teeth_of_a_planet_load_its_pin_twice() -> None:
    """Sun 18, planet 12, ring 42, radii 9, 6, 21: at rest the arm holds twice the teeth's force."""
    text = (
        HEAD
        + """
links: {sun: {}, arm: {}, planet: {}}
joints:
  S: {type: R, links: [ground, sun], point: [0, 0]}
  C: {type: R, links: [ground, arm], point: [0, 0]}
  P: {type: R, links: [arm, planet], point: [15, 0]}
motion: {inputs: {S.theta: {from: 0, to: 720, count: 7, rate: 1 rad/s}}}
loads: [{type: torque, joint: C, value: -3 N*m}]
couplings:
  K: {type: gear, joints: [S, P], teeth: [18, 12], pressure_angle: 20}
  R: {type: gear, joints: [C, P], teeth: [42, 12], internal: true, pressure_angle: 20}
"""
    )
    result = mk.loads(text).analyze()
    pin = 3.0 / 0.015
    np.testing.assert_allclose(result["S.effort"], 3000.0 * 0.3, rtol=1e-12)
    size = [np.hypot(*force) for force in result["P.force"]]
    np.testing.assert_allclose(size, pin, rtol=1e-12)
    for name in ("K.tooth_force", "R.tooth_force"):
        sizes = [np.hypot(*force) for force in result[name]]
        np.testing.assert_allclose(sizes, 0.5 * pin / np.cos(np.pi / 9), rtol=1e-12)


WRONG = {
    "radii": ("teeth: [20, 40]", "radii: [20, 45]", "do not mesh where they are drawn"),
    "module": ("teeth: [20, 40]", "teeth: [20, 40], module: 1", "do not mesh where they are drawn"),
    "pressure": (
        "teeth: [20, 40]",
        "teeth: [20, 40], pressure_angle: 95",
        "no teeth with a pressure",
    ),
    "ideal": ("teeth: [20, 40]", "teeth: [20, 40], pressure_angle: 20, ideal: true", "no teeth"),
    "coaxial": ("point: [60, 0]", "point: [0, 0]", "no pitch point"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_teeth_that_cannot_mesh_are_refused(before: str, after: str, words: str) -> None:
    text = SPUR + "couplings: {G: {type: gear, joints: [A, B], teeth: [20, 40]}}"
    right = text.replace("teeth: [20, 40]", "teeth: [20, 40], module: 2")
    assert mk.loads(right).analyze()["B.theta"][-1] == pytest.approx(-45.0)
    with pytest.raises(InvalidFile) as told:
        mk.loads(text.replace(before, after))
    assert any(words in str(d) for d in told.value.diagnostics)


def test_friction_beside_teeth_that_push_apart_is_refused() -> None:
    text = SPUR + "loads: [{type: friction, joint: A, coefficient: 0.1, radius: 5}]\n"
    words = "couplings: {G: {type: gear, joints: [A, B], teeth: [20, 40]%s}}"
    assert mk.loads(text + words % "").analyze()["B.theta"][-1] == pytest.approx(-45.0)
    with pytest.raises(InvalidFile, match="pushes wheels apart"):
        mk.loads(text + words % ", pressure_angle: 20")


RUBBING = (
    HEAD
    + """
links:
  w1: {mass: 1, center_of_mass: [0, 0], inertia: 100}
  w2: {mass: 2, center_of_mass: [60, 0], inertia: 300}
joints:
  A: {type: R, links: [ground, w1], point: [0, 0]}
  B: {type: R, links: [ground, w2], point: [60, 0]}
loads:
  - {type: torque, joint: B, value: 4 N*m}
  - {type: friction, joint: A, coefficient: 0.1, radius: 5}
  - {type: friction, joint: B, coefficient: 0.2, radius: 8}
couplings: {G: {type: gear, joints: [A, B], teeth: [20, 40]}}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
responses:
  r:
    start: {A.theta: 0, A.theta_dot: 10 rad/s}
    efforts: {A.theta: 3 N*m}
    time: {from: 0, to: 0.02, step: 0.01}
"""
)


def test_bearings_rub_by_the_force_of_teeth() -> None:
    """Moments about both axes, linear in the force F of the teeth and the acceleration."""
    model = mk.loads(RUBBING)
    result = model.analyze()
    force = 4000.0 / (40.0 - 0.2 * 8.0)
    np.testing.assert_allclose(result["norm(B.force)"], force, rtol=1e-12)
    np.testing.assert_allclose(result["A.effort"], force * (20.0 + 0.1 * 5.0), rtol=1e-12)
    matrix = [[100e-6, 0.02 + 0.1 * 0.005], [-0.5 * 300e-6, 0.04 - 0.2 * 0.008]]
    acceleration, force = np.linalg.solve(matrix, [3.0, 4.0])
    moved = model.respond("r")
    assert set(moved["row.status"]) == {"ok"}
    np.testing.assert_allclose(moved["norm(A.force)"], force, rtol=1e-10)
    time = moved["time"]
    turn = np.degrees(10.0 * time + acceleration * time * time / 2.0)
    np.testing.assert_allclose(moved["A.theta"], turn, rtol=1e-10, atol=1e-12)
