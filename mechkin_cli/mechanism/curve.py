"""A smooth curve through points of a table: the cubic spline, usually with not-a-knot ends.

Between the points x_i the curve is y_i + b_i u + c_i u^2 + d_i u^3 with u = x - x_i; value, slope
and curvature are continuous, so a motion law has a continuous acceleration. At either end the first
(last) two pieces are one cubic. A table of a cubic is met exactly, and the error of the curvature
goes with the square of the spacing up to the ends, where the natural spline would force it to zero.
Source: C. de Boor, A Practical Guide to Splines, chapter IV.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from mechkin_cli.diagnostics import Place
from mechkin_cli.expressions import Expression, Quantity, UnknownName, Vector
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.tape import JetNumber, of_numbers, orders_of, plain
from mechkin_cli.units import Dimension

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


Ends = Literal["not-a-knot", "natural", "clamped", "periodic"]


class Curve(NamedTuple):
    """A piecewise cubic: `x` (points,) and the coefficients y, b, c, d of the pieces (4, points).

    The last point has a piece too, the last one expanded there: every point is met exactly.
    """

    x: Floats
    coefficients: Floats

    @property
    def first(self) -> float:
        """The smallest x of the table."""
        first: float = plain(self.x[0])
        return first

    @property
    def last(self) -> float:
        """The largest x of the table."""
        last: float = plain(self.x[-1])
        return last

    def turning_places(self) -> Floats:
        """Where the slope is zero inside a piece, in no order."""
        _, b, c, d = self.coefficients[:, :-1]
        width = np.diff(self.x)
        with np.errstate(all="ignore"):
            root = np.sqrt(c * c - 3.0 * b * d)
            # of the two forms of a root the one that does not cancel
            larger = -(c + np.where(c < 0.0, -root, root))
            inside = np.concatenate([larger / (3.0 * d), b / larger])
        starts, widths = np.tile(self.x[:-1], 2), np.tile(width, 2)
        found: Floats = (starts + inside)[(inside > 0.0) & (inside < widths)]
        return found

    def evaluate(self, x: Floats) -> Floats:
        """Value and first three derivatives at x (rows,), shape (4, rows).

        Outside [first, last] the end pieces go on; whether that is wanted is the caller's to check.
        """
        piece = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, self.x.size - 1)
        y, b, c, d = self.coefficients[:, piece]
        u = x - self.x[piece]
        return np.stack(
            [
                y + u * (b + u * (c + u * d)),
                b + u * (2.0 * c + u * (3.0 * d)),
                2.0 * c + u * (6.0 * d),
                6.0 * d,
            ]
        )


def smooth_curve(x: Sequence[float], y: Sequence[float], ends: Ends = "not-a-knot") -> Curve:
    """The curve through two or more points with strictly increasing x.

    Its ends are natural (no curvature), clamped (no slope), periodic (the same slope and curvature)
    or not-a-knot: through two points a straight line then, through three a parabola.

    Example:
        >>> smooth_curve([0, 1, 3], [0, 1, 9]).evaluate(np.array([2.0])).tolist()
        [[4.0], [4.0], [2.0], [0.0]]
    """
    h = [b - a for a, b in pairwise(x)]
    slopes = [(b - a) / step for (a, b), step in zip(pairwise(y), h, strict=True)]
    m = _CURVATURES[ends](h, slopes)
    pieces = [
        (y[i], slopes[i] - h[i] * (2.0 * m[i] + m[i + 1]) / 6.0, m[i] / 2.0, _third(m, h, i))
        for i in range(len(h))
    ]
    end = slopes[-1] + h[-1] * (m[-2] + 2.0 * m[-1]) / 6.0
    pieces.append((y[-1], end, m[-1] / 2.0, pieces[-1][3]))
    return Curve(of_numbers(map(plain, x)), np.array(pieces).T.copy())


def _third(m: list[float], h: list[float], i: int) -> float:
    return (m[i + 1] - m[i]) / (6.0 * h[i])


def _curvatures(h: list[float], slopes: list[float]) -> list[float]:
    """Second derivatives m at the points.

    h_(i-1) m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_i m_(i+1) = 6 (slope_i - slope_(i-1)), where
    m_0 = m_1 + (m_1 - m_2) h_0/h_1 and its mirror image are put in; the matrix that is left is
    tridiagonal and dominated by its diagonal, so elimination needs no pivots.
    """
    jumps = [6.0 * (b - a) for a, b in pairwise(slopes)]
    if len(h) == 1:
        return [0.0, 0.0]
    if len(h) == 2:
        return [jumps[0] / (3.0 * (h[0] + h[1]))] * 3
    diagonal = [2.0 * (a + b) for a, b in pairwise(h)]
    below, above = [0.0, *h[1:-1]], [*h[1:-1], 0.0]
    diagonal[0], above[0] = h[0] + 2.0 * h[1], h[1] - h[0]
    diagonal[-1], below[-1] = 2.0 * h[-2] + h[-1], h[-2] - h[-1]
    jumps[0] *= h[1] / (h[0] + h[1])
    jumps[-1] *= h[-2] / (h[-2] + h[-1])
    inner = _tridiagonal(below, diagonal, above, jumps)
    first = inner[0] + (inner[0] - inner[1]) * (h[0] / h[1])
    last = inner[-1] + (inner[-1] - inner[-2]) * (h[-1] / h[-2])
    return [first, *inner, last]


def _natural(h: list[float], slopes: list[float]) -> list[float]:
    """As `_curvatures`, zero at the ends."""
    if len(h) == 1:
        return [0.0, 0.0]
    jumps = [6.0 * (b - a) for a, b in pairwise(slopes)]
    diagonal = [2.0 * (a + b) for a, b in pairwise(h)]
    return [0.0, *_tridiagonal([0.0, *h[1:-1]], diagonal, [*h[1:-1], 0.0], jumps), 0.0]


def _clamped(h: list[float], slopes: list[float]) -> list[float]:
    """As `_curvatures`, with slopes of zero at the ends."""
    jumps = [6.0 * (b - a) for a, b in pairwise([0.0, *slopes, 0.0])]
    diagonal = [2.0 * (a + b) for a, b in pairwise([0.0, *h, 0.0])]
    return _tridiagonal([0.0, *h], diagonal, [*h, 0.0], jumps)


def _periodic(h: list[float], slopes: list[float]) -> list[float]:
    """As `_curvatures`, with the same slope and curvature at both ends.

    The matrix is cyclic: with corners c it is T + c e e^T, e = e_0 + e_last, T tridiagonal.
    """
    jumps = [6.0 * (b - a) for a, b in pairwise([slopes[-1], *slopes])]
    if len(h) == 2:  # both neighbours of a point are the other one
        total = h[0] + h[1]
        m = jumps[0] / total
        return [m, -m, m]
    if len(h) == 1:
        return [0.0, 0.0]
    diagonal = [2.0 * (a + b) for a, b in pairwise([h[-1], *h])]
    corner = h[-1]
    diagonal[0] -= corner
    diagonal[-1] -= corner
    below, above = [0.0, *h[:-1]], [*h[:-1], 0.0]
    plain_part = _tridiagonal(below, diagonal, above, jumps)
    ends = _tridiagonal(below, diagonal, above, [1.0, *[0.0] * (len(h) - 2), 1.0])
    factor = corner * (plain_part[0] + plain_part[-1]) / (1.0 + corner * (ends[0] + ends[-1]))
    found = [a - factor * b for a, b in zip(plain_part, ends, strict=True)]
    return [*found, found[0]]


_CURVATURES: dict[Ends, Callable[[list[float], list[float]], list[float]]] = {
    "not-a-knot": _curvatures,
    "natural": _natural,
    "clamped": _clamped,
    "periodic": _periodic,
}


def _tridiagonal(
    below: list[float], diagonal: list[float], above: list[float], right: list[float]
) -> list[float]:
    """The solution of a tridiagonal system by elimination and back substitution."""
    pivots, sums = [diagonal[0]], [right[0]]
    for i in range(1, len(diagonal)):
        factor = below[i] / pivots[-1]
        pivots.append(diagonal[i] - factor * above[i - 1])
        sums.append(right[i] - factor * sums[-1])
    found = [sums[-1] / pivots[-1]]
    for i in range(len(diagonal) - 2, -1, -1):
        found.append((sums[i] - above[i] * found[-1]) / pivots[i])
    return found[::-1]


# The curve through the points of a table, joined as a file asks for it.
#
# - spline: cubic, with a continuous curvature (`curve.smooth_curve`); its ends not-a-knot, natural
#   (no curvature) or clamped (no slope: at rest).
# - monotone: cubic between the points, with slopes that let it rise and fall only where the points
#   do, so that it never leaves their range. Slopes are the weighted harmonic means of F. N. Fritsch
#   and J. Butland, A method for constructing local monotone piecewise cubic interpolants, SIAM J.
#   Sci. Stat. Comput. 5 (1984); at the ends those of the parabola through three points, limited as
#   by
#   F. N. Fritsch and R. E. Carlson, Monotone piecewise cubic interpolation, SIAM J. Numer. Anal. 17
#   (1980).
# - linear: straight between the points.

Interpolation = Literal["spline", "monotone", "linear"]


def joined_curve(
    x: Sequence[float], y: Sequence[float], interpolation: Interpolation, ends: Ends
) -> Curve:
    """The curve through two or more points with strictly increasing x; of a linear one the ends
    say nothing."""
    if interpolation == "spline":
        return smooth_curve(x, y, ends)
    h = [b - a for a, b in pairwise(x)]
    rises = [(b - a) / step for (a, b), step in zip(pairwise(y), h, strict=True)]
    if interpolation == "linear":
        pieces = [(y[i], rise, 0.0, 0.0) for i, rise in enumerate(rises)]
        pieces.append((y[-1], rises[-1], 0.0, 0.0))
    else:
        slopes = _monotone_slopes(h, rises)
        if ends == "clamped":
            slopes[0] = slopes[-1] = 0.0
        elif ends == "periodic":
            slopes[0] = slopes[-1] = _between(h[-1], h[0], rises[-1], rises[0])
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


@dataclass(frozen=True)
class ExpressionOf:
    """An expression as a function of the coordinate `argument` in SI, which it calls by its name,
    such as `A.theta`, or by the last word of that."""

    expression: Expression
    argument: str
    dimension: Dimension
    parameters: Mapping[str, Quantity]

    def __call__(self, value: Any) -> Any:
        """The expression in SI where the coordinate is a value of any kind."""
        return self.expression.evaluate(self.resolve(value)).value

    def resolve(self, value: Any) -> Callable[[str], Quantity]:
        """What the names in the expression are there."""
        words = (self.argument, self.argument.rpartition(".")[2])

        def quantity(name: str) -> Quantity:
            if name == self.argument or (name in words and name not in self.parameters):
                return Quantity(value, self.dimension)
            if name in self.parameters:
                parameter = self.parameters[name]
                if not isinstance(value, JetNumber) or isinstance(parameter.value, Vector):
                    return parameter
                return replace(parameter, value=value.beside(parameter.value))
            raise UnknownName(name, [*words, *self.parameters])

        return quantity


@dataclass(frozen=True, eq=False)
class CoordinateLaw:
    """A number as a function of a coordinate, both in SI: of `value`, which takes numbers of any
    kind, or by a `curve`, which repeats itself with a `period` unless that is 0."""

    value: Callable[[Any], Any] | None = None
    curve: Curve | None = None
    period: float = 0.0

    def orders(self, at: Floats) -> Floats:
        """Value and first three derivatives at places (rows,), shape (4, rows); straight beyond the
        ends of a table."""
        if self.curve is not None:
            first, last = self.curve.first, self.curve.last
            if self.period > 0.0:
                at = at - self.period * np.rint((at - 0.5 * (first + last)) / self.period)
            inner = np.clip(at, first, last)
            orders = self.curve.evaluate(inner)
            orders[0] += orders[1] * (at - inner)
            orders[2:] = np.where(at == inner, orders[2:], 0.0)
            return orders
        assert self.value is not None
        with np.errstate(all="ignore"):
            found = orders_of(self.value(JetNumber([at, 1.0, 0.0, 0.0])))
        return np.stack([np.broadcast_to(order, at.shape) for order in found])


class LoadLaw(NamedTuple):
    """The value of a load in SI: `expression`, or `curve` over the one quantity that is read.

    `reads` are the names of the quantities that the law depends on; `place` is where the file
    says it.
    """

    reads: tuple[str, ...]
    place: Place
    expression: Expression | None = None
    curve: Curve | None = None
