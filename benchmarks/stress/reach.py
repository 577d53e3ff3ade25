"""How far a branch goes from the drawing: where its discriminant vanishes.

The discriminant of a linkage that one rod closes is a trigonometric polynomial of degree two of
the input. Its extremes are the roots of one of degree four in exp(i x), refined by Newton's method
in double-double; between them it is monotone, so that their signs decide every row.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.stress.numbers.double_double import PI, DoubleDouble
from benchmarks.stress.numbers.series import Number, Series
from benchmarks.stress.quantity import Mask, Rows

TURN = DoubleDouble.of(2 * PI)
DEGREE = 2
LEAST_LEADING = 1e-17
"""Of the leading coefficient, in parts of the others: of a lower degree the others are far off."""
ON_CIRCLE = 0.1
"""How far from the unit circle a root in double precision is still tried by Newton's method."""
NEWTON_STEPS = 8
BISECTIONS = 30
"""Before Newton's method."""
EXTREME = 1e-12
"""A slope, in parts of the bend, that counts as zero at an extreme in double-double."""


@dataclass(frozen=True)
class Margin:
    """A discriminant, positive where a branch exists, and what rounding of the mechanism's numbers
    may change it by."""

    value: Number
    blur: Rows


MarginOf = Callable[[Number], Margin]
"""From angles (mechanisms, places) in rad."""


@dataclass(frozen=True)
class Reach:
    """Extremes (mechanisms, 4) in [0, 2 pi), nan where there are fewer, and the margins there."""

    margin_of: MarginOf
    extremes: DoubleDouble
    value: Rows
    blur: Rows

    def decide(self, angle: DoubleDouble) -> tuple[Mask, Mask]:
        """Whether the branch of angle 0 gets to the angles (mechanisms, rows), and whether that is
        decided."""
        here = self.margin_of(angle)
        least, certain = here.value.number.high - here.blur, here.value.number.high + here.blur
        for k in range(self.value.shape[1]):
            place = self.extremes[:, k : k + 1]
            passed = (angle - place).high >= 0.0
            passed |= (angle - place + TURN).high <= 0.0
            at, blur = self.value[:, k : k + 1], self.blur[:, k : k + 1]
            least = np.where(passed, np.fmin(least, at - blur), least)
            certain = np.where(passed, np.fmin(certain, at + blur), certain)
        return least > 0.0, (least > 0.0) | (certain < 0.0)

    def ends(self, sense: Rows) -> DoubleDouble:
        """By mechanism (mechanisms, 1) where the branch of angle 0 ends, forward (sense 1) or back
        (-1); nan where the input turns fully."""
        low, high = self._bracket(sense)
        ends = np.isfinite(high.high)
        high = _filled(high, ends, 1.0)
        low = _filled(low, ends, 0.0)
        for _ in range(BISECTIONS):
            middle = (low + high) * 0.5
            inside = self.margin_of(middle).value.number.high > 0.0
            low, high = _choose(inside, middle, low), _choose(inside, high, middle)
        place = low
        for _ in range(NEWTON_STEPS):
            place = self._newton(place)
        good = ((place - low).high >= 0.0) & ((high - place).high >= 0.0)
        low = _choose(good, place, low)
        return _filled(low, ends, np.nan)

    def _newton(self, place: DoubleDouble) -> DoubleDouble:
        """One step from a place towards the root."""
        ones = np.ones_like(place.high)
        moving = Series(place, DoubleDouble(ones), DoubleDouble(0.0 * ones))
        found = self.margin_of(moving).value
        step: DoubleDouble = found.value / found.rate
        return place - step

    def _bracket(self, sense: Rows) -> tuple[DoubleDouble, DoubleDouble]:
        """The last extreme on the way that still exists (or the start), and the first that does
        not."""
        count, columns = self.value.shape
        back = np.broadcast_to(sense < 0.0, (count, columns))
        places = _choose(back, self.extremes - TURN, self.extremes)
        order = np.argsort(np.where(np.isfinite(places.high), np.abs(places.high), np.inf), axis=1)
        places = DoubleDouble(
            np.take_along_axis(places.high, order, 1), np.take_along_axis(places.low, order, 1)
        )
        gone = np.take_along_axis(self.value, order, 1) <= 0.0
        first = np.argmax(gone, axis=1)[:, None]
        found = np.any(gone, axis=1)[:, None]
        high = DoubleDouble(
            np.where(found, np.take_along_axis(places.high, first, 1), np.nan),
            np.take_along_axis(places.low, first, 1),
        )
        before = np.maximum(first - 1, 0)
        low = DoubleDouble(
            np.where(first > 0, np.take_along_axis(places.high, before, 1), 0.0),
            np.where(first > 0, np.take_along_axis(places.low, before, 1), 0.0),
        )
        return low, high


