"""Belts over more than two pulleys: turns, tensions of strands and what bearings take of them, by
the tangents of circles found at 40 digits and statics of each pulley by hand."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.kernel.functions import widths

DRIVE = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
links: {crank: {}, pump: {}, idler: {}, fan: {}, tensioner: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [ground, pump], point: [240, 40]}
  I: {type: R, links: [idler, ground], point: [150, 150]}
  C: {type: R, links: [ground, fan], point: [80, 300]}
  T: {type: R, links: [ground, tensioner], point: [-40, 140]}
couplings:
  K:
    type: belt
    joints: [A, B, I, C, T]
    radii: [80, 60, 30, 45, 35]
    outside: [I, T]
    tensioner: T
    pretension: 300
motion: {inputs: {A.theta: {from: 0, to: 90, step: 45, rate: 10 rad/s}}}
loads:
  - {type: torque, joint: B, value: -6 N*m}
  - {type: torque, joint: C, value: -4 N*m}
"""
ORDER = "ABICT"
CENTRES = dict(zip(ORDER, (0, 240 + 40j, 150 + 150j, 80 + 300j, -40 + 140j), strict=True))
RADII = dict(zip(ORDER, (80, 60, 30, 45, 35), strict=True))
INSIDE = dict(zip(ORDER, (1, 1, -1, 1, -1), strict=True))


def tangents() -> dict[str, tuple[complex, complex]]:
    """By pulley, the unit direction of the strand that leaves it, and where it does: each centre
    lies its radius to the left of the belt, which runs anticlockwise, or to the right."""
    found = {}
    with mpmath.workdps(40):
        for one, other in zip(ORDER, ORDER[1:] + ORDER[0], strict=True):
            apart = mpmath.mpc(CENTRES[other]) - mpmath.mpc(CENTRES[one])
            rise = INSIDE[other] * RADII[other] - INSIDE[one] * RADII[one]
            angle = mpmath.arg(apart) - mpmath.asin(rise / abs(apart))
            along = mpmath.expj(angle)
            found[one] = (
                complex(along),
                complex(CENTRES[one] - 1j * INSIDE[one] * RADII[one] * along),
            )
    return found


def test_each_pulley_turns_with_the_belt_and_carries_both_strands() -> None:
    """A drives by (6/60 + 4/45) m kN; the idler turns backwards, and counts the ground's turn."""
    result = mk.loads(DRIVE).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.array([0.0, 45.0, 90.0])
    counted = {"B": 1.0, "I": 1.0, "C": 1.0, "T": -1.0}
    for name, sense in counted.items():
        expected = sense * 80.0 / RADII[name] * turn
        np.testing.assert_allclose(result[f"{name}.theta"], expected, rtol=1e-13, atol=1e-13)
    at_pump, at_fan = 6000.0 / 60.0, 4000.0 / 45.0
    np.testing.assert_allclose(result["A.effort"], 80.0 * (at_pump + at_fan), rtol=1e-12)
    # the belt pulls round anticlockwise: the strand before a pulley that takes power is the looser
    pulls = {"C": 300.0, "T": 300.0, "I": 300.0 - at_fan, "B": 300.0 - at_fan}
    pulls["A"] = 300.0 - at_fan - at_pump
    for name in "ABIT":
        np.testing.assert_allclose(result[f"K.{name}.tension"], pulls[name], rtol=1e-12)
    leaving = tangents()
    for k, name in enumerate(ORDER):
        before = ORDER[k - 1]
        pull = pulls[name] * leaving[name][0] - pulls[before] * leaving[before][0]
        # I counts the other way, and hands on what the belt pulls at its wheel
        sign = 1.0 if name == "I" else -1.0
        for row in range(3):
            expected = [sign * pull.real, sign * pull.imag]
            np.testing.assert_allclose(result[f"{name}.force"][row], expected, rtol=1e-11)
    assert np.nanmax(result["row.power_error"]) < 1e-13


