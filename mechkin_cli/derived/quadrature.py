"""Integrals in a fixed order of sums: of samples at equal distances, and of functions that jump.

Samples: between two of them stands the integral of the polynomial through the `POINTS` nearest
ones, of degree POINTS - 1. Over a whole cycle of a periodic function these add up to the
trapezoidal rule, whose error falls faster than any power of the distance where the function is
smooth (Trefethen and Weideman, The exponentially convergent trapezoidal rule, SIAM Review 56,
2014).

Functions that jump and bend (`integrals`): every piece is integrated by the 15 places of Kronrod's
extension of Gauss' seven (Piessens and others, QUADPACK, 1983, qk15). Its error is the difference
from the seven alone, without QUADPACK's hope for smoothness, and what lies between the outermost
places and the ends, where the polynomial through the places is compared with one more sample. A
piece that is not good enough is split in the middle, and one in which some smooth function, sampled
beside the integrands, has a zero is split there: what jumps at that zero costs no halving.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tolerances import NEXT_TO_END, NEXT_TO_ZERO, TURNS_NOT

if TYPE_CHECKING:
    from mechkin_cli.show import Bools, Floats


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
    result = lost = 0.0
    for value in values.tolist():
        after = result + value
        small, large = (value, result) if abs(result) >= abs(value) else (result, value)
        lost += (large - after) + small
        result = after
    return result + lost


def running_integral(values: Floats, step: float) -> Floats:
    """From the first sample to each (samples,), which is zero at the first; nan from a sample on
    that is nan."""
    integral = np.zeros(values.size)
    integral[1:] = np.cumsum(interval_integrals(values, POINTS)) * step
    return integral


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
    """The integral over a cycle whose `values` (samples,) repeat, and how far it may be off: by
    what leaving out every other sample changes; of an odd number of samples by what polynomials
    that do not go round the cycle change."""
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
        if _polynomial(near, inner + reach) < _polynomial(near, outer + reach):
            low = inner
        else:
            high = outer
    return max(_polynomial(near, (low + high) / 2.0 + reach), near[reach])


def _polynomial(samples: list[float], place: float) -> float:
    """The polynomial through samples at 0, 1, 2 ... (Neville)."""
    column = list(samples)
    for width in range(1, len(column)):
        for k in range(len(column) - width):
            column[k] = ((place - k) * column[k + 1] + (k + width - place) * column[k]) / width
    return column[0]


_HALF = (
    0.991455371120812639206854697526329,
    0.949107912342758524526189684047851,
    0.864864423359769072789712788640926,
    0.741531185599394439863864773280788,
    0.586087235467691130294144691693013,
    0.405845151377397166906606412076961,
    0.207784955007898467600689403773245,
)
_KRONROD = (
    0.022935322010529224963732008058970,
    0.063092092629978553290700663189204,
    0.104790010322250183839876322541518,
    0.140653259715525918745189590510238,
    0.169004726639267902826583426598550,
    0.190350578064785409913256402421014,
    0.204432940075298892414161999234649,
)
_GAUSS = (
    0.129484966168869693270611432679082,
    0.279705391489276667901467771423780,
    0.381830050505118944950369775488975,
)

PLACES = (*(-x for x in _HALF), 0.0, *reversed(_HALF))
"""On (-1, 1); every second one is Gauss'."""

FINE = (*_KRONROD, 0.209482141084727828012999174891714, *reversed(_KRONROD))
COARSE = (*_GAUSS, 0.417959183673469387755102040816327, *reversed(_GAUSS))
"""Weights of all places, and of Gauss' seven."""

ROUNDS = 48
"""Halvings after which a jump is as narrow as rounding."""


