"""Loads of bearings against closed forms, and dense systems of Newton and Euler in the plane, at 40
digits; the plane of motion lies anywhere in space."""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.precise import DEGREE, Number, course, cross, dot, mp, plus, turned, unit, vector
from mechanisms.runs import run, worst

import mechkin_cli as mk

LIMIT = 1e-13
ANGLES = range(0, 360, 15)
RATE, SPEEDING = 20, 5

# a rotation of rational numbers: the plane's x, y and normal in space
FRAME = np.array([[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]]) / 3.0
ORIGIN = np.array([0.3, -0.2, 0.5])


def in_space(x: float, y: float) -> list[float]:
    return (FRAME @ [x, y, 0.0] + ORIGIN).tolist()


def slide(theta: Number) -> Number:
    """Slide of the slider-crank kept here, from the centre line."""
    return mp.cos(theta) / 10 + mp.sqrt(mp.mpf("0.35") ** 2 - (mp.sin(theta) / 10) ** 2)


def test_pins_of_a_slider_crank_carry_the_force_along_the_rod():
    """The rod is massless: it pushes the slider with (m a + load)/cos(phi), and the crank, whose
    mass centre is its pivot, hands that on."""
    along, side = [], []
    for degrees in run("slider_crank")["A.theta"]:
        motion = course(int(degrees) * DEGREE, RATE, SPEEDING)
        acceleration = 2 * mp.taylor(lambda t, q=motion: slide(q(t)), 0, 2)[2]
        push = mp.mpf("1.5") * acceleration + 100
        sine = mp.sin(motion(0)) / mp.mpf("3.5")
        cosine = mp.sqrt(1 - sine**2)
        along.append(float(abs(push) / cosine))
        side.append(float(abs(push * sine / cosine)))
    analysis = run("slider_crank")
    for joint in "ABC":
        assert worst(analysis[f"{joint}.radial_force"], np.array(along)) <= LIMIT
        assert np.isnan(analysis[f"{joint}.axial_force"]).all()
        assert np.isnan(analysis[f"{joint}.tilting_moment"]).all()
    # what a rail carries square to the plane is arbitrary, so its whole load is
    assert np.isnan(analysis["D.radial_force"]).all()
    assert worst(np.abs(analysis["D.force.y"]), np.array(side)) <= LIMIT


LINKS = {"crank": (2, "0.05", "0.01", "0.03"), "rod": (1, "0.18", "0.06", "0.04")}
LINKS["rocker"] = (3, "0.12", "-0.02", "0.05")
"""Mass, mass centre along the link from its first pin and square to it, inertia about that."""
CRANK, ROD, ROCKER, BASE = (mp.mpf(x) for x in ("0.1", "0.4", "0.3", "0.45"))
GRAVITY = vector("1.5", "-9.5", 0)


def angles(theta: Number) -> tuple[Number, Number, Number]:
    """Directions of crank, rod and rocker from their first pins A, B and D."""
    x, y = CRANK * mp.cos(theta) - BASE, CRANK * mp.sin(theta)
    length = mp.sqrt(x * x + y * y)
    inner = mp.acos((length**2 + ROCKER**2 - ROD**2) / (2 * length * ROCKER))
    rocker = mp.pi + mp.atan2(-y, -x) - inner
    end = (ROCKER * mp.cos(rocker) - x, ROCKER * mp.sin(rocker) - y)
    return theta, mp.atan2(end[1], end[0]), rocker


def places(theta: Number) -> list[Number]:
    """Mass centres (x, y) and angles of the three links, in order."""
    crank, rod, rocker = angles(theta)
    pins = [(0, 0), (CRANK * mp.cos(theta), CRANK * mp.sin(theta)), (BASE, 0)]
    found = []
    for angle, pin, link in zip((crank, rod, rocker), pins, LINKS.values(), strict=True):
        along, across = mp.mpf(link[1]), mp.mpf(link[2])
        found += [
            pin[0] + along * mp.cos(angle) - across * mp.sin(angle),
            pin[1] + along * mp.sin(angle) + across * mp.cos(angle),
            angle,
        ]
    return found


