"""The proven number of assemblies of a small loop: its equation, and the number of its roots.

Roots: the real roots of a trigonometric polynomial of low degree,

    g(q) = a0 + a1 cos q + b1 sin q + a2 cos 2q + b2 sin 2q,

are counted by splitting the circle into intervals until Taylor's formula about each middle shows
that g has no root there, or that g' has none (then the signs at the ends decide). What errors of
the coefficients leave open stays undecided. A polynomial in a length is one in tan(q/2).

Equations, each of their roots one assembly:

- A sphere and three other motions x1 x2 x3 (Pieper 1968). x2 carries the place y of the sphere
  after x3 to the place w before x1. A turn keeps its height along the axis and its distance from a
  point of the axis, a slide two heights: two equations affine in (cos, sin) of x1 and of x3, or in
  (s, s^2). Solved for those of x1, cos^2 + sin^2 = 1, or s^2 = s s, is of fourth degree in x3.
- A distance and one motion: the distance of two points, of second degree.
- Two motions in a plane and a turn square to it at the cut joint: the first keeps the distance of
  that joint's point from its axis, or line; of second degree. One slide square to the plane, as in
  RRCR, takes up the heights, and has one place.
- Two parallel turns and a slide square to them at the cut joint: the sum of the turns is known, so
  that the offset from the slide's line is of first degree in (cos, sin) of one of them.
- A turn through the centre of two crossed axes at the cut joint (Hooke): their angle.
- Two turns and a turn at the cut joint, axes through one point, or with slides along every axis
  (RCCC): the direction of the cut joint's axis, R(t1) R(t2) z2 = z1, hence z_t1 . R(t2) z2 =
  z_t1 . z1, of first degree in (cos, sin).
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import functions
from mechkin_cli.mechanism import Vector, cross, dot, norm, scale, subtract, unit
from mechkin_cli.record import NamedTuple
from mechkin_cli.search.chain import (
    WITH_SPHERE,
    Chain,
    ChainMotion,
    are_parallel,
    chain_of,
    chains_of,
    square_to,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.plan import Layout
    from mechkin_cli.show import Floats


FIRST_INTERVALS = 16
"""Intervals to begin with: eight to each of the most roots would settle most of them at once."""


class Trigonometric(NamedTuple):
    """Coefficients of a trigonometric polynomial."""

    a0: float = 0.0
    a1: float = 0.0
    b1: float = 0.0
    a2: float = 0.0
    b2: float = 0.0

    def plus(self, other: Trigonometric, factor: float = 1.0) -> Trigonometric:
        """self + factor other."""
        return Trigonometric(*(x + factor * y for x, y in zip(self, other, strict=True)))

    def times(self, other: Trigonometric) -> Trigonometric:
        """The product of two of first degree."""
        return Trigonometric(
            self.a0 * other.a0 + 0.5 * (self.a1 * other.a1 + self.b1 * other.b1),
            self.a0 * other.a1 + self.a1 * other.a0,
            self.a0 * other.b1 + self.b1 * other.a0,
            0.5 * (self.a1 * other.a1 - self.b1 * other.b1),
            0.5 * (self.a1 * other.b1 + self.b1 * other.a1),
        )


def count_roots(g: Trigonometric, error: float = tolerances.ROOT_ROUNDING) -> int | None:
    """Number of real roots in a turn, all simple; None where errors of the coefficients, in parts
    of the largest, leave that open.

    >>> count_roots(Trigonometric(0.5, 1.0)), count_roots(Trigonometric(2.0, 1.0))
    (2, 0)
    >>> count_roots(Trigonometric(1.0, 1.0)) is None
    True
    >>> count_roots(Trigonometric(0.1, 0.0, 0.0, 1.0, 0.0))
    4
    """
    return counts_of_roots([g], [error])[0]


def counts_of_roots(some: Sequence[Trigonometric], errors: Sequence[float]) -> list[int | None]:
    """The same of many at once, each with its error."""
    given = np.array(some, dtype=np.float64).reshape(len(some), 5).T
    largest = np.abs(given).max(axis=0, initial=0.0)
    undecided = ~((largest > 0.0) & (largest < np.inf))
    of = given / np.where(undecided, 1.0, largest)
    doubts = 5.0 * np.array(errors, dtype=np.float64)
    bends = np.abs(of[1]) + np.abs(of[2]) + 4.0 * (np.abs(of[3]) + np.abs(of[4]))
    half = pi / FIRST_INTERVALS
    # an odd shift: roots of mechanisms drawn along axes do not fall on ends of intervals
    first: Floats = 0.1234 + 2.0 * half * np.arange(float(FIRST_INTERVALS))
    owner = np.repeat(np.flatnonzero(~undecided), FIRST_INTERVALS)
    middles = np.tile(first, owner.size // FIRST_INTERVALS)
    counts = np.zeros(len(some), dtype=np.intp)
    while middles.size:
        g, doubt, bend = of[:, owner], doubts[owner], bends[owner]
        value, slope = _at(g, middles)
        free = np.abs(value) - np.abs(slope) * half - 0.5 * bend * half * half > doubt
        steep = ~free & (np.abs(slope) - bend * half > 2.0 * doubt)
        low, high = (_at(g[:, steep], middles[steep] + side)[0] for side in (-half, half))
        near = (np.abs(low) <= doubt[steep]) | (np.abs(high) <= doubt[steep])
        undecided[owner[steep][near]] = True
        changes = owner[steep][(low < 0.0) != (high < 0.0)]
        counts += np.bincount(changes, minlength=len(some))
        left = ~free & ~steep & ~undecided[owner]
        owner, middles = owner[left], middles[left]
        half *= 0.5
        if half < tolerances.ROOT_LEAST_INTERVAL:
            undecided[owner] = True
            break
        owner = np.concatenate([owner, owner])
        middles = np.concatenate([middles - half, middles + half])
    pairs = zip(counts.tolist(), undecided.tolist(), strict=True)
    return [None if open_ else count for count, open_ in pairs]


def count_polynomial_roots(
    coefficients: tuple[float, ...], error: float = tolerances.ROOT_ROUNDING
) -> int | None:
    """Number of real roots, all simple, of a polynomial of at most fourth degree, lowest power
    first; None where errors of the coefficients, in parts of the largest, leave that open.

    Leading coefficients that are exactly zero count as not there.

    >>> count_polynomial_roots((-6.0, 11.0, -6.0, 1.0)), count_polynomial_roots((1.0, 0.0, 1.0))
    (3, 0)
    """
    g, at_infinity = _on_circle(coefficients)
    if g is None:
        return 0 if coefficients[0] != 0.0 else None
    count = count_roots(g, error)
    return None if count is None else count - at_infinity


def _on_circle(coefficients: tuple[float, ...]) -> tuple[Trigonometric | None, int]:
    """A polynomial of the tangent of half an angle as one of the angle, None of a constant; and how
    many roots it has at infinity."""
    degree = max((k for k, c in enumerate(coefficients) if c != 0.0), default=0)
    if degree == 0:
        return None, 0
    # cos^2, sin cos and sin^2 of half the angle; an odd degree has a root at infinity, too
    parts = Trigonometric(0.5, 0.5), Trigonometric(0.0, 0.0, 0.5), Trigonometric(0.5, -0.5)
    g = Trigonometric()
    for power, c in enumerate(coefficients[: degree + 1]):
        high = power // 2 if degree > 2 else 0
        term = parts[high].times(parts[power - high]) if degree > 2 else parts[power]
        g = g.plus(term, c)
    return g, degree % 2


def _at(g: Floats, angles: Floats) -> tuple[Floats, Floats]:
    """Values and slopes of polynomials (5, number), each at its angle (number,)."""
    a0, a1, b1, a2, b2 = g
    c, s = functions.cos(angles), functions.sin(angles)
    c2, s2 = c * c - s * s, 2.0 * s * c
    value = a0 + a1 * c + b1 * s + a2 * c2 + b2 * s2
    slope = b1 * c - a1 * s + 2.0 * (b2 * c2 - a2 * s2)
    return value, slope


Row = tuple[float, float, float]
"""Coefficients of 1, f1, f2: f = (cos, sin) of a turn, (s, s^2) of a slide."""


Equation = tuple[Trigonometric | tuple[float, ...] | None, float, int]
"""The polynomial of a loop (in a slide: its coefficients, lowest power first), how regular its
derivation was (0 to 1), and the most assemblies."""


def _with_sphere(motions: tuple[ChainMotion, ...], chain: Chain) -> Equation | None:
    """The equation of three motions between the sphere's places on the chain's ends."""
    if len(motions) != 3:
        return None
    x1, x2, x3 = motions
    most = WITH_SPHERE[sum(not x.slide for x in motions)]
    before, after = _invariants(x2, x1, chain.first.o), _invariants(x2, x3, chain.second.o)
    options = [(x3, after, x1, before), (x1, before, x3, after)]
    best = max(options, key=lambda option: _regularity(option[3]))
    regularity = _regularity(best[3])
    return _eliminated(*best) if regularity > 0.0 else None, regularity, most


def _invariants(middle: ChainMotion, x: ChainMotion, point: Vector) -> tuple[Row, Row]:
    """What the middle motion keeps of a point moved by x."""
    if middle.slide:
        smallest = min(range(3), key=lambda i: abs(middle.axis[i]))
        ground = (float(smallest == 0), float(smallest == 1), float(smallest == 2))
        one = unit(square_to(middle.axis, ground))
        return _heights(x, point, one), _heights(x, point, cross(middle.axis, one))
    return _heights(x, point, middle.axis), _squares(x, point, middle.point)


def _moved(x: ChainMotion, point: Vector) -> tuple[Vector, Vector, Vector]:
    """Y0, Y1, Y2 of the place Y0 + Y1 f1 + Y2 f2."""
    if x.slide:
        return point, x.axis, (0.0, 0.0, 0.0)
    arm = square_to(x.axis, subtract(point, x.point))
    return subtract(point, arm), arm, cross(x.axis, arm)


def _heights(x: ChainMotion, point: Vector, direction: Vector) -> Row:
    """The height along a direction of a point moved by x."""
    y0, y1, y2 = _moved(x, point)
    return dot(direction, y0), dot(direction, y1), dot(direction, y2)


def _squares(x: ChainMotion, point: Vector, centre: Vector) -> Row:
    """The squared distance of the place from `centre`."""
    y0, y1, y2 = _moved(x, point)
    away = subtract(y0, centre)
    constant, first = dot(away, away), 2.0 * dot(away, y1)
    if x.slide:
        return constant, first, 1.0
    return constant + dot(y1, y1), first, 2.0 * dot(away, y2)


def _determinant(rows: tuple[Row, Row]) -> float:
    return rows[0][1] * rows[1][2] - rows[0][2] * rows[1][1]


def _regularity(rows: tuple[Row, Row]) -> float:
    """How far the equations are from having no solution for f: 0 to 1."""
    sizes = [abs(row[1]) + abs(row[2]) for row in rows]
    return abs(_determinant(rows)) / (sizes[0] * sizes[1]) if min(sizes) > 0.0 else 0.0


def _eliminated(
    left: ChainMotion, known: tuple[Row, Row], solved: ChainMotion, unknown: tuple[Row, Row]
) -> Trigonometric | tuple[float, ...]:
    """The constraint between f1 and f2 of the motion solved for, in the one that is left: 1 = f1^2
    + f2^2 of a turn, f2 = f1^2 of a slide."""
    determinant = _determinant(unknown)
    (e, a, b), (f, c, d) = unknown
    p = (known[0][0] - e, *known[0][1:])
    q = (known[1][0] - f, *known[1][1:])
    f1 = [(d * x - b * y) / determinant for x, y in zip(p, q, strict=True)]
    f2 = [(a * y - c * x) / determinant for x, y in zip(p, q, strict=True)]
    if left.slide:
        first, second = _product(f1, f1), _product(f2, f2)
        if solved.slide:
            return tuple(x - y for x, y in zip(first, (*f2, 0.0, 0.0), strict=True))
        one = (1.0, 0.0, 0.0, 0.0, 0.0)
        return tuple(x + y - z for x, y, z in zip(first, second, one, strict=True))
    cosine, sine = Trigonometric(*f1), Trigonometric(*f2)
    if solved.slide:
        return cosine.times(cosine).plus(sine, -1.0)
    return cosine.times(cosine).plus(sine.times(sine)).plus(Trigonometric(1.0), -1.0)


def _product(p: list[float], q: list[float]) -> tuple[float, ...]:
    """Coefficients of the product of two polynomials of second degree."""
    product = [0.0] * 5
    for i, x in enumerate(p):
        for j, y in enumerate(q):
            product[i + j] += x * y
    return tuple(product)


MOST_OF_A_PLANE_LOOP = 2
"""Two circles, or a circle and a line."""

MOST_BY_DIRECTION = 2
"""Two roots of the direction's equation."""