def test_a_strand_that_would_push_is_named() -> None:
    """What the strand that leaves A carries less than the tensioner's is 188.9 N."""
    text = DRIVE.replace("pretension: 300", "pretension: P").replace(
        "links: {crank", "parameters: {P: 188 N}\nlinks: {crank"
    )
    model = mk.loads(text)
    result = model.analyze(["K.A.tension", "row.status"])
    assert set(result["row.status"]) == {"slack"}
    np.testing.assert_allclose(result["K.A.tension"], 188.0 - 100.0 - 4000.0 / 45.0, rtol=1e-11)
    (said,) = (d for d in result.diagnostics if d.code == "slack")
    assert "K.A.tension" in str(said.measured)
    varied = model.vary({"P": ["188 N", "190 N"]}, ["A.effort"])
    assert varied.status.tolist() == [["slack"] * 3, ["ok"] * 3]


def test_the_drawing_may_be_turned_over() -> None:
    """Clockwise in the order given, and in space with axes that point both ways."""
    flat = mk.loads(DRIVE).analyze()
    mirrored = DRIVE.replace("joints: [A, B, I, C, T]", "joints: [A, T, C, I, B]").replace(
        "radii: [80, 60, 30, 45, 35]", "radii: [80, 35, 45, 30, 60]"
    )
    other = mk.loads(mirrored.replace("tensioner: T", "tensioner: C")).analyze()
    # the tensioner's strand is again the one between T and C
    np.testing.assert_allclose(other["K.B.tension"], flat["K.A.tension"], rtol=1e-12)
    np.testing.assert_allclose(other["B.force"], flat["B.force"], rtol=1e-11)
    space = DRIVE.replace("plane: xy\n", "")
    for name, way in zip(ORDER, (1, -1, 1, 1, -1), strict=True):
        x, y = CENTRES[name].real, CENTRES[name].imag if name != "A" else 0
        links = next(line for line in space.splitlines() if line.startswith(f"  {name}: {{type: R"))
        point = f"point: [{x:g}, 0, {y:g}], axis: [0, {-way}, 0]}}"
        space = space.replace(links, links[: links.index("point:")] + point)
    space = space.replace("joint: B, value: -6", "joint: B, value: 6")
    turned = mk.loads(space).analyze()
    np.testing.assert_allclose(turned["A.effort"], flat["A.effort"], rtol=1e-12)
    np.testing.assert_allclose(turned["T.theta"], -flat["T.theta"], rtol=1e-12, atol=1e-12)
    for name in ORDER:
        np.testing.assert_allclose(
            turned[f"{name}.force"][:, [0, 2]], flat[f"{name}.force"], rtol=1e-11, atol=1e-9
        )


RIG = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links:
  arm: {mass: 2, center_of_mass: [0.3, 0.1], inertia: 0.2}
  a: {mass: 1, inertia: 0.05, center_of_mass: [0, 0]}
  b: {mass: 2, inertia: 0.08, center_of_mass: [0.62, 0.05]}
  c: {mass: 1, inertia: 0.02, center_of_mass: [0.2, 0.5]}
joints:
  O: {type: R, links: [ground, arm], point: [-0.3, 0]}
  A: {type: R, links: [arm, a], point: [0, 0]}
  B: {type: R, links: [arm, b], point: [0.6, 0]}
  C: {type: R, links: [arm, c], point: [0.2, 0.5]}
couplings: {K: {type: WHAT, joints: [A, B, C], tensioner: C, pretension: 900}}
motion:
  inputs:
    O.theta: {from: 0, to: 2, count: 5, rate: 3 rad/s, acceleration: 7 rad/s^2}
    A.theta: {with: 2*O.theta}
