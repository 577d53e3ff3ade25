"""Bevel wheels, and worms with their wheels, against velocities and statics at their pitch point
(Shigley, Mechanical Engineering Design, force analysis of bevel and worm gearing)."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile

BEVEL = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {w1: {}, w2: {}}
joints:
  A: {type: R, links: [ground, w1], point: [30, 0, 0], axis: [1, 0, 0]}
  B: {type: R, links: [ground, w2], point: [0, 40, 0], axis: [0, 1, 0]}
motion: {inputs: {A.theta: {from: 0, to: 500, count: 3, rate: 10 rad/s}}}
loads: [{type: torque, joint: B, value: 6 N*m}]
couplings:
  G: {type: gear, joints: [A, B], radii: [15, 30], pressure_angle: 20}
"""


def test_bevel_wheels() -> None:
    """Pitch point (30, 15, 0); there the first moves along z by 15, the second by -30 a radian."""
    result = mk.loads(BEVEL).analyze()
    np.testing.assert_allclose(result["B.theta"], [0.0, -125.0, -250.0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(result["A.effort"], 3000.0, rtol=1e-12)
    # on the wheel: 6 N m + (-30 mm)(Fz) = 0 about y at 30 mm of its axis
    tangential, cone = 200.0, np.arctan2(1.0, 2.0)
    push = tangential * np.tan(np.pi / 9)
    force = [-push * np.sin(cone), push * np.cos(cone), tangential]
    for row in range(3):
        np.testing.assert_allclose(result["G.tooth_force"][row], force, rtol=1e-12)
        np.testing.assert_allclose(result["B.force"][row], -np.array(force), rtol=1e-12)
        np.testing.assert_allclose(result["A.force"][row], force, rtol=1e-12)


@pytest.mark.parametrize("shaft", [50.0, 115.0])
def test_cones_of_any_shaft_angle_roll(shaft: float) -> None:
    """The second axis turned by the shaft's angle from the first: no slip at the pitch line."""
    c, s = float(np.cos(np.radians(shaft))), float(np.sin(np.radians(shaft)))
    text = BEVEL.replace(
        "[0, 40, 0], axis: [0, 1, 0]", f"[{40 * c!r}, {40 * s!r}, 0], axis: [{-c!r}, {-s!r}, 0]"
    )
    text = text.replace("radii: [15, 30]", "teeth: [15, 30], ideal: true").replace(
        ", pressure_angle: 20", ""
    )
    result = mk.loads(text).analyze()
    # the axis drawn backwards turns the sign round
    np.testing.assert_allclose(result["B.theta"], [0.0, 125.0, 250.0], rtol=1e-12, atol=1e-12)


WORM = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {worm: {}, wheel: {}}
joints:
  A: {type: R, links: [ground, worm], point: [-50, 0, 0], axis: [1, 0, 0]}
  B: {type: R, links: [ground, wheel], point: [0, 125, 10], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 7200, count: 3, rate: 10 rad/s}}}
loads: [{type: torque, joint: B, value: 100 N*m}]
couplings:
  G: {type: gear, joints: [A, B], teeth: [2, 40], radii: [25, 100], pressure_angle: 20, HELIX}
""".replace("HELIX", 'helix: "90 deg - atan(0.2)"')


@pytest.mark.parametrize("hand", [1.0, -1.0])
def test_a_worm_drives_its_wheel(hand: float) -> None:
    """Two threads of module 5 on a diameter of ten modules: the lead angle is atan(1/5). A nut on
    a right-hand screw that turns about +x goes towards -x."""
    text = (
        WORM
        if hand > 0.0
        else WORM.replace("90 deg - atan", "atan").replace("atan(0.2)", "atan(0.2) - 90 deg")
    )
    text = text if hand > 0.0 else text.replace("value: 100", "value: -100")
    result = mk.loads(text).analyze()
    np.testing.assert_allclose(
        result["B.theta"], [0.0, -180.0 * hand, -360.0 * hand], rtol=1e-11, atol=1e-9
    )
    np.testing.assert_allclose(result["A.effort"], 5000.0, rtol=1e-9)
    # the worm's tangential force 200 N is the wheel's thrust; 1000 N at the wheel's rim
    force = result["G.tooth_force"][1]
    apart = 200.0 * np.tan(np.pi / 9) / np.sin(np.arctan(0.2))
    np.testing.assert_allclose(np.abs(force), [1000.0, apart, 200.0], rtol=1e-9)
    assert force[1] > 0.0
    np.testing.assert_allclose(result["B.force"][1], -force, rtol=1e-9)


WRONG = {
    "no radii": (BEVEL, "radii: [15, 30]", "teeth: [15, 30]", "give radii"),
    "at the apex": (
        BEVEL,
        "point: [30, 0, 0]",
        "point: [0, 0, 0]",
        "where the axes of both wheels meet",
    ),
    "ring": (BEVEL, "radii: [15, 30]", "radii: [15, 30], internal: true", "parallel to its pinion"),
    "spiral": (BEVEL, "pressure_angle: 20", "pressure_angle: 20, helix: 10", "spiral"),
    "no helix": (WORM, ', helix: "90 deg - atan(0.2)"', "", "pass each other"),
    "teeth": (WORM, "teeth: [2, 40]", "teeth: [2, 41]", "another amount than by its teeth"),
    "distance": (WORM, "[0, 125, 10]", "[0, 124, 10]", "do not mesh where they are drawn"),
}


@pytest.mark.parametrize(("text", "before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_wheels_that_cannot_mesh_are_refused(
    text: str, before: str, after: str, words: str
) -> None:
    assert before in text
    with pytest.raises(InvalidFile) as told:
        mk.loads(text.replace(before, after))
    assert any(words in str(d) for d in told.value.diagnostics)
