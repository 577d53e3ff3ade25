"""The joint types as a textbook has them, at 40 digits: freedom screws and finite displacements.

A pair displaces the frame on its second link against the frame on its first: a chain of elementary
displacements, each with z as its axis. Displacements are 4 x 4 matrices, products of exponentials
of screws (angular, linear) at a frame's origin (Murray, Li and Sastry 1994, chapter 2).
Coordinates are found back from a displacement by elementary geometry.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from mpmath import mp

mp.dps = 40

Matrix = Any
State = Sequence[Any]

X, Y, Z, O = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)  # noqa: E741
PITCH = 0.375
"""Slide per radian of the helical pairs under test."""
COSINE = 0.28125
"""Cosine of the angle between the axes of the universal joint, and between the axis and the pin of
the slotted cylinder, under test."""


def twist_matrix(angular: Sequence[Any], linear: Sequence[Any]) -> Matrix:
    """The 4 x 4 matrix of a twist."""
    a, b, c = angular
    u, v, w = linear
    return mp.matrix([[0, -c, b, u], [c, 0, -a, v], [-b, a, 0, w], [0, 0, 0, 0]])


def exponential(angular: Sequence[Any], linear: Sequence[Any], by: Any = 1) -> Matrix:
    """The displacement along a screw: the exponential of its twist, summed (there (2.36))."""
    w, v = ([mp.mpf(by) * c for c in part] for part in (angular, linear))
    size = mp.sqrt(sum(c * c for c in w))
    if not size:
        return mp.matrix([[1, 0, 0, v[0]], [0, 1, 0, v[1]], [0, 0, 1, v[2]], [0, 0, 0, 1]])
    half_cosine, half_sine = mp.cos_sin(size / 2)
    sine, versed = 2 * half_sine * half_cosine, 2 * half_sine**2
    x, y, z = u = [c / size for c in w]
    across = [y * v[2] - z * v[1], z * v[0] - x * v[2], x * v[1] - y * v[0]]
    along, part = sum(a * b for a, b in zip(u, v, strict=True)), sine / size
    skew = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    rows = [
        [
            *(
                (1 - versed if i == j else 0) + versed * u[i] * u[j] + sine * skew[i][j]
                for j in range(3)
            ),
            part * v[i] + versed / size * across[i] + (1 - part) * along * u[i],
        ]
        for i in range(3)
    ]
    return mp.matrix([*rows, [0, 0, 0, 1]])


def vector(m: Matrix, column: int) -> list[Any]:
    """A column of a pose: axis 0, 1, 2 or the origin, 3."""
    return [m[i, column] for i in range(3)]


def quaternion_rotation(q: State) -> Matrix:
    """The rotation of a unit quaternion, scalar first, as an exponential."""
    sine = mp.sqrt(q[1] ** 2 + q[2] ** 2 + q[3] ** 2)
    angle = 2 * mp.atan2(sine, q[0])
    axis = [c / sine for c in q[1:]] if sine else list(Z)
    return exponential(axis, O, angle)


@dataclass(frozen=True)
class Elementary:
    """A displacement about its own frame by screws that do not move; the state is one number per
    screw, or a quaternion."""

    screws: tuple[tuple[Sequence[Any], Sequence[Any]], ...]
    quaternion: bool = False

    @property
    def states(self) -> int:
        return len(self.screws) + self.quaternion

    def moving(self, state: State, first: State, second: State, time: Any) -> Matrix:
        """The displacement at a time, from states and the two derivatives of the freedoms at 0."""
        steps = [v * time + a * time**2 / 2 for v, a in zip(first, second, strict=True)]
        if self.quaternion:
            return exponential(steps, O) * quaternion_rotation(state)
        moved = mp.eye(4)
        for (angular, linear), q, step in zip(self.screws, state, steps, strict=True):
            moved = moved * exponential(angular, linear, q + step)
        return moved


ELEMENTARY = {
    "R": Elementary(((Z, O),)),
    "P": Elementary(((O, Z),)),
    "H": Elementary(((Z, (0, 0, PITCH)),)),
    "C": Elementary(((Z, O), (O, Z))),
    "S": Elementary(((X, O), (Y, O), (Z, O)), quaternion=True),
    "W": Elementary(()),
}


@dataclass(frozen=True)
class Pair:
    """A joint type.

    `chain`: elementary letters with their frames at home, seen from the first link's frame, where
    the second link's frame stands at `home`. `nearest` is the displacement of the pair that comes
    nearest to any displacement: equal to it exactly where the pair is closed. `coordinates`: name
    to freedom and value. `drives`: what works on a freedom and on no other, a force or not, its
    parts in the first frame and in the second; none where the state is no list of scalars.
    """

    chain: tuple[tuple[str, Matrix], ...]
    nearest: Callable[[Matrix], Matrix]
    coordinates: dict[str, tuple[int, Callable[[Matrix], Any]]] = field(default_factory=dict)
    home: Matrix = field(default_factory=lambda: mp.eye(4))
    point_on_first: bool = False
    parameter: float = 0.0
    drives: Sequence[tuple[bool, Sequence[Any], Sequence[Any]]] = ()

    @property
    def parts(self) -> tuple[Elementary, ...]:
        return tuple(ELEMENTARY[letter] for letter, _ in self.chain)

    @property
    def freedoms(self) -> int:
        return sum(len(part.screws) for part in self.parts)

    @property
    def states(self) -> int:
        return sum(part.states for part in self.parts)

    @property
    def slides(self) -> tuple[bool, ...]:
        """For each freedom, whether it has no rotation."""
        return tuple(not any(angular) for part in self.parts for angular, _ in part.screws)

    def random_state(self, generator: np.random.Generator) -> list[float]:
        state: list[float] = []
        for part in self.parts:
            own = generator.uniform(-1, 1, part.states)
            state += (own / np.linalg.norm(own) if part.quaternion else own).tolist()
        return state

    def displacement(self, state: State) -> Matrix:
        """Displacement of the second side against the first."""
        still = [0] * self.freedoms
        return self.moving(state, still, still, 0)

    def moving(self, state: State, first: State, second: State, time: Any) -> Matrix:
        """The displacement at a time, from states and the two derivatives of the freedoms at 0."""
        moved, s, f = mp.eye(4), 0, 0
        for (_, at), part in zip(self.chain, self.parts, strict=True):
            q, freedoms = state[s : s + part.states], slice(f, f + len(part.screws))
            own = part.moving(q, first[freedoms], second[freedoms], time)
            moved = moved * at * own * mp.inverse(at)
            s, f = s + part.states, f + len(part.screws)
        return moved * self.home

    def powers(self, state: State, force: State, moment: State) -> list[float]:
        """Power of a wrench on each freedom; force and moment about the joint's point (origin of
        the first frame if it rides there, else of the second), in axes of the first frame."""
        at = self.displacement(state)
        point = mp.matrix(O) if self.point_on_first else mp.matrix(vector(at, 3))
        found = []
        for freedom in range(self.freedoms):
            rates = [int(freedom == k) for k in range(self.freedoms)]
            rate = derivative(lambda t, r=rates: self.moving(state, r, [0] * len(r), t), 1)
            twist = rate * mp.inverse(at)
            speed = twist[:3, :3] * point + twist[:3, 3]
            turning = twist[2, 1], twist[0, 2], twist[1, 0]
            terms = [*zip(turning, moment, strict=True), *zip(speed, force, strict=True)]
            found.append(float(sum(a * mp.mpf(float(b)) for a, b in terms)))
        return found


def turned(axis: Sequence[Any], angle: Any) -> Matrix:
    return exponential(axis, O, angle)


def shifted(x: Any, y: Any, z: Any) -> Matrix:
    return exponential(O, (x, y, z))


def rotation_only(m: Matrix) -> Matrix:
    """The rotation of a displacement, about the first frame's origin."""
    return m * shifted(*(-c for c in from_second(m)))


