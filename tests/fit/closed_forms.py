"""Closed forms of the four documented fits, and optima found on them without mechkin."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import least_squares, linprog, minimize_scalar

Rows = Callable[[np.ndarray], np.ndarray]


def minimax(
    rows: Rows, held: Rows, weight: float, start: list[float], bounds: list[tuple[float, float]]
) -> tuple:
    """Unknowns with the least largest magnitude of rows and held >= 0, and that magnitude: linear
    programmes within a box that shrinks where they do not help (Madsen 1975); `weight` of what held
    lacks is above its multiplier."""
    x, box = np.array(start), 0.1
    low, high = np.array(bounds).T

    def slopes(of: Rows, at: np.ndarray) -> np.ndarray:
        steps = np.diag(1e-4 * (high - low))
        return np.stack([(of(at + h) - of(at - h)) / (2 * h.max()) for h in steps], axis=1)

    def worth(at: np.ndarray) -> float:
        return float(np.abs(rows(at)).max() + weight * np.maximum(-held(at), 0.0).sum())

    while box > 1e-13:
        r, c, dr, dc = rows(x), held(x), slopes(rows, x), slopes(held, x)
        top = -np.ones((len(r), 1))
        table = np.vstack([np.hstack([dr, top]), np.hstack([-dr, top])])
        table = np.vstack([table, np.hstack([-dc, np.zeros((len(c), 1))])])
        ends = np.maximum(low - x, -box * (high - low)), np.minimum(high - x, box * (high - low))
        found = linprog(
            [0.0] * len(x) + [1.0],
            table,
            np.concatenate([-r, r, c]),
            bounds=[*zip(*ends, strict=True), (None, None)],
        )
        if found.success and worth(x + found.x[:-1]) < worth(x):
            x = x + found.x[:-1]
        else:
            box /= 3
    return x, float(np.abs(rows(x)).max())


def hoeken(theta: np.ndarray, a: float, b: float, d: float) -> np.ndarray:
    """The pen (rows, 2): crank pin A, pivot C of the rocker in the origin and the pen lie on a
    circle about the coupler's pin, A and pen opposite, so the pen is seen from C at a right angle
    to A (Thales), 2 b from A."""
    x, y = a * np.cos(theta) - d, a * np.sin(theta)
    far = np.hypot(x, y)
    out = np.sqrt(4 * b**2 - far**2) / far
    return np.stack([out * y, -out * x], axis=-1)


def straight_line(points: np.ndarray, start: list[float]) -> tuple[np.ndarray, float]:
    """b, d, h of a crank of 40 that lead through points, and the largest deviation."""

    def away(x: np.ndarray) -> np.ndarray:
        b, d, h = x

        def off(theta: float, point: np.ndarray) -> np.ndarray:
            return hoeken(np.array(theta), 40.0, b, d) - [0, h] - point

        found = []
        for point in points:
            grid = np.radians(np.linspace(90, 270, 181))
            near = grid[np.argmin(np.square(off(grid, point)).sum(axis=-1))]
            ends = max(near - 0.05, np.pi / 2), min(near + 0.05, 3 * np.pi / 2)
            foot = minimize_scalar(
                lambda t, p=point: float(np.square(off(t, p)).sum()),
                bounds=ends,
                method="bounded",
                options={"xatol": 1e-12},
            ).x
            # an end of the way itself, where the distance still falls there
            feet = [foot, *(end for end in ends if abs(foot - end) < 1e-6)]
            found.append(min((off(t, point) for t in feet), key=lambda v: float(v @ v)))
        return np.concatenate(found)

    end = least_squares(away, start, jac="3-point", x_scale=start, xtol=1e-13, ftol=1e-15)
    return end.x, float(np.linalg.norm(away(end.x).reshape(-1, 2), axis=1).max())


def rssr(theta: np.ndarray, r: float, x: float, d: float) -> np.ndarray:
    """The rocker of rssr.yaml (deg) from the distance of both spheres (Hunt, Kinematic Geometry of
    Mechanisms, 1978): q.e1 cos + q.e2 sin = const, of the two solutions the continuous one."""
    y, z, lean = 100.0, 60.0, np.radians(15.0)
    axis = np.array([np.sin(lean), 0.0, np.cos(lean)])
    arm = np.array([x - d, y, 0.0])
    level = (axis @ arm) * axis
    e1, e2 = arm - level, np.cross(axis, arm)
    pin = np.stack([r * np.cos(theta), r * np.sin(theta), 0 * theta], axis=-1)
    q = np.array([d, 0.0, z]) + level - pin
    c, s = 2 * q @ e1, 2 * q @ e2
    rest = (x - r) ** 2 + y**2 + z**2 - (q * q).sum(axis=-1) - e1 @ e1
    return np.degrees(np.arctan2(s, c) + np.arccos(rest / np.hypot(c, s)))


def rssr_function(degrees: list[float], wanted: list[float], start: list[float]) -> tuple:
    """r, x, d that give a function, and the deviations."""

    def away(x: np.ndarray) -> np.ndarray:
        return rssr(np.radians(degrees), *x) - wanted

    end = least_squares(away, start, jac="3-point", x_scale=start, xtol=1e-14, ftol=1e-15)
    return end.x, away(end.x)


TURN = np.radians(np.arange(0.0, 361.0, 15.0))


def momenta(theta: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Momentum (kg mm/s) and moment of momentum about the origin (kg mm^2/s), (rows, 3), of the
    four-bar at 10 rad/s with a counterweight of 0.5 kg in (x1, y1) of the crank and (x3, y3) of the
    rocker, as drawn."""
    a, b, c, d = 40.0, 120.0, 90.0, 130.0
    pin = a * np.exp(1j * theta)
    far = pin - d
    size = np.abs(far)
    out = np.angle(far) - np.arccos((size**2 + c**2 - b**2) / (2 * size * c))
    rod = np.angle(d + c * np.exp(1j * out) - pin)
    # rates by the loop a e^(i theta) + b e^(i rod) = d + c e^(i out), per radian of the crank
    rod_rate = a * np.sin(out - theta) / (b * np.sin(rod - out))
    out_rate = a * np.sin(theta - rod) / (c * np.sin(out - rod))
    x1, y1, x3, y3 = places
    total = np.zeros((len(theta), 3))
    turned = np.exp(1j * (out - np.pi / 2))  # from the drawing, where the rocker lies along y
    for mass, inertia, at, angle, rate, base, base_rate in (
        (0.30, 90, 20 + 0j, np.exp(1j * theta), 1.0, 0, 0),
        (0.50, 0, x1 + 1j * y1, np.exp(1j * theta), 1.0, 0, 0),
        (0.85, 1900, 50 + 70j, np.exp(1j * rod), rod_rate, pin, 1j * pin),
        (0.55, 620, 40j, turned, out_rate, d, 0),
        (0.50, 0, x3 + 1j * y3, turned, out_rate, d, 0),
    ):
        place = base + at * angle
        speed = 10.0 * (base_rate + 1j * rate * at * angle)
        about = mass * np.imag(np.conj(place) * speed) + 10.0 * inertia * rate
        total += np.stack([mass * speed.real, mass * speed.imag, about], axis=1)
    return total


