"""The 24 x 24 system of the dissertation (section 3.4): all reactions and the input couple at once.

Unknown: F41, M41, FA1 (ground on crank; F41, M41 across the axis A1), F12, M12 (crank on coupler),
FB, FC, FD (coupler on rocker along B, C and D = B x C), F43, M43, FA4 (ground on rocker), MIN.
Equations: six per link about the ground origin, two per pair that transmits nothing along or about
its axis. The inertia couples are the physical ones, -(r x m a + I alpha + omega x I omega).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from benchmark.arithmetic import Arithmetic
from benchmark.closure import Drawing, Kinematics, Motion
from benchmark.matrices import (
    Matrix,
    Vector,
    cross,
    dot,
    image,
    product,
    rotation,
    transpose,
)

from benchmarks.rcsr import MASSES, Dimensions

UNKNOWNS = 24
F41, M41, FA1, F12, M12, FB, FC, FD, F43, M43, FA4, MIN = 0, 3, 6, 7, 10, 13, 14, 15, 16, 19, 22, 23


class System:
    """The matrix (24, 24) and right-hand side (24), entries as the kinematics' numbers; None is
    zero."""

    def __init__(self) -> None:
        self.matrix: list[list[Any]] = [[None] * UNKNOWNS for _ in range(UNKNOWNS)]
        self.right: list[Any] = [None] * UNKNOWNS

    def vector(self, row: int, unknown: int, sign: int) -> None:
        """sign times a vector unknown, in three equations."""
        for i in range(3):
            self.matrix[row + i][unknown + i] = sign

    def along(self, row: int, unknown: int, direction: Vector) -> None:
        """A scalar unknown along a direction, in three equations."""
        for i in range(3):
            self.matrix[row + i][unknown] = direction[i]

    def across(self, row: int, unknown: int, direction: Vector) -> None:
        """One equation in a vector unknown: its product with a direction."""
        for i in range(3):
            self.matrix[row][unknown + i] = direction[i]

    def arrays(self, rows: int, dtype: Any) -> tuple[Any, Any]:
        """Matrix (rows, 24, 24) and right-hand side (rows, 24)."""
        matrix, right = (
            np.zeros((rows, UNKNOWNS, UNKNOWNS), dtype),
            np.zeros((rows, UNKNOWNS), dtype),
        )
        for i, line in enumerate(self.matrix):
            for j, entry in enumerate(line):
                if entry is not None:
                    matrix[:, i, j] = entry
            if self.right[i] is not None:
                right[:, i] = self.right[i]
        return matrix, right


def directions(d: Drawing, k: Kinematics) -> dict[str, Vector]:
    """A1, A2, A4, B, C, D and the points O2, O3, O4 at the positions of the kinematics."""
    number = d.arithmetic.number
    zero, one = number(0), number(1)
    coupler, rocker = k.links["coupler"].place, k.links["rocker"].place
    A2 = [dot(row, d.axis2) for row in rotation(coupler)]
    B = [row[1] for row in rotation(rocker)]
    C = [-row[1] for row in rotation(coupler)]
    return {
        "A1": [one, zero, zero],
        "A2": A2,
        "A4": d.axis4,
        "B": B,
        "C": C,
        "D": cross(B, C),
        "O2": image(coupler, d.point2),
        "O3": image(rocker, d.on_rocker),
        "O4": d.point4,
    }


def equations(size: Dimensions, d: Drawing, k: Kinematics) -> System:
    """The system at the positions of the kinematics."""
    v = directions(d, k)
    system = System()
    inertia = {link: _inertia(size, d.arithmetic, link, k.links[link]) for link in MASSES}
    for link, row in (("crank", 0), ("coupler", 6), ("rocker", 12)):
        system.right[row : row + 6] = [*inertia[link][0], *inertia[link][1]]
    torque = d.arithmetic.number(size.torque)
    for i in range(3):
        system.right[15 + i] = system.right[15 + i] - torque * v["A4"][i]
    system.vector(0, F41, 1)
    system.along(0, FA1, v["A1"])
    system.vector(0, F12, -1)
    system.vector(3, M41, 1)
    system.vector(3, M12, -1)
    system.along(3, MIN, v["A1"])
    system.vector(6, F12, 1)
    system.vector(9, M12, 1)
    system.vector(12, F43, 1)
    system.along(12, FA4, v["A4"])
    system.vector(15, M43, 1)
    system.along(15, FA4, cross(v["O4"], v["A4"]))
    for unknown, name in ((FB, "B"), (FC, "C"), (FD, "D")):
        moment = cross(v["O3"], v[name])
        system.along(6, unknown, [-x for x in v[name]])
        system.along(9, unknown, [-x for x in moment])
        system.along(12, unknown, v[name])
        system.along(15, unknown, moment)
    system.across(18, F41, v["A1"])
    system.across(19, M41, v["A1"])
    system.across(20, F12, v["A2"])
    system.across(21, M12, v["A2"])
    system.across(21, F12, cross(v["O2"], v["A2"]))
    system.across(22, F43, v["A4"])
    system.across(23, M43, v["A4"])
    system.across(23, F43, cross(v["O4"], v["A4"]))
    return system


def wrenches(d: Drawing, k: Kinematics, unknown: Any) -> dict[str, Any]:
    """`J.force` (rows, 3), `J.moment` about `J.point` (rows, 3) and `O1.effort` (rows) of a
    solution."""
    x, v = np.asarray(unknown).T, directions(d, k)
    coupler = [
        x[FB] * b + x[FC] * c + x[FD] * e for b, c, e in zip(v["B"], v["C"], v["D"], strict=True)
    ]
    axial1, axial4 = [x[FA1] * a for a in v["A1"]], [x[FA4] * a for a in v["A4"]]
    lever4 = cross(v["O4"], v["A4"])
    force = {
        "O1": _added(x[F41 : F41 + 3], axial1),
        "O2": list(x[F12 : F12 + 3]),
        "O3": coupler,
        "O4": _added(x[F43 : F43 + 3], axial4),
    }
    moment = {
        "O1": list(x[M41 : M41 + 3]),
        "O2": list(x[M12 : M12 + 3]),
        "O3": cross(v["O3"], coupler),
        "O4": _added(x[M43 : M43 + 3], [x[FA4] * a for a in lever4]),
    }
    points = {"O1": d.point1, "O2": v["O2"], "O3": v["O3"], "O4": v["O4"]}
    found: dict[str, Any] = {"O1.effort": -x[MIN]}
    for joint, push in force.items():
        lever = cross(points[joint], push)
        about = [m - moved for m, moved in zip(moment[joint], lever, strict=True)]
        found[f"{joint}.force"] = np.stack(push, axis=1)
        found[f"{joint}.moment"] = np.stack(about, axis=1)
    return found


def _added(a: Iterable[Any], b: Iterable[Any]) -> Vector:
    return [x + y for x, y in zip(a, b, strict=True)]


def _pair_axes(d: Arithmetic, link: str) -> Matrix:
    """Axes of a link's tensor and mass centre in the home drawing, as columns."""
    from benchmarks.rcsr import ALPHA1, ALPHA4

    angle = {"crank": 0, "coupler": ALPHA1, "rocker": -ALPHA4}[link]
    c, n, zero = d.cos(d.radians(angle)), d.sin(d.radians(angle)), d.number(0)
    return [[c, zero, -n], [zero, d.number(1), zero], [n, zero, c]]