def from_second(m: Matrix) -> list[Any]:
    """The second frame's origin against the first's, in axes of the second."""
    return list(m[:3, :3].T * m[:3, 3])


def along(m: Matrix, axis: Sequence[Any]) -> Any:
    """The second frame's origin against the first's, along an axis of the first."""
    return sum(m[i, 3] * c for i, c in enumerate(axis))


def angle_about_z(m: Matrix) -> Any:
    return mp.atan2(m[1, 0], m[0, 0])


def first_angle(m: Matrix) -> Any:
    """Euler's angles z x z: the turn about the first z ..."""
    return mp.atan2(m[0, 2], -m[1, 2])


def second_angle(m: Matrix) -> Any:
    """... and about the last."""
    return mp.atan2(m[2, 0], m[2, 1])


HERE = mp.eye(4)
ALONG_X = mp.matrix([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
"""The frame whose z is x, whose x is y: three of them in a row turn back to the first."""
ALONG_Y = ALONG_X * ALONG_X
OBLIQUE = turned(X, mp.acos(COSINE))
SQUARE = turned(X, mp.pi / 2)
SLOTTED = turned(Z, -mp.asin(COSINE)) * ALONG_X
"""The frame along the cylinder of Sc: its z lies in the slot's plane x y, and the pin is -y."""
CYLINDER = vector(SLOTTED, 2)
DUAL, CROSSED = 1 / (1 - COSINE**2), -COSINE / (1 - COSINE**2)
"""Dual basis of two oblique unit vectors: (a - (a.b) b) / (1 - (a.b)^2)."""
THETA, S = (0, angle_about_z), (0, lambda m: m[2, 3])

PAIRS = {
    "R": Pair(
        (("R", HERE),),
        lambda m: turned(Z, angle_about_z(m)),
        {"theta": THETA},
        drives=[(False, O, Z)],
    ),
    "P": Pair(
        (("P", HERE),),
        lambda m: shifted(0, 0, m[2, 3]),
        {"s": S},
        drives=[(True, O, Z)],
    ),
    "H": Pair(
        (("H", HERE),),
        lambda m: exponential(Z, (0, 0, PITCH), angle_about_z(m)),
        {"theta": THETA},
        drives=[(False, O, Z)],
    ),
    "C": Pair(
        (("C", HERE),),
        lambda m: turned(Z, angle_about_z(m)) * shifted(0, 0, m[2, 3]),
        {"theta": THETA, "s": (1, S[1])},
        drives=[(False, O, Z), (True, O, Z)],
    ),
    "S": Pair((("S", HERE),), rotation_only),
    "Sp": Pair(
        (("S", HERE), ("P", ALONG_X), ("P", ALONG_Y)),
        lambda m: rotation_only(m) * shifted(*from_second(m)[:2], 0),
        point_on_first=True,
    ),
    "Sg": Pair(
        (("S", HERE), ("P", turned(X, mp.pi))),
        lambda m: rotation_only(m) * shifted(0, 0, from_second(m)[2]),
        {"s": (3, lambda m: -from_second(m)[2])},
        point_on_first=True,
    ),
    "U": Pair(
        (("R", HERE), ("R", OBLIQUE)),
        lambda m: turned(Z, first_angle(m)) * OBLIQUE * turned(Z, second_angle(m)),
        {"theta1": (0, first_angle), "theta2": (1, second_angle)},
        home=OBLIQUE,
        parameter=COSINE,
        drives=[(False, (0, 0, DUAL), (0, 0, CROSSED)), (False, (0, 0, CROSSED), (0, 0, DUAL))],
    ),
    "E": Pair(
        (("P", ALONG_X), ("P", ALONG_Y), ("R", HERE)),
        lambda m: shifted(m[0, 3], m[1, 3], 0) * turned(Z, angle_about_z(m)),
        {"x": (0, lambda m: m[0, 3]), "y": (1, lambda m: m[1, 3]), "theta": (2, angle_about_z)},
        drives=[(True, X, O), (True, Y, O), (False, O, Z)],
    ),
    "Ss": Pair(
        (("R", HERE), ("R", SQUARE)),
        lambda m: turned(Z, first_angle(m)) * SQUARE * turned(Z, second_angle(m)),
        {"theta1": (0, first_angle), "theta2": (1, second_angle)},
        home=SQUARE,
        drives=[(False, Z, O), (False, O, Z)],
    ),
    "Sc": Pair(
        (("P", SLOTTED), ("R", HERE), ("R", SQUARE)),
        lambda m: (
            shifted(*(along(m, CYLINDER) * c for c in CYLINDER))
            * turned(Z, first_angle(m))
            * SQUARE
            * turned(Z, second_angle(m))
        ),
        {
            "s": (0, lambda m: along(m, CYLINDER)),
            "theta1": (1, first_angle),
            "theta2": (2, second_angle),
        },
        home=SQUARE,
        parameter=COSINE,
        drives=[(True, CYLINDER, O), (False, Z, O), (False, O, Z)],
    ),
    "Cp": Pair(
        (("R", HERE), ("R", SQUARE), ("P", SQUARE * ALONG_X), ("P", SQUARE * ALONG_Y)),
        lambda m: (
            turned(Z, first_angle(m))
            * SQUARE
            * turned(Z, second_angle(m))
            * shifted(*from_second(m)[:2], 0)
        ),
        {
            "theta1": (0, first_angle),
            "theta2": (1, second_angle),
            "x": (2, lambda m: from_second(m)[0]),
            "y": (3, lambda m: from_second(m)[1]),
        },
        home=SQUARE,
        point_on_first=True,
        drives=[(False, Z, O), (False, O, Z), (True, O, X), (True, O, Y)],
    ),
    "F": Pair(
        tuple(zip("PPPRRR", (ALONG_X, ALONG_Y, HERE, HERE, ALONG_Y, ALONG_X), strict=True)),
        lambda m: m,
        {
            "x": (0, lambda m: m[0, 3]),
            "y": (1, lambda m: m[1, 3]),
            "z": (2, lambda m: m[2, 3]),
            "rz": (3, angle_about_z),
            "ry": (4, lambda m: mp.asin(-m[2, 0])),
            "rx": (5, lambda m: mp.atan2(m[2, 1], m[2, 2])),
        },
    ),
    "W": Pair((("W", HERE),), lambda m: mp.eye(4)),
}


def derivative(path: Callable[[Any], Any], order: int) -> Any:
    """Derivative at time 0 by central differences, good to about 20 digits."""
    h = mp.mpf("1e-10")
    if order == 1:
        return (path(h) - path(-h)) / (2 * h)
    return (path(h) - 2 * path(mp.mpf(0)) + path(-h)) / h**2
