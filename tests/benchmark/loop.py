"""A loop of revolutes by 4x4 matrices: positions by Newton's method, rates and accelerations by the
product rule.

Closure: the product of the displacements M1(theta1) ... M7(theta7) is the identity; near it, its
skew part and its translation are the small displacement that is missing. Works in any `Arithmetic`;
with arrays, all rows at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from benchmark.arithmetic import Arithmetic
from benchmark.closure import Motion, moved
from benchmark.matrices import (
    Matrix,
    Vector,
    displacement,
    dot,
    plus,
    product,
    times,
    turning,
)
from benchmark.vector_equations import solve_columns

from benchmarks.sevenr import ACCELERATION, RATE, Loop

NEWTON_STEPS = 4
"""From a guess of 1e-9, quadratic convergence passes 40 digits in three steps."""


@dataclass(frozen=True)
class Lines:
    """Unit vectors and points of the joints' lines in the home drawing, as `arithmetic` has it."""

    arithmetic: Arithmetic
    axes: list[Vector]
    points: list[Vector]


def lines_of(loop: Loop, arithmetic: Arithmetic) -> Lines:
    """The joints' lines in the numbers of `arithmetic`."""
    number = arithmetic.number
    axes = []
    for line in loop.lines:
        axis = [number(x) for x in line.axis]
        length = dot(axis, axis) ** (number(1) / 2)
        axes.append([x / length for x in axis])
    return Lines(arithmetic, axes, [[number(x) for x in line.point] for line in loop.lines])


@dataclass(frozen=True)
class LoopKinematics:
    """Angles of all joints with their time derivatives, and the motion of links 1 to 6."""

    angles: Vector
    rates: Vector
    accelerations: Vector
    links: list[Motion]


def loop_kinematics(lines: Lines, theta1: Any, guess: Vector, dtype: Any) -> LoopKinematics:
    """Position next to the guess (theta2 ... theta7), rates and accelerations.

    Args:
        lines: the joints' lines.
        theta1: angle of the input, a number or (rows).
        guess: likewise, one per other joint.
        dtype: numpy's type of the numbers.
    """
    number, zero = lines.arithmetic.number, lines.arithmetic.zero_like(theta1)
    angles = [theta1, *guess]
    for _ in range(NEWTON_STEPS):
        gap, columns = _gap_and_columns(lines, angles)
        step = solve_columns(columns[1:], gap, dtype)
        angles = [theta1, *(x - dx for x, dx in zip(angles[1:], step, strict=True))]
    _, columns = _gap_and_columns(lines, angles)
    w1, a1 = zero + number(RATE), zero + number(ACCELERATION)
    rates = [w1, *solve_columns(columns[1:], [-w1 * x for x in columns[0]], dtype)]
    drift = _twist(_motions(lines, angles, rates, [a1, *[zero] * len(guess)])[-1].second)
    accelerations = [a1, *solve_columns(columns[1:], [-x for x in drift], dtype)]
    links = _motions(lines, angles, rates, accelerations)[:-1]
    return LoopKinematics(angles, rates, accelerations, links)


def _displacements(lines: Lines, angles: Vector) -> list[Matrix]:
    return [
        displacement(axis, point, angle, 0 * angle, lines.arithmetic)
        for axis, point, angle in zip(lines.axes, lines.points, angles, strict=True)
    ]


def _motions(lines: Lines, angles: Vector, rates: Vector, accelerations: Vector) -> list[Motion]:
    """Motions of links 1 to 7; the last one is ground again where the loop is closed."""
    found: list[Motion] = []
    for k, place in enumerate(_displacements(lines, angles)):
        D = turning(lines.axes[k], lines.points[k])
        step = moved(place, times(rates[k], D), times(accelerations[k], D))
        if found:
            last = found[-1]
            both = product(last.rate, step.rate)
            outer = plus(product(last.second, step.place), product(last.place, step.second))
            step = Motion(
                product(last.place, step.place),
                plus(product(last.rate, step.place), product(last.place, step.rate)),
                plus(outer, plus(both, both)),
            )
        found.append(step)
    return found


def _gap_and_columns(lines: Lines, angles: Vector) -> tuple[Vector, list[Vector]]:
    """The product of all displacements and its derivative by each angle, as twists."""
    places = _displacements(lines, angles)
    before, after = [places[0]], [places[-1]]
    for place in places[1:]:
        before.append(product(before[-1], place))
    for place in reversed(places[:-1]):
        after.append(product(place, after[-1]))
    columns = []
    for k, rest in enumerate(reversed(after)):
        turned = product(turning(lines.axes[k], lines.points[k]), rest)
        columns.append(_twist(product(before[k - 1], turned) if k else turned))
    return _twist(before[-1]), columns


def _twist(m: Matrix) -> Vector:
    """Skew part of the rotation and the translation (of a small displacement or a derivative)."""
    skew = [(m[2][1] - m[1][2]) / 2, (m[0][2] - m[2][0]) / 2, (m[1][0] - m[0][1]) / 2]
    return [*skew, *(row[3] for row in m[:3])]
