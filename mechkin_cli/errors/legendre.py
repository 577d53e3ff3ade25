"""Gauss-Legendre collocation in double-double: nodes, Legendre coefficients, integrals.

A function on [0, 1] is taken for the polynomial sum of a_k P_k(2 c - 1) through its values at the
nodes (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.7). How fast the
a_k fall tells how well.
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from functools import cache
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel.functions import cos
from mechkin_cli.tape import DoubleDoubles, joined, stacked

if TYPE_CHECKING:
    from collections.abc import Sequence


DIGITS = 50
"""Of the decimals that nodes are computed in; double-double has 32."""


@cache
def collocation(count: int) -> tuple[DoubleDoubles, DoubleDoubles, DoubleDoubles]:
    """Of a number of nodes: these (nodes,) in (0, 1); the matrix (nodes, nodes) from values there
    to Legendre coefficients; that (nodes + 1, nodes) from coefficients to the integrals from 0 to
    each node and to 1."""
    with localcontext() as context:
        context.prec = DIGITS
        roots = [_root(count, k) for k in range(count)]
        values = [_legendre(count + 1, x) for x in roots]
        # Gauss's weights on [-1, 1]
        weights = [
            2 / ((1 - x * x) * (count * (x * v[count] - v[count - 1]) / (x * x - 1)) ** 2)
            for x, v in zip(roots, values, strict=True)
        ]
        coefficients = [
            [(2 * k + 1) * w * v[k] / 2 for w, v in zip(weights, values, strict=True)]
            for k in range(count)
        ]
        ends = [*values, [Decimal(1)] * (count + 2)]
        integrals = [[_integral(k, v) for k in range(count)] for v in ends]
        nodes = [(x + 1) / 2 for x in roots]
    return _double_doubles(nodes), _double_doubles(coefficients), _double_doubles(integrals)


def integrals_to(places: DoubleDoubles, count: int) -> DoubleDoubles:
    """From `count` coefficients to the integrals from 0 to some places (places, count), which may
    lie outside [0, 1]."""
    p = _polynomials(places, count + 1)
    integrals = [places + 0.0]
    integrals += [(p[k + 1] - p[k - 1]) / (2.0 * (2.0 * k + 1.0)) for k in range(1, count)]
    return stacked(integrals, axis=1)


def values_at(places: DoubleDoubles, coefficients: DoubleDoubles) -> DoubleDoubles:
    """Polynomials of coefficients (polynomials, count) at some places (polynomials, places)."""
    p = _polynomials(places, coefficients.shape[1])
    return sum_of_products(stacked(p, axis=1), coefficients).T


def _polynomials(places: DoubleDoubles, count: int) -> list[DoubleDoubles]:
    """P_0 to P_(count - 1) of 2 c - 1 at some places."""
    x = 2.0 * places - 1.0
    p = [DoubleDoubles(np.ones(places.shape)), x]
    for k in range(1, count - 1):
        p.append(((2.0 * k + 1.0) * x * p[k] - float(k) * p[k - 1]) / float(k + 1))
    return p


def sum_of_products(matrix: DoubleDoubles, columns: DoubleDoubles) -> DoubleDoubles:
    """The products (rows, columns) of a matrix (rows, terms) with columns (columns, terms), summed
    in pairs."""
    terms = matrix[:, None, :] * columns[None, :, :]
    while terms.shape[2] > 1:
        half = terms.shape[2] // 2
        paired = terms[:, :, :half] + terms[:, :, half : 2 * half]
        terms = joined([paired, terms[:, :, 2 * half :]], axis=2)
    return terms[:, :, 0]


def _root(count: int, number: int) -> Decimal:
    """A root of P_count by Newton's method, in rising order."""
    x = Decimal(-float(cos(pi * (number + 0.75) / (count + 0.5))))
    for _ in range(8):
        p = _legendre(count, x)
        slope = count * (x * p[count] - p[count - 1]) / (x * x - 1)
        x -= p[count] / slope
    return x


def _legendre(highest: int, x: Decimal) -> list[Decimal]:
    """P_0 to P_highest."""
    p = [Decimal(1), x]
    for k in range(1, highest):
        p.append(((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1))
    return p


def _integral(degree: int, p: Sequence[Decimal]) -> Decimal:
    """The integral of P_degree(2 c - 1) from c = 0 to where the polynomials are p."""
    if degree == 0:
        return (p[1] + 1) / 2
    return (p[degree + 1] - p[degree - 1]) / (2 * (2 * degree + 1))


def _double_doubles(numbers: Sequence[Sequence[Decimal]] | Sequence[Decimal]) -> DoubleDoubles:
    decimals = np.array(numbers, dtype=object)
    high = decimals.astype(np.float64)
    with localcontext() as context:
        context.prec = DIGITS
        rest = np.vectorize(lambda x, h: float(x - Decimal(h)), otypes=[np.float64])
        return DoubleDoubles(high, rest(decimals, high))