def _equation_of(chain: Chain) -> Equation | None:
    """The equation of a chain; None for loops of other kinds."""
    if chain.distance is not None:
        # |x p - a|^2 = distance^2
        if len(chain.motions) != 1:
            return None
        (x,) = chain.motions
        constant, first, second = _squares(x, chain.second.o, chain.first.o)
        row = (constant - chain.distance * chain.distance, first, second)
        return row if x.slide else Trigonometric(*row), 1.0, 2
    motions = [freedom.motion for freedom in chain.joint.type.chain]
    if motions[:3] == ["ball"] * 3:
        frame = chain.second
        axes = {0: (), 1: (frame.z,), 2: (frame.x, frame.y)}[len(motions) - 3]
        slides = (ChainMotion(True, axis, frame.o) for axis in axes)
        return _with_sphere((*chain.motions, *slides), chain)
    if motions in (["turn"], ["turn", "slide"]):
        flat = _flattened(chain)
        if flat is not None:
            return _in_plane(flat)
    if motions == ["turn"] and len(chain.motions) == 2 and _is_spherical(chain):
        return _directed(chain)
    if motions == ["turn", "slide"] and len(chain.motions) == 4:
        return _directed(chain)
    if motions == ["slide"]:
        return _sliding(chain)
    if motions == ["turn", "turn"]:
        return _crossed(chain)
    return None


