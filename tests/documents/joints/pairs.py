"""A drawing of each pair of the joint table: the first link blue, the second orange."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin
from typing import Final

import numpy as np
from documents.joints.solids import Drawing, Point, ring

Y: Final[Point] = (0.0, 1.0, 0.0)
Z: Final[Point] = (0.0, 0.0, 1.0)
X: Final[Point] = (1.0, 0.0, 0.0)


def revolute() -> Drawing:
    """A fork with a pin, and an eye on it."""
    d = Drawing((0, 0, -0.1))
    d.axis((0, -2.6, 0), (0, -1, 0))
    d.box((-0.6, -1.1, -2.1), (0.6, 1.1, -1.7), "a")
    d.box((-0.5, -1.1, -1.7), (0.5, -0.6, 0), "a")
    d.cylinder((0, -1.1, 0), (0, -0.6, 0), 0.55, "a")
    d.cylinder((0, -0.6, 0), (0, -0.5, 0), 0.25, "a")
    d.box((-0.3, -0.4, 0), (0.3, 0.4, 2.2), "b")
    d.cylinder((0, -0.5, 0), (0, 0.5, 0), 0.62, "b")
    d.box((-0.5, 0.6, -1.7), (0.5, 1.1, 0), "a")
    d.cylinder((0, 0.6, 0), (0, 1.1, 0), 0.55, "a")
    d.cylinder((0, 1.1, 0), (0, 1.4, 0), 0.25, "a")
    d.axis((0, 1.4, 0), (0, 2.6, 0))
    d.turn((0, 2.0, 0), Y, 0.6, "theta", start=3.4, through=4.4, shift=(12, 13))
    return d


def prismatic() -> Drawing:
    """A block that grips a square rail."""
    d = Drawing((0, 0, 0.2))
    d.box((-0.35, -2.6, -0.35), (0.35, -0.9, 0.35), "a")
    d.box((-0.75, -0.9, -0.65), (0.75, 0.9, 0.65), "b")
    d.box((-0.25, -0.25, 0.65), (0.25, 0.25, 1.9), "b")
    d.box((-0.35, 0.9, -0.35), (0.35, 2.6, 0.35), "a")
    d.arrow((1.6, -0.9, 0), (1.6, 1.0, 0), "s")
    return d


def cylindric() -> Drawing:
    """A sleeve on a round bar."""
    d = Drawing((0, 0, 0.2))
    d.axis((0, -3.2, 0), (0, -2.6, 0))
    d.cylinder((0, -2.6, 0), (0, -0.9, 0), 0.35, "a")
    d.box((-0.25, -0.25, 0), (0.25, 0.25, 1.9), "b")
    d.cylinder((0, -0.9, 0), (0, 0.9, 0), 0.7, "b")
    d.cylinder((0, 0.9, 0), (0, 2.4, 0), 0.35, "a")
    d.axis((0, 2.4, 0), (0, 3.3, 0))
    d.arrow((1.4, -0.9, 0), (1.4, 1.0, 0), "s")
    d.turn((0, 2.9, 0), Y, 0.6, "theta", start=3.4, through=4.4, shift=(10, 12))
    return d


def _thread(d: Drawing, start: float, end: float, radius: float, lead: float) -> None:
    """The turns of a right-hand thread that are seen on a bar along y."""
    # towards the viewer lie angles about y from x towards z: the thread turns right-handed
    turns = int((end - start) / lead)
    for k in range(turns):
        foot = start + k * lead
        angles = [-0.45 * pi + pi * j / 10 * 1.15 for j in range(11)]
        way = [
            (radius * cos(a), foot + lead * (0.5 - a / (2 * pi)), radius * sin(a)) for a in angles
        ]
        d.path(way, "n", closed=False)


def helical() -> Drawing:
    """A nut on a screw."""
    d = Drawing((0, 0, 0.2))
    d.axis((0, -3.2, 0), (0, -2.6, 0))
    d.cylinder((0, -2.6, 0), (0, -0.6, 0), 0.4, "a")
    _thread(d, -2.5, -0.7, 0.4, 0.36)
    d.box((-0.25, -0.25, 0), (0.25, 0.25, 2.0), "b")
    d.cylinder((0, -0.6, 0), (0, 0.6, 0), 0.85, "b", corners=6)
    d.cylinder((0, 0.6, 0), (0, 2.5, 0), 0.4, "a")
    _thread(d, 0.75, 2.4, 0.4, 0.36)
    d.axis((0, 2.5, 0), (0, 3.4, 0))
    d.arrow((1.5, -0.9, 0), (1.5, 1.0, 0), "s")
    d.turn((0, 3.0, 0), Y, 0.6, "theta", start=3.4, through=4.4, shift=(10, 12))
    return d


def spherical() -> Drawing:
    """A ball in a socket."""
    d = Drawing((0, 0, 0.1))
    d.cylinder((0, 0, -2.4), (0, 0, -1.0), 0.3, "b")
    d.bowl_behind((0, 0, 0), 1.15, "b")
    d.ball((0, 0, 0.0), 1.0, "a")
    d.cylinder((0, 0, 0.8), (0, 0, 2.3), 0.3, "a")
    d.bowl_before((0, 0, 0), 0.98, 1.2, "b")
    return d


def sphere_plane() -> Drawing:
    """A ball on a plate."""
    d = Drawing((0, 0, 0.4))
    d.box((-1.9, -1.9, -0.35), (1.9, 1.9, 0), "b")
    d.ball((0, 0, 0.7), 0.7, "a")
    d.cylinder((0, 0, 1.25), (0, 0, 2.4), 0.25, "a")
    d.arrow((-1.2, 1.2, 0), (-1.2, 1.2, 1.1), "normal")
    return d


def sphere_groove() -> Drawing:
    """A ball between the walls of a groove."""
    d = Drawing((0, 0, 0.4))
    d.box((-1.2, -2.3, -0.3), (1.2, 2.3, 0.0), "b")
    d.box((-1.2, -2.3, 0.0), (-0.7, 2.3, 0.7), "b")
    d.ball((0, 0, 0.7), 0.7, "a")
    d.cylinder((0, 0, 1.25), (0, 0, 2.4), 0.25, "a")
    d.box((0.7, -2.3, 0.0), (1.2, 2.3, 0.7), "b")
    d.arrow((2.0, -0.8, 0.0), (2.0, 1.0, 0.0), "s")
    return d


def universal() -> Drawing:
    """Two forks on a cross."""
    d = Drawing((0, 0, 0.05))
    d.axis((0, -2.5, 0), (0, 0, 0))
    d.axis((-2.5, 0, 0), (0, 0, 0))
    d.cylinder((0, 0, -2.5), (0, 0, -1.9), 0.3, "a")
    d.box((-0.3, -1.3, -1.9), (0.3, 1.3, -1.5), "a")
    d.box((-0.3, -1.3, -1.5), (0.3, -1.0, 0.4), "a")
    d.box((-1.3, -0.3, -0.4), (-1.0, 0.3, 1.5), "b")
    d.cylinder((0, -1.0, 0), (0, 1.1, 0), 0.2, "c")
    d.cylinder((-1.0, 0, 0), (1.1, 0, 0), 0.2, "c")
    d.box((-0.35, -0.35, -0.3), (0.35, 0.35, 0.3), "c")
    d.cylinder((0, 0.35, 0), (0, 1.0, 0), 0.2, "c")
    d.cylinder((0.35, 0, 0), (1.0, 0, 0), 0.2, "c")
    d.box((-0.3, 1.0, -1.5), (0.3, 1.3, 0.4), "a")
    d.box((1.0, -0.3, -0.4), (1.3, 0.3, 1.5), "b")
    d.box((-1.3, -0.3, 1.5), (1.3, 0.3, 1.9), "b")
    d.cylinder((0, 0, 1.9), (0, 0, 2.5), 0.3, "b")
    d.axis((0, 1.3, 0), (0, 2.6, 0))
    d.axis((1.3, 0, 0), (2.6, 0, 0))
    d.turn((0, 2.0, 0), Y, 0.5, "theta1", start=3.4, through=4.4, shift=(13, 14))
    d.turn((2.0, 0, 0), X, 0.5, "theta2", start=3.4, through=4.4, shift=(-12, 14))
    return d


def planar() -> Drawing:
    """A slab on a plate."""
    d = Drawing((0, 0, 0.4))
    d.box((-2.1, -2.1, -0.35), (2.1, 2.1, 0), "a")
    d.box((-0.8, -0.8, 0), (0.8, 0.8, 0.5), "b")
    d.cylinder((0, 0, 0.5), (0, 0, 2.0), 0.25, "b")
    d.arrow((0.8, 0, 0), (1.7, 0, 0), "x")
    d.arrow((0, 0.8, 0), (0, 1.7, 0), "y")
    d.turn((0, 0, 1.4), Z, 0.6, "theta", start=-0.6, shift=(-22, 0))
    return d


def slotted_sphere() -> Drawing:
    """A ball whose pin runs in a slot of its socket."""
    d = Drawing((0, 0, 0.1))
    d.cylinder((0, 0, -2.4), (0, 0, -1.0), 0.3, "a")
    d.bowl_behind((0, 0, 0), 1.15, "a")
    d.ball((0, 0, 0), 1.0, "b")
    d.cylinder((0, 0, 0.8), (0, 0, 2.3), 0.3, "b")
    d.bowl_before((0, 0, 0), 0.98, 1.2, "a")
    d.path([(0.3, 1.17, 0.05), (0.3, 0.9, -0.8), (-0.3, 0.9, -0.8), (-0.3, 1.17, 0.05)], "a2")
    d.cylinder((0, 0.9, -0.15), (0, 1.7, -0.15), 0.2, "b")
    d.axis((0, 1.7, -0.15), (0, 2.8, -0.15))
    d.turn((0, 2.2, -0.15), Y, 0.45, "theta2", start=3.4, shift=(-4, 12))
    d.turn((0, 0, 1.7), X, 0.9, "theta1", start=-1.1, through=1.4, shift=(16, -4))
    return d


def sphere_cylinder() -> Drawing:
    """A ball in a tube, its pin in a slot along it."""
    d = Drawing((0, 0, 0.3))
    d.cylinder((0, -2.4, 0), (0, 2.4, 0), 0.9, "a")
    d.path([(-0.3, -1.7, 0.88), (0.35, -1.7, 0.88), (0.35, 1.7, 0.88), (-0.3, 1.7, 0.88)], "a2")
    d.path([(-0.3, -0.6, 0.88), (0.35, -0.6, 0.88), (0.35, 0.6, 0.88), (-0.3, 0.6, 0.88)], "b1")
    d.cylinder((0, 0, 0.85), (0, 0, 2.2), 0.28, "b")
    d.path(ring((0, 2.4, 0), np.array(Y), 0.68), "c2")
    d.arrow((1.6, -0.8, 0), (1.6, 1.0, 0), "s")
    d.turn((0, 0, 1.6), Z, 0.6, "theta2", start=-0.6, shift=(-36, -16))
    d.turn((0, 0, 0), (-1, 0, 0), 2.6, "theta1", start=0.15, through=0.6, shift=(26, -2))
    return d


def cylinder_plane() -> Drawing:
    """A cylinder that lies on a plate."""
    d = Drawing((0, 0, 0.4))
    d.box((-1.9, -2.1, -0.35), (1.9, 2.1, 0), "b")
    d.axis((0, -2.4, 0.7), (0, -1.3, 0.7))
    d.cylinder((0, -1.3, 0.7), (0, 1.3, 0.7), 0.7, "a")
    d.cylinder((0, 1.3, 0.7), (0, 1.9, 0.7), 0.22, "a")
    d.axis((0, 1.9, 0.7), (0, 3.2, 0.7))
    d.turn((0, 2.6, 0.7), Y, 0.5, "theta1", start=3.4, through=4.4, shift=(16, 14))
    d.arrow((-1.4, -0.9, 0), (-1.4, -0.9, 1.4), "theta2, normal")
    d.arrow((0.9, 0, 0), (1.8, 0, 0), "x")
    d.arrow((1.4, 0.6, 0), (1.4, 1.5, 0), "y")
    return d


def pin_in_slot() -> Drawing:
    """A pin in the slot of a bar."""
    d = Drawing((0, 0, 0.1))
    d.box((-2.3, -0.35, -1.0), (0.3, 0.35, -0.65), "a")
    d.cylinder((0, 0, -0.9), (0, 0, -0.3), 0.3, "a")
    d.box((-0.7, -2.5, -0.3), (0.7, 2.5, 0.15), "b")
    d.path([(-0.33, -1.7, 0.15), (0.33, -1.7, 0.15), (0.33, 1.7, 0.15), (-0.33, 1.7, 0.15)], "b2")
    d.cylinder((0, 0, 0.0), (0, 0, 0.9), 0.3, "a")
    d.arrow((1.8, -0.7, 0), (1.8, 1.0, 0), "s")
    d.turn((0, 0, 1.2), Z, 0.75, "theta", start=-0.4, shift=(-36, -14))
    return d


def weld() -> Drawing:
    """Two bars that are one body."""
    d = Drawing((0, 0, 0.3))
    d.box((-0.5, -2.3, -0.5), (0.5, 1.2, 0.3), "a")
    d.box((-0.35, -0.4, 0.3), (0.35, 0.4, 2.2), "b")
    for k in range(6):
        y = -0.4 + 0.16 * k
        d.ball((0.42, y, 0.36), 0.12, "c")
    for k in range(4):
        d.ball((0.42 - 0.2 * k, 0.46, 0.36), 0.12, "c")
    return d


def free_pose() -> Drawing:
    """Two triads with nothing between them."""
    d = Drawing((0, 0.3, 0.9))
    d.box((-0.3, -2.5, -0.3), (0.3, -1.9, 0.3), "a")
    d.axis((0, -2.2, 0), (0, 1.5, 0))
    d.axis((0, 1.5, 0), (-0.6, 1.5, 0))
    d.axis((-0.6, 1.5, 0), (-0.6, 1.5, 1.6))
    d.arrow((0.3, -2.2, 0), (1.4, -2.2, 0), "x")
    d.arrow((0, -1.9, 0), (0, -0.8, 0), "y")
    d.arrow((0, -2.2, 0.3), (0, -2.2, 1.4), "z")
    d.box((-0.9, 1.2, 1.3), (-0.3, 1.8, 1.9), "b")
    d.turn((-0.6, 1.5, 2.2), Z, 0.6, "rz, ry, rx", start=-0.6, shift=(16, -28))
    return d


PAIRS: Final[dict[str, tuple[str, Callable[[], Drawing]]]] = {
    "R": ("revolute", revolute),
    "P": ("prismatic", prismatic),
    "C": ("cylindric", cylindric),
    "H": ("helical", helical),
    "S": ("spherical", spherical),
    "Sp": ("sphere on a plane", sphere_plane),
    "Sg": ("sphere in a groove", sphere_groove),
    "U": ("universal", universal),
    "E": ("planar", planar),
    "Ss": ("slotted sphere", slotted_sphere),
    "Sc": ("sphere in a slotted cylinder", sphere_cylinder),
    "Cp": ("cylinder on a plane", cylinder_plane),
    "F": ("free pose", free_pose),
    "W": ("weld", weld),
    "Ps": ("pin in a slot", pin_in_slot),
}
"""Letter of the joint table -> what it is called, and its drawing."""
