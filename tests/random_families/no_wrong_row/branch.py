"""How far the drawn branch goes either way, and how near it comes to its end on the way.

Discriminants are read on a fine grid; every low minimum and every change of sign is enlarged
until its place is known to 1e-13, and what is near zero is decided at 50 digits. Places where a
loop turns fast because another is nearly singular get points of their own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from oracle.numerics import Number, mp
from random_families.no_wrong_row.bodies import Placed
from random_families.no_wrong_row.field import EXACT, FAST
from random_families.no_wrong_row.linkage import Linkage

Array = NDArray[np.float64]
TURN = 2 * math.pi
GRID = 720
"""Points of a turn."""
LOW = 2e-3
"""A minimum of a discriminant below this is enlarged; between points of the grid it changes by
about 1e-4."""
DECIDED = 1e-8
"""Below this float64 does not tell a discriminant's sign behind another loop nearly singular."""
SUDDEN = 2.5
"""A change between neighbouring points of a way (rad) whose sense float64 does not show: a shaft
nearly at a right angle to one that is nearly at a right angle itself turns by half a turn within
the product of both gaps, 1e-22 of the input."""
UNDECIDED = 3e-15
"""A discriminant below this may have either sign for numbers rounded to float64."""
ROUNDING = 2.0**-52
"""A rounding of a discriminant of a body before, in parts of its scale."""
AGREED = 1e-3
"""Rad that float64 may be off 50 digits where an angle does not change suddenly."""
RESOLVED = mp.mpf(10) ** -40
"""Width of a place that 50 digits still resolve."""


class Undecided(Exception):
    """A minimum is zero to rounding: nothing can be asked of the mechanism."""


@dataclass
class Way:
    """The branch for 0 <= t <= end in one direction: places t with their values and margins."""

    sign: int
    end: float
    folds: str | None  # the body that ends it
    t: Array
    margin: dict[str, Array]
    value: dict[str, Array]
    critical: list[tuple[float, str, float]] = field(default_factory=list)
    periodic: bool = False

    def reduced(self, t: Array) -> tuple[Array, Array]:
        """Distances from the start, and whole turns, of places on the way."""
        turns = np.floor(t / TURN) if self.periodic else np.zeros_like(t)
        return t - turns * TURN, turns


MOST_MINIMA = 2000
"""Low minima of a discriminant on a turn; more are rounding of one that hardly changes."""


def way(linkage: Linkage, sign: int, span: float, *, judging: bool = False) -> Way:
    """The way from the drawing to |t| = span, or once around where that is its period.

    Mechanisms are drawn by it as well. For `judging` them a minimum counts as zero to rounding
    also where bodies before enlarge what is rounding, and sudden turns have their sense.

    Raises:
        Undecided: a discriminant touches zero.
    """
    factors = [body.drive for body in linkage.bodies if body.drive is not None]
    repeats = all(float(f).is_integer() for f in factors)
    reach = min(span, TURN) if repeats else span
    t = np.linspace(0.0, reach, max(3, math.ceil(GRID * reach / TURN) + 1))
    end, folds, critical = reach, None, []
    for body in linkage.bodies:
        if body.rod is None:
            continue
        margin = linkage.at(sign * t, FAST, body.name).margin[body.name]
        places = low_places(margin, t)
        if len(places) > MOST_MINIMA * max(1.0, reach / TURN):
            raise Undecided(f"the discriminant of {body.name} rests at its own rounding")
        for low, high in places:
            place, least = lowest(linkage, body.name, sign, low, high, judging)
            critical.append((place, body.name, max(least, 0.0)))
            t = np.union1d(t, fine(place, end))
            if least <= 0:
                end, folds = first_zero(linkage, body.name, sign, low, place), body.name
                break
        t = np.append(t[t < end], end)
    critical = [item for item in critical if item[0] < end or item[1] == folds]
    final = linkage.at(sign * t, FAST)
    return Way(
        sign,
        end if folds else math.inf,
        folds,
        t,
        {name: np.maximum(m, 0.0) for name, m in final.margin.items()},
        {
            name: unwrapped(linkage, name, sign, t, v) if judging else np.unwrap(v)
            for name, v in final.value.items()
        },
        critical,
        folds is None and repeats and reach == TURN,
    )


def low_places(margin: Array, t: Array) -> list[tuple[float, float]]:
    """Intervals about low minima, in their order; the last one ends where a sign changes."""
    places = []
    for i in range(len(t)):
        before, after = margin[max(i - 1, 0)], margin[min(i + 1, len(t) - 1)]
        if margin[i] <= 0 or (margin[i] < LOW and margin[i] <= before and margin[i] <= after):
            places.append((float(t[max(i - 1, 0)]), float(t[min(i + 1, len(t) - 1)])))
            if margin[i] <= 0:
                break
    return places


