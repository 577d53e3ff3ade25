"""Random numbers of few decimal digits, the same on every machine."""

from __future__ import annotations

import random
from collections.abc import Sequence
from decimal import Decimal

import numpy as np

from benchmarks.stress.quantity import Rows

DIGITS = 4
Generators = Sequence[random.Random]


def generator(seed: int, family: str, number: int) -> random.Random:
    """That of one mechanism, whichever others are drawn."""
    return random.Random(f"{seed} {family} {number}")


def uniform(rng: random.Random, low: float, high: float) -> float:
    """A decimal between two."""
    return round(rng.uniform(low, high), DIGITS)


def magnitude(rng: random.Random, low: int, high: int) -> float:
    """Digits in [1, 10) times a power of ten from 10^low up to, and without, 10^high."""
    return float(f"{uniform(rng, 1.0, 9.999)}e{rng.randrange(low, high)}")


def scaled(value: float, power: int) -> float:
    """A decimal times a power of ten, rounded once."""
    return float(Decimal(repr(value)).scaleb(power))


def point(rng: random.Random, size: float = 1.0) -> list[float]:
    """Components within a size."""
    return [uniform(rng, -size, size) for _ in range(3)]


def direction(rng: random.Random) -> list[float]:
    """A vector of about unit length that is nowhere near zero."""
    while True:
        found = point(rng)
        if 0.3 < sum(x * x for x in found) < 1.0:
            return found


def array(rows: Sequence[Sequence[float]]) -> Rows:
    """Rows of numbers as an array."""
    return np.array(rows, float)


def transposed(drawn: Sequence[Sequence[Sequence[float]]]) -> tuple[Rows, ...]:
    """Of (mechanisms, items) vectors, one array (mechanisms, components) for each item."""
    return tuple(array(item) for item in zip(*drawn, strict=True))
