"""Vectors of three floats as tuples, in a fixed order of operations so that bits are the same
everywhere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli import tolerances
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import by_rounding, either, largest, nonzero, square_root
from mechkin_cli.tolerances import UNIT_SQUARE

if TYPE_CHECKING:
    from collections.abc import Sequence

Vector = tuple[float, float, float]

ZERO: Vector = (0.0, 0.0, 0.0)


def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(s: float, a: Vector) -> Vector:
    """s a."""
    return (s * a[0], s * a[1], s * a[2])


def dot(a: Vector, b: Vector) -> float:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a: Vector) -> float:
    """Length of a; scaled first, so that neither tiny nor huge vectors lose it."""
    longest = largest(abs(a[0]), abs(a[1]), abs(a[2]))
    b = scale(1.0 / nonzero(longest), a)
    length: float = longest * square_root(dot(b, b))
    return length


def unit(a: Vector) -> Vector:
    """a / |a|; a vector that is a unit vector to rounding comes back unchanged.

    Raises:
        ZeroDivisionError: a is zero.
    """
    square = dot(a, a)
    as_given = by_rounding(abs(square - 1.0) <= UNIT_SQUARE)
    return either(as_given, lambda: a, lambda: _shortened(a))


def _shortened(a: Vector) -> Vector:
    longest = largest(abs(a[0]), abs(a[1]), abs(a[2]))
    b = (a[0] / longest, a[1] / longest, a[2] / longest)
    length = square_root(dot(b, b))
    return (b[0] / length, b[1] / length, b[2] / length)


# Right-handed orthonormal frames: three axes and an origin, in ground axes of the home drawing.


class Frame(NamedTuple):
    """Axes x, y, z and origin o."""

    x: Vector
    y: Vector
    z: Vector
    o: Vector

    def components(self, vector: Vector) -> Vector:
        """Components of a vector along the frame's axes."""
        # three dot products, written out: plans take them by the hundred
        (a, b, c), (d, e, f), (g, h, i), (x, y, z) = self.x, self.y, self.z, vector
        return (a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z)

    def vector(self, components: Vector) -> Vector:
        """The vector that has these components along the frame's axes."""
        a, b, c = components
        return add(add(scale(a, self.x), scale(b, self.y)), scale(c, self.z))

    def carry(self, inner: Frame) -> Frame:
        """A frame given in this one, in ground axes."""
        x, y, z = (self.vector(axis) for axis in (inner.x, inner.y, inner.z))
        return Frame(x, y, z, add(self.vector(inner.o), self.o))

    def local(self, point: Vector) -> Vector:
        """Coordinates of a point in the frame."""
        return self.components(subtract(point, self.o))

    def of(self, inner: Frame) -> Frame:
        """A frame given in ground axes, expressed in this one."""
        return Frame(
            self.components(inner.x),
            self.components(inner.y),
            self.components(inner.z),
            self.local(inner.o),
        )

    def flipped(self) -> Frame:
        """The same frame turned half a turn about x: z reversed."""
        return Frame(self.x, scale(-1.0, self.y), scale(-1.0, self.z), self.o)


GROUND: Frame = Frame((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), ZERO)


def upright(point: Vector) -> Frame:
    """The frame along the ground's axes with its origin at a point."""
    return Frame(GROUND.x, GROUND.y, GROUND.z, point)


def perpendicular(z: Vector) -> Vector:
    """A unit vector square to the unit vector z: from the ground axis that is farthest from z."""
    found = (*GROUND.x, abs(z[0]))
    for axis, component in ((GROUND.y, z[1]), (GROUND.z, z[2])):
        # of equal components the first; no guard, since parameters move axes past each other
        found = _axis_if(abs(component) < found[3], (*axis, abs(component)), found)
    return unit(cross((found[0], found[1], found[2]), z))


_AxisAndSize = tuple[float, float, float, float]


def _axis_if(condition: bool, chosen: _AxisAndSize, other: _AxisAndSize) -> _AxisAndSize:
    x, y, z, size = either(condition, lambda: chosen, lambda: other)
    return (x, y, z, size)


def frame_about(z: Vector, x: Vector, o: Vector) -> Frame:
    """The frame with axis z whose x is the projection of `x` square to z.

    Raises:
        ZeroDivisionError: x is parallel to z.
    """
    square = unit(subtract(x, scale(dot(x, z), z)))
    return Frame(square, cross(z, square), z, o)


def turned_shortest(a: Vector, b: Vector, vector: Vector) -> Vector:
    """`vector` turned by the shortest rotation that carries the unit vector a onto b.

    Rodrigues' formula with axis a x b; for opposite a and b the half turn about `perpendicular(a)`.
    """
    axis, cosine = cross(a, b), dot(a, b)
    if cosine <= tolerances.OPPOSITE_COSINE:
        p = perpendicular(a)
        return subtract(scale(2.0 * dot(p, vector), p), vector)
    # 1 / (1 + cosine), from |axis|^2 = (1 + cosine)(1 - cosine) where 1 + cosine cancels
    inverse = (1.0 - cosine) / dot(axis, axis) if cosine < 0.0 else 1.0 / (1.0 + cosine)
    along = scale(dot(axis, vector) * inverse, axis)
    return add(add(scale(cosine, vector), cross(axis, vector)), along)


def turned_tensor(tensor: tuple[float, ...], frame: Frame) -> tuple[float, ...]:
    """A tensor in ground axes expressed in a frame's axes: xx, yy, zz, xy, xz, yz."""
    xx, yy, zz, xy, xz, yz = tensor

    def times(a: Vector) -> Vector:
        return (
            xx * a[0] + xy * a[1] + xz * a[2],
            xy * a[0] + yy * a[1] + yz * a[2],
            xz * a[0] + yz * a[1] + zz * a[2],
        )

    x, y, z = (frame.components(times(axis)) for axis in (frame.x, frame.y, frame.z))
    return (x[0], y[1], z[2], y[0], z[0], z[1])


def eliminated(
    matrix: Sequence[Sequence[float]], right: Sequence[float], least_pivot: float
) -> list[float] | None:
    """The solution of a square system by elimination with row pivots; None where a pivot of the
    equations, scaled to a largest coefficient of 1, is not above `least_pivot`."""
    size = len(right)
    rows = []
    for coefficients, number in zip(matrix, right, strict=True):
        most = max((abs(value) for value in coefficients), default=0.0) or 1.0
        rows.append([value / most for value in (*coefficients, number)])
    for k in range(size):
        pivot = max(range(k, size), key=lambda i: abs(rows[i][k]))
        if not abs(rows[pivot][k]) > least_pivot:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            if factor:
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    values = [0.0] * size
    for k in reversed(range(size)):
        rest = rows[k][size]
        for j in range(k + 1, size):
            rest -= rows[k][j] * values[j]
        values[k] = rest / rows[k][k]
    return values


class Line(NamedTuple):
    """A line that a link carries, on its drawing: unit vector, and a point in m. Without a vector
    it is every line through the point."""

    along: Vector | None
    start: Vector

    def distance(self, point: Vector) -> float:
        """How far a point lies off it, m."""
        way = subtract(point, self.start)
        return norm(way if self.along is None else cross(way, self.along))
