"""Places of a chain's bodies and the gaps of its closings, in numbers of any kind."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

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


class Entries:
    """Frames as three rows of four entries, which are floats, arrays over rows, jets or symbols.

    Args:
        cos, sin: of an entry.
        number: makes an entry of a float.
    """

    def __init__(
        self,
        cos: Callable[[Any], Any],
        sin: Callable[[Any], Any],
        number: Callable[[float], Any] = float,
    ) -> None:
        self.cos, self.sin, self.number = cos, sin, number

    def frame(self, frame: Frame) -> Any:
        """A constant frame."""
        columns = (frame.x, frame.y, frame.z, frame.o)
        return [[self.number(column[i]) for column in columns] for i in range(3)]

    def inverse(self, frame: Any) -> Any:
        """The inverse displacement."""
        turned = [[frame[j][i] for j in range(3)] for i in range(3)]
        return [[*row, -sum(row[k] * frame[k][3] for k in range(3))] for row in turned]

    def product(self, a: Any, b: Any) -> Any:
        """The product of two displacements."""
        return [
            [
                *(row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j] for j in range(3)),
                row[0] * b[0][3] + row[1] * b[1][3] + row[2] * b[2][3] + row[3],
            ]
            for row in a
        ]

    def screwed(self, a: Any, angle: Any, slide: Any) -> Any:
        """The frame turned about its z axis and moved along it; None for neither."""
        if slide is not None:
            a = [[x, y, z, o + z * slide] for x, y, z, o in a]
        return a if angle is None else self.turned(a, 2, angle)

    def turned(self, a: Any, about: int, angle: Any) -> Any:
        """The frame turned about its axis x (0), y (1) or z (2)."""
        c, s = self.cos(angle), self.sin(angle)
        i, j = (about + 1) % 3, (about + 2) % 3
        found = [list(row) for row in a]
        for row, old in zip(found, a, strict=True):
            row[i], row[j] = old[i] * c + old[j] * s, old[j] * c - old[i] * s
        return found

    def oriented(self, a: Any, orientation: Any) -> Any:
        """The frame turned by a matrix (3, 3)."""
        return self.product(a, [[*row, 0.0] for row in orientation])

    def image(self, a: Any, place: Place) -> Sequence[Any]:
        """The image of a point."""
        x, y, z = place
        return [row[0] * x + row[1] * y + row[2] * z + row[3] for row in a]

    def apart(self, a: Any, b: Any) -> Sequence[Any]:
        """From one frame to another that nearly coincides with it: three turns, three lengths."""
        turns = []
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            # half the sum of the axes' vector products
            turns.append(sum(b[j][n] * a[k][n] - b[k][n] * a[j][n] for n in range(3)) * 0.5)
        return [*turns, *(a[i][3] - b[i][3] for i in range(3))]


class Placing:
    """A chain in an algebra: its constant frames multiplied once."""

    def __init__(self, chain: BodyTree, algebra: Entries) -> None:
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