loads: [{type: gravity, g: [0, -10 m/s^2]}]
"""


@pytest.mark.parametrize("what", ["belt, radii: [0.05, 0.1, 0.04]", "chain"])
def test_power_on_an_arm_that_speeds_up(what: str) -> None:
    """Wheels turn by the arm and by the belt: w = w_arm + 2 w_arm r_a / r; Euler of the wheel b."""
    if what == "chain":
        what = "chain, teeth: [10, 20, 8], pitch: 31.415926535897932 mm"
    result = mk.loads(RIG.replace("WHAT", what)).analyze()
    assert set(result["row.status"]) == {"ok"}
    np.testing.assert_allclose(result["B.theta"], result["A.theta"] / 2.0, rtol=1e-14)
    assert np.nanmax(result["row.power_error"]) < 1e-13
    # of b about its pin, on the arm that turns by one radian for each of the motor's
    turn = np.linspace(0.0, 2.0, 5)
    arm, hand = np.exp(1j * turn), np.exp(2j * turn)
    pin = (7j - 9.0) * 0.9 * arm
    lever = (0.02 + 0.05j) * hand
    centre = pin + lever * (14j - 36.0)
    moment = 0.08 * 14.0 + (np.conj(lever) * 2.0 * (centre + 10j)).imag
    # the strand from A to B brings it, less what leaves for C, which is the tensioner's
    np.testing.assert_allclose(result["K.A.tension"], 900.0 - moment / 0.1, rtol=1e-12)


WRONG = {
    "radii": ("radii: [80, 60, 30, 45, 35]", "radii: [80, 60]", "5 joints have 2 radii"),
    "tensioner": ("    tensioner: T\n", "", "add tensioner: T"),
    "name": ("tensioner: T", "tensioner: X", "X is none of the joints"),
    "outside": ("outside: [I, T]", "outside: [I, X]", "X is none of the joints"),
    "crossed": ("outside: [I, T]", "crossed: true", "do not cross"),
    "overlap": ("radii: [80, 60, 30,", "radii: [80, 60, 120,", "lie on one another"),
    "order": ("joints: [A, B, I, C, T]", "joints: [A, C, B, I, T]", "runs through the pulley at T"),
    "touch": ("point: [150, 150]", "point: [230, 300]", "does not run round once"),
    "efficiency": ("outside: [I, T]", "outside: [I, T]\n    efficiency: 0.9", "two pulleys"),
    "carrier": ("links: [ground, tensioner]", "links: [fan, tensioner]", "no common link"),
}


@pytest.mark.parametrize(("before", "after", "words"), WRONG.values(), ids=WRONG.keys())
def test_belts_that_cannot_run_are_refused(before: str, after: str, words: str) -> None:
    assert before in DRIVE
    with pytest.raises(InvalidFile) as told:
        mk.loads(DRIVE.replace(before, after))
    assert any(words in str(d) for d in told.value.diagnostics)
    assert all(d.place is not None for d in told.value.diagnostics if d.severity == "error")


def test_strands_that_cross_are_named() -> None:
    """Round the corners of a hexagon, two neighbours of which are passed on the wrong side."""
    places = {"A": (0, 0), "B": (300, 0), "C": (450, 260), "D": (300, 520), "E": (0, 520)}
    places["F"] = (-150, 260)
    joints = "".join(
        f"  {name}: {{type: R, links: [ground, w{name}], point: {list(at)}}}\n"
        for name, at in places.items()
    )
    text = f"""
format: 1
plane: xy
units: {{length: mm, angle: deg, mass: kg, force: N}}
links: {{wA: {{}}, wB: {{}}, wC: {{}}, wD: {{}}, wE: {{}}, wF: {{}}}}
joints:
{joints}
couplings:
  K:
    type: belt
    joints: [A, B, C, D, E, F]
    radii: [30, 30, 30, 30, 30, 30]
    outside: [A, B]
    tensioner: F
motion: {{inputs: {{A.theta: {{from: 0, to: 90, step: 45}}}}}}
"""
    with pytest.raises(InvalidFile, match="the strands that leave A and B cross"):
        mk.loads(text)
    assert set(mk.loads(text.replace("[A, B]\n", "[]\n")).analyze()["row.status"]) == {"ok"}


def test_the_same_bits_on_all_lanes_and_threads() -> None:
    model = mk.loads(DRIVE)
    rows = [model.analyze(lanes=n, threads=t)["I.force"] for n in widths() for t in (1, 2)]
    assert len({row.tobytes() for row in rows}) == 1
    assert set(model.certify().status) == {"proven"}
