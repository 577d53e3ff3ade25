"""Motions with closed forms."""

from __future__ import annotations

import mpmath
from kernel.forced import Switch, System

from mechkin_cli.tape.scalars import sin


def oscillator(*switches: Switch, at: float = 0.0) -> System:
    """x'' = -x with the work of a damper of coefficient 1 that has no force, or a switch x - at."""

    def rates(t, x, v, w, side, p):
        return [-x[0]], [v[0] * v[0]], [x[0] - at for _ in switches], 0.0

    return System(rates, 1, 1, switches)


PENDULUM = System(lambda t, x, v, w, side, p: ([-p[0] * sin(x[0])], [], [], 0.0), 1, 0, (), 1)


def exact_pendulum(time: float, rate: float, square: float) -> float:
    """theta(time) of theta'' = -square sin(theta) from 0 with a rate below the one that turns it
    over: sin(theta/2) = k sn(sqrt(square) time, k), k = rate/(2 sqrt(square))."""
    with mpmath.workdps(40):
        root = mpmath.sqrt(square)
        k = mpmath.mpf(rate) / (2 * root)
        return float(2 * mpmath.asin(k * mpmath.ellipfun("sn", root * time, m=k * k)))


def wall() -> System:
    """x'' = -x where x is below the parameter; beyond is a fault 7."""
    return System(
        lambda t, x, v, w, side, p: ([-x[0]], [], [], (p[0] - x[0] < 0.0).choose(7.0, 0.0)),
        1,
        0,
        (),
        1,
    )