def dense(degrees: int) -> dict[str, Number]:
    """Forces at the pins A, B, C, D of nine equations of motion."""
    motion = course(degrees * DEGREE, RATE, SPEEDING)
    theta = motion(0)
    accelerations = [2 * mp.taylor(lambda t, k=k: places(motion(t))[k], 0, 2)[2] for k in range(9)]
    crank, _, rocker = angles(theta)
    pins = {
        "A": (mp.mpf(0), mp.mpf(0)),
        "B": (CRANK * mp.cos(crank), CRANK * mp.sin(crank)),
        "C": (BASE + ROCKER * mp.cos(rocker), ROCKER * mp.sin(rocker)),
        "D": (BASE, mp.mpf(0)),
    }
    # each force is that of the first link on the second
    acts = {"A": {0: 1}, "B": {0: -1, 1: 1}, "C": {1: -1, 2: 1}, "D": {2: 1}}
    matrix, right = mp.zeros(9, 9), mp.zeros(9, 1)
    centres = places(theta)
    for body, link in enumerate(LINKS.values()):
        mass, inertia = mp.mpf(link[0]), mp.mpf(link[3])
        for axis in range(2):
            right[3 * body + axis] = mass * (accelerations[3 * body + axis] - GRAVITY[axis])
        right[3 * body + 2] = inertia * accelerations[3 * body + 2]
        for number, (pin, signs) in enumerate(acts.items()):
            sign = signs.get(body, 0)
            lever = [pins[pin][k] - centres[3 * body + k] for k in range(2)]
            matrix[3 * body, 2 * number] = matrix[3 * body + 1, 2 * number + 1] = sign
            matrix[3 * body + 2, 2 * number] = -sign * lever[1]
            matrix[3 * body + 2, 2 * number + 1] = sign * lever[0]
    matrix[2, 8] = 1
    found = mp.lu_solve(matrix, right)
    return {pin: mp.sqrt(found[2 * k] ** 2 + found[2 * k + 1] ** 2) for k, pin in enumerate(acts)}


def four_bar() -> str:
    theta = mp.mpf(0)
    rocker = angles(theta)[2]
    pins = {
        "A": (0.0, 0.0),
        "B": (0.1, 0.0),
        "C": (float(BASE + ROCKER * mp.cos(rocker)), float(ROCKER * mp.sin(rocker))),
        "D": (0.45, 0.0),
    }
    normal = FRAME[:, 2].tolist()
    centres = places(theta)
    bodies = ""
    for k, (name, link) in enumerate(LINKS.items()):
        centre = in_space(float(centres[3 * k]), float(centres[3 * k + 1]))
        # the same about every axis: what is not about the normal does nothing in the plane
        inertia = f"{{xx: {link[3]}, yy: {link[3]}, zz: {link[3]}}}"
        bodies += f"  {name}: {{mass: {link[0]}, center_of_mass: {centre}, inertia: {inertia}}}\n"
    ends = {"A": "ground, crank", "B": "crank, rod", "C": "rod, rocker", "D": "ground, rocker"}
    joints = "".join(
        f"  {pin}: {{type: R, links: [{ends[pin]}], point: {in_space(*at)}, axis: {normal}}}\n"
        for pin, at in pins.items()
    )
    gravity = (FRAME @ [float(g) for g in GRAVITY]).tolist()
    return (
        f"format: 1\nlinks:\n{bodies}joints:\n{joints}loads: [{{type: gravity, g: {gravity}}}]\n"
        "motion: {inputs: {A.theta: {from: 0, to: 345, step: 15, rate: 20 rad/s, "
        "acceleration: 5 rad/s^2}}}\n"
    )


@pytest.fixture(scope="module")
def analysis() -> mk.Analysis:
    return mk.loads(four_bar()).analyze([f"{pin}.force" for pin in "ABCD"], tables=[])


@pytest.fixture(scope="module")
def systems() -> list[dict[str, Number]]:
    return [dense(degrees) for degrees in ANGLES]


@pytest.mark.parametrize("pin", "ABCD")
def test_pins_of_a_four_bar_solve_the_equations_of_motion(pin, analysis, systems):
    expected = np.array([float(row[pin]) for row in systems])
    assert worst(analysis[f"{pin}.radial_force"], expected) <= LIMIT
    assert np.isnan(analysis[f"norm({pin}.force)"]).all()


def test_their_true_errors_are_those_against_the_dense_system(analysis, systems):
    found, cells = analysis.errors["C.radial_force"], analysis["C.radial_force"]
    for error, cell, row in zip(found, cells, systems, strict=True):
        # the file's places are rounded: both are off by that
        assert abs(error - float(abs(row["C"] - mp.mpf(float(cell))))) <= 1e-13 * cells.max()


