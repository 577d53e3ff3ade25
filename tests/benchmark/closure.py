"""The RCSR loop by 4x4 matrices: positions by Newton's method, rates and accelerations by the
product rule.

Closure: the sphere's centre on the coupler, M1(theta1) M2(theta2, s) p, is that on the rocker,
M4(theta4) q. Works in any `Arithmetic`; with arrays, all rows at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from benchmark.arithmetic import Arithmetic
from benchmark.matrices import (
    Matrix,
    Vector,
    displacement,
    image,
    plus,
    product,
    sliding,
    solve_three,
    times,
    turning,
)

from benchmarks.rcsr import ACCELERATION, ALPHA1, ALPHA4, RATE, Dimensions

NEWTON_STEPS = 8
"""From a guess of 1e-3, quadratic convergence passes 40 digits in five steps."""


@dataclass(frozen=True)
class Drawing:
    """Axes and points of the home drawing, in the numbers of `arithmetic`."""

    arithmetic: Arithmetic
    axis1: Vector
    point1: Vector
    axis2: Vector
    point2: Vector
    axis4: Vector
    point4: Vector
    on_coupler: Vector
    on_rocker: Vector


def drawing(size: Dimensions, arithmetic: Arithmetic) -> Drawing:
    """The home drawing of the mechanism."""
    number = arithmetic.number
    a1, a4 = arithmetic.radians(ALPHA1), arithmetic.radians(ALPHA4)
    c1, n1, c4, n4 = (f(a) for a in (a1, a4) for f in (arithmetic.cos, arithmetic.sin))
    zero, one = number(0), number(1)
    P1, P2, P3, P4 = (number(p) for p in (size.P1, size.P2, size.P3, size.P4))
    s1, s4 = number(size.s1), number(size.s4)
    return Drawing(
        arithmetic=arithmetic,
        axis1=[-one, zero, zero],
        point1=[-s1, zero, zero],
        axis2=[-c1, zero, -n1],
        point2=[-s1, -P1, zero],
        axis4=[c4, zero, -n4],
        point4=[s4 * c4, P4, -s4 * n4],
        on_coupler=[-s1, -P1 - P2, zero],
        on_rocker=[s4 * c4, P4 + P3, -s4 * n4],
    )


@dataclass(frozen=True)
class Motion:
    """A link's matrix and its first two time derivatives."""

    place: Matrix
    rate: Matrix
    second: Matrix


@dataclass(frozen=True)
class Kinematics:
    """Coordinates (theta2, s, theta4) with their time derivatives, and the motion of the three
    links."""

    coordinates: Vector
    rates: Vector
    accelerations: Vector
    links: dict[str, Motion]


@dataclass(frozen=True)
class Position:
    """The three displacements at one position, the gap of the closure, and its columns by
    coordinate."""

    M1: Matrix
    M2: Matrix
    M4: Matrix
    gap: Vector
    columns: dict[str, Vector]


def position(d: Drawing, theta1: Any, theta2: Any, s: Any, theta4: Any) -> Position:
    """The displacements and the derivatives of the gap by theta1, theta2, s and theta4."""
    zero = d.arithmetic.zero_like(theta1)
    M1 = displacement(d.axis1, d.point1, theta1, zero, d.arithmetic)
    M2 = displacement(d.axis2, d.point2, theta2, s, d.arithmetic)
    M4 = displacement(d.axis4, d.point4, theta4, zero, d.arithmetic)
    M12 = product(M1, M2)
    left, right = image(M12, d.on_coupler), image(M4, d.on_rocker)
    D2, S2 = turning(d.axis2, d.point2), sliding(d.axis2)
    return Position(
        M1,
        M2,
        M4,
        [x - y for x, y in zip(left, right, strict=True)],
        {
            "theta1": image(product(turning(d.axis1, d.point1), M12), d.on_coupler),
            "theta2": image(product(M1, product(D2, M2)), d.on_coupler),
            "s": image(product(M1, product(S2, M2)), d.on_coupler),
            "theta4": [-x for x in image(product(turning(d.axis4, d.point4), M4), d.on_rocker)],
        },
    )