def one(linkage: Linkage, name: str, sign: int, t: Any) -> Any:
    """A body's margin."""
    return linkage.at(sign * t, FAST, name).margin[name]


def lowest(
    linkage: Linkage, name: str, sign: int, low: float, high: float, judging: bool
) -> tuple[float, float]:
    """Place and value of the least margin between two places.

    Raises:
        Undecided: it is zero to rounding.
    """
    while True:
        t = np.linspace(low, high, 41)
        margin = one(linkage, name, sign, t)
        best = int(np.argmin(margin))
        if margin[best] < -DECIDED or high - low < 1e-13 * max(1.0, high) + 1e-15:
            break
        low, high = float(t[max(best - 1, 0)]), float(t[min(best + 1, 40)])
    place, least = float(t[best]), float(margin[best])
    if abs(least) < DECIDED:
        placed = linkage.at(sign * mp.mpf(place), EXACT, name)
        least = float(placed.margin[name])
        unit = UNDECIDED * float(placed.blur.get(name, 1))
        if judging:
            unit *= roundings(linkage, name, sign * mp.mpf(place), placed)
        if abs(least) < unit:
            raise Undecided
    return place, least


def roundings(linkage: Linkage, name: str, t: Number, placed: Placed) -> float:
    """What roundings of the input change in a margin, in parts of its own: those too that a nearly
    singular body before it enlarges, by 1 over twice the root of its discriminant."""
    own, total = UNDECIDED * float(placed.blur.get(name, 1)), 1.0
    for before, margin in placed.margin.items():
        if before == name or before not in placed.value or not 0 < margin < DECIDED:
            continue
        unit = 1.0 if linkage.turns(before) else linkage.size
        step = ROUNDING * placed.blur.get(before, 1) * unit / (2 * mp.sqrt(margin))
        moved = linkage.at(t, EXACT, name, {before: placed.value[before] + step}).margin[name]
        total += float(abs(moved - placed.margin[name])) / own
    return total


def first_zero(linkage: Linkage, name: str, sign: int, low: float, high: float) -> float:
    """The first place where the margin is not positive; it is at `high`, and positive at `low`."""
    while high - low > 1e-15 * max(1.0, high):
        t = np.linspace(low, high, 41)
        gone = one(linkage, name, sign, t) <= 0
        gone[-1] = True
        first = int(np.argmax(gone))
        if first == 0:
            break
        new = float(t[first - 1]), float(t[first])
        if new == (low, high):
            break
        low, high = new
    return high


def fine(place: float, end: float) -> Array:
    """Points that come closer to a place in equal ratios."""
    steps = 10.0 ** np.arange(-13, -2, 0.125)
    points = np.concatenate([place - steps, [place], place + steps])
    return points[(points > 0) & (points < end)]


def unwrapped(linkage: Linkage, name: str, sign: int, t: Array, value: Array) -> Array:
    """A coordinate without jumps of whole turns; where it changes suddenly its values and the
    sense are those of 60 digits. What stays sudden there is NaN from its place on."""
    found = np.unwrap(value)
    if not linkage.turns(name):
        return found

    def at(place: Any) -> Any:
        return linkage.at(sign * mp.mpf(place), EXACT, name).value[name]

    known = -1
    for k in np.flatnonzero(np.abs(np.diff(found)) > SUDDEN):
        if k < known:
            continue
        first, known = int(k), int(k) + 1
        while first > 0 and abs(turned(found[first], at(t[first]))) > AGREED:
            first -= 1
        while known < len(t) - 1 and abs(turned(found[known], at(t[known]))) > AGREED:
            known += 1
        after = found[known + 1 :] - found[known]
        for i in range(first, known):
            found[i + 1] = found[i] + float(exact_change(at, t[i], t[i + 1]))
        found[known + 1 :] = found[known] + after
    return found


def turned(a: Any, b: Any) -> Any:
    """The angle from a to b that is at most half a turn."""
    return b - a - 2 * mp.pi * mp.nint((b - a) / (2 * mp.pi))


def exact_change(at: Callable[[Any], Any], first: float, last: float) -> Number:
    """The change of an angle between two places, by halving its sudden part."""
    low, high, total = mp.mpf(first), mp.mpf(last), mp.zero
    here, there = at(low), at(high)
    while abs(whole := turned(here, there)) > SUDDEN / 2:
        if high - low < RESOLVED:
            return np.nan
        middle = (low + high) / 2
        value = at(middle)
        before, after = turned(here, value), turned(value, there)
        if abs(before) > abs(after):
            total, high, there = total + after, middle, value
        else:
            total, low, here = total + before, middle, value
    return total + whole
