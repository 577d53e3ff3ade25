"""Mechanisms whose motion has a closed form; efforts by the power of the moving masses."""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.precise import DEGREE, Number, course, mp, plus, rows, turned, vector
from mechanisms.runs import model, run, worst, worst_angle

LIMIT = 1e-13
GRAVITY = mp.mpf("9.81")
TO_DEGREES = float(180 / mp.pi)


def inputs(name: str, rate: Number, acceleration: Number = 0) -> list:
    """The crank's angle over time in every row, in rad; rates as the file says."""
    return [course(int(d) * DEGREE, rate, acceleration) for d in run(name)[model_input(name)]]


def model_input(name: str) -> str:
    return ".".join(model(name).graph.driven[0])


def agrees_with(name: str, angle: str, functions: list) -> None:
    """An angle in degrees and its two rates."""
    value, first, second = rows(functions)
    analysis = run(name)
    assert worst_angle(analysis[angle], value * TO_DEGREES) <= LIMIT
    assert worst(analysis[f"{angle}_dot"], first) <= LIMIT
    assert worst(analysis[f"{angle}_ddot"], second) <= LIMIT


def hooke_driven(theta: Number) -> Number:
    """tan(theta_B) = tan(theta_A) cos(angle), continuous over the turns."""
    lag = (mp.cos(30 * DEGREE) - 1) * mp.sin(theta) * mp.cos(theta)
    return theta + mp.atan(lag / (1 + (mp.cos(30 * DEGREE) - 1) * mp.sin(theta) ** 2))


def test_hooke_driven_shaft():
    courses = inputs("hooke", 10)
    agrees_with("hooke", "B.theta", [lambda t, q=q: hooke_driven(q(t)) for q in courses])


def test_hooke_cross():
    """The pins' turns from the direction of the driven pin as seen from the driver, and back."""
    first, second = [], []
    beta = 30 * DEGREE
    for q in inputs("hooke", 10):
        theta, phi = q(0), hooke_driven(q(0))
        y = mp.sin(theta) * mp.sin(phi) + mp.cos(beta) * mp.cos(theta) * mp.cos(phi)
        first.append(float((beta + mp.atan2(-mp.sin(beta) * mp.cos(phi), y)) / DEGREE))
        x = mp.cos(theta) * mp.cos(phi) + mp.cos(beta) * mp.sin(theta) * mp.sin(phi)
        second.append(float(mp.atan2(mp.sin(beta) * mp.sin(theta), x) / DEGREE))
    assert worst_angle(run("hooke")["U.theta1"], np.array(first)) <= LIMIT
    assert worst_angle(run("hooke")["U.theta2"], np.array(second)) <= LIMIT


def test_hooke_effort():
    courses = inputs("hooke", 10)
    _, rate, acceleration = rows([lambda t, q=q: hooke_driven(q(t)) for q in courses])
    effort = (0.03 * acceleration + 5.0) * rate / 10.0
    assert worst(run("hooke")["A.effort"], effort) <= LIMIT


def test_parallelogram_joints():
    """The coupler only moves in parallel: cranks turn alike, the coupler against them."""
    courses = inputs("parallelogram", 3, 2)
    backwards = [lambda t, q=q: -q(t) for q in courses]
    for joint, functions in (("B", backwards), ("C", courses), ("D", courses)):
        agrees_with("parallelogram", f"{joint}.theta", functions)
    assert np.max(np.abs(run("parallelogram")["two.omega"])) <= LIMIT * 3.0


def test_parallelogram_effort():
    """Both cranks about their pivots, the coupler as a point on the crank's circle."""
    crank = mp.mpf("0.3")
    inertia = 2 * (mp.mpf("0.01") + crank**2 / 4) + 2 * crank**2
    weight = GRAVITY * (crank / 2 + 2 * crank + crank / 2)
    effort = [inertia * 2 + weight * mp.cos(q(0)) for q in inputs("parallelogram", 3, 2)]
    found = run("parallelogram")["A.effort"]
    assert worst(found, np.array([float(x) for x in effort])) <= LIMIT


