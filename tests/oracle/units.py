"""Units of a file, and the coherent base in which the oracle computes.

If the file's force is its mass * length / time^2 (`lbm*in/s^2` with in, lbm and s), the file's own
units are coherent: Newton's law holds between the bare numbers, and they are the base. Otherwise
(`lbf` with `lbm`, `N` with `mm`) the base is SI. Angles are always in radians.
"""

from __future__ import annotations

import re
from fractions import Fraction
from functools import lru_cache

from oracle.numerics import Number, mp

_INCH, _POUND, _GRAVITY = Fraction(254, 10000), Fraction(45359237, 10**8), Fraction(980665, 10**5)

# name: (SI value, exponents of length, mass, time)
_UNITS: dict[str, tuple[Fraction, tuple[int, int, int]]] = {
    "m": (Fraction(1), (1, 0, 0)),
    "mm": (Fraction(1, 1000), (1, 0, 0)),
    "cm": (Fraction(1, 100), (1, 0, 0)),
    "km": (Fraction(1000), (1, 0, 0)),
    "in": (_INCH, (1, 0, 0)),
    "ft": (12 * _INCH, (1, 0, 0)),
    "kg": (Fraction(1), (0, 1, 0)),
    "g": (Fraction(1, 1000), (0, 1, 0)),
    "t": (Fraction(1000), (0, 1, 0)),
    "lbm": (_POUND, (0, 1, 0)),
    "slug": (_POUND * _GRAVITY / (12 * _INCH), (0, 1, 0)),
    "s": (Fraction(1), (0, 0, 1)),
    "ms": (Fraction(1, 1000), (0, 0, 1)),
    "min": (Fraction(60), (0, 0, 1)),
    "N": (Fraction(1), (1, 1, -2)),
    "mN": (Fraction(1, 1000), (1, 1, -2)),
    "kN": (Fraction(1000), (1, 1, -2)),
    "lbf": (_POUND * _GRAVITY, (1, 1, -2)),
    "kgf": (_GRAVITY, (1, 1, -2)),
    "rad": (Fraction(1), (0, 0, 0)),
}
_PARTS_OF_PI = {"deg": Fraction(1, 180), "turn": Fraction(2), "rev": Fraction(2)}

WORDS = (*_UNITS, *_PARTS_OF_PI)
_DEFAULTS = {
    "length": "m",
    "angle": "deg",
    "mass": "kg",
    "force": "N",
    "time": "s",
    "angular_rate": "rad/s",
}
_KINDS = {
    "length": "{length}",
    "angle": "{angle}",
    "mass": "{mass}",
    "force": "{force}",
    "torque": "{force}*{length}",
    "inertia": "{mass}*{length}^2",
    "speed": "{length}/{time}",
    "acceleration": "{length}/{time}^2",
    "jerk": "{length}/{time}^3",
    "angular rate": "{angular_rate}",
    "angular acceleration": "{angular_rate}/s",
    "angular jerk": "{angular_rate}/s^2",
}


def _factors(text: str) -> list[tuple[str, int]]:
    """`lbm*in/s^2` -> (lbm, 1), (in, 1), (s, -2)."""
    found = re.findall(r"([*/]?)\s*([A-Za-z]+)(?:\^(-?\d+))?", text)
    return [(w, (-1 if sign == "/" else 1) * int(power or 1)) for sign, w, power in found]


class Units:
    """The units of one file; `of(kind)` is what a bare number 1 of that kind is in the base."""

    def __init__(self, written: dict[str, str] | None = None) -> None:
        self.words = _DEFAULTS | (written or {})
        length, mass, time = (self._si(self.words[k]) for k in ("length", "mass", "time"))
        self.coherent = self._si(self.words["force"]) == mass * length / time**2
        self._base = (length, mass, time) if self.coherent else (Fraction(1),) * 3
        self.value = lru_cache(self._value)

    @staticmethod
    def _si(text: str) -> Fraction:
        value = Fraction(1)
        for word, power in _factors(text):
            value *= _UNITS[word][0] ** power
        return value

    def _value(self, text: str) -> Number:
        """The unit `text` in the base."""
        value = mp.one
        for word, power in _factors(text):
            if word in _PARTS_OF_PI:
                part = _PARTS_OF_PI[word]
                factor = mp.pi * part.numerator / part.denominator
            else:
                si, exponents = _UNITS[word]
                for size, exponent in zip(self._base, exponents, strict=True):
                    si /= size**exponent
                factor = mp.mpf(si.numerator) / si.denominator
            value *= factor**power
        return value

    def text(self, kind: str) -> str:
        """The file's unit of a kind, as text that may follow a number."""
        return _KINDS[kind].format(**self.words)

    def of(self, kind: str) -> Number:
        """One file unit of a kind (a key of the table above) in the base; `number` is 1."""
        return mp.one if kind == "number" else self.value(self.text(kind))