def test_the_note_names_them(analysis):
    (note,) = [d for d in analysis.diagnostics if d.code == "not-unique"]
    assert note.hint is not None
    assert note.hint.startswith(
        "ask for A.radial_force, B.radial_force, C.radial_force, D.radial_force, which are unique"
    )


def test_a_swinging_mass_loads_its_bearing_in_space():
    """A point mass on an oblique axis: force m(a - g) and its moment about the bearing's point."""
    axis, arm = unit(vector(1, 2, -2)), vector("0.3", "-0.1", "0.25")
    gravity, mass = vector("0.7", "-0.4", "-9.81"), mp.mpf("1.75")
    text = (
        "format: 1\nlinks: {bob: {mass: 1.75, center_of_mass: [0.3, -0.1, 0.25]}}\n"
        "joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [1, 2, -2]}}\n"
        "loads: [{type: gravity, g: [0.7, -0.4, -9.81]}]\n"
        "motion: {inputs: {A.theta: {from: 0, to: 330, step: 30, rate: 3 rad/s, "
        "acceleration: -2 rad/s^2}}}\n"
    )
    expected: dict[str, list[float]] = {"radial_force": [], "axial_force": [], "tilting_moment": []}
    for degrees in range(0, 331, 30):
        motion = course(degrees * DEGREE, 3, -2)
        acceleration = [
            2 * mp.taylor(lambda t, k=k, q=motion: turned(arm, axis, q(t))[k], 0, 2)[2]
            for k in range(3)
        ]
        force = [mass * part for part in plus(acceleration, gravity, -1)]
        moment = cross(turned(arm, axis, motion(0)), force)
        expected["axial_force"].append(float(dot(axis, force)))
        for name, load in (("radial_force", force), ("tilting_moment", moment)):
            square = cross(axis, load)
            expected[name].append(float(mp.sqrt(dot(square, square))))
    found = mk.loads(text).analyze(["A.force", "A.moment"], tables=[])
    for name, values in expected.items():
        assert worst(found[f"A.{name}"], np.array(values)) <= LIMIT


def test_variants_have_the_loads_of_single_runs():
    model = mk.load("mechanisms/dissertation/rcsr.yaml")
    asked = ["O2.radial_force", "O1.tilting_moment"]
    varied = model.vary({"P1": [0.46, 0.5]}, asked)
    for number, crank in enumerate((0.46, 0.5)):
        alone = model.with_parameters({"P1": crank}).analyze(asked, tables=[])
        for name in asked:
            np.testing.assert_array_equal(varied[name][number], alone[name])


def test_a_response_has_them():
    text = (
        "format: 1\nlinks: {bob: {mass: 2, center_of_mass: [0, -0.25, 0]}}\n"
        "joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0.1], axis: [0, 0, 1]}}\n"
        "loads: [{type: gravity, g: [0, -9.81, 0]}]\n"
        "responses: {swing: {start: {A.theta: 60}, time: {from: 0, to: 1, step: 0.1}}}\n"
    )
    result = mk.loads(text).respond("swing", ["A.radial_force", "A.tilting_moment"])
    # along the arm, by energy: m g cos + m w^2 l = m g (3 cos - 2 cos(start)); square to it
    # nothing, as the whole mass is one point on the arm
    cosine = np.cos(np.radians(result["A.theta"]))
    np.testing.assert_allclose(
        result["A.radial_force"], 2 * 9.81 * (3 * cosine - 1), rtol=0, atol=1e-7
    )
    np.testing.assert_allclose(
        result["A.tilting_moment"], 0.1 * result["A.radial_force"], rtol=1e-12
    )


def test_what_has_none_says_who_has():
    model = mk.load("mechanisms/dissertation/rcsr.yaml")
    with pytest.raises(mk.UsageError, match=r"joints with an axis .* have bearing loads"):
        model.analyze(["O3.radial_force"])
    with pytest.raises(mk.UsageError, match="not enclosed: computed from other quantities"):
        model.certify().enclosure("O2.radial_force")
    with pytest.raises(mk.UsageError, match=r"solve does not give O2\.radial_force"):
        model.solve({"O1.theta": 161.5}, ["O2.radial_force"])
