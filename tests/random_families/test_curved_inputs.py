"""A five-bar whose two cranks follow different laws of time: row by row in closed form."""

from __future__ import annotations

import random

import numpy as np
from random_families.four_bars import Vector, cases

from mechkin_cli import loads

AXIS = "axis: [0, 0, 1]"


def rise(kind: str, z: Vector) -> Vector:
    z = np.clip(z, 0, 1)
    if kind == "harmonic":
        return (1 - np.cos(np.pi * z)) / 2
    return z - np.sin(2 * np.pi * z) / (2 * np.pi)


def law(rng: random.Random, size: float, times: Vector) -> tuple[str, Vector]:
    """A law as the file writes it, and its values."""
    kind = rng.choice(["polynomial", "harmonic", "cycloidal", "constant-acceleration"])
    a, b = rng.uniform(-size, size), rng.uniform(-size, size)
    if kind == "polynomial":
        return f"{{law: polynomial, coefficients: [0, {a}, 0, {b}]}}", a * times + b * times**3
    if kind == "constant-acceleration":
        text = f"{{law: {kind}, at: 0, rate: {a}, acceleration: {b}}}"
        return text, a * times + b * times**2 / 2
    text = f"{{law: {kind}, from: 0, to: {a}, start: 0.25, duration: 0.5}}"
    return text, a * rise(kind, (times - 0.25) / 0.5)


def test_five_bar_on_laws_of_time() -> None:
    tried = 0
    for rng in cases(21, 40):
        a, e = rng.uniform(0.3, 1), rng.uniform(0.3, 1)
        b, c = rng.uniform(1.5, 3), rng.uniform(1.5, 3)
        side, start = rng.choice([-1, 1]), (rng.uniform(-3, 3), rng.uniform(-3, 3))
        count, size = rng.choice([2, 5, 11, 50, 400]), rng.choice([0.3, 1.0, 3.0, 6.0])
        fine = max(1, 4000 // count)
        times = np.linspace(0, 1, (count - 1) * fine + 1)
        (one, q1), (two, q2) = law(rng, size, times), law(rng, size, times)
        t1, t2 = start[0] + q1, start[1] + q2
        left = np.stack([a * np.cos(t1), a * np.sin(t1)], -1)
        right = np.stack([2 + e * np.cos(t2), e * np.sin(t2)], -1)
        far = np.linalg.norm(right - left, axis=-1)
        along = (far**2 + b * b - c * c) / (2 * far)
        if (b * b - along**2).min() < 1e-3:
            continue  # the branch ends on the way
        across = side * np.sqrt(b * b - along**2)
        u = (right - left) / far[:, None]
        top = left + along[:, None] * u + across[:, None] * np.stack([-u[:, 1], u[:, 0]], -1)
        at = [f"[{float(p[0])!r}, {float(p[1])!r}, 0]" for p in (left[0], top[0], right[0])]
        text = (
            "format: 1\nname: five-bar\nunits: {length: m, angle: rad, mass: kg, force: N}\n"
            "links: {k: {}, u: {}, v: {}, w: {}}\njoints:\n"
            f"  A: {{type: R, links: [ground, k], point: [0, 0, 0], {AXIS}}}\n"
            f"  B: {{type: R, links: [k, u], point: {at[0]}, {AXIS}}}\n"
            f"  C: {{type: R, links: [u, v], point: {at[1]}, {AXIS}}}\n"
            f"  D: {{type: R, links: [v, w], point: {at[2]}, {AXIS}}}\n"
            f"  E: {{type: R, links: [ground, w], point: [2, 0, 0], {AXIS}}}\n"
            f"points: {{top: {{link: u, at: {at[1]}}}}}\n"
            f"motion:\n  inputs:\n    A.theta: {one}\n    E.theta: {two}\n"
            f"  time: {{from: 0, to: 1, count: {count}}}\n"
        )
        result = loads(text).analyze(["top.position", "A.theta", "B.theta", "C.theta"])
        assert set(result["row.status"].tolist()) == {"ok"}, text
        assert np.abs(result["A.theta"] - q1[::fine]).max() < 1e-9, text
        assert np.abs(result["top.position"][:, :2] - top[::fine]).max() < 1e-7, text
        first, second = (np.unwrap(np.arctan2(*(top - p).T[::-1])) for p in (left, right))
        first, second = first - first[0], second - second[0]
        assert np.abs(result["B.theta"] - (first - q1)[::fine]).max() < 1e-6, text
        assert np.abs(result["C.theta"] - (second - first)[::fine]).max() < 1e-6, text
        tried += 1
    assert tried > 5
