"""Whole turns of angles: taken off in the file's own unit, so that decimal degrees stay exact.

360 deg are exact in degrees and not in radians: 36010 deg is 100 turns and 10 deg, exactly, while
its radians are rounded by half the last place of 628. Where a turn is no whole number of the unit
(rad), it is subtracted in three parts with their rounding errors (W. J. Cody, W. Waite, Software
Manual for the Elementary Functions, 1980; D. E. Knuth, The Art of Computer Programming 2, 4.2.2).
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

MOST_TURNS = float(1 << 52)
"""Whole turns beyond which an angle says nothing of the place within a turn."""

_PART_BITS = 26
"""Bits of the first parts of a turn: their products with as many bits of turns are exact."""


def reduce_angle(value: float, turn: Fraction) -> tuple[float, float]:
    """One angle; as `without_turns`."""
    if abs(value) <= 0.5 * float(turn):
        return value, 0.0
    rest, whole = without_turns(np.array([value]), turn)
    return float(rest[0]), float(whole[0])


def without_turns(values: Floats, turn: Fraction) -> tuple[Floats, Floats]:
    """Angles in (-half a turn, half a turn] and the whole turns taken off, both (rows,).

    Args:
        values: angles.
        turn: a full turn in their unit.
    """
    size = float(turn)
    most = float(np.max(np.abs(values), initial=0.0))
    if not 0.5 * size < most <= MOST_TURNS * size:
        return values, np.zeros_like(values)
    if Fraction(size) == turn:
        rest = np.fmod(values, size)  # exact by IEEE 754
    else:
        rest = _subtract(values, np.rint(values / size), turn)
    for way in (1.0, -1.0):
        beyond = rest > 0.5 * size if way > 0.0 else rest <= -0.5 * size
        if beyond.any():
            here = rest[beyond]
            rest[beyond] = _subtract(here, np.full_like(here, way), turn)
    return rest, np.rint((values - rest) / size)


def _subtract(values: Floats, whole: Floats, turn: Fraction) -> Floats:
    """values - whole * turn to the last place."""
    if np.any(np.abs(whole) >= float(1 << _PART_BITS)):
        rows = zip(values.tolist(), whole.tolist(), strict=True)
        return np.array([float(Fraction(x) - int(k) * turn) for x, k in rows])
    first, second, third = _parts(turn)
    one, lost = _difference(values, whole * first)
    two, more = _difference(one, whole * second)
    rest: Floats = two + ((lost + more) - whole * third)
    return rest


def _difference(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """a - b and what rounding lost of it."""
    s = a - b
    t = s - a
    return s, (a - (s - t)) - (b + t)


@cache
def _parts(turn: Fraction) -> tuple[float, float, float]:
    found = []
    rest = turn
    for _ in range(2):
        places = _PART_BITS - int(np.frexp(float(rest))[1])
        scale = Fraction(1 << max(places, 0), 1 << max(-places, 0))
        part = Fraction(int(rest * scale), 1) / scale
        found.append(float(part))
        rest -= part
    return found[0], found[1], float(rest)
