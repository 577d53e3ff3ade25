"""How many real roots a trigonometric polynomial of low degree has, proven.

    g(q) = a0 + a1 cos q + b1 sin q + a2 cos 2q + b2 sin 2q

The circle is split into intervals until Taylor's formula about each middle shows that g has no
root there, or that g' has none (then the signs at the ends decide). What errors of the
coefficients leave open stays undecided. A polynomial in a length is one in tan(q/2).
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import functions

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

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
    largest = max(abs(c) for c in g)
    if not 0.0 < largest < np.inf:
        return None
    g = Trigonometric(*(c / largest for c in g))
    doubt = 5.0 * error
    bend = abs(g.a1) + abs(g.b1) + 4.0 * (abs(g.a2) + abs(g.b2))
    half = pi / FIRST_INTERVALS
    # an odd shift: roots of mechanisms drawn along axes do not fall on ends of intervals
    middles: Floats = 0.1234 + 2.0 * half * np.arange(float(FIRST_INTERVALS))
    count = 0
    while middles.size:
        value, slope = _at(g, middles)
        free = np.abs(value) - np.abs(slope) * half - 0.5 * bend * half * half > doubt
        steep = ~free & (np.abs(slope) - bend * half > 2.0 * doubt)
        ends = [_at(g, middles[steep] + side)[0] for side in (-half, half)]
        if (np.abs(ends[0]) <= doubt).any() or (np.abs(ends[1]) <= doubt).any():
            return None
        count += int(np.count_nonzero((ends[0] < 0.0) != (ends[1] < 0.0)))
        left = middles[~free & ~steep]
        half *= 0.5
        if half < tolerances.ROOT_LEAST_INTERVAL:
            return None if left.size else count
        middles = np.concatenate([left - half, left + half])
    return count


def count_polynomial_roots(
    coefficients: tuple[float, ...], error: float = tolerances.ROOT_ROUNDING
) -> int | None:
    """Number of real roots, all simple, of a polynomial of at most fourth degree, lowest power
    first; None where errors of the coefficients, in parts of the largest, leave that open.

    Leading coefficients that are exactly zero count as not there.

    >>> count_polynomial_roots((-6.0, 11.0, -6.0, 1.0)), count_polynomial_roots((1.0, 0.0, 1.0))
    (3, 0)
    """
    degree = max((k for k, c in enumerate(coefficients) if c != 0.0), default=0)
    if degree == 0:
        return 0 if coefficients[0] != 0.0 else None
    # cos^2, sin cos and sin^2 of half the angle; an odd degree has a root at infinity, too
    parts = Trigonometric(0.5, 0.5), Trigonometric(0.0, 0.0, 0.5), Trigonometric(0.5, -0.5)
    g = Trigonometric()
    for power, c in enumerate(coefficients[: degree + 1]):
        high = power // 2 if degree > 2 else 0
        term = parts[high].times(parts[power - high]) if degree > 2 else parts[power]
        g = g.plus(term, c)
    found = count_roots(g, error)
    return None if found is None else found - degree % 2


def _at(g: Trigonometric, angles: Floats) -> tuple[Floats, Floats]:
    """Values and slopes."""
    c, s = functions.cos(angles), functions.sin(angles)
    c2, s2 = c * c - s * s, 2.0 * s * c
    value = g.a0 + g.a1 * c + g.b1 * s + g.a2 * c2 + g.b2 * s2
    slope = g.b1 * c - g.a1 * s + 2.0 * (g.b2 * c2 - g.a2 * s2)
    return value, slope
