"""Four-bars of the plane that miss a fold by little: the rod is too long or too short by a part of
itself, so that two branches keep apart by about its root. The motion turns from one to the other.

The reference goes along |C - B|^2 = rod^2 by its own arc length in (theta, phi), whose tangent
turns and never jumps, and back onto the curve after each short piece.
"""

from __future__ import annotations

import math
import random
from cmath import exp
from typing import Any

import numpy as np
from random_families.change_points.neutral import GRAVITY, Array, Case, draw, response
from scipy.integrate import solve_ivp

PIECES, LENGTH = 48, 4.8
"""Of the way in (theta, phi), rad."""


class Way:
    """Along the curve of a planar four-bar with a rod of its own; points are complex numbers."""

    def __init__(self, sides: Any, masses: Array, weights: Array, square: float) -> None:
        self.ground, self.crank, self.rocker = sides.ground, sides.crank, sides.rocker
        self.masses = masses.tolist()
        self.along = [complex(x, y) for x, y in weights]
        self.square, self.energy = square, 0.0

    def miss(self, theta: float, phi: float) -> tuple[float, float, float]:
        """What the closure misses, and its derivatives."""
        first, second = self.crank * exp(1j * theta), self.rocker * exp(1j * phi)
        rod = self.ground + second - first
        value = rod.real**2 + rod.imag**2 - self.square
        x = 2 * (rod.conjugate() * (-1j * first)).real
        return value, x, 2 * (rod.conjugate() * (1j * second)).real

    def closed(self, theta: float, phi: float) -> tuple[float, float]:
        """The place of the curve next to one."""
        for _ in range(4):
            off, x, y = self.miss(theta, phi)
            theta, phi = theta - x * off / (x * x + y * y), phi - y * off / (x * x + y * y)
        return theta, phi

    def moved(self, theta: float, phi: float, x: float, y: float) -> tuple[float, float]:
        """Inertia along a direction, and the potential energy."""
        first, second = self.crank * exp(1j * theta), self.rocker * exp(1j * phi)
        turn, swing = 1j * x * first, 1j * y * second
        one, two, three = self.along
        places = (
            one * first,
            first + two * (self.ground + second - first),
            self.ground + three * second,
        )
        rates = (one * turn, turn + two * (swing - turn), three * swing)
        inertia = sum(m * abs(v) ** 2 for m, v in zip(self.masses, rates, strict=True))
        height = -sum(
            m * (GRAVITY[0] * p.real + GRAVITY[1] * p.imag)
            for m, p in zip(self.masses, places, strict=True)
        )
        return inertia, float(height)

    def tangent(self, theta: float, phi: float) -> tuple[float, float]:
        _, x, y = self.miss(theta, phi)
        size = math.hypot(x, y)
        return y / size, -x / size

    def rates(self, _: float, y: Array) -> list[float]:
        theta, phi = float(y[0]), float(y[1])
        along = self.tangent(theta, phi)
        inertia, height = self.moved(theta, phi, *along)
        return [*along, math.sqrt(inertia / (2 * (self.energy - height)))]

    def go(self, theta: float, phi: float, sign: float) -> Array:
        """theta, phi and the time (3, pieces + 1); it falls where the way goes backwards."""
        y = np.array([theta, phi, 0.0])
        places = [y]
        for _ in range(PIECES):
            piece = (0, sign * LENGTH / PIECES)
            y = solve_ivp(self.rates, piece, y, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
            y[:2] = self.closed(y[0], y[1])
            places.append(y.copy())
        return np.array(places).T


def near_case(number: int, part: float) -> Case:
    """The mechanism of a number, the square of its rod wrong by a `part`; steps exact to 1e-9, as
    rounding is magnified by one over the gap."""
    r = random.Random(number)
    while True:
        curve, what = draw(r)
        masses = np.array([r.uniform(0.5, 2) for _ in range(3)])
        weights = np.array([(r.uniform(0.3, 1.2), r.uniform(-0.3, 0.3)) for _ in range(3)])
        psi = np.array([r.choice((0, math.pi)) + r.uniform(0.5, 1.5)])
        sign = r.choice((-1.0, 1.0))
        if curve.sides.is_spherical:
            continue
        (c, s), (k, z) = curve.directions(psi)
        rod = curve.sides.span(*curve.fold)
        way = Way(curve.sides, masses, weights, rod * (1 + part))
        theta, phi = way.closed(math.atan2(s[0], c[0]), math.atan2(z[0], k[0]))
        along = way.tangent(theta, phi)
        if abs(along[0]) > 0.2 and rod > 0.05:
            break
    inertia, low = way.moved(theta, phi, *along)
    way.energy = low + 25 * float(masses.sum())
    found = way.go(theta, phi, sign)
    rate = sign * along[0] * math.sqrt(2 * (way.energy - low) / inertia)
    times = sign * found[2]
    rows = np.arange(0, PIECES + 1, PIECES // 8)
    at = tuple((np.array([math.cos(x)]), np.array([math.sin(x)])) for x in (theta, phi))
    name = f"near miss {number}"
    text = response(name, curve, at, masses, weights, rate, times[rows], 1e-9)
    off = found - found[:, :1]
    return Case(text, f"{what}, rod {part:g}", times[rows], off[0, rows], off[1, rows], 0)
