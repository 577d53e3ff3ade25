"""The kinds of numbers that the independent solution can be computed in.

The 4x4 matrices of the benchmark are nested lists whose entries are anything that adds and
multiplies: arrays of extended precision over the rows, or numbers of mpmath.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

DIGITS = 40
PI = "3.14159265358979323846264338327950288419716939937510582097494459"


@dataclass(frozen=True)
class Arithmetic:
    """Numbers made from doubles or texts, with their cosine and sine; `epsilon` is one rounding."""

    name: str
    epsilon: float
    number: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    sin: Callable[[Any], Any]

    def radians(self, degrees: int) -> Any:
        """An angle in degrees as radians."""
        return self.number(PI) * degrees / 180

    def zero_like(self, value: Any) -> Any:
        """Zero of the same shape."""
        return value * self.number(0)


def extended() -> Arithmetic:
    """The widest floating-point numbers of numpy: 80 bits on x86, elsewhere maybe only 64."""
    epsilon = float(np.finfo(np.longdouble).eps)
    name = f"numpy longdouble (rounding {epsilon:.0e})"
    return Arithmetic(name, epsilon, _long_double, np.cos, np.sin)


def best() -> Arithmetic:
    """mpmath with 40 digits if it can be imported, else `extended`; for one row at a time."""
    try:
        from importlib import import_module

        mpmath: Any = import_module("mpmath")
    except ImportError:
        return extended()
    context = mpmath.MPContext()
    context.dps = DIGITS
    name = f"mpmath ({DIGITS} digits)"
    return Arithmetic(name, 10.0**-DIGITS, context.mpf, context.cos, context.sin)


def _long_double(value: Any) -> Any:
    return np.asarray(value, dtype=np.longdouble)[()]
