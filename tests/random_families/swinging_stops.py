"""Stops whose values swing many times while a block slides steadily, or falls, against closed
motions and passages on a grid that is fine beside the fastest swing.

    python -m random_families.swinging_stops 0:1000

from `tests/` prints what is wrong or lost and counts. The exit code is 1 if anything is.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

import mechkin_cli as mk

END = 5.0
"""Of the response, in s."""
GRID = 400_001
"""Places of the grid: 20 for each of a thousand swings in 1 m or 1 s, at a few m/s."""
WRONG = 1e-8
"""Of moments in s and places in m."""

Value = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""Less what it is to pass, by place in m and time in s."""

FILE = """format: 1
name: block
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{block: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints: {{S: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}}}
loads: [{{type: force, joint: S, value: {force} N}}]
responses:
  run:
    start: {{S.s: {place}, S.s_dot: {rate}}}
    time: {{from: 0, to: 5, count: {rows}}}
    stop: [{{value: "{value}", at: {at}, direction: {direction}, count: {count}}}]
"""


class Judged(NamedTuple):
    """`word` is ok, wrong or lost."""

    word: str
    text: str
    moment: float
    right: float


def _value(rng: np.random.Generator) -> tuple[str, str, Value]:
    """Text, what it passes, and the difference of both."""
    w = float(round(10 ** rng.uniform(0, 3), 2))
    a, at = float(round(rng.uniform(0.1, 1), 3)), float(round(rng.uniform(-0.95, 0.95), 3))
    period, part = round(1 / w, 4), float(round(rng.uniform(0.2, 0.8) / w, 6))
    v = round(1.37 * w, 2)
    kinds: list[tuple[str, str, Value]] = [
        (f"sin({w} rad/m*S.s + {a} rad)", f"{at}", lambda s, t: np.sin(w * s + a) - at),
        (f"cos({w} rad/s*time)*S.s", f"{at} m", lambda s, t: np.cos(w * t) * s - at),
        (f"mod(S.s, {period} m)", f"{part} m", lambda s, t: np.mod(s, period) - part),
        (f"abs(sin({w} rad/s*time))", f"{abs(at)}", lambda s, t: abs(np.sin(w * t)) - abs(at)),
        (
            f"max(sin({w} rad/s*time), S.s/(1 m) - 2)",
            f"{at}",
            lambda s, t: np.maximum(np.sin(w * t), s - 2) - at,
        ),
        (
            f"exp(-((time - {3 * a:.3f} s)/(0.01 s))^2)",
            "0.5",
            lambda s, t: np.exp(-(((t - round(3 * a, 3)) / 0.01) ** 2)) - 0.5,
        ),
        (
            f"sin({w} rad/m*S.s) + sin({v} rad/s*time)",
            f"{at}",
            lambda s, t: np.sin(w * s) + np.sin(v * t) - at,
        ),
    ]
    return kinds[int(rng.integers(len(kinds)))]


def _passages(values: np.ndarray, times: np.ndarray, way: int) -> list[tuple[float, float]]:
    """First and last moment between which the value passes zero upwards (1), downwards (-1) or
    either way (0)."""
    sign = np.where(values < 0.0, -1, 1)
    ups = np.flatnonzero(sign[1:] != sign[:-1])
    return [(times[k], times[k + 1]) for k in ups if not way or sign[k + 1] == way]


def judge(seed: int) -> Judged:
    """One block."""
    rng = np.random.default_rng([seed, 5])
    text, at, value = _value(rng)
    way, count = int(rng.integers(-1, 2)), int(rng.integers(1, 30))
    count = min(count, 2) if text.startswith("exp") else count
    rate, force = float(round(rng.uniform(0.2, 3), 3)), float(rng.choice([0.0, 0.0, 1.5, -2.0]))
    # not where a value jumps at once
    place, rows = float(round(rng.uniform(-1, 1), 3)) + 0.00037, int(rng.choice([2, 6, 101]))
    file = FILE.format(
        force=force, place=place, rate=rate, rows=rows, value=text, at=at, count=count,
        direction={0: "any", 1: "up", -1: "down"}[way],
    )  # fmt: skip

    def moved(t: np.ndarray) -> np.ndarray:
        return place + rate * t + 0.5 * force * t * t

    def along(t: float) -> float:
        return float(value(np.asarray(moved(np.asarray(t))), np.asarray(t)))

    times = np.linspace(0.0, END, GRID)
    found = _passages(value(moved(times), times), times, way)
    right = brentq(along, *found[count - 1], xtol=1e-15) if len(found) >= count else END
    response = mk.loads(file).respond("run")
    moment = float(response["time"][-1])
    if str(response["row.status"][-1]) != "ok":
        return Judged("lost", file, moment, right)
    off = max(
        abs(moment - right), abs(float(response["S.s"][-1]) - float(moved(np.asarray(right))))
    )
    ends = bool(str(response["row.event"][-1])) == (len(found) >= count)
    return Judged("ok" if off < WRONG and ends else "wrong", file, moment, right)


def main() -> int:
    """Judges the seeds that the command line names."""
    first, last = (int(part) for part in sys.argv[1].split(":"))
    words: Counter[str] = Counter()
    for seed in range(first, last):
        judged = judge(seed)
        words[judged.word] += 1
        if judged.word != "ok":
            print(f"seed {seed}: {judged.word}, {judged.moment} for {judged.right}\n{judged.text}")
    print(dict(words))
    return int(words.total() > words["ok"])


if __name__ == "__main__":
    sys.exit(main())
