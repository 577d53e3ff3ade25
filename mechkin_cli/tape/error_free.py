"""Sums, products and roots of doubles with their rounding errors, over arrays.

T. J. Dekker (Numerische Mathematik 18, 1971), D. E. Knuth (The Art of Computer Programming, vol. 2,
4.2.2), and for pairs M. Joldes, J.-M. Muller and V. Popescu (ACM Trans. Math. Software 44, 2017),
algorithms 6, 12 and 17. Valid while nothing overflows or underflows; factors stay below 2^995.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

    Pair = tuple[Floats, Floats]

_HALVES = float(2**27 + 1)
"""2^27 + 1, which cuts a double into two of 26 bits."""


def fast_two_sum(a: Floats, b: Floats) -> Pair:
    """a + b exactly, where |a| >= |b|."""
    total = a + b
    return total, b - (total - a)


def two_sum(a: Floats, b: Floats) -> Pair:
    """a + b exactly."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def two_product(a: Floats, b: Floats) -> Pair:
    """a b exactly."""
    product = a * b
    (p, q), (r, s) = _halves(a), _halves(b)
    return product, (((p * r - product) + p * s) + q * r) + q * s


def _halves(a: Floats) -> Pair:
    scaled = _HALVES * a
    high = scaled - (scaled - a)
    return high, a - high


def sum_of(a: Pair, b: Pair) -> Pair:
    """a + b to 3 u^2 of the result, u = 2^-53, whatever the signs are."""
    (high, low), (t, e) = two_sum(a[0], b[0]), two_sum(a[1], b[1])
    high, low = fast_two_sum(high, low + t)
    return fast_two_sum(high, low + e)


def product_of(a: Pair, b: Pair) -> Pair:
    """a b to 5 u^2."""
    high, low = two_product(a[0], b[0])
    return fast_two_sum(high, low + (a[0] * b[1] + (a[1] * b[0] + a[1] * b[1])))


def quotient_of(a: Pair, b: Pair) -> Pair:
    """a / b to 10 u^2."""
    quotient = a[0] / b[0]
    back = product_of(b, (quotient, np.zeros_like(quotient)))
    rest = (a[0] - back[0]) + (a[1] - back[1])
    return fast_two_sum(quotient, rest / b[0])


def root_of(a: Pair) -> Pair:
    """The square root to 4 u^2; that of zero is zero."""
    root = np.sqrt(a[0])
    square, missing = two_product(root, root)
    rest = ((a[0] - square) - missing) + a[1]
    return fast_two_sum(root, np.where(root > 0.0, rest / (2.0 * root), 0.0))
