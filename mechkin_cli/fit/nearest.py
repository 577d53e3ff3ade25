"""Where curves, known in equal steps, come nearest to points.

Between rows a curve is the polynomial through the ten rows around (Berrut & Trefethen 2004,
Barycentric Lagrange interpolation, section 2): with steps h its error in the middle is below h^10
times the tenth derivative divided by 4000. On it the nearest place is found by Newton steps.
Eight rows would tell the place as well, but of the derivatives of a place only nine digits.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats


NODES = 10
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
    found = _nearest(curves, points)
    return found.first + HALF + HALF * found.z, found.places


def nearest_slopes(curve: Floats, slopes: Floats, points: Floats) -> Floats:
    """Derivatives of the nearest places of one curve (rows, width), whose own derivatives with
    some unknowns are `slopes` (unknowns, rows, width): (unknowns, points, width).

    The place itself moves along the curve so that what is left stays perpendicular to it: with
    c(z, u) the curve and r = c - point, r . c_z = 0 gives z_u = -(c_zu . r + c_u . c_z) /
    (c_z . c_z + r . c_zz), and c_u + c_z z_u is the derivative. At an end of the curve it stays.
    """
    found = _nearest(curve[None], points)
    first, z = found.first[0], found.z[0]
    around = curve[first[:, None] + POWERS]
    moved = slopes[:, first[:, None] + POWERS]
    coefficients = np.einsum("pn,knw->kpw", TO_COEFFICIENTS, around)
    c_u, c_zu = (
        np.einsum("kn,uknw->ukw", _powers(z, order) @ TO_COEFFICIENTS, moved) for order in (0, 1)
    )
    c_z, c_zz = (np.einsum("kp,kpw->kw", _powers(z, order), coefficients) for order in (1, 2))
    away = found.places[0] - points
    curved = (c_z * c_z + away * c_zz).sum(axis=1)
    down = (c_zu * away + c_u * c_z).sum(axis=2)
    stays = found.at_end[0] | (curved == 0.0)
    z_u = np.where(stays, 0.0, -down / np.where(stays, 1.0, curved))
    result: Floats = c_u + c_z * z_u[:, :, None]
    return result


class _CurvePlaces(NamedTuple):
    """Of curves (S) the nearest places to points: the first rows of their polynomials and z there
    (S, points), the places (S, points, width), and whether they are ends of the curve."""

    first: NDArray[np.intp]
    z: Floats
    places: Floats
    at_end: Bools


def _nearest(curves: Floats, points: Floats) -> _CurvePlaces:
    distances = np.square(curves[:, :, None, :] - points).sum(axis=3)
    rows = distances.argmin(axis=1)
    last = curves.shape[1] - 1
    found = _from(curves, points, rows)
    # a closed curve has its ends at one place, and the nearest may lie on the other side of it
    at_end = (rows == 0) | (rows == last)
    if at_end.any():
        other = _from(curves, points, np.where(rows == 0, last, np.where(rows == last, 0, rows)))
        nearer = at_end & (_far(other.places, points) < _far(found.places, points))
        found = _CurvePlaces(
            np.where(nearer, other.first, found.first),
            np.where(nearer, other.z, found.z),
            np.where(nearer[..., None], other.places, found.places),
            np.where(nearer, other.at_end, found.at_end),
        )
    return found


def _far(places: Floats, points: Floats) -> Floats:
    found: Floats = np.square(places - points).sum(axis=2)
    return found


def _powers(z: Floats, order: int) -> Floats:
    """Derivatives of an order of the powers of z, of as many as a polynomial has."""
    factors = np.ones(NODES)
    for step in range(order):
        factors = factors * (POWERS - step)
    found: Floats = factors * z[..., None] ** np.maximum(POWERS - order, 0)
    return found


def _from(curves: Floats, points: Floats, rows: NDArray[np.intp]) -> _CurvePlaces:
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
    z: Floats = np.asarray((middle - HALF) / HALF)
    for _ in range(STEPS):
        away, slope, bend = at(coefficients, z) - points, at(slopes, z), at(bends, z)
        down = (away * slope).sum(axis=2)
        flat = (slope * slope).sum(axis=2)
        curved = flat + (away * bend).sum(axis=2)
        steep = np.where(curved > 0.1 * flat, curved, flat)
        z = np.clip(z - down / np.where(steep > 0.0, steep, 1.0), low, high)
    found = first + HALF + HALF * z
    at_end = (found <= 0.0) | (found >= last)
    return _CurvePlaces(first, z, at(coefficients, z), at_end)
