"""Closed forms of the paper on three-link mechanisms with sphere-plane and sphere-groove pairs.

Body one turns about and slides along A through P, body two along B through Q; R is the sphere's
centre on body one, N the plane's normal or the groove's direction on body two. With D = R_j - Q -
s_B u_B, a plane requires D . N_j = (R - Q) . N, a groove D - s_G N_j = (R - Q)_j. Both lead to
C1 cos(theta_B) + C2 sin(theta_B) = C0; the root is the one that contains home.
"""

from __future__ import annotations

from dataclasses import dataclass

from mechanisms.precise import Number, Vector, cross, dot, mp, plus, turned


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
