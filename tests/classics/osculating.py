"""Bars that hold a four-bar in third or fourth order only: from a coupler point to the centre of
its path's curvature. At 40 digits, from the four-bar's closure alone."""

from __future__ import annotations

import mpmath as mp

from classics.drawing import Classic, planar

CORNERS = {"A": (0, 0), "a": ("0.3", 1), "b": ("2.1", "1.7"), "B": ("2.6", "0.1")}
PLACES = [mp.mpf(k) / 50 for k in range(-4, 5)]
"""Crank angles from whose coupler positions Taylor's polynomials are read."""


def _turn(angle: mp.mpf) -> mp.matrix:
    return mp.matrix([[mp.cos(angle), -mp.sin(angle)], [mp.sin(angle), mp.cos(angle)]])


def _positions() -> list[tuple[mp.matrix, mp.mpf]]:
    """Where coupler point a is, and the coupler's angle, at each of the places."""
    fixed, near, far, other = (mp.matrix([mp.mpf(c) for c in CORNERS[name]]) for name in "AabB")

    def position(angle: mp.mpf) -> tuple[mp.matrix, mp.mpf]:
        tip = fixed + _turn(angle) * (near - fixed)
        rod = mp.norm(far - other) ** 2
        closure = lambda t: mp.norm(tip + _turn(t) * (far - near) - other) ** 2 - rod  # noqa: E731
        return tip, mp.findroot(closure, -angle / 5)

    return [position(angle) for angle in PLACES]


def _path(point: tuple[mp.mpf, mp.mpf]) -> tuple[list[mp.mpf], list[mp.mpf]]:
    """Taylor's coefficients of the path of a point drawn at `point` from a."""
    count = len(PLACES)
    powers = mp.matrix(count, count)
    for i, angle in enumerate(PLACES):
        for j in range(count):
            powers[i, j] = angle**j
    seen = [tip + _turn(t) * mp.matrix(point) for tip, t in _positions()]
    return tuple(list(mp.lu_solve(powers, mp.matrix([p[k] for p in seen]))) for k in (0, 1))


def _circle(point: tuple[mp.mpf, mp.mpf]) -> tuple[tuple, tuple, mp.mpf]:
    """The point's place, the centre of its path's curvature, and the third-order coefficient of the
    squared distance between them."""
    x, y = _path(point)
    square = [sum(x[i] * x[k - i] + y[i] * y[k - i] for i in range(k + 1)) for k in range(4)]
    slopes = mp.matrix([[2 * x[1], 2 * y[1]], [2 * x[2], 2 * y[2]]])
    centre = mp.lu_solve(slopes, mp.matrix([square[1], square[2]]))
    third = square[3] - 2 * (centre[0] * x[3] + centre[1] * y[3])
    return (x[0], y[0]), (centre[0], centre[1]), third


def held(point: tuple[mp.mpf, mp.mpf]) -> str:
    """The four-bar with a bar from a coupler point to its centre of curvature."""
    place, centre, _ = _circle(point)
    pins = CORNERS | {"c": place, "C": centre}
    numbers = {name: tuple(float(mp.mpf(c)) for c in pin) for name, pin in pins.items()}
    return planar(numbers, ["ABC", "Aa", "Bb", "abc", "Cc"])


def stationary(height: str) -> tuple[mp.mpf, mp.mpf]:
    """A point at some height over the coupler's a whose curvature is stationary."""
    y = mp.mpf(height)
    return mp.findroot(lambda x: _circle((x, y))[2], (mp.mpf("0.5"), mp.mpf("0.6"))), y


with mp.workdps(40):
    CASES = [
        Classic("bar to a centre of curvature", held((mp.mpf(1), mp.mpf("0.8"))), (0,), 1),
        Classic("bar to one of stationary curvature", held(stationary("0.7")), (0,), 1),
        Classic("another such bar", held(stationary("1.5")), (0,), 1),
    ]