def reach(margin_of: MarginOf, count: int) -> Reach:
    """Of `count` mechanisms, each with a margin that is a polynomial of degree two."""
    guesses = _guesses(margin_of, count)
    place = DoubleDouble(np.where(np.isfinite(guesses), guesses, 0.0))
    one, none = np.ones_like(guesses), np.zeros_like(guesses)
    for _ in range(NEWTON_STEPS):
        found = margin_of(Series(place, DoubleDouble(one), DoubleDouble(none))).value
        bend = found.acceleration.high
        step = found.rate * (1.0 / np.where(bend == 0.0, 1.0, bend))
        place = place - _choose(np.abs(step.high) < 1.0, step, DoubleDouble(none))
    found = margin_of(Series(place, DoubleDouble(one), DoubleDouble(none))).value
    good = np.isfinite(guesses)
    good &= np.abs(found.rate.high) <= EXTREME * np.abs(found.acceleration.high)
    turns = np.floor(place.high / TURN.high)
    place = _filled(place - TURN * turns, good, np.nan)
    at = margin_of(_filled(place, good, 0.0))
    value = np.where(good, at.value.number.high, np.nan)
    return Reach(margin_of, place, value, np.where(good, at.blur, 0.0))


def _guesses(margin_of: MarginOf, count: int) -> Rows:
    """Angles of the extremes to double precision, nan where a root is complex."""
    samples = 2 * DEGREE + 1
    step = TURN * (np.arange(samples) / samples)
    values = margin_of(step[None, :] + np.zeros((count, 1))).value.number
    coefficients = np.zeros((count, samples), complex)
    for k in range(-DEGREE, DEGREE + 1):
        sine, cosine = (step * float(k)).sin_cos()
        real, imaginary = values * cosine, values * sine
        coefficients[:, k + DEGREE] = 1j * k * (_total(real) - 1j * _total(imaginary))
    largest = np.abs(coefficients).max(axis=1, keepdims=True)
    coefficients = coefficients / np.where(largest > 0.0, largest, 1.0)
    leading = coefficients[:, -1:]
    leading = np.where(np.abs(leading) < LEAST_LEADING, LEAST_LEADING, leading)
    companion = np.zeros((count, 2 * DEGREE, 2 * DEGREE), complex)
    companion[:, 1:, :-1] = np.eye(2 * DEGREE - 1)
    companion[:, :, -1] = -coefficients[:, :-1] / leading
    roots = np.linalg.eigvals(companion)
    return np.where(np.abs(np.abs(roots) - 1.0) < ON_CIRCLE, np.angle(roots), np.nan)


def _total(values: DoubleDouble) -> Rows:
    total = values[:, 0]
    for k in range(1, values.shape[1]):
        total = total + values[:, k]
    return total.high


def _choose(mask: Mask, yes: DoubleDouble, no: DoubleDouble) -> DoubleDouble:
    return DoubleDouble(np.where(mask, yes.high, no.high), np.where(mask, yes.low, no.low))


def _filled(values: DoubleDouble, where: Mask, fill: float) -> DoubleDouble:
    low = np.where(where, values.low, 0.0)
    return DoubleDouble(np.where(where, values.high, fill), low)
