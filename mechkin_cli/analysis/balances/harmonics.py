"""Fourier coefficients over a cycle of rows at equal distances.

    f = mean + sum over n of (c_n cos(n x) + s_n sin(n x)),     x the input's angle, or 2 pi t / T

Of N rows these are the coefficients of the trigonometric polynomial through them; what orders above
N/2 of the function leave in them (aliasing) falls as its harmonics do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.analysis.derived.quadrature import total
from mechkin_cli.kernel.functions import atan2, cos, sin

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.balance import Cycle


class Harmonic(NamedTuple):
    """One order: coefficients, amplitude and phase (rad) of amplitude cos(n x - phase), and how far
    the coefficients may be off."""

    order: float
    cosine: float
    sine: float
    amplitude: float
    phase: float
    error: float


def harmonic(values: Floats, cycle: Cycle, order: float) -> Harmonic:
    """The harmonic of an order of samples over the cycle (rows - 1,)."""
    cosine, sine = _coefficients(values, cycle, order)
    error = float("nan")
    if values.size % 2 == 0 and 4 * round(order * cycle.turns) < values.size:
        coarse = _coefficients(values[::2], cycle, order)
        error = max(abs(cosine - coarse[0]), abs(sine - coarse[1]))
    amplitude = float(np.sqrt(cosine * cosine + sine * sine))
    phase = float(atan2(np.array([sine]), np.array([cosine]))[0])
    return Harmonic(order, cosine, sine, amplitude, phase, error)


def _coefficients(values: Floats, cycle: Cycle, order: float) -> tuple[float, float]:
    count, whole = values.size, round(order * cycle.turns)
    # n x from row to row is a whole number of N-th parts of a turn
    part = (whole * np.arange(count)) % count
    angle = np.asarray(part * (2.0 * np.pi / count), dtype=np.float64)
    if cycle.number is not None:
        angle = (angle if cycle.step > 0.0 else -angle) + order * cycle.first
    factor = (1.0 if whole == 0 else 2.0) / count
    cosine = factor * total(values * cos(angle))
    sine = 0.0 if whole == 0 else factor * total(values * sin(angle))
    return cosine, sine