def shaking(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Force (rows, 2) in N and moment (rows,) in N mm on the foundation: what momentum loses."""
    h = 1e-3
    at = [momenta(TURN + k * h, places) for k in (-2, -1, 1, 2)]
    lost = -10.0 * (at[0] - at[3] + 8 * (at[2] - at[1])) / (12 * h) / 1000.0
    return lost[:, :2], lost[:, 2]


def force_balanced() -> np.ndarray:
    """The places of both counterweights that leave no force (Berkof & Lowen 1969, equations 18):
    the coupler's mass split between its pins, each part balanced about its link's pivot."""
    part = (50 + 70j) / 120
    crank = -(0.30 * 20 + 0.85 * 40 * (1 - part)) / 0.5
    rocker = -(0.55 * 40j + 0.85 * 90j * part) / 0.5
    return np.array([crank.real, crank.imag, rocker.real, rocker.imag])


OPENING = np.radians(np.arange(0.0, 81.0, 5.0))


def spring_length(x: np.ndarray) -> np.ndarray:
    """Of the hatch's gas spring with its seat in (u, v) and its end at p, (rows,)."""
    u, v, p = x
    return np.hypot(p * np.cos(OPENING) - u, p * np.sin(OPENING) - v)


def hatch(x: np.ndarray) -> np.ndarray:
    """What a hand adds at the hinge (N mm): what weight and spring do for a small turn."""
    u, v, p = x
    length = spring_length(x)
    longer = p * (u * np.sin(OPENING) - v * np.cos(OPENING)) / length
    lifted = 450 * np.cos(OPENING) - 20 * np.sin(OPENING)
    return 15 * 9.80665 * lifted - (400 - 0.2 * (length - 300)) * longer