def _flattened(chain: Chain) -> Chain | None:
    """The chain in the plane square to the cut joint's axis, without the one slide along that axis
    that it may have; None where turns are not about it, other slides not square to it, or its
    halves in different planes and no slide joins them."""
    normal, limit = chain.first.z, tolerances.PARALLEL
    if dot(normal, chain.second.z) < 0.0 or not are_parallel(normal, chain.second.z):
        return None
    flat = tuple(x for x in chain.motions if not (x.slide and are_parallel(x.axis, normal)))
    square = len(chain.motions) - len(flat) + len(chain.joint.type.chain) - 1
    height = dot(normal, subtract(chain.second.o, chain.first.o))
    if len(flat) != 2 or square > 1 or (square == 0 and abs(height) > limit):
        return None
    if any(x.slide and abs(dot(x.axis, normal)) > limit for x in flat):
        return None
    if not all(x.slide or are_parallel(x.axis, normal) for x in flat):
        return None
    second = chain.second._replace(o=subtract(chain.second.o, scale(height, normal)))
    return chain._replace(motions=flat, second=second)


def _is_spherical(chain: Chain) -> bool:
    """Whether the turns' axes and both halves of the cut joint meet in one point."""
    if any(x.slide for x in chain.motions):
        return False
    one, other = chain.motions
    across = cross(one.axis, other.axis)
    square = dot(across, across)
    if square < tolerances.ROOT_REGULAR**2:
        return False
    between = subtract(other.point, one.point)
    along = dot(cross(between, other.axis), across) / square
    centre = subtract(one.point, scale(-along, one.axis))
    first, second = chain.first, chain.second
    heights = []
    for axis, point in ((other.axis, other.point), (first.z, first.o), (second.z, second.o)):
        arm = subtract(point, centre)
        heights.append(dot(arm, axis))
        if norm(square_to(axis, arm)) > tolerances.PARALLEL:
            return False
    return abs(heights[1] - heights[2]) < tolerances.PARALLEL