def _inertia(
    size: Dimensions, arithmetic: Arithmetic, link: str, motion: Motion
) -> tuple[Vector, Vector]:
    """The inertia wrench of a link of the RCSR mechanism."""
    number = arithmetic.number
    axes = _pair_axes(arithmetic, link)
    foot = {
        "crank": [-size.s1, 0.0, 0.0],
        "coupler": [-size.s1, -size.P1, 0.0],
        "rocker": [0.0, size.P4, 0.0],
    }[link]
    along = [number(size.cx), number(size.cy), number(size.cz)]
    if link == "rocker":
        along[0] = along[0] + number(size.s4)
    centre = _added([number(x) for x in foot], [dot(row, along) for row in axes])
    turned = product(rotation(motion.place), axes)
    tensor = _tensor(size, arithmetic, link)
    return inertia_wrench(motion, number(MASSES[link]), centre, turned, tensor)


def inertia_wrench(
    motion: Motion, mass: Any, centre: Vector, turned: Matrix, tensor: Matrix
) -> tuple[Vector, Vector]:
    """m a and r x m a + I alpha + omega x I omega about the ground origin.

    Args:
        motion: of the link.
        mass, centre: the mass and its centre in the home drawing.
        turned: the axes of the tensor as they stand now, as columns.
        tensor: about the mass centre in these axes.
    """
    force = [mass * a for a in image(motion.second, centre)]
    omega, alpha = _angular(motion)

    def momentum(w: Vector) -> Vector:
        inner = [dot(column, w) for column in transpose(turned)]
        return [dot(row, [dot(line, inner) for line in tensor]) for row in turned]

    couple = _added(momentum(alpha), cross(omega, momentum(omega)))
    return force, _added(cross(image(motion.place, centre), force), couple)


def _tensor(size: Dimensions, arithmetic: Arithmetic, link: str) -> Matrix:
    entry = {name: arithmetic.number(value) for name, value in size.tensors[link].items()}
    zero = arithmetic.number(0)
    names = (("xx", "xy", "xz"), ("xy", "yy", "yz"), ("xz", "yz", "zz"))
    return [[entry.get(name, zero) for name in row] for row in names]


def _angular(motion: Motion) -> tuple[Vector, Vector]:
    """omega and alpha from the skew parts of R' R^T and R'' R^T."""
    back = transpose(rotation(motion.place))
    first, second = (product(rotation(m), back) for m in (motion.rate, motion.second))
    omega, alpha = (
        [(m[2][1] - m[1][2]) / 2, (m[0][2] - m[2][0]) / 2, (m[1][0] - m[0][1]) / 2]
        for m in (first, second)
    )
    return omega, alpha
