"""Bushings of the file: springs and dampers between two links in all six directions.

A stiffness has an energy that is nowhere negative, else a link at rest on it alone would run away;
a damping takes power, and puts in none: both matrices are symmetric and positive semidefinite.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.building.joints import points_of, square_axes
from mechkin_cli.diagnostics import Number, nearest_hint
from mechkin_cli.mechanism import GROUND, GROUND_NAME, UPPER_HALF, Bushing, Frame, cross, norm
from mechkin_cli.tape import Recorded, TraceLost, advice
from mechkin_cli.units import (
    ANGLE,
    DAMPING,
    FORCE,
    LENGTH,
    STIFFNESS,
    TIME,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
)

if TYPE_CHECKING:
    from mechkin_cli import schema
    from mechkin_cli.building.fields import Fields, Path
    from mechkin_cli.mechanism import Vector
    from mechkin_cli.units import Dimension

_AXES = ("x", "y", "z", "rx", "ry", "rz")
_SLIDES = 3
_STIFFNESS = (STIFFNESS, FORCE / ANGLE, TORSIONAL_STIFFNESS)
_DAMPING = (DAMPING, FORCE * TIME / ANGLE, TORSIONAL_DAMPING)

Matrix = list[list[float]]


def build_bushing(
    fields: Fields, path: Path, section: schema.BushingBetweenLinks, links: Mapping[str, object]
) -> Iterator[Bushing]:
    """The spring of a bushing, and its damper; errors are noted in `fields`."""
    for i, name in enumerate(section.links):
        if name != GROUND_NAME and name not in links:
            if not fields.is_refused(name):
                hint = nearest_hint(name, [GROUND_NAME, *links])
                at = (*path, "links", i)
                fields.error("unknown-link", at, f"there is no link {name}", hint)
            return
    errors = fields.error_count
    points = points_of(fields, path, section)
    x, y, z = _axes(fields, path, section)
    frames = Frame(x, y, z, points[0]), Frame(x, y, z, points[1])
    free = (0.0,) * 6 if section.free is None else _free(fields, (*path, "free"), section.free)
    parts = [("stiffness", section.stiffness, _STIFFNESS), ("damping", section.damping, _DAMPING)]
    for key, given, dimensions in parts:
        if given is None:
            continue
        matrix = _matrix(fields, (*path, key), given, dimensions)
        if fields.error_count > errors or not _is_sound(fields, (*path, key), matrix):
            continue
        first, second = section.links
        half = tuple(matrix[i][k] for i, k in UPPER_HALF)
        damps = key == "damping"
        yield Bushing(section.name or "", (first, second), frames, half, free, damps)


def _axes(
    fields: Fields, path: Path, section: schema.BushingBetweenLinks
) -> tuple[Vector, Vector, Vector]:
    if section.axes is None:
        return GROUND.x, GROUND.y, GROUND.z
    x, y = square_axes(fields, (*path, "axes"), section.axes, "a bushing")
    return x, y, cross(x, y)


def _free(fields: Fields, path: Path, section: schema.BushingFree) -> tuple[float, ...]:
    """The deflection without force, whose turn is less than half a turn."""
    errors = fields.error_count
    free = tuple(
        fields.number((*path, axis), getattr(section, axis), LENGTH if i < _SLIDES else ANGLE)
        for i, axis in enumerate(_AXES)
    )
    turn = norm((free[3], free[4], free[5]))
    if fields.error_count == errors and not turn < pi:
        text = "a bushing without force is turned by less than half a turn"
        hint = "write the shorter turn, the other way round, or draw its halves turned"
        fields.error(
            "bushing-turn", path, text, hint, measured=fields.units.text(float(turn), ANGLE)
        )
    return free


def _matrix(
    fields: Fields,
    path: Path,
    given: schema.BushingStiffness | schema.BushingDamping | Sequence[Sequence[str]],
    dimensions: Sequence[Dimension],
) -> Matrix:
    """A matrix as it is written, in SI."""

    def dimension(i: int, k: int) -> Dimension:
        return dimensions[(i >= _SLIDES) + (k >= _SLIDES)]

    if isinstance(given, (list, tuple)):
        return [
            [fields.number((*path, i, k), text, dimension(i, k)) for k, text in enumerate(row)]
            for i, row in enumerate(given)
        ]
    matrix = [[0.0] * len(_AXES) for _ in _AXES]
    for i, axis in enumerate(_AXES):
        matrix[i][i] = fields.number((*path, axis), getattr(given, axis), dimension(i, i))
    return matrix


def _is_sound(fields: Fields, path: Path, matrix: Matrix) -> bool:
    """Whether a matrix is symmetric and positive semidefinite; if not, that is noted."""
    if _is_surely_sound(matrix):
        return True
    if any(isinstance(entry, Recorded) for row in matrix for entry in row):
        raise TraceLost("the matrix of a bushing is not symmetric and positive semidefinite")
    what = path[-1]
    for i, k in UPPER_HALF:
        if matrix[i][k] != matrix[k][i]:
            fields.error(
                "not-symmetric",
                (*path, k, i),
                f"a {what} matrix is symmetric: {_AXES[k]}, {_AXES[i]} is another number than "
                f"{_AXES[i]}, {_AXES[k]}",
                "write the same expression in both places",
            )
            return False
    worst = next((i for i in range(len(_AXES)) if matrix[i][i] < 0.0), None)
    if worst is not None:
        at = path if fields.document.node((*path, _AXES[worst])) is None else (*path, _AXES[worst])
        text = f"the {what} along {_AXES[worst]} is negative"
        fields.error("indefinite-bushing", at, text, "write a number that is not below zero")
        return False
    least = float(np.linalg.eigvalsh(np.array(_scaled(matrix)))[0])
    fields.error(
        "indefinite-bushing",
        path,
        f"this {what} matrix is not positive semidefinite: some deflection has "
        + ("a negative energy" if what == "stiffness" else "a negative dissipation"),
        "check the signs of the entries beside the diagonal, and the order x, y, z, rx, ry, rz",
        measured=f"least eigenvalue {least:.3g}, with a diagonal of ones",
        limit=f"{-tolerances.INDEFINITE_BUSHING:g}",
        numbers=(Number("least eigenvalue", least, limit=-tolerances.INDEFINITE_BUSHING),),
    )
    return False


def _scaled(matrix: Matrix) -> Matrix:
    """The matrix with a diagonal of ones, and zeros where there is no stiffness."""
    by = [1.0 / sqrt(matrix[i][i]) if matrix[i][i] > 0.0 else 1.0 for i in range(len(_AXES))]
    return [[entry * by[i] * by[k] for k, entry in enumerate(row)] for i, row in enumerate(matrix)]


def _is_surely_sound(matrix: Matrix) -> bool:
    """Judged by the pivots of the elimination, each with the slack of its entry of the diagonal:
    without roots, so that it can be recorded."""
    count = len(_AXES)
    if not all(advice(matrix[i][k] == matrix[k][i]) for i, k in UPPER_HALF):
        return False
    rest = [list(row) for row in matrix]
    for j in range(count):
        own = matrix[j][j]
        if advice(own == 0.0):
            # no stiffness along this axis, and none that couples it
            if not all(advice(entry == 0.0) for entry in matrix[j]):
                return False
            continue
        pivot = rest[j][j] + tolerances.INDEFINITE_BUSHING * own
        if not advice(own > 0.0) or not advice(pivot > 0.0):
            return False
        for i in range(j + 1, count):
            if advice(rest[i][j] == 0.0):
                continue
            factor = rest[i][j] / pivot
            for k in range(j + 1, count):
                rest[i][k] = rest[i][k] - factor * rest[j][k]
    return True