def integrals(
    low: Floats, high: Floats, sample: Callable[[Floats], tuple[Floats, Floats]], allowed: Floats
) -> tuple[Floats, Floats]:
    """Integrals from `low` to `high` (pieces,), rising and apart from each other, and how far each
    may be off (integrands, pieces).

    Args:
        low, high: the ends; no end is sampled.
        sample: at rising places the integrands (integrands, places), and functions whose zeros part
            them (functions, places).
        allowed: error for each unit of length (integrands,).
    """
    span = float(high[-1] - low[0]) if low.size else 0.0
    values, errors = np.zeros((2, allowed.size, low.size))
    own, largest = np.arange(low.size), 0.0
    for left in range(ROUNDS, -1, -1):
        if not low.size:
            break
        half, middle = 0.5 * (high - low), 0.5 * (low + high)
        places = np.array([-NEXT_TO_END, *PLACES, NEXT_TO_END])
        samples, parting = sample((middle[:, None] + half[:, None] * places).reshape(-1))
        fine, error = _both_rules(samples.reshape(allowed.size, -1, places.size), half)
        parting = parting.reshape(-1, low.size, places.size)[:, :, 1:-1]
        largest = np.fmax(largest, np.max(np.abs(parting), axis=(1, 2), initial=0.0))
        cuts = _zeros_inside(parting, low, high, NEXT_TO_ZERO * span, TURNS_NOT * largest)
        good = (error <= allowed[:, None] * (high - low)).all(axis=0)
        # halving does not help where there is no value anywhere near
        good |= ~np.isfinite(fine).any(axis=0)
        final = (good & np.array([not each for each in cuts], dtype=bool)) | (left == 0)
        for piece in np.flatnonzero(final):
            values[:, own[piece]] += fine[:, piece]
            errors[:, own[piece]] += error[:, piece]
        ends = [
            (a, b, own[piece])
            for piece in np.flatnonzero(~final)
            for a, b in pairwise([low[piece], *(cuts[piece] or [middle[piece]]), high[piece]])
        ]
        low, high = np.array([e[0] for e in ends]), np.array([e[1] for e in ends])
        own = np.array([e[2] for e in ends], dtype=np.int64)
    return values, errors


def _both_rules(every: Floats, half: Floats) -> tuple[Floats, Floats]:
    """Integrals (integrands, pieces) of samples (integrands, pieces, places and next to the ends),
    and their errors."""
    f = every[:, :, 1:-1]
    fine, coarse, size = np.zeros((3, *f.shape[:2]))
    for k, weight in enumerate(FINE):
        fine += weight * f[:, :, k]
        size += weight * np.abs(f[:, :, k])
    for k, weight in enumerate(COARSE):
        coarse += weight * f[:, :, 2 * k + 1]
    ends = np.fmax(
        np.abs(_interpolated(f, -NEXT_TO_END) - every[:, :, 0]),
        np.abs(_interpolated(f, NEXT_TO_END) - every[:, :, -1]),
    )
    error = np.fmax(np.abs(fine - coarse), (1.0 - PLACES[-1]) * ends)
    # rounding of the sums and of the samples
    floor = 16.0 * np.finfo(np.float64).eps * size
    return half * fine, half * np.where(error > floor, error, floor)


def _zeros_inside(
    parting: Floats, low: Floats, high: Floats, near: float, still: Floats
) -> list[list[float]]:
    """Zeros of the functions (functions, pieces, places) inside each piece, rising."""
    ends = np.stack([_interpolated(parting, -1.0), _interpolated(parting, 1.0)], axis=-1)
    every = np.concatenate([ends[:, :, :1], parting, ends[:, :, 1:]], axis=-1)
    turns: Bools = (every[:, :, 1:] > 0.0) != (every[:, :, :-1] > 0.0)
    turns &= (np.max(np.abs(every), axis=-1, initial=0.0) > still[:, None])[:, :, None]
    at = (-1.0, *PLACES, 1.0)
    cuts: list[list[float]] = [[] for _ in low]
    for function, piece, place in zip(*np.nonzero(turns), strict=True):
        zero = _zero(parting[function, piece], at[place], at[place + 1])
        middle, half = 0.5 * (low[piece] + high[piece]), 0.5 * (high[piece] - low[piece])
        cut = float(middle + half * zero)
        if low[piece] + near < cut < high[piece] - near:
            cuts[piece].append(cut)
    apart: list[list[float]] = [[] for _ in low]
    for piece, every_cut in enumerate(cuts):
        for cut in sorted(every_cut):
            if not apart[piece] or cut - apart[piece][-1] > near:
                apart[piece].append(cut)
    return apart


def _zero(f: Floats, low: float, high: float) -> float:
    """A zero of the polynomial through f (places,) between two places of different sign."""
    below = bool(_interpolated(f, low) > 0.0)
    for _ in range(60):
        middle = 0.5 * (low + high)
        if bool(_interpolated(f, middle) > 0.0) == below:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _barycentric() -> list[float]:
    weights = []
    for k, own in enumerate(PLACES):
        product = 1.0
        for j, other in enumerate(PLACES):
            product *= 2.0 * (own - other) if j != k else 1.0
        weights.append(1.0 / product)
    return weights


_WEIGHTS = _barycentric()


def _interpolated(f: Floats, x: float) -> Floats:
    """The polynomial through f (..., places) at x (Berrut and Trefethen, 2004)."""
    if x in PLACES:
        here: Floats = f[..., PLACES.index(x)]
        return here
    above, below = np.zeros(f.shape[:-1]), 0.0
    for k, (place, weight) in enumerate(zip(PLACES, _WEIGHTS, strict=True)):
        above = above + weight / (x - place) * f[..., k]
        below += weight / (x - place)
    return above / below
