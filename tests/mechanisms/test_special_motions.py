"""Mechanisms that move by their special dimensions, or by slides alone, against closed forms.

Efforts follow from the power of moving masses and loads.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import pytest
from mechanisms.precise import DEGREE, Number, Vector, course, dot, mp, rows, unit, vector
from mechanisms.runs import model, run, worst, worst_angle

LIMIT = 1e-13
TO_DEGREES = float(180 / mp.pi)

Course = Callable[[Number], Number]


def courses(name: str, rate: Number, acceleration: Number = 0) -> list[Course]:
    """The driven angle over time in every row, in rad."""
    driven = ".".join(model(name).graph.driven[0])
    return [course(int(d) * DEGREE, rate, acceleration) for d in run(name)[driven]]


def agrees(name: str, angle: str, functions: Sequence[Course]) -> None:
    value, first, second = rows(functions)
    assert worst_angle(run(name)[angle], value * TO_DEGREES) <= LIMIT
    assert worst(run(name)[f"{angle}_dot"], first) <= LIMIT
    assert worst(run(name)[f"{angle}_ddot"], second) <= LIMIT


def power(masses: Sequence[tuple[Number, Callable[[Number], Vector]]], gravity: Number) -> Number:
    """Power at time 0 that moves some masses against their inertia and their weight along -z."""
    total = mp.zero
    for mass, place in masses:
        for axis in range(3):
            _, speed, half = mp.taylor(lambda t, p=place, c=axis: p(t)[c], 0, 2)
            total += mass * (2 * half + (gravity if axis == 2 else 0)) * speed
    return total


def as_floats(values: Sequence[Number]) -> np.ndarray:
    return np.array([float(value) for value in values])


# two parallel shafts, 25 degrees off the one between them


def between(theta: Number) -> Number:
    """tan = tan(theta) cos(angle), continuous over the turns."""
    c = mp.cos(25 * DEGREE)
    return theta + mp.atan2(
        (c - 1) * mp.sin(theta) * mp.cos(theta), 1 + (c - 1) * mp.sin(theta) ** 2
    )


def test_double_hooke_turns_steadily():
    analysis = run("double_hooke")
    assert worst_angle(analysis["B.theta"], analysis["A.theta"]) <= LIMIT
    assert np.max(np.abs(analysis["B.theta_dot"] - 20)) <= 20 * LIMIT
    assert np.max(np.abs(analysis["B.theta_ddot"] - 50)) <= 400 * LIMIT


def test_double_hooke_middle_shaft():
    _, rate, acceleration = rows(
        [lambda t, q=q: between(q(t)) for q in courses("double_hooke", 20, 50)]
    )
    omega = run("double_hooke")["between.omega"]
    assert worst(np.sqrt(np.sum(omega * omega, axis=1)), rate) <= LIMIT
    effort = 8 + 2 * 0.004 * 50 + 0.006 * acceleration * rate / 20
    assert worst(run("double_hooke")["A.effort"], effort) <= LIMIT


# lower plates of 80 mm and upper ones of 100 mm that fold outwards, drawn at 45 degrees

LOWER, UPPER, FOLD = mp.mpf(80), mp.mpf(100), 45 * DEGREE


def upper_tilt(tilt: Number) -> Number:
    """Both plates reach out equally far."""
    return mp.asin(LOWER * mp.sin(tilt) / UPPER)


SARRUS = {
    "B": lambda q: FOLD + upper_tilt(FOLD) - (FOLD + q) - upper_tilt(FOLD + q),
    "C": lambda q: upper_tilt(FOLD + q) - upper_tilt(FOLD),
    "D": lambda q: q,
}
SARRUS |= {"E": SARRUS["B"], "F": SARRUS["C"]}


def height(q: Number) -> Number:
    return LOWER * mp.cos(FOLD + q) + UPPER * mp.cos(upper_tilt(FOLD + q))


@pytest.mark.parametrize("joint", SARRUS)
def test_sarrus_joints(joint):
    angle = SARRUS[joint]
    agrees(
        "sarrus", f"{joint}.theta", [lambda t, q=q: angle(q(t)) for q in courses("sarrus", 2, 5)]
    )


def test_sarrus_height():
    expected = rows([lambda t, q=q: height(q(t)) for q in courses("sarrus", 2, 5)])
    for quantity, values in zip(("position", "velocity", "acceleration"), expected, strict=True):
        found = run("sarrus")[f"top.{quantity}"]
        assert worst(found[:, 2], values) <= LIMIT
        assert np.max(np.abs(found[:, :2])) <= LIMIT * np.max(np.abs(values))


def test_sarrus_effort():
    efforts = []
    for q in courses("sarrus", 2, 5):

        def lower(t: Number, q: Course = q) -> Vector:
            tilt = FOLD + q(t)
            return [LOWER / 2 * mp.sin(tilt), mp.zero, LOWER / 2 * mp.cos(tilt)]

        def upper(t: Number, q: Course = q) -> Vector:
            out, _, up = lower(t, q)
            return [out, mp.zero, up + height(q(t)) / 2]

        light, heavy = mp.mpf("0.2"), mp.mpf("1.5")
        moving = [(light, lower), (light, upper)] * 2
        moving.append((heavy, lambda t, q=q: [mp.zero, mp.zero, height(q(t))]))
        # kg mm^2/s^2 to N mm
        efforts.append(power(moving, mp.mpf(9810)) / 2 / 1000)
    assert worst(run("sarrus")["A.effort"], as_floats(efforts)) <= LIMIT


# six links of 0.3 m with twists of 60 and -60 degrees by turns

LENGTH, TWIST = mp.mpf("0.3"), 60 * DEGREE


def link(theta: Number, twist: Number) -> Number:
    """From the frame at the next joint to that at this one (Denavit and Hartenberg)."""
    c, s, ct, st = mp.cos(theta), mp.sin(theta), mp.cos(twist), mp.sin(twist)
    return mp.matrix(
        [
            [c, -s * ct, s * st, LENGTH * c],
            [s, c * ct, -c * st, LENGTH * s],
            [0, st, ct, 0],
            [0, 0, 0, 1],
        ]
    )


def pair(theta: Number, phi: Number) -> Number:
    return link(theta, TWIST) * link(phi, -TWIST)


def every_second(theta: Number) -> Number:
    """The other three joints' angle: three pairs of links close where each turns by 120 degrees,
    so that the trace of its rotation, linear in cos(phi) and sin(phi), is zero."""

    def trace(phi: Number) -> Number:
        m = pair(theta, phi)
        return m[0, 0] + m[1, 1] + m[2, 2]

    mean = (trace(mp.zero) + trace(mp.pi)) / 2
    along, across = trace(mp.zero) - mean, trace(mp.pi / 2) - mean
    return mp.atan2(across, along) + mp.acos(-mean / mp.hypot(along, across))


def bricard_angles(q: Course) -> list[Course]:
    return [q, lambda t: every_second(q(t))] * 3


@cache
def driven_alike() -> tuple[np.ndarray, ...]:
    return rows(courses("bricard", 2, "0.5"))


@cache
def the_others() -> tuple[np.ndarray, ...]:
    return rows([bricard_angles(q)[1] for q in courses("bricard", 2, "0.5")])


def test_the_closed_form_closes_the_bricard_loop():
    for degrees in (-60, -25, 0, 45):
        theta = degrees * DEGREE
        gap = pair(theta, every_second(theta)) ** 3 - mp.eye(4)
        assert max(abs(x) for x in gap) <= mp.mpf("1e-50")


@pytest.mark.parametrize(("place", "joint"), list(enumerate("BCDEF", start=1)))
def test_bricard_joints(place, joint):
    expected = driven_alike() if place % 2 == 0 else the_others()
    assert worst_angle(run("bricard")[f"{joint}.theta"], expected[0] * TO_DEGREES) <= LIMIT
    assert worst(run("bricard")[f"{joint}.theta_dot"], expected[1]) <= LIMIT
    assert worst(run("bricard")[f"{joint}.theta_ddot"], expected[2]) <= LIMIT


def test_bricard_effort():
    """In every sixth row: the links' mass centres stand halfway along them."""

    def middles(q: Course) -> Callable[[Number], list[Vector]]:
        def places(t: Number) -> list[Vector]:
            m, found = mp.eye(4), []
            theta = q(t)
            for k, angle in enumerate([theta, every_second(theta)] * 3):
                m = m * link(angle, TWIST if k % 2 == 0 else -TWIST)
                found.append([m[i, 3] - LENGTH / 2 * m[i, 0] for i in range(3)])
            return found[:5]

        return places

    chosen = slice(None, None, 6)
    efforts = [motion_power(middles(q)) / 2 for q in courses("bricard", 2, "0.5")[chosen]]
    assert worst(run("bricard")["A.effort"][chosen], as_floats(efforts)) <= LIMIT


