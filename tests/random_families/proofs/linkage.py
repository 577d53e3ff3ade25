"""A linkage written in decimals, and what closed forms say of it at many digits."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, localcontext
from typing import Any

from oracle.numerics import mp

DIGITS = 110
"""Of closed forms: second differences over `STEP` keep 40 of them, up to 1e-12 from an end."""
STEP = mp.mpf(10) ** -30
"""Seconds."""

Place = tuple[str, ...]
"""Inputs in degrees, as written."""
Rates = Sequence[str]
"""Of the inputs, in rad/s and rad/s^2 as written."""
Assemblies = Mapping[int, Mapping[str, Any]]
"""Coordinates (rad, m) of what closes at one place, by side: 1 and -1, or none."""


@dataclass(frozen=True)
class Linkage:
    """`margin` tells of inputs in rad, arrays, how far the linkage is from an end of its branch:
    zero there, negative where nothing closes, of the order of one where it is far."""

    body: str
    inputs: tuple[str, ...]
    assemblies: Callable[[Sequence[Any]], Assemblies]
    margin: Callable[[Sequence[Any]], Any]
    home: int
    """The side on which it is drawn."""

    def text(self, places: Sequence[Place], rates: Rates, accelerations: Rates) -> str:
        """The file of a sweep over places."""
        laws = []
        for k, name in enumerate(self.inputs):
            values = ", ".join(f"{place[k]} deg" for place in places)
            law = f"values: [{values}], rate: {rates[k]}, acceleration: {accelerations[k]}"
            laws.append(f"{name}: {{{law}}}")
        return f"{self.body}motion: {{inputs: {{{', '.join(laws)}}}}}\n"

    def at(self, place: Place) -> Assemblies:
        """What closes there."""
        with mp.workdps(DIGITS):
            return self.assemblies([mp.radians(mp.mpf(x)) for x in place])

    def moving(self, place: Place, rates: Rates, accelerations: Rates, side: int) -> dict[str, Any]:
        """Coordinates, rates and accelerations of the assembly on a side."""
        with mp.workdps(DIGITS):
            before, here, after = (
                self.assemblies(
                    [
                        mp.radians(mp.mpf(x)) + mp.mpf(v) * t + mp.mpf(a) * t * t / 2
                        for x, v, a in zip(place, rates, accelerations, strict=True)
                    ]
                )[side]
                for t in (-STEP, mp.zero, STEP)
            )
            found: dict[str, Any] = {}
            for name, value in here.items():
                one, other = (within_a_turn(name, x[name] - value) for x in (after, before))
                found[name] = value
                found[f"{name}_dot"] = (one - other) / (2 * STEP)
                found[f"{name}_ddot"] = (one + other) / STEP**2
            return found


def within_a_turn(name: str, angle: Any) -> Any:
    """An angle's difference modulo a turn; lengths as they are."""
    if name.endswith(".s"):
        return angle
    return angle - 2 * mp.pi * mp.nint(angle / (2 * mp.pi))


def decimal(rng: random.Random, low: float, high: float) -> Decimal:
    """Three decimals."""
    return Decimal(f"{rng.uniform(low, high):.3f}")


def decimals(rng: random.Random, count: int = 3, size: float = 1.0) -> tuple[Decimal, ...]:
    """A vector within a size."""
    return tuple(decimal(rng, -size, size) for _ in range(count))


@dataclass(frozen=True)
class Frame:
    """Where a drawing lies in space, and its size: turned by a matrix of decimals."""

    axes: tuple[tuple[Decimal, ...], ...]
    origin: tuple[Decimal, ...]
    power: int

    def point(self, *drawn: Decimal) -> str:
        """A point of the drawing, of two or three components, in m."""
        with localcontext(prec=90):
            x = (*drawn, Decimal(0))[:3]
            turned = (sum(a * b for a, b in zip(row, x, strict=True)) for row in self.axes)
            placed = (a + b for a, b in zip(turned, self.origin, strict=True))
            return _text(value.scaleb(self.power) for value in placed)

    def direction(self, *drawn: Decimal) -> str:
        """A direction of the drawing."""
        with localcontext(prec=90):
            x = (*drawn, Decimal(0))[:3]
            return _text(sum(a * b for a, b in zip(row, x, strict=True)) for row in self.axes)


def frame(rng: random.Random) -> Frame:
    """Sizes 1e-9 to 1e9 m; one in three is not turned, one in two is about its origin."""
    one, zero = Decimal(1), Decimal(0)
    axes = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
    for first, second in ((0, 1), (1, 2), (0, 1)) if rng.random() < 0.67 else ():
        c, s = map(Decimal, rng.choice((("0.6", "0.8"), ("-0.8", "0.6"), ("0.28", "-0.96"))))
        turn = [list(row) for row in ((one, zero, zero), (zero, one, zero), (zero, zero, one))]
        turn[first][first], turn[first][second] = c, -s
        turn[second][first], turn[second][second] = s, c
        axes = tuple(
            tuple(sum(turn[i][k] * axes[k][j] for k in range(3)) for j in range(3))
            for i in range(3)
        )
    origin = decimals(rng, size=3.0) if rng.random() < 0.5 else (zero, zero, zero)
    return Frame(axes, origin, rng.choice((0, 0, 0, *range(-9, 10))))


def _text(values: Any) -> str:
    return "[" + ", ".join(f"{value:e}" for value in values) + "]"
