"""The joint types as a textbook has them, at 40 digits: freedom screws and finite displacements.

A pair's frame has z as its axis. A local screw (angular, linear) stands at the frame's origin;
displacements are 4 x 4 matrices, products of exponentials of the screws (Murray, Li and Sastry
1994, chapter 2). Coordinates are found back from a displacement by elementary geometry.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from mpmath import mp

mp.dps = 40

Matrix = Any
State = Sequence[Any]

X, Y, Z, O = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)  # noqa: E741
PITCH = 0.375
"""Slide per radian of the helical pairs under test."""


def twist_matrix(angular: Sequence[Any], linear: Sequence[Any]) -> Matrix:
    """The 4 x 4 matrix of a twist."""
    a, b, c = angular
    u, v, w = linear
    return mp.matrix([[0, -c, b, u], [c, 0, -a, v], [-b, a, 0, w], [0, 0, 0, 0]])


def exponential(angular: Sequence[Any], linear: Sequence[Any], by: Any = 1) -> Matrix:
    """The displacement along a screw."""
    return mp.expm(twist_matrix(angular, linear) * mp.mpf(by))


def vector(m: Matrix, column: int) -> list[Any]:
    """A column of a pose: axis 0, 1, 2 or the origin, 3."""
    return [m[i, column] for i in range(3)]


def quaternion_rotation(q: State) -> Matrix:
    """The rotation of a unit quaternion, scalar first, as an exponential."""
    sine = mp.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    angle = 2 * mp.atan2(sine, q[0])
    axis = [c / sine for c in q[1:]] if sine else list(Z)
    return exponential(axis, O, angle)


def rotation_only(m: Matrix) -> Matrix:
    turned = m.copy()
    turned[0, 3] = turned[1, 3] = turned[2, 3] = 0
    return turned


def angle_about_z(m: Matrix) -> Any:
    return mp.atan2(m[1, 0], m[0, 0])


@dataclass(frozen=True)
class Pair:
    """A joint type.

    `screws` are its freedoms in the frame that does not move; `nearest` is the displacement of the
    pair that comes nearest to any displacement: equal to it exactly where the pair is closed.
    """

    screws: tuple[tuple[Sequence[Any], Sequence[Any]], ...]
    nearest: Callable[[Matrix], Matrix]
    quaternion: bool = False

    def displacement(self, state: State) -> Matrix:
        """Displacement of the second side against the first."""
        if self.quaternion:
            return quaternion_rotation(state)
        moved = mp.eye(4)
        for (angular, linear), value in zip(self.screws, state, strict=True):
            moved = moved * exponential(angular, linear, value)
        return moved

    def moving(self, state: State, first: State, second: State, time: Any) -> Matrix:
        """The displacement at a time, from states and the two derivatives of the freedoms at 0."""
        if not self.quaternion:
            return self.displacement(
                [
                    q + v * time + a * time**2 / 2
                    for q, v, a in zip(state, first, second, strict=True)
                ]
            )
        turn = [v * time + a * time**2 / 2 for v, a in zip(first, second, strict=True)]
        return exponential(turn, O) * self.displacement(state)


PAIRS = {
    "R": Pair(((Z, O),), lambda m: exponential(Z, O, angle_about_z(m))),
    "P": Pair(((O, Z),), lambda m: exponential(O, Z, m[2, 3])),
    "H": Pair(((Z, (0, 0, PITCH)),), lambda m: exponential(Z, (0, 0, PITCH), angle_about_z(m))),
    "C": Pair(
        ((Z, O), (O, Z)),
        lambda m: exponential(Z, O, angle_about_z(m)) * exponential(O, Z, m[2, 3]),
    ),
    "S": Pair(((X, O), (Y, O), (Z, O)), rotation_only, quaternion=True),
}


def derivative(path: Callable[[Any], Any], order: int) -> Any:
    """Derivative at time 0 by central differences, good to about 20 digits."""
    h = mp.mpf("1e-10")
    if order == 1:
        return (path(h) - path(-h)) / (2 * h)
    return (path(h) - 2 * path(mp.mpf(0)) + path(-h)) / h**2
