"""Blocks on a plane under growing, swinging and passing forces, from rest or with a shove,
against scipy: pieces of slip are integrated, ends of rests are found on a fine grid."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import exp, sin

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import mechkin_cli as mk

COUNTS = (2, 5, 51)
END, WEIGHT = 3.0, 10.0
GRID = 30001
TOLERANCE = 1e-7
"""Of places in m and rates in m/s; an event is told to about 1e-10 s, 10 m/s2 are common."""

Force = Callable[[float], float]


@dataclass(frozen=True)
class Block:
    static: float
    sliding: float
    falls_within: float
    """The speed within which the coefficient falls; 0: at once."""
    text: str
    force: Force
    shove: float

    def coefficient(self, speed: float) -> float:
        if not self.falls_within:
            return self.sliding
        fall = exp(-((speed / self.falls_within) ** 2))
        return self.sliding + (self.static - self.sliding) * fall


@dataclass(frozen=True)
class Found:
    fault: str
    error: float
    text: str
    remark: str = ""

    @property
    def figures(self) -> dict[str, float]:
        return {"motion": self.error}


def short(x: float) -> float:
    return float(f"{x:.3g}")


def block_of(seed: int) -> Block:
    rng = random.Random(seed)
    sliding = short(rng.uniform(0.05, 0.4))
    static = sliding if seed % 3 == 0 else short(sliding * rng.uniform(1.05, 2))
    falls_within = short(10 ** rng.uniform(-2, 0.5)) if seed % 3 == 2 else 0.0
    a, b, w = short(rng.gauss(0, 1)), short(rng.uniform(2, 9)), short(10 ** rng.uniform(0, 1.5))
    middle, width = short(rng.uniform(0.5, 2.5)), short(10 ** rng.uniform(-1.5, -0.5))
    text, force = rng.choice(
        [
            (f"{a} N + {b} N/s*time", lambda t: a + b * t),
            (f"{a} N + {b} N*sin({w} rad/s*time)", lambda t: a + b * sin(w * t)),
            (
                f"{a} N + {b} N*exp(-((time - {middle} s)/({width} s))^2)",
                lambda t: a + b * exp(-(((t - middle) / width) ** 2)),
            ),
        ]
    )
    return Block(
        static, sliding, falls_within, text, force, rng.choice((0.0, short(rng.gauss(0, 1))))
    )


def written(block: Block, count: int) -> str:
    speed = f", speed: {block.falls_within} m/s" if block.falls_within else ""
    coefficient = f"{{static: {block.static}, sliding: {block.sliding}{speed}}}"
    if block.static == block.sliding:
        coefficient = str(block.sliding)
    return (
        "format: 1\nname: block\nunits: {length: m, angle: rad, mass: kg, force: N}\n"
        "links: {a: {mass: 1, center_of_mass: [0, 0, 0]}}\n"
        "joints: {A: {type: P, links: [ground, a], point: [0, 0, 0], axis: [1, 0, 0]}}\n"
        "loads:\n  - {type: gravity, g: [0, 0, -10]}\n"
        f"  - {{type: friction, joint: A, coefficient: {coefficient}}}\n"
        f'  - {{type: force, joint: A, value: "{block.text}"}}\n'
        f"responses:\n  r: {{start: {{A.s: 0 m, A.s_dot: {block.shove} m/s}},"
        f" time: {{from: 0 s, to: {END} s, count: {count}}}}}\n"
    )


def end_of_rest(block: Block, start: float) -> float:
    """Where the force first passes what is held; END where it never does."""

    def margin(t: float) -> float:
        return block.static * WEIGHT - abs(block.force(t))

    grid = np.linspace(start, END, GRID)
    for before, after in pairwise(grid):
        if margin(after) < 0:
            return float(brentq(margin, before, after)) if margin(before) > 0 else float(before)
    return END


def states(block: Block, times: np.ndarray) -> np.ndarray:
    """Place and rate at these times, (times, 2)."""
    found = np.zeros((len(times), 2))
    t, state = 0.0, np.array([0.0, block.shove])
    sense = float(np.sign(block.shove))
    while t < END:
        if sense == 0 and abs(block.force(t)) <= block.static * WEIGHT * (1 + 1e-9):
            t_end = end_of_rest(block, t)
            found[(times >= t) & (times <= t_end)] = state
            t = t_end
            if t >= END:
                break
        if sense == 0:
            sense = float(np.sign(block.force(t)))

        def rates(t: float, y: np.ndarray, sense: float = sense) -> list[float]:
            return [y[1], block.force(t) - sense * WEIGHT * block.coefficient(y[1])]

        def ends(_: float, y: np.ndarray, sense: float = sense) -> float:
            return sense * y[1]

        ends.terminal, ends.direction = True, -1  # type: ignore[attr-defined]
        slip = solve_ivp(
            rates, (t, END), state, "DOP853", events=ends, dense_output=True,
            rtol=1e-11, atol=1e-13, max_step=0.01,
        )  # fmt: skip
        within = (times >= t) & (times <= slip.t[-1])
        if within.any():
            found[within] = slip.sol(times[within]).T
        t, state, sense = float(slip.t[-1]), np.array([slip.y[0, -1], 0.0]), 0.0
    return found


def run_one(seed: int) -> Found:
    block = block_of(seed)
    worst = 0.0
    for count in COUNTS:
        text = written(block, count)
        rows = mk.loads(text).respond("r", ["A.s", "A.s_dot"])
        if not (rows["row.status"] == "ok").all():
            return Found(f"{seed}: rows lost of {count}", 0.0, text)
        have = np.array([rows["A.s"], rows["A.s_dot"]]).T
        error = float(np.abs(have - states(block, np.linspace(0, END, count))).max())
        if not error <= TOLERANCE:
            return Found(f"{seed}: with {count} rows off by {error:.1e}", error, text)
        worst = max(worst, error)
    return Found("", worst, text)