def _in_plane(chain: Chain) -> Equation:
    """The first motion keeps the cut joint's point at its distance from the axis, or the line."""
    x1, x2 = chain.motions
    if x1.slide:
        across = cross(chain.first.z, x1.axis)
        constant, *turned = _heights(x2, chain.second.o, across)
        constant -= dot(across, chain.first.o)
    else:
        constant, *turned = _squares(x2, chain.second.o, x1.point)
        arm = subtract(chain.first.o, x1.point)
        constant -= dot(arm, arm)
    row = (constant, turned[0], turned[1])
    regularity = 1.0 if x1.slide or x2.slide else min(norm(_between(x1, x2)), 1.0)
    return row if x2.slide else Trigonometric(*row), regularity, MOST_OF_A_PLANE_LOOP


def _between(x1: ChainMotion, x2: ChainMotion) -> Vector:
    """From one parallel axis to another."""
    return square_to(x1.axis, subtract(x2.point, x1.point))


def _directed(chain: Chain) -> Equation | None:
    """By the direction of the cut joint's axis."""
    turns = [x for x in chain.motions if not x.slide]
    if len(turns) != 2:
        return None
    one, other = turns
    arm = square_to(other.axis, chain.second.z)
    still = dot(other.axis, chain.second.z) * dot(one.axis, other.axis)
    constant = still - dot(one.axis, chain.first.z)
    turned = dot(one.axis, arm), dot(one.axis, cross(other.axis, arm))
    # sines of the angles between axes: parallel ones decide nothing
    sines = arm, square_to(one.axis, chain.first.z), square_to(one.axis, other.axis)
    regularity = min(norm(sine) for sine in sines)
    return Trigonometric(constant, *turned), regularity, MOST_BY_DIRECTION


