"""Machines with wheels against closed forms: curves of planets, a bevel differential with unequal
loads; every file with its mount moving and accelerated; and one pair of wheels written in many
ways."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

PLANET = """
format: 1
plane: xy
units: {{length: mm, angle: rad, mass: kg, force: N}}
links:
  arm: {{}}
  planet: {{mass: 2, center_of_mass: [{far}, 0], inertia: 300}}
joints:
  C: {{type: R, links: [ground, arm], point: [0, 0]}}
  P: {{type: R, links: [arm, planet], point: [{far}, 0]}}
points: {{tip: {{link: planet, at: [{tip}, 0]}}}}
couplings: {{K: {{type: gear, joints: [C, P], {wheels}}}}}
motion:
  inputs: {{C.theta: {{from: 0, to: 6, count: 13, rate: 3 rad/s, acceleration: 2 rad/s^2}}}}
"""


def test_a_planet_as_large_as_its_sun_draws_a_cardioid() -> None:
    """Radii 20: z = 2 a e^(it) - a e^(2it), from the cusp at (a, 0)."""
    text = PLANET.format(far=40, tip=20, wheels="teeth: [30, 30], pressure_angle: 0.35")
    result, turn = mk.loads(text).analyze(), np.linspace(0.0, 6.0, 13)
    place = 40.0 * np.exp(1j * turn) - 20.0 * np.exp(2j * turn)
    np.testing.assert_allclose(result["tip.position.x"], place.real, atol=1e-12)
    np.testing.assert_allclose(result["tip.position.y"], place.imag, atol=1e-12)
    np.testing.assert_allclose(result["planet.omega"], 6.0, rtol=1e-13)
    # Newton's law for the planet: M about its centre, by teeth at the sun's rim
    needed = 300e-6 * 4.0
    tangential = needed / 0.02
    sizes = [np.hypot(*force) for force in result["K.tooth_force"]]
    np.testing.assert_allclose(sizes, tangential / np.cos(0.35), rtol=1e-11)


def test_a_planet_of_half_its_ring_goes_straight() -> None:
    """Cardan's circles: the rim stays on a diameter of the ring, x = 2 r cos(t)."""
    text = PLANET.format(far=20, tip=40, wheels="teeth: [60, 30], internal: true")
    result, turn = mk.loads(text).analyze(), np.linspace(0.0, 6.0, 13)
    np.testing.assert_allclose(result["tip.position.x"], 40.0 * np.cos(turn), atol=1e-12)
    np.testing.assert_allclose(result["tip.position.y"], 0.0, atol=1e-12)
    np.testing.assert_allclose(result["planet.omega"], -3.0, rtol=1e-13)


DIFFERENTIAL = """
format: 1
units: {length: mm, angle: rad, mass: kg, force: N}
links:
  case: {mass: 4, center_of_mass: [0, 0, 0], inertia: {xx: 900, yy: 900, zz: 900}}
  left: {mass: 1, center_of_mass: [-40, 0, 0], inertia: {xx: 50, yy: 40, zz: 40}}
  right: {mass: 1, center_of_mass: [40, 0, 0], inertia: {xx: 50, yy: 40, zz: 40}}
  pinion: {mass: 0.5, center_of_mass: [0, 30, 0], inertia: {xx: 10, yy: 12, zz: 10}}
joints:
  C: {type: R, links: [ground, case], point: [0, 0, 0], axis: [1, 0, 0]}
  L: {type: R, links: [ground, left], point: [-40, 0, 0], axis: [1, 0, 0]}
  R: {type: R, links: [ground, right], point: [40, 0, 0], axis: [1, 0, 0]}
  P: {type: R, links: [case, pinion], point: [0, 30, 0], axis: [0, 1, 0]}
couplings:
  A: {type: gear, joints: [L, P], teeth: [24, 15], radii: [32 mm, 20 mm], pressure_angle: 0.35}
  B: {type: gear, joints: [R, P], teeth: [24, 15], radii: [32 mm, 20 mm], pressure_angle: 0.35}
loads:
  - {type: torque, link: left, torque: [-3 N*m, 0, 0]}
  - {type: torque, link: right, torque: [-3.5 N*m, 0, 0]}
"""