def slide(theta: Number) -> Number:
    """x = r cos + sqrt(l^2 - r^2 sin^2), from the drawing."""
    r, length = mp.mpf("0.1"), mp.mpf("0.35")
    reach = mp.sqrt(length**2 - (r * mp.sin(theta)) ** 2)
    return r * mp.cos(theta) + reach - r - length


def slider_rows() -> tuple[np.ndarray, ...]:
    return rows([lambda t, q=q: slide(q(t)) for q in inputs("slider_crank", 20, 5)])


@pytest.mark.parametrize(("quantity", "order"), [("D.s", 0), ("D.s_dot", 1), ("D.s_ddot", 2)])
def test_slider_crank(quantity, order):
    assert worst(run("slider_crank")[quantity], slider_rows()[order]) <= LIMIT


def test_slider_crank_effort():
    _, rate, acceleration = slider_rows()
    effort = 0.02 * 5.0 + (1.5 * acceleration + 100.0) * rate / 20.0
    assert worst(run("slider_crank")["A.effort"], effort) <= LIMIT


ALPHA, BETA = 40 * DEGREE, 75 * DEGREE
LENGTH_A = mp.mpf(1)
LENGTH_B = mp.sin(BETA) / mp.sin(ALPHA)


def bennett_second(theta: Number) -> Number:
    """tan(theta1/2) tan(theta2/2) = sin((beta + alpha)/2)/sin((beta - alpha)/2) (Bennett)."""
    ratio = mp.sin((BETA + ALPHA) / 2) / mp.sin((BETA - ALPHA) / 2)
    return 2 * mp.atan2(ratio * mp.cos(theta / 2), mp.sin(theta / 2))


def test_bennett_joints():
    courses = inputs("bennett", 2, "0.5")
    second = [lambda t, q=q: bennett_second(q(t)) for q in courses]
    agrees_with("bennett", "B.theta", second)
    agrees_with("bennett", "C.theta", [lambda t, q=q: -q(t) for q in courses])
    agrees_with("bennett", "D.theta", [lambda t, f=f: -f(t) for f in second])


def bennett_masses(theta: Number) -> list[tuple[int, list[Number]]]:
    """Mass and place of the links' mass centres: turned about the joints from the tip inwards."""
    angles = [theta, bennett_second(theta), -theta]
    twists, places = [0, ALPHA, ALPHA + BETA], [0, LENGTH_A, LENGTH_A + LENGTH_B]
    drawn = [
        (1, vector(LENGTH_A / 2, 0, "0.1")),
        (2, vector(LENGTH_A + LENGTH_B / 2, "0.1", 0)),
        (1, vector(LENGTH_A + LENGTH_B + LENGTH_A / 2, 0, "0.1")),
    ]
    found = []
    for k, (mass, place) in enumerate(drawn):
        for j in range(k, -1, -1):
            pivot, axis = vector(places[j], 0, 0), vector(0, -mp.sin(twists[j]), mp.cos(twists[j]))
            place = plus(pivot, turned(plus(place, pivot, -1), axis, angles[j]))
        found.append((mass, place))
    return found


def test_bennett_effort():
    """Effort times rate is the power of inertia and weight."""
    efforts = []
    for q in inputs("bennett", 2, "0.5"):
        power = mp.zero
        for k in range(3):
            for c in range(3):
                place = mp.taylor(lambda t, q=q, k=k, c=c: bennett_masses(q(t))[k][1][c], 0, 2)
                weight = GRAVITY if c == 2 else 0
                power += (1, 2, 1)[k] * (2 * place[2] + weight) * place[1]
        efforts.append(float(power / 2))
    assert worst(run("bennett")["A.effort"], np.array(efforts)) <= LIMIT
