"""P-Sp-P, C-Sp-C and C-Sg-C against the closed forms of the paper on three-link mechanisms.

Body one turns about and slides along A through P, body two along B through Q; R is the sphere's
centre on body one, N the plane's normal or the groove's direction on body two. With D = R_j - Q -
s_B u_B, a plane requires D . N_j = (R - Q) . N, a groove D - s_G N_j = (R - Q)_j. Both lead to
C1 cos(theta_B) + C2 sin(theta_B) = C0; the root is the one that contains home.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from mechanisms.precise import (
    DEGREE,
    Number,
    Vector,
    course,
    cross,
    dot,
    mp,
    plus,
    rows,
    turned,
    unit,
    vector,
)
from mechanisms.runs import run, worst, worst_angle

LIMIT = 1e-13
RATES = ("", "_dot", "_ddot")


@dataclass(frozen=True)
class Pair:
    """The drawing: axes A and B, points P and Q on them, sphere R, normal or groove N."""

    a: Vector
    b: Vector
    p: Vector
    q: Vector
    r: Vector
    n: Vector

    def sphere(self, theta_a: Number, s_a: Number) -> Vector:
        arm = turned(plus(self.r, self.p, -1), self.a, theta_a)
        return plus(plus(self.p, arm), self.a, s_a)

    @property
    def arm(self) -> Vector:
        return plus(self.r, self.q, -1)


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


def root(c0: Number, c1: Number, c2: Number, sign: int) -> Number:
    return mp.atan2(c2, c1) + sign * mp.acos(c0 / mp.hypot(c1, c2))


def home_sign(c0: Number, c1: Number, c2: Number) -> int:
    """The sign whose root is zero in the drawing."""
    return min((1, -1), key=lambda sign: abs(root(c0, c1, c2, sign)))


def plane_turn(pair: Pair, sphere: Vector, s_b: Number) -> tuple[Number, Number, Number]:
    d = plus(plus(sphere, pair.q, -1), pair.b, -s_b)
    along = dot(pair.n, pair.b)
    square = plus(pair.n, pair.b, -along)
    c0 = dot(pair.arm, pair.n) - along * dot(d, pair.b)
    return c0, dot(d, square), dot(d, cross(pair.b, pair.n))


def groove_turn(pair: Pair, sphere: Vector) -> tuple[Number, Number, Number]:
    d = plus(sphere, pair.q, -1)
    across = cross(pair.b, pair.n)
    return dot(pair.arm, across), dot(d, across), dot(d, cross(pair.b, across))


def groove_slides(pair: Pair, sphere: Vector, theta_b: Number) -> tuple[Number, Number]:
    """s_G and s_B once theta_B is known."""
    along = dot(pair.n, pair.b)
    square = plus(pair.n, pair.b, -along)
    back = turned(plus(sphere, pair.q, -1), pair.b, -theta_b)
    gap = plus(back, pair.arm, -1)
    s_g = dot(gap, square) / dot(square, square)
    return s_g, dot(gap, pair.b) - s_g * along


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