def test_a_bevel_differential_with_unequal_loads() -> None:
    """The pinion turns by the difference and shares torques but for its inertia; the case turns by
    the mean, of one driven with both wheels' laws given."""
    motion = """motion:
  inputs:
    L.theta: {from: 0, to: 4, count: 5, rate: 3 rad/s, acceleration: 1 rad/s^2}
    R.theta: {from: 0, to: -1, count: 5, rate: 2 rad/s, acceleration: 5 rad/s^2}
"""
    result = mk.loads(DIFFERENTIAL + motion).analyze()
    assert set(result["row.status"]) == {"ok"}
    np.testing.assert_allclose(result["C.theta"], np.linspace(0.0, 1.5, 5), atol=1e-14)
    np.testing.assert_allclose(result["C.theta_dot"], 2.5, rtol=1e-13)
    np.testing.assert_allclose(
        np.abs(result["P.theta"]), np.linspace(0.0, 2.5, 5) * 24 / 15, atol=1e-13
    )
    np.testing.assert_allclose(np.abs(result["P.theta_dot"]), 0.5 * 24 / 15, rtol=1e-12)
    # Lagrange, of left and right: the case turns by half of each, the pinion by 0.8 of the
    # difference; both carry the pinion round at 30 mm
    carried = (900.0 + 10.0 + 0.5 * 30.0**2) * 1e-6
    case, pinion = 0.5 * (1.0 + 5.0) * carried * 0.5, 12e-6 * 0.8 * 0.8 * (1.0 - 5.0)
    left, right = 50e-6 * 1.0 + case + pinion + 3.0, 50e-6 * 5.0 + case - pinion + 3.5
    np.testing.assert_allclose(result["L.effort"], 1000.0 * left, rtol=1e-11)
    np.testing.assert_allclose(result["R.effort"], 1000.0 * right, rtol=1e-11)


