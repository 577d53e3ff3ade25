"""Screws of a link against ground: of its instant motion (Mozzi) and of its whole displacement
from the drawing (Chasles).

Instant: with the angular velocity w and the velocity v of a point a, the axis through a + w x v/w^2
along w, of pitch w.v/w^2 per radian. Finite: with the unit axis u and angle phi of the rotation and
the shift d of the point from a0 to a, the axis through (a0 + a)/2 + cot(phi/2) (u x d)/2, and the
slide u.d (Bottema and Roth, Theoretical Kinematics, chapter 3). A point of an axis is the one
nearest to the ground origin.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.derived.basis import Reading
from mechkin_cli.analysis.derived.rotations import angle, quaternion
from mechkin_cli.analysis.derived.row_vectors import (
    add,
    choose,
    cross,
    divide,
    dot,
    length,
    off,
    scale,
    subtract,
)
from mechkin_cli.mechanism.derived_quantities import reference_point

if TYPE_CHECKING:
    from mechkin_cli.analysis.derived.row_vectors import RowVector
    from mechkin_cli.arrays import Floats


class InstantScrew(NamedTuple):
    """Unit axis along the angular velocity, point (m), pitch (m/rad, right-handed positive).

    A link that only shifts has the direction of its velocity, no point and no pitch; one that
    stands still has nothing.
    """

    axis: RowVector
    point: RowVector
    pitch: Floats


class FiniteScrew(NamedTuple):
    """Unit axis, point (m), angle (rad, 0 to pi) and slide along the axis (m).

    A link that is only shifted has the direction of the shift, no point, angle 0 and the length of
    the shift; one that is where it was drawn has no axis, angle 0 and slide 0.
    """

    axis: RowVector
    point: RowVector
    angle: Floats
    slide: Floats


def instant_screw(run: Reading, link: str) -> InstantScrew:
    """The screw of a link's velocity."""
    unit = run.session.layout.length
    omega = run.vector(f"{link}.omega")
    place, velocity = run.vector(f"{link} place"), run.vector(f"{link} velocity")
    rate, speed = length(omega), length(velocity)
    fastest = np.max(np.abs(run.inputs.rates), axis=0, initial=0.0)
    still = tolerances.STANDS_STILL * np.maximum(fastest, np.maximum(rate, speed / unit))
    turns, moves = rate > still, speed > still * unit
    axis = choose(turns, divide(omega, rate), choose(moves, divide(velocity, speed), np.nan))
    centre = add(place, divide(cross(axis, velocity), rate))
    pitch = np.where(turns, dot(axis, velocity) / rate, np.nan)
    return InstantScrew(axis, choose(turns, off(axis, centre), np.nan), pitch)


def finite_screw(run: Reading, link: str) -> FiniteScrew:
    """The screw of a link's displacement from the drawing."""
    q = quaternion(run.rotation(link))
    size = length(q[1:])
    place = run.vector(f"{link} place")
    x, y, z = reference_point(run.session.layout.mechanism, link).vector
    drawn = (np.full_like(size, x), np.full_like(size, y), np.full_like(size, z))
    shift = subtract(place, drawn)
    distance = length(shift)
    turned = size > tolerances.NO_TURN
    moved = distance > tolerances.NO_TURN * run.session.layout.length
    axis = choose(turned, divide(q[1:], size), choose(moved, divide(shift, distance), np.nan))
    lever = scale(np.abs(q[0]) / size, cross(axis, shift))
    centre = scale(0.5, add(add(drawn, place), lever))
    known = np.isfinite(size)
    slide = np.where(turned, dot(axis, shift), np.where(known & moved, distance, 0.0 * distance))
    return FiniteScrew(
        axis,
        choose(turned, off(axis, centre), np.nan),
        np.where(known & ~turned, 0.0, angle(q)),
        slide,
    )
