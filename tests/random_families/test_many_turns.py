"""Crank-rockers and drag links over many turns, in coarse steps, either way: angles go on."""

from __future__ import annotations

import math
import random

import numpy as np
from random_families.four_bars import Vector, cases, rotation, text, vector

from mechkin_cli import loads


def angles(bars: tuple[float, ...], crank: Vector, side: int) -> tuple[Vector, Vector]:
    """Direction of rocker and coupler against the ground line, without jumps."""
    a, b, c, d = bars
    across = np.stack([a * np.cos(crank) - d, a * np.sin(crank)], -1)
    far = np.linalg.norm(across, axis=-1)
    turn = np.arccos((far**2 + c * c - b * b) / (2 * far * c))
    rocker = np.arctan2(across[:, 1], across[:, 0]) + side * turn
    tip = np.stack([c * np.cos(rocker), c * np.sin(rocker)], -1) - across
    return np.unwrap(rocker), np.unwrap(np.arctan2(tip[:, 1], tip[:, 0]))


def grashof(rng: random.Random) -> tuple[float, ...]:
    while True:
        longest = rng.uniform(1.5, 4)
        rest = [rng.uniform(1.0, longest), rng.uniform(1.0, longest)]
        if sum(rest) > longest + 1.05:
            break
    bars = [*rest, longest]
    rng.shuffle(bars)
    bars.insert(rng.choice([0, 3]), 1.0)
    return tuple(round(bar, 4) for bar in bars)


def test_angles_and_quaternions_go_on() -> None:
    for rng in cases(77, 25):
        bars, side, first = grashof(rng), rng.choice([-1, 1]), rng.uniform(-3, 3)
        a, _, c, d = bars
        (psi,), _ = angles(bars, np.array([first]), side)
        places = {
            "A": ("ground", "crank", (0.0, 0.0)),
            "B": ("crank", "coupler", (a * math.cos(first), a * math.sin(first))),
            "C": ("coupler", "rocker", (d + c * math.cos(psi), c * math.sin(psi))),
            "D": ("ground", "rocker", (d, 0.0)),
        }
        frame, origin = rotation(vector(rng) + 1e-3, rng.uniform(0, 3)), vector(rng)
        normal = frame @ np.array([0.0, 0.0, 1.0])
        spatial = rng.random() < 0.5
        letters = {"A": "R", "B": "C" if spatial else "R", "C": "S" if spatial else "R", "D": "R"}
        flips = {name: rng.random() < 0.5 for name in places}
        joints = ""
        for name in rng.sample(sorted(places), 4):
            one, two, (x, y) = places[name]
            links = f"{two}, {one}" if flips[name] else f"{one}, {two}"
            at = frame @ np.array([x, y, 0.0]) + origin
            axis = "" if letters[name] == "S" else f", axis: {text(normal)}"
            joints += (
                f"  {name}: {{type: {letters[name]}, links: [{links}], point: {text(at)}{axis}}}\n"
            )
        step, way = rng.choice([1, 5, 30, 45, 90, 97, 120]), rng.choice([-1, 1])
        span = way * 360 * rng.choice([1, 2, 5, 20])
        file = (
            "format: 1\nname: turns\nunits: {length: m, angle: deg, mass: kg, force: N}\n"
            f"links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}\njoints:\n{joints}"
            f"motion: {{inputs: {{A.theta: {{from: 0, to: {span}, step: {step}}}}}}}\n"
        )
        sign = {name: -1 if flip else 1 for name, flip in flips.items()}
        crank = first + sign["A"] * np.radians(np.arange(0, abs(span) + 1) * way)
        rocker, coupler = angles(bars, crank, side)
        rocker, coupler, crank = rocker - rocker[0], coupler - coupler[0], crank - crank[0]
        want = {"B": coupler - crank, "C": rocker - coupler, "D": rocker}
        want = {name: sign[name] * value[::step] for name, value in want.items()}
        result = loads(file).analyze([f"{name}.theta" for name in want if letters[name] != "S"])
        assert set(result["row.status"].tolist()) == {"ok"}, file
        for name, value in want.items():
            if letters[name] != "S":
                assert np.abs(result[f"{name}.theta"] - np.degrees(value)).max() < 1e-6, file
                continue
            assert np.abs(result[f"{name}.q0"] - np.cos(value / 2)).max() < 1e-8, file
            part = np.stack([result[f"{name}.q{k}"] for k in (1, 2, 3)], -1)
            assert np.abs(part - np.sin(value / 2)[:, None] * normal).max() < 1e-8, file