def test_a_differential_that_moves_under_its_loads() -> None:
    """Lagrange's equations of case and difference are linear: constant accelerations."""
    times = "time: {from: 0, to: 0.01, step: 0.005}"
    motion = f"responses: {{r: {{start: {{L.theta: 0, R.theta: 0}}, {times}}}}}\n"
    motion = motion.replace("start:", "efforts: {C.theta: 9 N*m}, start:")
    result = mk.loads(DIFFERENTIAL + motion).respond("r")
    carried = (900.0 + 10.0 + 0.5 * 30.0**2) * 1e-6
    own = 50e-6 + carried / 4.0 + 12e-6 * 0.64
    cross = carried / 4.0 - 12e-6 * 0.64
    forces = [9.0 / 2.0 - 3.0, 9.0 / 2.0 - 3.5]
    left, right = np.linalg.solve([[own, cross], [cross, own]], forces)
    t = result["time"]
    np.testing.assert_allclose(result["L.theta"], left * t * t / 2.0, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(result["R.theta"], right * t * t / 2.0, rtol=1e-9, atol=1e-12)


MOVED = """
format: 1
units: {length: mm, angle: rad, mass: kg, force: N}
links:
  frame: {mass: 3, center_of_mass: [10, 5, 0], inertia: {xx: 900, yy: 900, zz: 900}}
  w1: {mass: 1, center_of_mass: [2, 1, 3], inertia: {xx: 50, yy: 40, zz: 60}}
  w2: {mass: 2, center_of_mass: [61, 0, 5], inertia: {xx: 50, yy: 45, zz: 70}}
  rack: {mass: 1, center_of_mass: [5, -20, 0], inertia: {xx: 50, yy: 40, zz: 60}}
joints:
  X: {type: C, links: [ground, frame], point: [7, 3, 1], axis: [1, 2, 2]}
  A: {type: R, links: [frame, w1], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [w2, frame], point: [60, 0, 4], axis: [0, 0, 1]}
  S: {type: P, links: [frame, rack], point: [0, -20, 0], axis: [1, 0, 0]}
couplings:
  G: {type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: 0.35, helix: 0.3}
  K: {type: rack, joints: [A, S], radius: 20 mm, pressure_angle: 0.3}
loads:
  - {type: gravity, g: standard}
  - {type: force, joint: S, value: -50}
motion:
  inputs:
    A.theta: {from: 0, to: 3, count: 5, rate: 10 rad/s, acceleration: 30 rad/s^2}
    X.theta: {from: 0, to: 1, count: 5, rate: 4 rad/s, acceleration: -20 rad/s^2}
    X.s: {from: 0, to: 10, count: 5, rate: 100 mm/s, acceleration: 900 mm/s^2}
"""


def test_powers_are_in_balance_on_a_mount_that_moves() -> None:
    result = mk.loads(MOVED).analyze()
    assert set(result["row.status"]) == {"ok"}
    assert np.max(result["row.power_error"]) < 1e-13


SWEPT = (
    "motion: {inputs: {L.theta: {from: 0, to: 1, count: 3}, R.theta: {from: 0, to: 2, count: 3}}}"
)
ALL = {
    "rack and helical wheels": MOVED,
    "sun and planet": PLANET.format(far=40, tip=20, wheels="teeth: [30, 30]"),
    "ring": PLANET.format(far=20, tip=40, wheels="teeth: [60, 30], internal: true"),
    "bevel wheels": DIFFERENTIAL + SWEPT,
}


@pytest.mark.parametrize("text", ALL.values(), ids=ALL.keys())
def test_errors_are_bounded_by_the_file_s_own_numbers(text: str) -> None:
    """So that no number of a coupling is lost to double-double."""
    result = mk.loads(text).analyze()
    assert np.all(result["row.error_bound"] < 1e-13)
    assert result.certificate.is_one_branch


WHEELS = "G: {type: gear, joints: [A, B], teeth: [20, 40], pressure_angle: 0.35, helix: 0.3}"
ALIKE = {
    "radii": (WHEELS, WHEELS.replace("teeth: [20, 40]", "radii: [20 mm, 40 mm]")),
    "module": (
        WHEELS,
        WHEELS.replace("teeth: [20, 40]", "teeth: [20, 40], module: 2 mm*cos(0.3 rad)"),
    ),
    "of the other hand, from the other side": (
        WHEELS,
        WHEELS.replace("[A, B], teeth: [20, 40]", "[B, A], teeth: [40, 20]").replace(
            "0.3}", "-0.3}"
        ),
    ),
    "an axis turned": (
        "B: {type: R, links: [w2, frame], point: [60, 0, 4], axis: [0, 0, 1]}",
        "B: {type: R, links: [frame, w2], point: [60, 0, 4], axis: [0, 0, -1]}",
    ),
    "another name": (WHEELS, WHEELS.replace("G:", "wheels:")),
    "another order": (
        "  w1: {mass: 1, center_of_mass: [2, 1, 3], inertia: {xx: 50, yy: 40, zz: 60}}\n"
        "  w2: {mass: 2, center_of_mass: [61, 0, 5], inertia: {xx: 50, yy: 45, zz: 70}}\n",
        "  w2: {mass: 2, center_of_mass: [61, 0, 5], inertia: {xx: 50, yy: 45, zz: 70}}\n"
        "  w1: {mass: 1, center_of_mass: [2, 1, 3], inertia: {xx: 50, yy: 40, zz: 60}}\n",
    ),
}


@pytest.mark.parametrize("change", ALIKE.values(), ids=ALIKE.keys())
def test_one_pair_of_wheels_in_other_words(change: tuple[str, str]) -> None:
    assert change[0] in MOVED
    one, other = mk.loads(MOVED).analyze(), mk.loads(MOVED.replace(*change)).analyze()
    for name in ("B.theta", "B.theta_ddot", "S.s", "A.effort", "K.torque"):
        np.testing.assert_allclose(other[name], one[name], rtol=1e-12)
    for joint in ("A", "S", "X"):
        np.testing.assert_allclose(other[f"{joint}.force"], one[f"{joint}.force"], rtol=1e-11)
