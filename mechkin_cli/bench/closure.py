"""Places of the bodies of a chain and the gaps of its closings, in numbers of any kind.

`Entries` has frames as nested lists whose entries are anything that adds and multiplies: arrays
over the rows, jets, symbols. `Matrices` has them as 4x4 arrays of doubles, for one row at a time.
A `Jet` is a number with two derivatives by one parameter, f + f' t + f'' t^2/2, truncated: a
formula that is evaluated on jets gives its derivatives along a direction without one of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import cos, sin
from typing import Any, Protocol

import numpy as np

from mechkin_cli.bench.chain import (
    GROUND,
    BodyTree,
    CommonFrame,
    CommonPoint,
    Distance,
    Place,
    TreeDisplacement,
)
from mechkin_cli.mechanism import Frame

Turned = Mapping[int, Any]
"""The orientation (3, 3) from which each ball counts its three turns, by its first coordinate."""


class Algebra(Protocol):
    """What placing needs of frames."""

    def frame(self, frame: Frame) -> Any:
        """A constant frame."""

    def inverse(self, frame: Any) -> Any:
        """From the frame back."""

    def product(self, a: Any, b: Any) -> Any:
        """One after the other."""

    def screwed(self, a: Any, angle: Any, slide: Any) -> Any:
        """Turned about its z and moved along it; None for neither."""

    def turned(self, a: Any, about: int, angle: Any) -> Any:
        """Turned about its axis x (0), y (1) or z (2)."""

    def oriented(self, a: Any, orientation: Any) -> Any:
        """Turned by a matrix."""

    def image(self, a: Any, place: Place) -> Sequence[Any]:
        """Where it takes a point."""

    def apart(self, a: Any, b: Any) -> Sequence[Any]:
        """The displacement between two frames that nearly coincide: three turns, three lengths."""


class Placing:
    """A chain in an algebra: its constant frames multiplied once."""

    def __init__(self, chain: BodyTree, algebra: Algebra) -> None:
        self.chain, self.algebra = chain, algebra
        self._frames: dict[Frame, tuple[Any, Any]] = {}

    def _constant(self, frame: Frame) -> tuple[Any, Any]:
        if frame not in self._frames:
            there = self.algebra.frame(frame)
            self._frames[frame] = there, self.algebra.inverse(there)
        return self._frames[frame]

    def places(self, q: Any, turned: Turned) -> list[Any]:
        """Displacements of all bodies from the drawing; None of those that hang."""
        found: list[Any] = []
        for body in self.chain.bodies:
            if body is None:
                found.append(None)
                continue
            parent = None if body.parent == GROUND else found[body.parent]
            frame = self._moved(parent, body.by, q, turned)
            found.append(self.algebra.product(frame, self._constant(body.by.after)[1]))
        return found

    def _moved(self, parent: Any, by: TreeDisplacement, q: Any, turned: Turned) -> Any:
        """The frame behind a displacement."""
        before, algebra = self._constant(by.before)[0], self.algebra
        frame = before if parent is None else algebra.product(parent, before)
        k = by.first
        if by.kind == "R":
            return algebra.screwed(frame, q[k], None)
        if by.kind == "P":
            return algebra.screwed(frame, None, q[k])
        if by.kind == "H":
            return algebra.screwed(frame, q[k], by.pitch * q[k])
        if by.kind == "C":
            return algebra.screwed(frame, q[k], q[k + 1])
        if by.kind == "S":
            frame = algebra.oriented(frame, turned[k]) if k in turned else frame
            for about in range(3):
                frame = algebra.turned(frame, about, q[k + about])
        return frame

    def gaps(self, places: Sequence[Any], q: Any, turned: Turned) -> list[Any]:
        """All closing equations, turns in rad and lengths in m."""
        found: list[Any] = []
        for closing in self.chain.closings:
            if isinstance(closing, CommonFrame):
                found += self._frame_gap(closing, places, q, turned)
                continue
            ends = zip(
                (closing.first, closing.second),
                (closing.on_first, closing.on_second),
                strict=True,
            )
            one, two = (self.image(places, body, at) for body, at in ends)
            apart = [a - b for a, b in zip(one, two, strict=True)]
            if isinstance(closing, CommonPoint):
                found += apart
            else:
                found.append(_distance_gap(closing, apart, q))
        return found

    def image(self, places: Sequence[Any], body: int, at: Place) -> Sequence[Any]:
        """Where a point of a body is now."""
        return at if body == GROUND else self.algebra.image(places[body], at)

    def _frame_gap(
        self, closing: CommonFrame, places: Sequence[Any], q: Any, turned: Turned
    ) -> list[Any]:
        one = None if closing.first == GROUND else places[closing.first]
        last = closing.chain[-1]
        for by in closing.chain:
            one = self._moved(one, by, q, turned)
            if by is not last:
                one = self.algebra.product(one, self._constant(by.after)[1])
        two = self._constant(last.after)[0]
        if closing.second != GROUND:
            two = self.algebra.product(places[closing.second], two)
        return list(self.algebra.apart(one, two))


def _distance_gap(closing: Distance, apart: Sequence[Any], q: Any) -> Any:
    """(d^2 - l^2)/(2 l) of the lengths as drawn: the difference of the lengths, smooth at zero."""
    x, y, z = apart
    wanted = (
        closing.length
        if closing.slide is None
        else closing.length + closing.sign * q[closing.slide]
    )
    return (x * x + y * y + z * z - wanted * wanted) * (0.5 / closing.length)


class Entries:
    """Frames as three rows of four entries; `number` makes an entry of a double."""

    def __init__(
        self,
        cos: Callable[[Any], Any],
        sin: Callable[[Any], Any],
        number: Callable[[float], Any] = float,
    ) -> None:
        self.cos, self.sin, self.number = cos, sin, number

    def frame(self, frame: Frame) -> Any:
        """See `Algebra`."""
        columns = (frame.x, frame.y, frame.z, frame.o)
        return [[self.number(column[i]) for column in columns] for i in range(3)]

    def inverse(self, frame: Any) -> Any:
        """See `Algebra`."""
        turned = [[frame[j][i] for j in range(3)] for i in range(3)]
        return [[*row, -sum(row[k] * frame[k][3] for k in range(3))] for row in turned]

    def product(self, a: Any, b: Any) -> Any:
        """See `Algebra`."""
        return [
            [
                *(row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j] for j in range(3)),
                row[0] * b[0][3] + row[1] * b[1][3] + row[2] * b[2][3] + row[3],
            ]
            for row in a
        ]

    def screwed(self, a: Any, angle: Any, slide: Any) -> Any:
        """See `Algebra`."""
        if slide is not None:
            a = [[x, y, z, o + z * slide] for x, y, z, o in a]
        return a if angle is None else self.turned(a, 2, angle)

    def turned(self, a: Any, about: int, angle: Any) -> Any:
        """See `Algebra`."""
        c, s = self.cos(angle), self.sin(angle)
        i, j = (about + 1) % 3, (about + 2) % 3
        found = [list(row) for row in a]
        for row, old in zip(found, a, strict=True):
            row[i], row[j] = old[i] * c + old[j] * s, old[j] * c - old[i] * s
        return found

    def oriented(self, a: Any, orientation: Any) -> Any:
        """See `Algebra`."""
        return self.product(a, [[*row, 0.0] for row in orientation])

    def image(self, a: Any, place: Place) -> Sequence[Any]:
        """See `Algebra`."""
        x, y, z = place
        return [row[0] * x + row[1] * y + row[2] * z + row[3] for row in a]

    def apart(self, a: Any, b: Any) -> Sequence[Any]:
        """See `Algebra`."""
        turns = []
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            # half the sum of the axes' vector products
            turns.append(sum(b[j][n] * a[k][n] - b[k][n] * a[j][n] for n in range(3)) * 0.5)
        return [*turns, *(a[i][3] - b[i][3] for i in range(3))]


class Matrices:
    """Frames as 4x4 arrays, as a script has them."""

    def frame(self, frame: Frame) -> Any:
        """See `Algebra`."""
        found = np.eye(4)
        found[:3] = np.column_stack([frame.x, frame.y, frame.z, frame.o])
        return found

    def inverse(self, frame: Any) -> Any:
        """See `Algebra`."""
        return np.linalg.inv(frame)

    def product(self, a: Any, b: Any) -> Any:
        """See `Algebra`."""
        return a @ b

    def screwed(self, a: Any, angle: Any, slide: Any) -> Any:
        """See `Algebra`."""
        m = np.eye(4)
        if angle is not None:
            m[0, 0] = m[1, 1] = cos(angle)
            m[1, 0] = sin(angle)
            m[0, 1] = -m[1, 0]
        if slide is not None:
            m[2, 3] = slide
        return a @ m

    def turned(self, a: Any, about: int, angle: Any) -> Any:
        """See `Algebra`."""
        i, j = (about + 1) % 3, (about + 2) % 3
        m = np.eye(4)
        m[i, i] = m[j, j] = cos(angle)
        m[j, i] = sin(angle)
        m[i, j] = -m[j, i]
        return a @ m

    def oriented(self, a: Any, orientation: Any) -> Any:
        """See `Algebra`."""
        m = np.eye(4)
        m[:3, :3] = orientation
        return a @ m

    def image(self, a: Any, place: Place) -> Sequence[Any]:
        """See `Algebra`."""
        found: Sequence[Any] = a[:3, :3] @ place + a[:3, 3]
        return found

    def apart(self, a: Any, b: Any) -> Sequence[Any]:
        """See `Algebra`."""
        m = b[:3, :3] @ a[:3, :3].T
        turns = (m[1, 2] - m[2, 1], m[2, 0] - m[0, 2], m[0, 1] - m[1, 0])
        return [*(0.5 * x for x in turns), *(a[:3, 3] - b[:3, 3])]


class Jet:
    """A value with its first and second derivative."""

    __array_ufunc__ = None
    """Arrays leave their operators to the jet."""

    def __init__(self, value: Any, first: Any = 0.0, second: Any = 0.0) -> None:
        self.value, self.first, self.second = value, first, second

    def __add__(self, other: Any) -> Jet:
        o = jet(other)
        return Jet(self.value + o.value, self.first + o.first, self.second + o.second)

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.first, -self.second)

    def __sub__(self, other: Any) -> Jet:
        return self + -jet(other)

    def __rsub__(self, other: Any) -> Jet:
        return jet(other) - self

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.value * other, self.first * other, self.second * other)
        crossed = self.first * other.first
        return Jet(
            self.value * other.value,
            self.first * other.value + self.value * other.first,
            self.second * other.value + crossed + crossed + self.value * other.second,
        )

    __radd__ = __add__
    __rmul__ = __mul__

    def outer(self, value: Any, slope: Any, bend: Any) -> Jet:
        """f(self), with f, f' and f'' at its value."""
        return Jet(value, slope * self.first, slope * self.second + bend * self.first * self.first)


def jet(value: Any) -> Jet:
    """A number as a jet, a constant if it is none."""
    return value if isinstance(value, Jet) else Jet(value)
