"""Curves and surfaces that a pair goes along: places by one parameter u, or by two, u and v.

A place is one of the drawing (m). Its derivatives by u and v are those of Taylor expansions along
lines of parameters (`JetNumber`): along u, along v and, for the mixed ones, along u + v and u - v.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.mechanism.curve import Curve
from mechkin_cli.mechanism.vectors import Vector, dot, subtract
from mechkin_cli.record import dataclass
from mechkin_cli.tape import JetNumber, as_recorded, orders_of
from mechkin_cli.tolerances import TABLE_END

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

Places = Callable[..., Sequence[Any]]
"""Coordinates x, y, z of a place (m) by `Track.numbers` and parameters, of any kind of number."""


@dataclass(frozen=True, eq=False)
class Track:
    """A curve, or a surface.

    `places`: a formula of the parameters, or `knots`: of a curve, the three coordinates over u.
    `ends`: of each parameter; `closed`: whether it comes back to its begin there. These ends bound
    nothing, nor do those of `endless` parameters, which only say where searches start. `numbers`
    are those of the drawing that a formula takes before its parameters: what is computed must not
    depend on their values, such as zeros.
    """

    ends: tuple[tuple[float, float], ...]
    closed: tuple[bool, ...]
    places: Places | None = None
    knots: tuple[Curve, ...] = ()
    endless: tuple[str, ...] = ()
    numbers: tuple[Any, ...] = ()

    @property
    def bounded(self) -> tuple[bool, ...]:
        """Of each parameter, whether nothing is beyond its ends."""
        pairs = zip(self.names, self.closed, strict=True)
        return tuple(not closed and name not in self.endless for name, closed in pairs)

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters: `("u",)` or `("u", "v")`."""
        return ("u", "v")[: len(self.ends)]

    def jets(
        self, at: Sequence[Any], along: Sequence[float], numbers: Sequence[Any]
    ) -> list[Sequence[Any]]:
        """Value and three derivatives of the coordinates x, y, z, along a line of parameters."""
        if self.knots:
            return self._of_knots(at[0])
        assert self.places is not None
        moving = [JetNumber([x, a, 0.0, 0.0]) for x, a in zip(at, along, strict=True)]
        return [orders_of(coordinate) for coordinate in self.places(*numbers, *moving)]

    def _of_knots(self, at: Any) -> list[Sequence[Any]]:
        u = np.asarray(self.wrapped((at,))[0], dtype=np.float64).reshape(1)
        return [[float(x) for x in curve.evaluate(u)[:, 0]] for curve in self.knots]

    def orders(
        self, at: Sequence[Any], numbers: Sequence[Any] | None = None
    ) -> tuple[list[Any], ...]:
        """The place, then its first, second and third derivatives: x, y, z by u; or by u, v; uu,
        uv, vv; uuu, uuv, uvv, vvv. `numbers` take the place of its own."""
        numbers = self.numbers if numbers is None else numbers
        if len(self.ends) == 1:
            return _derivatives_of_one(self.jets(at, (1.0,), numbers))
        lines = ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0))
        return _derivatives_of_two([self.jets(at, along, numbers) for along in lines])

    def place(self, at: Sequence[float]) -> Vector:
        """Where parameters lead."""
        x, y, z = (as_recorded(_number(value)) for value in self.orders(at)[0])
        return (x, y, z)

    def slopes(self, at: Sequence[float]) -> list[Vector]:
        """How the place moves by each parameter."""
        first = [as_recorded(_number(value)) for value in self.orders(at)[1]]
        return [(first[k], first[k + 1], first[k + 2]) for k in range(0, len(first), 3)]

    def wrapped(self, at: Iterable[Any]) -> list[Any]:
        """Parameters, those that come back taken between their ends."""
        return [
            x - (high - low) * np.floor((x - low) / (high - low)) if closed else x
            for x, (low, high), closed in zip(at, self.ends, self.closed, strict=True)
        ]

    def holds(self, at: Floats) -> Any:
        """Which columns of parameters (parameters, rows) lie between the ends that bound them, as
        far as rounding leaves it open."""
        inside = np.ones(at.shape[1], dtype=bool)
        for x, (low, high), bounded in zip(at, self.ends, self.bounded, strict=True):
            slack = TABLE_END * (high - low)
            inside &= (not bounded) | ((x >= low - slack) & (x <= high + slack))
        return inside

    def places_at(self, at: Floats) -> list[Floats]:
        """Coordinates x, y, z of the places of parameters (parameters, rows)."""
        if self.knots:
            (u,) = self.wrapped(at)
            return [curve.evaluate(u)[0] for curve in self.knots]
        assert self.places is not None
        with np.errstate(all="ignore"):
            jets = self.places(*self.numbers, *(JetNumber([x, 0.0, 0.0, 0.0]) for x in at))
        rows = at.shape[1]
        return [np.broadcast_to(as_recorded(orders_of(jet)[0]), (rows,)) for jet in jets]

    def speeds(self, u: Floats) -> Floats:
        """Lengths along a curve by its parameter, at parameters (rows,)."""
        (first,) = self.derivatives(u, 1)
        found: Floats = np.sqrt(_dot(first, first))
        return found

    def derivatives(self, u: Floats, count: int) -> list[list[Floats]]:
        """Derivatives of a curve's coordinates x, y, z at parameters (rows,), first to `count`."""
        jets: list[Any]
        if self.knots:
            (at,) = self.wrapped((u,))
            jets = [curve.evaluate(at) for curve in self.knots]
        else:
            jets = self.jets((u,), (1.0,), self.numbers)
        return [
            [np.broadcast_to(as_recorded(jet[order]), u.shape) for jet in jets]
            for order in range(1, count + 1)
        ]

    def length_rate(self, order: int, at: Sequence[Floats]) -> Floats:
        """A derivative of the length along a curve by time, of order 1 to 3 (rows,); `at` are the
        parameter and its derivatives by time, to that order. With w = |c'|,

        s. = w u.,  s.. = w' u.^2 + w u..,  s... = w'' u.^3 + 3 w' u. u.. + w u...,
        w' = c'.c''/w,  w'' = (c''.c'' + c'.c''' - w'^2)/w;

        not finite where the curve stands still.

        Raises:
            TypeError: the parameters are no doubles.
        """
        if not isinstance(at[0], np.ndarray):
            raise TypeError("rates of lengths along a curve")
        by_u = self.derivatives(at[0], order)
        speed: Floats = np.sqrt(_dot(by_u[0], by_u[0]))
        rate = at[1]
        if order == 1:
            return speed * rate
        slope = _dot(by_u[0], by_u[1]) / speed
        if order == 2:
            return slope * (rate * rate) + speed * at[2]
        bend = (_dot(by_u[1], by_u[1]) + _dot(by_u[0], by_u[2]) - slope * slope) / speed
        return bend * (rate * rate * rate) + 3.0 * slope * (rate * at[2]) + speed * at[3]

    def lengths(self, u: Floats) -> Floats:
        """Lengths (m) along a curve to parameters (rows,), from where it is zero, or else from the
        begin.

        Raises:
            TypeError: the parameters are no doubles.
        """
        if not isinstance(u, np.ndarray):
            raise TypeError("lengths along a curve")
        ((low, high),) = self.ends
        edges = self._pieces()
        pieces = [self._length(a[None], b[None]) for a, b in pairwise(edges)]
        totals = [np.zeros(1)]
        for piece in pieces:
            totals.append(totals[-1] + piece)
        sums = np.concatenate(totals)

        def from_begin(at: Floats) -> Floats:
            (inside,) = self.wrapped((at,))
            piece = np.clip(np.searchsorted(edges, inside, side="right") - 1, 0, len(pieces) - 1)
            turns = np.rint((at - inside) / (high - low)) if self.closed[0] else 0.0
            length: Floats = turns * sums[-1] + sums[piece] + self._length(edges[piece], inside)
            return length

        start = np.array([0.0 if low < 0.0 < high else low])
        found: Floats = from_begin(u) - from_begin(start)
        return found

    def _pieces(self) -> Floats:
        """Ends of the pieces that lengths are summed over."""
        ((low, high),) = self.ends
        if not self.knots:
            return np.linspace(low, high, _PIECES + 1)
        inside = [x for x in self.knots[0].x.tolist() if low <= x <= high]
        halves = [
            (a, a + 0.25 * (b - a), 0.5 * (a + b), b - 0.25 * (b - a)) for a, b in pairwise(inside)
        ]
        return np.array([*(x for some in halves for x in some), inside[-1]])

    def _length(self, begin: Floats, end: Floats) -> Floats:
        """By the quadrature of Gauss."""
        half, middle = 0.5 * (end - begin), 0.5 * (begin + end)
        total = np.zeros_like(half)
        for node, weight in _GAUSS:
            total = total + weight * self.speeds(middle - node * half)
            total = total + weight * self.speeds(middle + node * half)
        return half * total

    def nearest(self, point: Vector) -> tuple[float, ...]:
        """The parameters between the ends of the place that is nearest to a point."""
        grids = [np.linspace(low, high, _SAMPLES[len(self.ends)]) for low, high in self.ends]
        starts = np.stack(np.meshgrid(*grids, indexing="ij")).reshape(len(grids), -1)
        x, y, z = (found - x for found, x in zip(self.places_at(starts), point, strict=True))
        off = x * x + y * y + z * z
        first = int(np.argmin(np.where(np.isnan(off), inf, off)))
        at = tuple(starts[:, first].tolist())
        least = _square(subtract(self.place(at), point))
        for _ in range(_STEPS):
            step = self._towards(at, point)
            moved = tuple(
                min(max(x + dx, low), high) if bounded else x + dx
                for x, dx, (low, high), bounded in zip(
                    at, step, self.ends, self.bounded, strict=True
                )
            )
            now = _square(subtract(self.place(moved), point))
            if not now < least:
                break
            at, least = moved, now
        return at

    def _towards(self, at: tuple[float, ...], point: Vector) -> tuple[float, ...]:
        """A step of Gauss and Newton towards a point."""
        miss, slopes = subtract(point, self.place(at)), self.slopes(at)
        right = [dot(slope, miss) for slope in slopes]
        squares = [_square(slope) for slope in slopes]
        if len(slopes) == 1:
            return (right[0] / squares[0],) if squares[0] > 0.0 else (0.0,)
        mixed = dot(*slopes)
        size = squares[0] * squares[1] - mixed * mixed
        if not size > 0.0:
            return (0.0, 0.0)
        return (
            (right[0] * squares[1] - right[1] * mixed) / size,
            (right[1] * squares[0] - right[0] * mixed) / size,
        )


