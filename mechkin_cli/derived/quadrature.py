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

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tolerances import (
    LEAST_PIECES,
    MOST_PIECES,
    NEXT_TO_END,
    NEXT_TO_ZERO,
    TURNS_NOT,
)

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


class RunningTotal:
    """The sum of samples that come block by block, in their order, with what each addition loses
    (Neumaier, 1974)."""

    def __init__(self) -> None:
        self._sum = self._lost = 0.0

    def add(self, values: Floats) -> None:
        """Adds the next samples."""
        sums = np.cumsum(np.concatenate([[self._sum], values]))
        lost = _lost(sums[:-1], values, sums[1:])
        self._lost = float(np.cumsum(np.concatenate([[self._lost], lost]))[-1])
        self._sum = float(sums[-1])

    def found(self) -> float:
        """The sum of the samples so far."""
        return self._sum + self._lost


def _lost(before: Floats, values: Floats, after: Floats) -> Floats:
    """What sums `after` = `before` + `values` lose, element by element."""
    with np.errstate(invalid="ignore"):  # beside what is infinite
        is_larger = np.abs(before) >= np.abs(values)
        large, small = np.where(is_larger, (before, values), (values, before))
        lost: Floats = (large - after) + small
    return lost


def total(values: Floats) -> float:
    """The sum of samples as `RunningTotal` has it."""
    found = RunningTotal()
    found.add(values)
    return found.found()


def running_integral(values: Floats, step: float) -> Floats:
    """From the first sample to each (samples,), which is zero at the first; nan from a sample on
    that is nan."""
    integral = np.zeros(values.size)
    integral[1:] = np.cumsum(interval_integrals(values, POINTS)) * step
    return integral


def interval_integrals(values: Floats, most: int) -> Floats:
    """From each sample to the next (samples - 1,), a unit apart, of the polynomial through the
    `most` nearest ones."""
    return IntervalIntegrals(values.size, most).add(values)


class IntervalIntegrals:
    """The same of samples that come block by block: an interval is known when those samples are
    that it is read from, of which some come behind it.

    Args:
        count: of all samples.
        most: samples that an interval is read from, if there are so many.
    """

    def __init__(self, count: int, most: int) -> None:
        self._count, self._points = count, min(most, count)
        self._before = self._points // 2 - 1  # samples before an interval's own
        self._held = np.empty(0)
        self._first = self._done = 0  # the first sample that is held; intervals that are known

    def add(self, values: Floats) -> Floats:
        """Takes the next samples; gives the intervals that are now known, behind those before."""
        held = self._held = np.concatenate([self._held, values])
        known, points = self._first + held.size, self._points
        end = known - points + self._before + 1 if known >= points else 0
        end = max(self._count - 1, 0) if known == self._count else max(end, 0)
        parts = np.empty(end - self._done)
        # polynomials through as many samples on either side
        inner = max(self._done, self._before), min(end, self._count - points + self._before + 1)
        for interval in range(self._done, end):
            if inner[0] <= interval < inner[1]:
                continue
            first = self._start(interval)
            weights = np.array(interval_weights(points, interval - first))
            own = first - self._first
            parts[interval - self._done] = total(weights * held[own : own + points])
        if inner[0] < inner[1]:
            own = self._start(inner[0]) - self._first
            windows = [held[own + k :][: inner[1] - inner[0]] for k in range(points)]
            weights = np.array(interval_weights(points, self._before))
            at = slice(inner[0] - self._done, inner[1] - self._done)
            parts[at] = _total_of_products(weights, windows)
        self._done = end
        first = self._start(end)
        self._held, self._first = held[first - self._first :].copy(), first
        return parts

    def _start(self, interval: int) -> int:
        """The first sample that an interval is read from."""
        return min(max(interval - self._before, 0), self._count - self._points)


def _total_of_products(weights: Floats, columns: Sequence[Floats]) -> Floats:
    """The `total` of the columns' products with their weights, element by element."""
    sums, lost = np.zeros((2, columns[0].size))
    for weight, column in zip(weights.tolist(), columns, strict=True):
        product = weight * column
        after = sums + product
        lost += _lost(sums, product, after)
        sums = after
    return sums + lost


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
    found = CycleIntegral(values.size, step)
    found.add(values)
    return found.found()


class CycleIntegral:
    """The same of samples that come block by block, of which there are `count` in all."""

    def __init__(self, count: int, step: float) -> None:
        self._step = step
        self._every, self._half = RunningMean(count), RunningMean(count, each=2)
        self._intervals = None if count % 2 == 0 else IntervalIntegrals(count + 1, POINTS)
        self._around = -0.0  # nothing is changed by what is added to -0
        self._first: Floats | None = None

    def add(self, values: Floats) -> None:
        """Takes the next samples."""
        self._every.add(values)
        if self._intervals is None:
            self._half.add(values)
            return
        self._first = values[:1].copy() if self._first is None and values.size else self._first
        self._integrate(values)

    def _integrate(self, values: Floats) -> None:
        assert self._intervals is not None
        parts = self._intervals.add(values)
        self._around = float(np.cumsum(np.concatenate([[self._around], parts]))[-1])

    def found(self) -> tuple[float, float]:
        """The integral and its error, when all samples have been taken."""
        whole = self._every.found() * self._every.count * self._step
        if self._intervals is None:
            other = self._half.found() * self._every.count * self._step
        else:
            assert self._first is not None
            self._integrate(self._first)
            other = self._around * self._step
        return whole, abs(whole - other)


class RunningMean:
    """The mean of samples that come block by block; nan where one is.

    Args:
        count: of the samples of all blocks.
        each: counts every second one, or every one, from the first on.
    """

    def __init__(self, count: int, each: int = 1) -> None:
        self.count, self._each = count, each
        self._total, self._taken, self._is_lost = RunningTotal(), 0, False

    def add(self, values: Floats) -> None:
        """Takes the next samples."""
        own = values[-self._taken % self._each :: self._each]
        self._taken += values.size
        self._is_lost |= not np.isfinite(own).all()
        if not self._is_lost:
            self._total.add(own)

    def found(self) -> float:
        """The mean, when all samples have been taken."""
        return float("nan") if self._is_lost else self._total.found() / -(-self.count // self._each)


def mean(values: Floats) -> float:
    """The mean of samples; nan where one is."""
    found = RunningMean(values.size)
    found.add(values)
    return found.found()


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
    most = max(MOST_PIECES * low.size, LEAST_PIECES)
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
        final = good & np.array([not each for each in cuts], dtype=bool)
        if left == 0 or np.count_nonzero(~final) > most:
            final[:] = True  # their errors say how good they are
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