def motion_power(places: Callable[[Number], list[Vector]]) -> Number:
    """Power at time 0 of unit masses under gravity, by central differences at 60 digits."""
    h = mp.mpf("1e-20")
    before, now, after = places(-h), places(mp.zero), places(h)
    total = mp.zero
    for one, two, three in zip(before, now, after, strict=True):
        for axis in range(3):
            speed = (three[axis] - one[axis]) / (2 * h)
            acceleration = (three[axis] - 2 * two[axis] + one[axis]) / (h * h)
            total += (acceleration + (mp.mpf("9.81") if axis == 2 else 0)) * speed
    return total


# a plunger at 32 mm on a plate tilted by 18 degrees, 0.06 kg, pressed down by 2262 N


def plunger() -> tuple[np.ndarray, ...]:
    reach = 32 * mp.tan(18 * DEGREE)
    return rows([lambda t, q=q: reach * (1 - mp.cos(q(t))) for q in courses("swash_plate", 150)])


@pytest.mark.parametrize(("quantity", "order"), [("s", 0), ("s_dot", 1), ("s_ddot", 2)])
def test_swash_plate(quantity, order):
    assert worst(run("swash_plate")[f"bore.{quantity}"], plunger()[order]) <= LIMIT


def test_swash_plate_forces():
    _, speed, acceleration = plunger()
    axial = 2262 + 0.06 * acceleration / 1000
    analysis = run("swash_plate")
    assert worst(analysis["shaft_bearing.effort"], axial * speed / 150) <= LIMIT
    tilt = 18 * DEGREE
    assert worst(analysis["norm(nose.force)"], axial / float(mp.cos(tilt))) <= LIMIT
    assert worst(analysis["norm(bore.force)"], axial * float(mp.tan(tilt))) <= LIMIT


