"""A mass in free flight or on a spring, with random values of comparisons, floors, signs, kinks and
conditions within each other: as the value of a stop, whose moment is bisected in the closed motion;
as a load, against Runge-Kutta steps of at most 0.1 ms."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp

import mechkin_cli as mk

Written = tuple[str, str]
"""A value in the file and in Python, of s, v and t."""

LEAVES: list[Written] = [("P.s/(1 m)", "s"), ("time/(1 s)", "t"), ("P.s_dot/(1 m/s)", "v")]
MOMENT, PLACE = 1e-9, 1e-8
"""Errors of a stop's moment (s), and of a place in parts of its size."""

END = 2.0
GRID = 20_000
LARGEST = 30.0
"""Motions that grow beyond it grow errors, too."""

HEAD = """format: 1
units: {{length: m, angle: rad}}
links: {{b: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints: {{P: {{type: P, links: [ground, b], point: [0, 0, 0], axis: [0, 0, 1]}}}}
loads:
{loads}
responses:
  run:
    start: {{P.s: {s}, P.s_dot: {v}}}
    time: {{from: 0, to: 2, step: {step}}}
"""


@dataclass(frozen=True)
class Found:
    text: str
    fault: str = ""
    remark: str = ""
    figures: dict[str, float] = field(default_factory=dict)


def value(rng: random.Random, depth: int) -> Written:
    """A number within numbers."""
    if depth == 0:
        return rng.choice(LEAVES)
    (a, pa), (b, pb) = value(rng, depth - 1), value(rng, depth - 1)
    c, factor = round(rng.uniform(-3, 4), 3), round(rng.uniform(0.3, 4.3), 3)
    kind = rng.choice(["abs", "max", "min", "floor", "sign", "if", "if", "if", "sum"])
    if kind == "abs":
        return f"abs({a} - ({c}))", f"abs({pa} - ({c}))"
    if kind == "max":
        return f"max({a}, {b})", f"max({pa}, {pb})"
    if kind == "min":
        return f"min({a}, {c})", f"min({pa}, {c})"
    if kind == "floor":
        return f"floor({a}*{factor})", f"floor(({pa})*{factor})"
    if kind == "sign":
        return f"sign({a} - ({c}))", f"sign({pa} - ({c}))"
    if kind == "if":
        q, pq = condition(rng, depth - 1)
        return f"if({q}, {a}, {b})", f"(({pa}) if ({pq}) else ({pb}))"
    return f"({a} + {b}*({c}))", f"(({pa}) + ({pb})*({c}))"


def condition(rng: random.Random, depth: int) -> Written:
    """A condition of numbers and conditions."""
    a, pa = value(rng, max(depth - 1, 0))
    c, sign = round(rng.uniform(-3, 4), 3), rng.choice(["<", ">", "<=", ">="])
    one, pone = f"({a} {sign} {c})", f"(({pa}) {sign} {c})"
    if depth <= 0 or rng.random() < 0.5:
        return one, pone
    (two, ptwo), word = condition(rng, depth - 1), rng.choice(["and", "or"])
    return f"({one} {word} {two})", f"({pone} {word} {ptwo})"


def compiled(text: str) -> Callable[[float, float, float], float]:
    """The Python form as a function of s, v and t."""
    names = {"floor": math.floor, "sign": lambda x: float(np.sign(x)), "max": max, "min": min}
    code = compile(text, "value", "eval")
    return lambda s, v, t: float(eval(code, {**names, "abs": abs, "s": s, "v": v, "t": t}))


def run_stop(seed: int) -> Found:
    """A stop at a value of free flight."""
    rng = random.Random(seed)
    text, python = value(rng, rng.choice([1, 2, 2, 3]))
    at, step = round(rng.uniform(-3, 4), 3) + 0.00037, rng.choice([0.05, 0.5, 1, 2])
    gravity = "- {type: gravity, g: [0, 0, -10]}"
    file = HEAD.format(loads=gravity, s=5, v=3, step=step)
    file += f'    stop: [{{value: "{text}", at: {at}}}]\n'
    read = compiled(python)

    def off(t: float) -> float:
        return read(5 + 3 * t - 5 * t * t, 3 - 10 * t, t) - at

    expected = _first_passage(off)
    analysis = mk.loads(file).respond("run")
    reached, is_stopped = float(analysis["time"][-1]), bool(analysis["row.event"][-1])
    if is_stopped != (expected is not None):
        return Found(file, f"stopped at {reached}, expected {expected}")
    error = abs(reached - (END if expected is None else expected))
    fault = f"stopped at {reached!r}, expected {expected!r}" if error > MOMENT else ""
    return Found(file, fault, "stopped" if is_stopped else "not stopped", {"moments": error})


def _first_passage(off: Callable[[float], float]) -> float | None:
    """The first moment at which a value changes its sign or becomes zero."""
    times = np.linspace(0.0, END, GRID + 1).tolist()
    before = off(0.0)
    for low, high in itertools.pairwise(times):
        after = off(high)
        if (after > 0) == (before > 0) and after != 0:
            before = after
            continue
        while low < (middle := 0.5 * (low + high)) < high:
            if (off(middle) > 0) == (before > 0):
                low = middle
            else:
                high = middle
        return high
    return None


def run_load(seed: int) -> Found:
    """A force on a mass with a spring."""
    rng = random.Random(seed)
    text, python = value(rng, rng.choice([2, 3, 3]))
    s, v = round(rng.uniform(-2, 4), 3), round(rng.uniform(-3, 3), 3)
    spring = "- {type: spring, joint: P, coordinate: s, stiffness: 3 N/m}\n"
    force = f'- {{type: force, link: b, point: [0, 0, 0], force: [0, 0, "({text})*1 N"]}}'
    file = HEAD.format(loads=spring + force, s=s, v=v, step=rng.choice([0.1, 0.5, 2]))
    read = compiled(python)
    analysis = mk.loads(file).respond("run")
    reached = float(analysis["P.s"][-1])
    if str(analysis["row.status"][-1]) == "friction-undecided":
        return Found(file, "", "held at a jump")

    def rates(t: float, y: np.ndarray) -> list[float]:
        return [float(y[1]), read(float(y[0]), float(y[1]), float(t)) - 3 * float(y[0])]

    for longest in (np.inf, 1e-4):
        options = {"rtol": 2e-13, "atol": 1e-13, "max_step": longest}
        solution = solve_ivp(rates, (0.0, END), [s, v], method="RK45", **options)
        size = float(np.abs(solution.y).max())
        if size > LARGEST:
            return Found(file, "", "grow")
        error = abs(float(solution.y[0, -1]) - reached) / max(1.0, size)
        if error <= PLACE:
            return Found(file, "", "", {"places": error})
    fault = f"s = {reached!r}, expected {float(solution.y[0, -1])!r}"
    return Found(file, fault, "", {"places": error})


def run_one(seed: int) -> Found:
    """Stops and loads in turns."""
    return run_stop(seed // 2) if seed % 2 else run_load(seed // 2)