def close(d: Drawing, known: dict[str, Any], guess: dict[str, Any]) -> dict[str, Any]:
    """All four coordinates: one known, the other three from a guess by Newton's method."""
    q = known | guess
    for _ in range(NEWTON_STEPS):
        here = position(d, q["theta1"], q["theta2"], q["s"], q["theta4"])
        step = solve_three([here.columns[name] for name in guess], here.gap)
        q = q | {name: q[name] - step[i] for i, name in enumerate(guess)}
    return q


def kinematics(d: Drawing, theta1: Any, guess: Vector) -> Kinematics:
    """Position next to the guess (theta2, s, theta4), rates and accelerations."""
    names = ("theta2", "s", "theta4")
    q = close(d, {"theta1": theta1}, dict(zip(names, guess, strict=True)))
    here = position(d, q["theta1"], q["theta2"], q["s"], q["theta4"])
    columns = [here.columns[name] for name in names]
    zero = d.arithmetic.zero_like(theta1)
    w1, a1 = zero + d.arithmetic.number(RATE), zero + d.arithmetic.number(ACCELERATION)
    rates = solve_three(columns, [-w1 * x for x in here.columns["theta1"]])
    drift = _links(d, here, (w1, *rates), (a1, zero, zero, zero))
    gap2 = [
        x - y
        for x, y in zip(
            image(drift["coupler"].second, d.on_coupler),
            image(drift["rocker"].second, d.on_rocker),
            strict=True,
        )
    ]
    accelerations = solve_three(columns, [-x for x in gap2])
    links = _links(d, here, (w1, *rates), (a1, *accelerations))
    return Kinematics([q[name] for name in names], rates, accelerations, links)


def _links(
    d: Drawing, here: Position, rates: tuple[Any, ...], accelerations: tuple[Any, ...]
) -> dict[str, Motion]:
    """Motions of the links for given rates and accelerations of theta1, theta2, s, theta4."""
    D1, D4 = turning(d.axis1, d.point1), turning(d.axis4, d.point4)
    D2, S2 = turning(d.axis2, d.point2), sliding(d.axis2)
    crank = moved(here.M1, times(rates[0], D1), times(accelerations[0], D1))
    on_crank = moved(
        here.M2,
        plus(times(rates[1], D2), times(rates[2], S2)),
        plus(times(accelerations[1], D2), times(accelerations[2], S2)),
    )
    rocker = moved(here.M4, times(rates[3], D4), times(accelerations[3], D4))
    both = product(crank.rate, on_crank.rate)
    coupler = Motion(
        product(crank.place, on_crank.place),
        plus(product(crank.rate, on_crank.place), product(crank.place, on_crank.rate)),
        plus(
            plus(product(crank.second, on_crank.place), product(crank.place, on_crank.second)),
            plus(both, both),
        ),
    )
    return {"crank": crank, "coupler": coupler, "rocker": rocker}


def moved(place: Matrix, first: Matrix, second: Matrix) -> Motion:
    """M' = W M and M'' = (W' + W W) M for the operators W and W' of a joint's motion."""
    return Motion(place, product(first, place), product(plus(second, product(first, first)), place))


@dataclass(frozen=True)
class DeadCentre:
    """Where theta1 turns back."""

    theta1: Any
    theta4: Any


def dead_centre(d: Drawing, guess: dict[str, float]) -> DeadCentre:
    """Where d(theta1)/d(theta4) = 0 next to a guess of all coordinates, by the secant method."""
    number = d.arithmetic.number
    q = {name: number(value) for name, value in guess.items()}

    def slope(theta4: Any) -> Any:
        nonlocal q
        start = {name: q[name] for name in ("theta1", "theta2", "s")}
        q = close(d, {"theta4": theta4}, start)
        here = position(d, q["theta1"], q["theta2"], q["s"], q["theta4"])
        columns = [here.columns[name] for name in start]
        return solve_three(columns, [-x for x in here.columns["theta4"]])[0]

    x0, x1 = q["theta4"], q["theta4"] - number(1) / 100
    y0, y1 = slope(x0), slope(x1)
    for _ in range(60):
        # theta1 is stationary here: a step of epsilon^0.6 moves it by less than epsilon
        if abs(float(x1 - x0)) < d.arithmetic.epsilon**0.6:
            break
        x0, x1, y0 = x1, x1 - y1 * (x1 - x0) / (y1 - y0), y1
        y1 = slope(x1)
    return DeadCentre(q["theta1"], q["theta4"])
