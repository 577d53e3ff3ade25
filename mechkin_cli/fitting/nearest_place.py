"""Where curves, known in equal steps, come nearest to points.

Between rows a curve is the polynomial through the eight rows around (Berrut & Trefethen 2004,
Barycentric Lagrange interpolation, section 2): with steps h its error is below h^8 times the eighth
derivative divided by 5000. On it the nearest place is found by Newton steps.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats

NODES = 8
"""Rows of a polynomial."""

HALF = 0.5 * (NODES - 1)
POWERS = np.arange(NODES)
TO_COEFFICIENTS = np.linalg.inv(((POWERS - HALF) / HALF)[:, None] ** POWERS)
"""From the values at eight rows to a polynomial in z in [-1, 1]."""

STEPS = 30
"""Newton steps, each at most a row."""


def nearest_places(curves: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Of curves (S, rows, width) the nearest places to points (points, width).

    Returns their rows, in parts (S, points), and where they are (S, points, width).
    """
    distances = np.square(curves[:, :, None, :] - points).sum(axis=3)
    rows = distances.argmin(axis=1)
    last = curves.shape[1] - 1
    found = _from(curves, points, rows)
    # a closed curve has its ends at one place, and the nearest may lie on the other side of it
    at_end = (rows == 0) | (rows == last)
    if at_end.any():
        other = _from(curves, points, np.where(rows == 0, last, np.where(rows == last, 0, rows)))
        nearer = at_end & (_far(other[1], points) < _far(found[1], points))
        found = (
            np.where(nearer, other[0], found[0]),
            np.where(nearer[..., None], other[1], found[1]),
        )
    return found


def _far(places: Floats, points: Floats) -> Floats:
    found: Floats = np.square(places - points).sum(axis=2)
    return found


def _from(curves: Floats, points: Floats, rows: NDArray[np.intp]) -> tuple[Floats, Floats]:
    """The nearest place within a row of given ones (S, points)."""
    last = curves.shape[1] - 1
    first = np.clip(rows - NODES // 2 + 1, 0, last - NODES + 1)
    of = np.arange(len(curves))[:, None, None]
    around = curves[of, first[:, :, None] + POWERS]
    coefficients = np.einsum("pn,sknw->skpw", TO_COEFFICIENTS, around)
    slopes = coefficients[:, :, 1:] * POWERS[1:, None]
    bends = slopes[:, :, 1:] * POWERS[1:-1, None]

    def at(polynomial: Floats, z: Any) -> Floats:
        powers = z[..., None] ** np.arange(polynomial.shape[2])
        found: Floats = np.einsum("skp,skpw->skw", powers, polynomial)
        return found

    middle = rows - first
    low = (np.maximum(middle - 1, 0) - HALF) / HALF
    high = (np.minimum(middle + 1, NODES - 1) - HALF) / HALF
    z = (middle - HALF) / HALF
    for _ in range(STEPS):
        away, slope, bend = at(coefficients, z) - points, at(slopes, z), at(bends, z)
        down = (away * slope).sum(axis=2)
        flat = (slope * slope).sum(axis=2)
        curved = flat + (away * bend).sum(axis=2)
        steep = np.where(curved > 0.1 * flat, curved, flat)
        z = np.clip(z - down / np.where(steep > 0.0, steep, 1.0), low, high)
    return first + HALF + HALF * z, at(coefficients, z)
