"""Random linkages that move in a plane, about a point or by slides alone, written so that only the
exact numbers of the text tell: drawn at several heights, tilted by fractions or by angles."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from oracle.numerics import mpmath_context as mp

Rational = tuple[Fraction, Fraction, Fraction]
Near = Callable[[str], float]
"""A coordinate in doubles, in deg or m."""
Reference = Callable[[Any, Near], Any]
"""The output coordinate by the driven one: of several the one next to the doubles."""


@dataclass(frozen=True)
class Joint:
    """A pair as drawn before it is tilted."""

    kind: str
    links: tuple[str, str]
    point: Rational
    axis: Rational


@dataclass(frozen=True)
class Linkage:
    """Joints before they are tilted; the first drives, the coordinate `output` has a closed form.

    Attributes:
        exact: whether its axes have to be parallel, or to meet: one number off, it is another.
        meets: whether the axes meet in a point.
        step: of the input from row to row, in deg or m.
    """

    joints: dict[str, Joint]
    output: str
    reference: Reference
    exact: bool = True
    meets: bool = False
    input: str = "A.theta"
    step: str = "4"


@dataclass(frozen=True)
class Tilt:
    """How a drawing is turned: its parameters, and the entries of the rotation as texts."""

    parameters: str
    rows: tuple[tuple[str, str, str], ...]

    def written(self, vector: Rational, off: str = "", number: int = 0, unit: str = "1") -> str:
        """A turned vector; `off` is added to one of its components."""
        sums = [self._sum(row, vector) for row in self.rows]
        sums[number] += off
        return "[" + ", ".join(f"({one})*{unit}" for one in sums) + "]"

    @staticmethod
    def _sum(row: tuple[str, str, str], vector: Rational) -> str:
        return "+".join(f"({m})*({c})" for m, c in zip(row, vector, strict=True))


def none(_: random.Random) -> Tilt:
    return Tilt("", (("1", "0", "0"), ("0", "1", "0"), ("0", "0", "1")))


def by_fractions(rng: random.Random) -> Tilt:
    """By a quaternion of whole numbers."""
    a, b, c, d = (rng.choice([-5, -3, -2, -1, 1, 2, 4]) for _ in range(4))
    n = a * a + b * b + c * c + d * d
    entries = (
        (a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)),
        (2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)),
        (2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d),
    )
    return Tilt("", tuple(tuple(f"{e}/{n}" for e in row) for row in entries))  # type: ignore[misc]


def by_angles(rng: random.Random, unit: str = "deg") -> Tilt:
    """About z by one angle, then about x by another."""
    size = 100.0 if unit == "deg" else 2.0
    a, b = (round(rng.uniform(-size, size), rng.choice([0, 1, 3])) for _ in range(2))
    entries = (
        ("cos(a)", "-sin(a)", "0"),
        ("cos(b)*sin(a)", "cos(b)*cos(a)", "-sin(b)"),
        ("sin(b)*sin(a)", "sin(b)*cos(a)", "cos(b)"),
    )
    return Tilt(f"parameters: {{a: {a} {unit}, b: {b} {unit}}}\n", entries)


TILTS = (none, by_fractions, by_angles, lambda rng: by_angles(rng, "rad"))


def decimal(rng: random.Random, low: float, high: float) -> Fraction:
    """A number of a few digits."""
    return Fraction(str(round(rng.uniform(low, high), rng.choice([1, 2, 3]))))


def plane(rng: random.Random, x: float, y: float) -> Rational:
    """A point near some place of the plane, at any height."""
    return (decimal(rng, x - 0.3, x + 0.3), decimal(rng, y - 0.3, y + 0.3), decimal(rng, -2, 2))


Z: Rational = (Fraction(0), Fraction(0), Fraction(1))


def four_bar(rng: random.Random) -> Linkage:
    """A crank, a coupler and a rocker whose joints lie at different heights."""
    a, b, c, d = (plane(rng, *at) for at in ((0, 0), (0, 1), (3, 2.5), (4, 0)))
    joints = {
        "A": Joint("R", ("ground", "crank"), a, Z),
        "B": Joint("R", ("crank", "coupler"), b, Z),
        "C": Joint("R", ("coupler", "rocker"), c, Z),
        "D": Joint("R", ("ground", "rocker"), d, Z),
    }

    def reference(theta: Any, near: Near) -> Any:
        ways = circles(turned(b, a, theta), distance(b, c), complex_of(d), distance(c, d))
        return nearest(
            [angle(p - complex_of(d), complex_of(c) - complex_of(d)) for p in ways], near("D.theta")
        )

    return Linkage(joints, "D.theta", reference)


def six_bar(rng: random.Random) -> Linkage:
    """A four-bar with a dyad from its rocker to ground."""
    base = four_bar(rng)
    d = base.joints["D"].point
    e, f, g = (plane(rng, *at) for at in ((4.5, 3), (7, 2.5), (8, 0)))
    joints = base.joints | {
        "E": Joint("R", ("rocker", "rod"), e, Z),
        "F": Joint("R", ("rod", "arm"), f, Z),
        "G": Joint("R", ("ground", "arm"), g, Z),
    }

    def reference(theta: Any, near: Near) -> Any:
        turn = base.reference(theta, near)
        ways = circles(turned(e, d, turn), distance(e, f), complex_of(g), distance(f, g))
        return nearest(
            [angle(p - complex_of(g), complex_of(f) - complex_of(g)) for p in ways], near("G.theta")
        )

    return Linkage(joints, "G.theta", reference)


def slider_crank(rng: random.Random) -> Linkage:
    """A crank, a rod and a slide in any direction of the plane."""
    a, b, c, d = (plane(rng, *at) for at in ((0, 0), (0, 1), (4, 0), (5, 0)))
    u = (decimal(rng, 0.5, 1), decimal(rng, -0.5, 0.5), Fraction(0))
    joints = {
        "A": Joint("R", ("ground", "crank"), a, Z),
        "B": Joint("R", ("crank", "rod"), b, Z),
        "C": Joint("R", ("rod", "slider"), c, Z),
        "D": Joint("P", ("ground", "slider"), d, u),
    }

    def reference(theta: Any, near: Near) -> Any:
        way = complex_of(u) / abs(complex_of(u))
        off = (complex_of(c) - turned(b, a, theta)) / way
        root = mp.sqrt(distance(b, c) ** 2 - off.imag**2)
        return min((-off.real + root, -off.real - root), key=lambda s: abs(s - near("D.s")))

    return Linkage(joints, "D.s", reference)


def spherical(rng: random.Random) -> Linkage:
    """Four axes through one point, which stands nowhere in the text."""
    centre = tuple(decimal(rng, -2, 2) for _ in range(3))
    near = ((0.1, 0, 1), (0.5, 0.2, 1), (1, 1.5, 1), (1.5, -0.3, 0.8))
    axes = [tuple(decimal(rng, x - 0.2, x + 0.2) for x in at) for at in near]
    names = [("ground", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("ground", "rocker")]
    joints = {}
    for name, links, axis in zip("ABCD", names, axes, strict=True):
        far = decimal(rng, -2, 2)
        point = tuple(o + far * x for o, x in zip(centre, axis, strict=True))
        joints[name] = Joint("R", links, point, axis)  # type: ignore[arg-type]

    def reference(theta: Any, near: Near) -> Any:
        a, b, c, d = (unit(axis) for axis in axes)
        moved = about(a, theta) * b
        one, other, kept = dot(c, d), dot(c, b), dot(moved, d)
        below = 1 - kept * kept
        along, across = (one - other * kept) / below, (other - one * kept) / below
        rest = mp.sqrt((1 - along * one - across * other) / below)
        normal = cross(d, moved)
        ways = [along * d + across * moved + sign * rest * normal for sign in (1, -1)]
        return nearest([turn_about(d, c, way) for way in ways], near("D.theta"))

    return Linkage(joints, "D.theta", reference, meets=True)


def slides(rng: random.Random) -> Linkage:
    """Four slides in space."""
    names = [("ground", "one"), ("one", "two"), ("two", "three"), ("three", "ground")]
    near = ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1))
    axes = [tuple(decimal(rng, x - 0.3, x + 0.3) for x in at) for at in near]
    joints = {}
    for name, links, axis in zip("ABCD", names, axes, strict=True):
        joints[name] = Joint("P", links, plane(rng, 0, 0), axis)  # type: ignore[arg-type]

    def reference(s: Any, near: Near) -> Any:
        a, *rest = (unit(axis) for axis in axes)
        matrix = mp.matrix([[axis[i] for axis in rest] for i in range(3)])
        return mp.lu_solve(matrix, -s * a)[2]

    return Linkage(joints, "D.s", reference, exact=False, input="A.s", step="0.125")


FAMILIES: dict[str, Callable[[random.Random], Linkage]] = {
    "four-bar": four_bar,
    "six-bar": six_bar,
    "slider-crank": slider_crank,
    "spherical": spherical,
    "slides": slides,
}


def complex_of(point: Rational) -> Any:
    return mp.mpc(real(point[0]), real(point[1]))


def real(number: Fraction) -> Any:
    return mp.mpf(number.numerator) / number.denominator


def distance(a: Rational, b: Rational) -> Any:
    return abs(complex_of(b) - complex_of(a))


def turned(point: Rational, centre: Rational, theta: Any) -> Any:
    o = complex_of(centre)
    return o + (complex_of(point) - o) * mp.expj(theta * mp.pi / 180)


def circles(p: Any, r: Any, q: Any, s: Any) -> list[Any]:
    """Where two circles meet."""
    far = abs(q - p)
    along = (r * r - s * s + far * far) / (2 * far)
    across = mp.sqrt(r * r - along * along)
    way = (q - p) / far
    return [p + way * mp.mpc(along, sign * across) for sign in (1, -1)]


def angle(to: Any, start: Any) -> Any:
    return mp.arg(to / start) * 180 / mp.pi


def nearest(angles: list[Any], near: Near) -> Any:
    """The angle next to one in deg, with its whole turns."""
    with_turns = [a + 360 * mp.nint((near - a) / 360) for a in angles]
    return min(with_turns, key=lambda a: abs(a - near))


def unit(vector: Any) -> Any:
    v = mp.matrix([real(x) for x in vector])
    return v / mp.norm(v)


def dot(a: Any, b: Any) -> Any:
    return (a.T * b)[0]


def cross(a: Any, b: Any) -> Any:
    return mp.matrix(
        [a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3)]
    )


def about(axis: Any, theta: Any) -> Any:
    """The rotation about an axis by an angle in deg."""
    x, y, z = axis
    k = mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    t = theta * mp.pi / 180
    return mp.eye(3) + mp.sin(t) * k + (1 - mp.cos(t)) * k * k


def turn_about(axis: Any, start: Any, to: Any) -> Any:
    return (
        mp.atan2(dot(axis, cross(start, to)), dot(start, to) - dot(axis, start) * dot(axis, to))
        * 180
        / mp.pi
    )
