"""P-Sp-P, C-Sp-C and C-Sg-C against the closed forms of the paper on three-link mechanisms."""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.precise import (
    DEGREE,
    Number,
    course,
    dot,
    mp,
    plus,
    rows,
    turned,
    unit,
    vector,
)
from mechanisms.runs import run, worst, worst_angle
from mechanisms.three_links import (
    Pair,
    groove_slides,
    groove_turn,
    home_sign,
    plane_turn,
    root,
)

LIMIT = 1e-13
RATES = ("", "_dot", "_ddot")


PSPP = Pair(
    unit(vector(1, 2, 2)),
    unit(vector(2, -1, 3)),
    vector(1, 0, 2),
    vector("0.25", "0.75", "-1.5"),
    vector("2.5", 1, "-0.5"),
    unit(vector(1, -2, 4)),
)
CSPC = Pair(
    unit(vector(2, 1, 0)),
    unit(vector(-3, 2, 0)),
    vector(0, 0, 0),
    vector(0, 6, 1),
    vector("1.5", "1.5", "1.5"),
    unit(vector(1, -1, 5)),
)
CSGC = Pair(
    unit(vector(1, 2, 1)),
    unit(vector(2, 1, 0)),
    vector(0, 0, 0),
    vector(0, 0, 1),
    vector(3, 3, 3),
    unit(vector(1, 1, 2)),
)


def agrees(name: str, quantity: str, functions: list, degrees: bool = False) -> None:
    for suffix, expected in zip(RATES, rows(functions), strict=True):
        found = run(name)[quantity + suffix]
        if degrees and not suffix:
            assert worst_angle(found, expected * float(1 / DEGREE)) <= LIMIT
        else:
            assert worst(found, expected) <= LIMIT, quantity + suffix


def test_pspp_is_a_wedge():
    """s_B = s_A (u_A . N)/(u_B . N), so the rates are in the same ratio."""
    ratio = float(dot(PSPP.a, PSPP.n) / dot(PSPP.b, PSPP.n))
    assert worst(run("pspp")["B.s"], ratio * run("pspp")["A.s"]) <= LIMIT
    assert worst(run("pspp")["B.s_dot"], np.full(17, 1.5 * ratio)) <= LIMIT
    assert worst(run("pspp")["B.s_ddot"], np.full(17, -0.7 * ratio)) <= LIMIT


def test_pspp_slip():
    """What is left of the sphere's displacement against the plane lies in the plane."""
    ratio = dot(PSPP.a, PSPP.n) / dot(PSPP.b, PSPP.n)
    per_slide = np.array([float(x) for x in plus(PSPP.a, PSPP.b, -ratio)])
    expected = run("pspp")["A.s"][:, None] * per_slide
    assert worst(run("pspp")["S.slip"], expected) <= LIMIT


def cspc_turn(theta_a: Number, s_a: Number, s_b: Number) -> Number:
    home = plane_turn(CSPC, CSPC.r, mp.zero)
    sphere = CSPC.sphere(theta_a, s_a)
    return root(*plane_turn(CSPC, sphere, s_b), home_sign(*home))


def cspc_courses() -> list[tuple]:
    theta, s = run("cspc")["A.theta"], run("cspc")["A.s"]
    b = course(mp.mpf("0.25"), "-0.3")
    return [
        (course(int(x) * DEGREE, 1), course(mp.mpf(repr(float(y))), "0.2"), b)
        for x, y in zip(theta, s, strict=True)
    ]


def test_cspc():
    courses = cspc_courses()
    turns = [lambda t, c=c: cspc_turn(*(each(t) for each in c)) for c in courses]
    agrees("cspc", "B.theta", turns, degrees=True)


@pytest.mark.parametrize("axis", range(3))
def test_cspc_slip(axis):
    """The sphere against the point of the plane that it touched in the drawing."""
    expected = []
    for theta_a, s_a, s_b in cspc_courses():
        values = theta_a(0), s_a(0), s_b(0)
        contact = plus(CSPC.q, turned(CSPC.arm, CSPC.b, cspc_turn(*values)))
        contact = plus(contact, CSPC.b, values[2])
        expected.append(float(plus(CSPC.sphere(*values[:2]), contact, -1)[axis]))
    assert worst(run("cspc")["S.slip"][:, axis], np.array(expected)) <= LIMIT


def csgc_state(theta_a: Number, s_a: Number) -> tuple[Number, Number, Number]:
    """theta_B, s_G, s_B."""
    sphere = CSGC.sphere(theta_a, s_a)
    sign = home_sign(*groove_turn(CSGC, CSGC.r))
    theta_b = root(*groove_turn(CSGC, sphere), sign)
    return theta_b, *groove_slides(CSGC, sphere, theta_b)


@pytest.mark.parametrize(("quantity", "index"), [("B.theta", 0), ("S.s", 1), ("B.s", 2)])
def test_csgc(quantity, index):
    theta, s = run("csgc")["A.theta"], run("csgc")["A.s"]
    functions = []
    for x, y in zip(theta, s, strict=True):
        a, b = course(int(x) * DEGREE, 1), course(mp.mpf(repr(float(y))), "0.5", "0.2")
        functions.append(lambda t, a=a, b=b: csgc_state(a(t), b(t))[index])
    agrees("csgc", quantity, functions, degrees=quantity == "B.theta")
