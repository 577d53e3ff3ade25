"""The energy of a bushing as its definition says, at 40 digits, with the rotation vector from the
quaternion of the relative pose; what acts along coordinates is its numerical gradient."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from mpmath import MPContext

mp = MPContext()
mp.dps = 40

POSE = ("x", "y", "z", "rz", "ry", "rx")
"""Coordinates of a pair F, in the order in which they move."""

Matrix = Any


def turned(pose: Mapping[str, Any]) -> Matrix:
    """The rotation by rz about z, then ry about the y and rx about the x that turn with it."""
    (cz, sz), (cy, sy), (cx, sx) = (
        (mp.cos(pose[name]), mp.sin(pose[name])) for name in ("rz", "ry", "rx")
    )
    about_z = mp.matrix([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    about_y = mp.matrix([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_x = mp.matrix([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    return about_z * about_y * about_x


def rotation_vector(r: Matrix) -> Matrix:
    """Of a rotation by less than half a turn."""
    w = mp.sqrt(1 + r[0, 0] + r[1, 1] + r[2, 2]) / 2
    v = mp.matrix([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / (4 * w)
    sine = mp.norm(v)
    return v * (2 * mp.asin(sine) / sine if sine else 2)


class Bushing:
    """Between ground and a body whose pose is that of an F at the origin, in SI and rad."""

    def __init__(
        self,
        point: Sequence[float],
        axes: Matrix,
        matrix: Sequence[Sequence[float]],
        free: Sequence[float] = (0.0,) * 6,
    ) -> None:
        self.point, self.axes = mp.matrix(point), axes
        self.matrix, self.free = mp.matrix(matrix), mp.matrix(free)

    def deflection(self, pose: Mapping[str, Any]) -> Matrix:
        """Shift and rotation vector in its axes."""
        r = turned(pose)
        place = r * self.point + mp.matrix([pose["x"], pose["y"], pose["z"]])
        shift = self.axes.T * (place - self.point)
        turn = rotation_vector(self.axes.T * r * self.axes)
        return mp.matrix([*shift, *turn])

    def energy(self, pose: Mapping[str, Any]) -> Any:
        """Half the stiffness times the square of the deflection from where it is free."""
        e = self.deflection(pose) - self.free
        return (e.T * self.matrix * e)[0] / 2


def slope(energy: Callable[[Mapping[str, Any]], Any], pose: Mapping[str, Any], name: str) -> Any:
    """The derivative by a coordinate, by central differences of fourth order at 40 digits."""
    h = mp.mpf(10) ** -8

    def at(step: int) -> Any:
        return energy({**pose, name: pose[name] + step * h})

    return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)
