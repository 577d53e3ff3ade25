"""Two sliders under random loads of magnitudes, signs, larger and smaller values within each other,
against scipy's integration of the written expressions in tiny steps."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from math import sin

import numpy as np
from scipy.integrate import solve_ivp

import mechkin_cli as mk

DEPTH = 3
COUNTS = (2, 5, 101)
TOLERANCE, TOLERANCE_ROWS = 2e-7, 1e-8
"""Of rates and places of size 1: from the tiny steps, which go over kinks blindly; between
responses with other rows."""

Value = Callable[[float, np.ndarray], float]
LEAVES: list[tuple[str, Value]] = [
    ("A.s/(1 m)", lambda t, y: y[0]),
    ("A.s_dot/(1 m/s)", lambda t, y: y[1]),
    ("B.s/(1 m)", lambda t, y: y[2]),
    ("B.s_dot/(1 m/s)", lambda t, y: y[3]),
    ("time/(1 s)", lambda t, y: t),
]
QUANTITIES = ["A.s", "A.s_dot", "B.s", "B.s_dot"]


@dataclass(frozen=True)
class Found:
    fault: str
    error: float
    is_whole: bool
    text: str

    @property
    def figures(self) -> dict[str, float]:
        return {"motion": self.error}

    @property
    def remark(self) -> str:
        return "" if self.is_whole else "end early"


def sign(x: float) -> float:
    return float(x > 0) - float(x < 0)


def number(rng: random.Random) -> float:
    return rng.choice((-1, 1)) * round(rng.uniform(0.05, 1.5), 2)


def expression(rng: random.Random, depth: int) -> tuple[str, Value]:
    """Signs are those of something less a number: none begins at its jump at rest."""
    if depth == 0 or rng.random() < 0.1:
        if rng.random() < 0.25:
            constant = number(rng)
            return f"({constant})", lambda t, y: constant
        return rng.choice(LEAVES)
    kind = rng.choice(["abs", "sign", "min", "max", "min", "max", "+", "*", "sin"])
    text, value = expression(rng, depth - 1)
    if kind == "abs":
        return f"abs({text})", lambda t, y: abs(value(t, y))
    if kind == "sin":
        return f"sin(({text})*(1 rad))", lambda t, y: sin(value(t, y))
    if kind == "sign":
        at = number(rng)
        return f"sign({text} - ({at}))", lambda t, y: sign(value(t, y) - at)
    text_b, value_b = expression(rng, depth - 1)
    if kind == "min":
        return f"min({text}, {text_b})", lambda t, y: min(value(t, y), value_b(t, y))
    if kind == "max":
        return f"max({text}, {text_b})", lambda t, y: max(value(t, y), value_b(t, y))
    if kind == "+":
        return f"({text} + {text_b})", lambda t, y: value(t, y) + value_b(t, y)
    return f"({text})*({text_b})", lambda t, y: value(t, y) * value_b(t, y)


def written(loads: list[str], start: list[float], count: int) -> str:
    places = ", ".join(
        f"{name}: {x!r} {unit}"
        for name, x, unit in zip(QUANTITIES, start, ("m", "m/s") * 2, strict=True)
    )
    links = ", ".join(f"{link}: {{mass: 1, center_of_mass: [0, 0, 0]}}" for link in "ab")
    joint = "{{type: P, links: [ground, {}], point: [0, 0, 0], axis: {}}}"
    forces = "".join(
        f'  - {{type: force, joint: {name}, value: "1 N*({load})"}}\n'
        for name, load in zip("AB", loads, strict=True)
    )
    return (
        "format: 1\nname: kinks within kinks\n"
        "units: {length: m, angle: rad, mass: kg, force: N}\n"
        f"links: {{{links}}}\njoints:\n  A: {joint.format('a', '[1, 0, 0]')}\n"
        f"  B: {joint.format('b', '[0, 1, 0]')}\nloads:\n{forces}"
        f"responses:\n  r: {{start: {{{places}}}, time: {{from: 0, to: 1, count: {count}}}}}\n"
    )


def states(text: str) -> tuple[np.ndarray, bool]:
    """Of the rows that are there, (rows, 4), and whether these are all."""
    rows = mk.loads(text).respond("r", QUANTITIES)
    solved = rows["row.status"] == "ok"
    have = np.array([rows[name] for name in QUANTITIES]).T
    return have[solved], bool(solved.all())


def run_one(seed: int) -> Found:
    rng = random.Random(seed)
    loads = [expression(rng, rng.randint(1, DEPTH)), expression(rng, rng.randint(0, DEPTH))]
    start = [rng.choice((0.0, round(rng.gauss(0, size), 2) + 0.003)) for size in (0.2, 1, 0.2, 1)]
    texts = [written([load[0] for load in loads], start, count) for count in COUNTS]
    have = [states(text) for text in texts]
    places, is_whole = have[-1]
    text = texts[-1]
    if not is_whole:
        return Found("", 0.0, False, text)
    reference = solve_ivp(
        lambda t, y: [y[1], loads[0][1](t, y), y[3], loads[1][1](t, y)],
        (0, 1), start, "DOP853", t_eval=np.linspace(0, 1, COUNTS[-1]),
        rtol=1e-11, atol=1e-12, max_step=0.01,
    )  # fmt: skip
    if len(reference.t) < COUNTS[-1]:
        return Found("", 0.0, False, text)
    size = max(1.0, float(np.abs(places).max()))
    error = float(np.abs(places - reference.y.T).max()) / size
    if error > TOLERANCE:
        return Found(f"{seed}: off by {error:.1e}", error, True, text)
    for count, (other, all_there) in zip(COUNTS[:-1], have[:-1], strict=True):
        if not all_there:
            return Found(f"{seed}: lost with {count} rows", error, True, texts[0])
        same = float(np.abs(other[-1] - places[-1]).max()) / size
        if same > TOLERANCE_ROWS:
            return Found(f"{seed}: with {count} rows off by {same:.1e}", same, True, text)
    return Found("", error, True, text)