_PIECES = 64
_GAUSS = (
    (0.1834346424956498, 0.3626837833783620),
    (0.5255324099163290, 0.3137066458778873),
    (0.7966664774136267, 0.2223810344533745),
    (0.9602898564975363, 0.1012285362903763),
)
"""Nodes and weights of eight points, both signs of each (Abramowitz and Stegun, table 25.4)."""

_SAMPLES = {1: 721, 2: 61}
_STEPS = 60


def _square(vector: Vector) -> float:
    return dot(vector, vector)


def _number(value: Any) -> Any:
    """A number of one row as a float; a recorded one as it is."""
    return float(value) if isinstance(value, np.ndarray | np.floating | int) else value


def _derivatives_of_one(jets: Sequence[Sequence[Any]]) -> tuple[list[Any], ...]:
    """From orders of each coordinate to the coordinates of each order."""
    return tuple([jet[order] for jet in jets] for order in range(4))


def _derivatives_of_two(lines: Sequence[Sequence[Sequence[Any]]]) -> tuple[list[Any], ...]:
    """From expansions along u, v, u + v and u - v."""
    u, v, plus, minus = lines

    def each(of: Callable[[Any, Any, Any, Any], Any], order: int) -> list[Any]:
        rows = zip(u, v, plus, minus, strict=True)
        return [of(*(jet[order] for jet in row)) for row in rows]

    second = [
        *each(lambda a, b, p, m: a, 2),
        *each(lambda a, b, p, m: 0.25 * (p - m), 2),
        *each(lambda a, b, p, m: b, 2),
    ]
    third = [
        *each(lambda a, b, p, m: a, 3),
        *each(lambda a, b, p, m: ((p - m) - 2.0 * b) / 6.0, 3),
        *each(lambda a, b, p, m: ((p + m) - 2.0 * a) / 6.0, 3),
        *each(lambda a, b, p, m: b, 3),
    ]
    first = [*each(lambda a, b, p, m: a, 1), *each(lambda a, b, p, m: b, 1)]
    return each(lambda a, b, p, m: a, 0), first, second, third


def _dot(a: Sequence[Floats], b: Sequence[Floats]) -> Floats:
    """The products of rows of vectors."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
