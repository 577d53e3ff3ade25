"""The curve through the points of a table, joined as a file asks for it.

- spline: cubic, with a continuous curvature (`curve.smooth_curve`); its ends not-a-knot, natural
  (no curvature) or clamped (no slope: at rest).
- monotone: cubic between the points, with slopes that let it rise and fall only where the points
  do, so that it never leaves their range. Slopes are the weighted harmonic means of F. N. Fritsch
  and J. Butland, A method for constructing local monotone piecewise cubic interpolants, SIAM J.
  Sci. Stat. Comput. 5 (1984); at the ends those of the parabola through three points, limited as by
  F. N. Fritsch and R. E. Carlson, Monotone piecewise cubic interpolation, SIAM J. Numer. Anal. 17
  (1980).
- linear: straight between the points.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from mechkin_cli.mechanism.curve import Curve, Ends, smooth_curve
from mechkin_cli.tape.rows import of_numbers
from mechkin_cli.tape.scalars import plain

Interpolation = Literal["spline", "monotone", "linear"]


class Joining(NamedTuple):
    """How points are joined; of a linear curve the ends say nothing."""

    interpolation: Interpolation = "spline"
    ends: Ends = "not-a-knot"


def joined_curve(x: Sequence[float], y: Sequence[float], joining: Joining) -> Curve:
    """The curve through two or more points with strictly increasing x."""
    if joining.interpolation == "spline":
        return smooth_curve(x, y, joining.ends)
    h = [b - a for a, b in pairwise(x)]
    rises = [(b - a) / step for (a, b), step in zip(pairwise(y), h, strict=True)]
    if joining.interpolation == "linear":
        pieces = [(y[i], rise, 0.0, 0.0) for i, rise in enumerate(rises)]
        pieces.append((y[-1], rises[-1], 0.0, 0.0))
    else:
        slopes = _monotone_slopes(h, rises)
        if joining.ends == "clamped":
            slopes[0] = slopes[-1] = 0.0
        pieces = [_piece(y[i], slopes[i], slopes[i + 1], rises[i], h[i]) for i in range(len(h))]
        _, _, bend, third = pieces[-1]
        pieces.append((y[-1], slopes[-1], bend + 3.0 * third * h[-1], third))
    return Curve(of_numbers(map(plain, x)), np.array(pieces).T.copy())


def _piece(
    y: float, first: float, last: float, rise: float, h: float
) -> tuple[float, float, float, float]:
    """The cubic of a value and two slopes that rises by `rise` times h."""
    bend = (3.0 * rise - 2.0 * first - last) / h
    return (y, first, bend, (first + last - 2.0 * rise) / (h * h))


def _monotone_slopes(h: list[float], rises: list[float]) -> list[float]:
    if len(h) == 1:
        return [rises[0], rises[0]]
    inner = [
        _between(*steps, *both) for steps, both in zip(pairwise(h), pairwise(rises), strict=True)
    ]
    first = _at_end(h[0], h[1], rises[0], rises[1])
    last = _at_end(h[-1], h[-2], rises[-1], rises[-2])
    return [first, *inner, last]


def _between(h0: float, h1: float, rise0: float, rise1: float) -> float:
    if rise0 * rise1 <= 0.0:
        return 0.0
    weight0, weight1 = 2.0 * h1 + h0, h1 + 2.0 * h0
    return (weight0 + weight1) / (weight0 / rise0 + weight1 / rise1)


def _at_end(h0: float, h1: float, rise0: float, rise1: float) -> float:
    """The slope of the parabola through three points at an end, kept within what is monotone."""
    slope = ((2.0 * h0 + h1) * rise0 - h0 * rise1) / (h0 + h1)
    if slope * rise0 <= 0.0:
        return 0.0
    if rise0 * rise1 <= 0.0 and abs(slope) > 3.0 * abs(rise0):
        return 3.0 * rise0
    return slope