# three slides and the slide of the cylindric pair close a polygon of fixed directions

DIRECTIONS = {"J1": (1, 2, 6), "J2": (4, 1, -2), "J4": (2, 5, -1), "J6": (-1, 3, 5)}


def ratios() -> dict[str, Number]:
    """Slides per slide of J1."""
    units = {name: unit(vector(*d)) for name, d in DIRECTIONS.items()}
    sides = mp.matrix([[units[n][i] for n in ("J2", "J4", "J6")] for i in range(3)])
    solved = mp.lu_solve(sides, mp.matrix([-x for x in units["J1"]]))
    return {"J1": mp.one, "J2": solved[0], "J4": solved[1], "J6": solved[2]}


@pytest.mark.parametrize("joint", ["J2", "J4", "J6"])
def test_pphchp_slides(joint):
    analysis, ratio = run("pphchp"), float(ratios()[joint])
    assert worst(analysis[f"{joint}.s"], ratio * analysis["J1.s"]) <= LIMIT
    assert worst(analysis[f"{joint}.s_dot"], np.full(11, ratio * 0.5)) <= LIMIT
    assert worst(analysis[f"{joint}.s_ddot"], np.full(11, ratio * 0.2)) <= LIMIT


def test_pphchp_does_not_turn():
    for name in ("one", "two", "three", "four", "five"):
        assert np.max(np.abs(run("pphchp")[f"{name}.omega"])) <= LIMIT


def test_pphchp_effort():
    way, ways = vector(0, 0, 0), {}
    for joint in ("J1", "J2", "J4"):
        along = unit(vector(*DIRECTIONS[joint]))
        way = [x + ratios()[joint] * y for x, y in zip(way, along, strict=True)]
        ways[joint] = way
    masses = [("J1", 1), ("J2", 2), ("J2", 1), ("J4", 2), ("J4", 1)]
    effort = sum(
        mass * (dot(ways[joint], ways[joint]) / 5 + mp.mpf("386.09") * ways[joint][2])
        for joint, mass in masses
    )
    effort -= 10 * ratios()["J6"]
    assert worst(run("pphchp")["J1.effort"], np.full(11, float(effort))) <= LIMIT
