"""Mass, place and inertia of MJCF's geoms, of uniform density."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.bridges.markup import Element, about, pose
from mechkin_cli.bridges.parts import refuse

DENSITY: Final = "1000"
"""MuJoCo's (kg/m^3)."""

_SIZES: Final = {
    "sphere": (1,),
    "capsule": (1, 2),
    "cylinder": (1, 2),
    "box": (3,),
    "ellipsoid": (3,),
}
"""Numbers of size that count, by type; lengths are left out where `fromto` gives them."""


def geom_mass(geom: Element, turn_of: Callable[[Element], Any]) -> tuple[float, Any, Any] | None:
    """The mass of a geom (kg), its frame (4, 4) on its body, and its inertia about its centre in
    that frame (kg m^2); None of one whose shape is not known here, such as a mesh or the shell of
    an ellipsoid.

    Raises:
        InvalidFile: its sizes are missing or not positive.
    """
    kind = geom.attributes.get("type", "sphere")
    if kind == "plane":
        return 0.0, np.eye(4), np.zeros((3, 3))
    if kind not in _SIZES or "mesh" in geom.attributes:
        mass = geom.number("mass")
        return None if mass is None or mass > 0.0 else (0.0, np.eye(4), np.zeros((3, 3)))
    size = geom.numbers("size", (1, 2, 3), "0")
    ends = geom.numbers("fromto", (6,))
    if ends is None:
        frame = pose(turn_of(geom), geom.numbers("pos", (3,), "0 0 0"))
        half = None
    else:
        frame, half = _between(geom, ends)
    size = _sizes(geom, kind, size, half)
    is_shell = geom.attributes.get("shellinertia", "false") == "true"
    mass = geom.number("mass")
    if is_shell and kind == "ellipsoid":
        return None if mass is None or mass > 0.0 else (0.0, frame, np.zeros((3, 3)))
    with np.errstate(divide="ignore", invalid="ignore"):
        content, shape = _shell(kind, size) if is_shell else _shape(kind, size)
    if not np.isfinite(shape).all():
        told = f"the {kind} is too small to have a mass"
        refuse("no-size", told, geom.at, "write its size in metres")
    if mass is None:
        mass = content * (geom.number("density", DENSITY) or 0.0)
    if mass < 0.0:
        refuse("no-mass", "the mass of a geom is negative", geom.at, "correct it")
    return mass, frame, mass * np.diag(shape)


def _between(geom: Element, ends: Any) -> tuple[Any, float]:
    """The frame in the middle of two points with z towards the first, and half their distance."""
    way = ends[:3] - ends[3:]
    length = float(np.linalg.norm(way))
    if length < tolerances.NO_DIRECTION:
        refuse("no-direction", "fromto has twice the same point", geom.at, "correct it")
    z = way / length
    across = np.cross([0.0, 0.0, 1.0], z)
    far = float(np.linalg.norm(across))
    turn = (
        np.eye(3)
        if far < tolerances.PARALLEL_AXIS
        else about(across / far, float(np.arctan2(far, z[2])))
    )
    return pose(turn, 0.5 * (ends[:3] + ends[3:])), 0.5 * length


def _sizes(geom: Element, kind: str, size: Any, half: float | None) -> Any:
    if half is not None:
        # the first size is the radius, or half the width and half the depth; others do not count
        across = size[:1].repeat(2 if kind in ("box", "ellipsoid") else 1)
        size = np.array([*across, half])
    needed = _SIZES[kind][-1]
    if len(size) < needed or not all(value > 0.0 for value in size[:needed]):
        told = f"a {kind} needs {needed} positive numbers of size"
        refuse("no-size", told, geom.at, 'write size="..."')
    return np.asarray(size[:needed], dtype=float)


def _shape(kind: str, size: Any) -> tuple[float, Any]:
    """Volume, and the moments of inertia by mass."""
    if kind == "sphere":
        return 4.0 / 3.0 * np.pi * size[0] ** 3, np.full(3, 0.4 * size[0] ** 2)
    if kind == "box":
        x, y, z = size**2
        return 8.0 * float(np.prod(size)), np.array([y + z, x + z, x + y]) / 3.0
    if kind == "ellipsoid":
        x, y, z = size**2
        volume = 4.0 / 3.0 * np.pi * float(np.prod(size))
        return volume, np.array([y + z, x + z, x + y]) / 5.0
    r, h = size[0], 2.0 * size[1]
    cylinder = np.pi * r * r * h
    across = r * r / 4.0 + h * h / 12.0
    if kind == "cylinder":
        return cylinder, np.array([across, across, 0.5 * r * r])
    ball = 4.0 / 3.0 * np.pi * r**3
    volume = cylinder + ball
    # two halves of a ball, each with its centre 3/8 r beyond the end
    ends = ball * (0.4 * r * r + 0.25 * h * h + 0.375 * h * r)
    along = cylinder * 0.5 * r * r + ball * 0.4 * r * r
    return volume, np.array([(cylinder * across + ends), cylinder * across + ends, along]) / volume


def _shell(kind: str, size: Any) -> tuple[float, Any]:
    """Area, and the moments of inertia by mass, of a thin shell."""
    if kind == "sphere":
        return 4.0 * np.pi * size[0] ** 2, np.full(3, 2.0 / 3.0 * size[0] ** 2)
    if kind == "box":
        x, y, z = size
        faces = 8.0 * np.array([y * z, x * z, x * y])
        area = float(faces.sum())
        squares = size**2 * (faces + (area - faces) / 3.0) / area
        return area, squares.sum() - squares
    r, half = size
    side = 4.0 * np.pi * r * half
    # the ends: two discs, or two halves of a ball's shell with their centres r/2 beyond
    if kind == "cylinder":
        ends, along, across = 2.0 * np.pi * r * r, 0.5 * r * r, 0.25 * r * r + half * half
    else:
        ends, along = 4.0 * np.pi * r * r, 2.0 / 3.0 * r * r
        across = along + half * half + half * r
    area = side + ends
    x = (side * (r * r / 2.0 + half * half / 3.0) + ends * across) / area
    return area, np.array([x, x, (side * r * r + ends * along) / area])
