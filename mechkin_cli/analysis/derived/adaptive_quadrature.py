"""Integrals of functions that jump and bend, with an estimate of their error.

Every piece is integrated by the 15 places of Kronrod's extension of Gauss' seven (Piessens and
others, QUADPACK, 1983, qk15). Its error is what the seven say otherwise, without QUADPACK's hope
for smoothness, and what lies between the outermost places and the ends, where the polynomial
through the places is compared with one more sample. A piece that is not good enough is split in the
middle, and one in which some smooth function, given beside the integrands, has a zero is split
there: what jumps at that zero costs no halving.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.tolerances import NEXT_TO_END, NEXT_TO_ZERO, TURNS_NOT

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools, Floats

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


class Samples(NamedTuple):
    """Integrands (integrands, places), and functions whose zeros part them (functions, places)."""

    values: Floats
    parting: Floats


class Integrals(NamedTuple):
    """Over each piece, and how far each may be off (integrands, pieces)."""

    values: Floats
    errors: Floats


def integrals(
    low: Floats, high: Floats, sample: Callable[[Floats], Samples], allowed: Floats
) -> Integrals:
    """Integrals from `low` to `high` (pieces,), rising and apart from each other.

    Args:
        low, high: the ends; no end is sampled.
        sample: everything at rising places.
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
        found = sample((middle[:, None] + half[:, None] * places).reshape(-1))
        fine, error = _both_rules(found.values.reshape(allowed.size, -1, places.size), half)
        parting = found.parting.reshape(-1, low.size, places.size)[:, :, 1:-1]
        largest = np.fmax(largest, np.max(np.abs(parting), axis=(1, 2), initial=0.0))
        cuts = _zeros_inside(parting, low, high, NEXT_TO_ZERO * span, TURNS_NOT * largest)
        good = (error <= allowed[:, None] * (high - low)).all(axis=0)
        # what has no value anywhere near is not found by halving
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
    return Integrals(values, errors)


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
        np.abs(_at(f, -NEXT_TO_END) - every[:, :, 0]), np.abs(_at(f, NEXT_TO_END) - every[:, :, -1])
    )
    error = np.fmax(np.abs(fine - coarse), (1.0 - PLACES[-1]) * ends)
    # rounding of the sums and of the samples
    floor = 16.0 * np.finfo(np.float64).eps * size
    return half * fine, half * np.where(error > floor, error, floor)


def _zeros_inside(
    parting: Floats, low: Floats, high: Floats, near: float, still: Floats
) -> list[list[float]]:
    """Zeros of the functions (functions, pieces, places) inside each piece, rising."""
    ends = np.stack([_at(parting, -1.0), _at(parting, 1.0)], axis=-1)
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
    return [_apart(sorted(each), near) for each in cuts]


def _apart(cuts: list[float], near: float) -> list[float]:
    kept: list[float] = []
    for cut in cuts:
        if not kept or cut - kept[-1] > near:
            kept.append(cut)
    return kept


def _zero(f: Floats, low: float, high: float) -> float:
    """A zero of the polynomial through f (places,) between two places of different sign."""
    below = bool(_at(f, low) > 0.0)
    for _ in range(60):
        middle = 0.5 * (low + high)
        if bool(_at(f, middle) > 0.0) == below:
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


def _at(f: Floats, x: float) -> Floats:
    """The polynomial through f (..., places) at x (Berrut and Trefethen, 2004)."""
    if x in PLACES:
        here: Floats = f[..., PLACES.index(x)]
        return here
    above, below = np.zeros(f.shape[:-1]), 0.0
    for k, (place, weight) in enumerate(zip(PLACES, _WEIGHTS, strict=True)):
        above = above + weight / (x - place) * f[..., k]
        below += weight / (x - place)
    return above / below