def _sliding(chain: Chain) -> Equation | None:
    """By the offset from the line of the cut joint's slide, in a plane."""
    if len(chain.motions) != 2 or any(x.slide for x in chain.motions):
        return None
    (one, other), limit = chain.motions, tolerances.PARALLEL
    normal, first, second = one.axis, chain.first, chain.second
    tilt = subtract(first.components(normal), second.components(normal))
    heights = dot(normal, first.z), dot(normal, subtract(first.o, second.o))
    if not are_parallel(normal, other.axis) or norm(tilt) > limit:
        return None
    if max(abs(height) for height in heights) > limit:
        return None
    # the second link's orientation is known: where its point is from the other turn's axis
    arm = first.vector(second.components(subtract(second.o, other.point)))
    between = _between(one, other)
    across = cross(normal, first.z)
    constant = dot(across, arm) + dot(across, subtract(one.point, first.o))
    turned = dot(across, between), dot(across, cross(normal, between))
    regularity = min(norm(between), 1.0)
    return Trigonometric(constant, *turned), regularity, MOST_OF_A_PLANE_LOOP


def _crossed(chain: Chain) -> Equation | None:
    """By the angle between the two axes of the cut joint, about its centre."""
    if len(chain.motions) != 1 or chain.motions[0].slide:
        return None
    (x,), limit = chain.motions, tolerances.PARALLEL
    for end in (chain.first, chain.second):
        if norm(square_to(x.axis, subtract(end.o, x.point))) > limit:
            return None
    if abs(dot(x.axis, subtract(chain.first.o, chain.second.o))) > limit:
        return None
    joint, arm = chain.joint, square_to(x.axis, chain.second.z)
    still = dot(x.axis, chain.second.z) * dot(x.axis, chain.first.z)
    constant = still - dot(joint.on_first.z, joint.on_second.z)
    turned = dot(chain.first.z, arm), dot(chain.first.z, cross(x.axis, arm))
    regularity = min(norm(arm), norm(square_to(x.axis, chain.first.z)))
    return Trigonometric(constant, *turned), regularity, MOST_BY_DIRECTION


def count_assemblies(layout: Layout, number: int, base: Floats) -> tuple[int | None, int] | None:
    """A block's number of assemblies, upstream states as in `base` (states,), None where rounding
    leaves it open, and the most that such a loop has; None for loops of other kinds."""
    chain = chain_of(layout, number, base)
    return _counts_of([chain], number)[0]


def counts_of_assemblies(
    layout: Layout, number: int, bases: Floats
) -> list[tuple[int | None, int] | None]:
    """The same at many places (columns of `bases`, (states, places))."""
    chains = chains_of(layout, number, bases)
    return [None] * bases.shape[1] if chains is None else _counts_of(chains, number)


def _counts_of(chains: Sequence[Chain | None], number: int) -> list[tuple[int | None, int] | None]:
    # the upstream states of the first block are inputs, those of others are solved for
    error = tolerances.ROOT_STATE_ERROR if number else tolerances.ROOT_ROUNDING
    found: list[tuple[int | None, int] | None] = [None] * len(chains)
    ahead = []
    for k, chain in enumerate(chains):
        equation = None if chain is None else _equation_of(chain)
        if equation is None:
            continue
        polynomial, regularity, most = equation
        found[k] = None, most
        if polynomial is None or regularity < tolerances.ROOT_REGULAR:
            continue
        if isinstance(polynomial, Trigonometric):
            g, beside = polynomial, 0
        else:
            circle, beside = _on_circle(polynomial)
            if circle is None:
                found[k] = 0 if polynomial[0] != 0.0 else None, most
                continue
            g = circle
        ahead.append((k, g, beside, most, error / (regularity * regularity)))
    counts = counts_of_roots([each[1] for each in ahead], [each[4] for each in ahead])
    for (k, _, beside, most, _), count in zip(ahead, counts, strict=True):
        found[k] = None if count is None else count - beside, most
    return found
