"""Integrals of samples at equal distances, in a fixed order of sums.

Between two samples stands the integral of the polynomial through the `POINTS` nearest ones, of
degree POINTS - 1. Over a whole cycle of a periodic function these add up to the trapezoidal rule,
whose error falls faster than any power of the distance where the function is smooth (Trefethen and
Weideman, The exponentially convergent trapezoidal rule, SIAM Review 56, 2014).
"""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

POINTS = 8
"""Samples that the integral over one interval reads; the error falls with their distance to the
ninth power on an interval, to the eighth over all."""


@cache
def interval_weights(points: int, place: int) -> tuple[float, ...]:
    """What each of `points` samples at 0, 1, 2 ... adds to the integral from `place` to the next.

    >>> interval_weights(2, 0)
    (0.5, 0.5)
    """
    weights = []
    for own in range(points):
        polynomial, divisor = [Fraction(1)], 1
        for other in range(points):
            if other != own:
                raised = [Fraction(0), *polynomial]
                for power, factor in enumerate(polynomial):
                    raised[power] -= other * factor
                polynomial, divisor = raised, divisor * (own - other)
        antiderivative = [factor / (power + 1) for power, factor in enumerate(polynomial)]
        rise = _horner(antiderivative, place + 1) - _horner(antiderivative, place)
        weights.append(float(rise / divisor))
    return tuple(weights)


def _horner(factors: list[Fraction], x: int) -> Fraction:
    """x (factors[0] + x (factors[1] + ...))."""
    value = Fraction(0)
    for factor in reversed(factors):
        value = (value + factor) * x
    return value


def total(values: Floats) -> float:
    """The sum in the order of the samples, with what each addition loses (Neumaier, 1974)."""
    found = lost = 0.0
    for value in values.tolist():
        after = found + value
        small, large = (value, found) if abs(found) >= abs(value) else (found, value)
        lost += (large - after) + small
        found = after
    return found + lost


def running_integral(values: Floats, step: float) -> Floats:
    """From the first sample to each (samples,), which is zero at the first; nan from a sample on
    that is nan."""
    found = np.zeros(values.size)
    found[1:] = np.cumsum(interval_integrals(values, POINTS)) * step
    return found


def interval_integrals(values: Floats, most: int) -> Floats:
    """From each sample to the next (samples - 1,), a unit apart, of the polynomial through the
    `most` nearest ones."""
    count = values.size
    points = min(most, count)
    parts = np.empty(max(count - 1, 0))
    for interval in range(count - 1):
        first = min(max(interval - (points // 2 - 1), 0), count - points)
        weights = interval_weights(points, interval - first)
        parts[interval] = total(np.array(weights) * values[first : first + points])
    return parts


def running_integral_of_cycle(values: Floats, step: float) -> Floats:
    """The same over a cycle whose `values` (samples,) repeat: at the samples and at its end
    (samples + 1,)."""
    points = min(POINTS, values.size)
    around = np.concatenate([values, values, values])
    weights = interval_weights(points, points // 2 - 1)
    first = values.size - (points // 2 - 1)
    parts = np.zeros(values.size)
    for place, weight in enumerate(weights):
        parts += weight * around[first + place : first + place + values.size]
    return np.concatenate([[0.0], np.cumsum(parts) * step])


def over_cycle(values: Floats, step: float) -> tuple[float, float]:
    """The integral over a cycle whose `values` (samples,) repeat, and how far it may be off: what
    leaving out every other sample changes; of an odd number what the ends' polynomials change that
    know of no cycle."""
    total = mean(values) * values.size * step
    if values.size % 2 == 0:
        half = mean(values[::2]) * values.size * step
    else:
        closed = np.concatenate([values, values[:1]])
        half = float(running_integral(closed, step)[-1])
    return total, abs(total - half)


def mean(values: Floats) -> float:
    """The mean of samples; nan where one is."""
    if not np.isfinite(values).all():
        return float("nan")
    return total(values) / values.size


def largest_between(values: Floats) -> float:
    """The largest value of a periodic function between its samples: of the polynomial through the
    samples around the largest one."""
    top = int(np.argmax(values))
    points = min(POINTS - 1, values.size)
    reach = points // 2
    near = [float(values[(top + k) % values.size]) for k in range(-reach, points - reach)]
    low, high = -1.0, 1.0
    # golden section: the polynomial has one top between the neighbours of the largest sample
    ratio = 0.6180339887498949
    for _ in range(60):
        inner, outer = high - ratio * (high - low), low + ratio * (high - low)
        if _at(near, inner + reach) < _at(near, outer + reach):
            low = inner
        else:
            high = outer
    return max(_at(near, (low + high) / 2.0 + reach), near[reach])


def _at(samples: list[float], place: float) -> float:
    """The polynomial through samples at 0, 1, 2 ... (Neville)."""
    column = list(samples)
    for width in range(1, len(column)):
        for k in range(len(column) - width):
            column[k] = ((place - k) * column[k + 1] + (k + width - place) * column[k]) / width
    return column[0]
