"""A block that rubs on its guide, on a spring, pushed by forces that jump and bend, with several
stops at once, against closed accelerations integrated piece by piece.

    python -m random_families.pushed_blocks 0:1000

from `tests/` prints what is wrong or lost and counts. The exit code is 1 if anything is.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import mechkin_cli as mk

WRONG = 1e-8
"""Errors of moments in s, of places and rates in parts of the largest."""
PIECE, GRID = 0.1, 160
"""Longest piece in s, and places in it where changes of sign are looked for."""
ZERO = 1e-11
"""Values at the ends of a piece that count as zero: what the pieces' own errors leave."""

Value = Callable[[float, float, float], float]
"""Of time, place and rate."""
State = tuple[float, float, float]
Piece = Callable[[float], tuple[float, float]]
"""Place and rate by time."""


class Unclear(Exception):
    """The reference cannot tell: a value touches its limit and goes back."""


@dataclass(frozen=True)
class Push:
    """A force: its text, its value by the signs of its switches, and the switches."""

    text: str
    force: Callable[[float, float, list[float]], float]
    switches: tuple[Value, ...]


@dataclass(frozen=True)
class Stop:
    """Its keys in the file, the value that passes zero, +-1 for up or down, and which passage."""

    keys: dict[str, Any]
    value: Value
    direction: int
    count: int


def _push(rng: np.random.Generator) -> Push:
    kind = int(rng.integers(0, 8))
    a, b = (round(float(x), 3) for x in rng.uniform(-8, 8, 2))
    c, t = round(float(rng.uniform(-0.8, 0.8)), 1), round(float(rng.uniform(0.1, 1)), 1)
    end = round(t + float(rng.uniform(0.05, 0.8)), 3)
    place: Value = lambda _, x, __: x - c  # noqa: E731
    later: Value = lambda time, *_: time - t  # noqa: E731
    last: Value = lambda time, *_: time - end  # noqa: E731
    if kind == 0:
        return Push(f"{a} N/m*abs(S.s - {c} m)", lambda _, x, s: a * s[0] * (x - c), (place,))
    if kind == 1:
        text = f"if(S.s > {c} m, {a} N, {b} N)"
        return Push(text, lambda _, __, s: a if s[0] > 0 else b, (place,))
    if kind == 2:
        text = f"max(0 N, {20 * abs(a)} N/m*({c} m - S.s))"
        return Push(text, lambda _, x, s: 20 * abs(a) * (c - x) if s[0] < 0 else 0.0, (place,))
    if kind == 3:
        full, rise = abs(a), abs(b) + 0.1
        text = f"min({full} N, {rise} N/s*time)"
        switch: Value = lambda time, *_: rise * time - full  # noqa: E731
        return Push(text, lambda time, _, s: full if s[0] > 0 else rise * time, (switch,))
    if kind == 4:
        return Push(f"{a} N*sign(time - {t} s)", lambda _, __, s: a * s[0], (later,))
    if kind == 5:
        text = f"{a} N*(time > {t} s and time < {end} s)"
        return Push(text, lambda _, __, s: a * (s[0] > 0 > s[1]), (later, last))
    if kind == 6:
        steps = tuple(_at(n * t) for n in range(1, 30))
        text = f"{a} N*floor(time/({t} s))"
        return Push(text, lambda _, __, s: a * sum(x > 0 for x in s), steps)
    text = f"if(S.s > {c} m and time < {end} s, {a} N, 0 N)"
    return Push(text, lambda _, __, s: a * (s[0] > 0 > s[1]), (place, last))


def _at(moment: float) -> Value:
    return lambda time, *_: time - moment


def _stop(rng: np.random.Generator) -> Stop:
    kind, c = int(rng.integers(0, 7)), round(float(rng.uniform(-0.6, 0.6)), 1)
    direction, count = int(rng.integers(-1, 2)), int(rng.integers(1, 4))
    keys: dict[str, Any] = {"direction": ("any", "up", "down")[direction], "count": count}
    if kind == 0:
        keys |= {"value": "S.s", "at": f"{c} m"}
        return Stop(keys, lambda _, x, __: x - c, direction, count)
    if kind == 1:
        keys |= {"value": "S.s_dot", "at": f"{c} m/s"}
        return Stop(keys, lambda _, __, v: v - c, direction, count)
    if kind == 2:
        keys |= {"value": "abs(S.s)", "at": f"{abs(c)} m"}
        return Stop(keys, lambda _, x, __: abs(x) - abs(c), direction, count)
    if kind == 3:
        return Stop(
            {"value": "S.s_dot", "at": "0 m/s", **keys}, lambda _, __, v: v, direction, count
        )
    if kind == 4:
        moment = round(1 + c, 1)
        return Stop({"value": "time", "at": f"{moment} s"}, lambda t, _, __: t - moment, 0, 1)
    if kind == 5:
        condition = {"value": f"S.s > {c} m", "count": count}
        return Stop(condition, lambda _, x, __: x - c, 1, count)
    keys |= {"value": f"max(S.s - {c} m, 2*(S.s - {c} m))", "at": "0 m"}
    return Stop(keys, lambda _, x, __: max(x - c, 2 * (x - c)), direction, count)


class Block:
    """The mechanism of a seed and its motion."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.pushes = [_push(rng) for _ in range(int(rng.integers(1, 4)))]
        self.switches = [g for push in self.pushes for g in push.switches]
        self.mass = round(float(rng.uniform(0.5, 3)), 3)
        self.spring = round(float(rng.uniform(5, 60)), 3) if rng.random() < 0.6 else 0.0
        self.static = round(float(rng.uniform(0.1, 0.5)), 3) if rng.random() < 0.6 else 0.0
        self.sliding = self.static if rng.random() < 0.5 else round(self.static * 0.7, 4)
        self.normal = self.mass * 9.81
        rate = round(float(rng.uniform(-2, 2)), 3) if rng.random() < 0.7 else 0.0
        self.start = round(float(rng.uniform(-1, 1)), 3), rate
        self.times = np.linspace(0, round(float(rng.uniform(0.5, 2)), 2), int(rng.integers(3, 15)))
        stops = [_stop(rng) for _ in range(int(rng.integers(0, 3)))]
        self.stops = [stop for stop in stops if self._is_clear(stop)]

    def _is_clear(self, stop: Stop) -> bool:
        """No rate of zero at which friction may keep the block; no condition met at once."""
        if "at" in stop.keys:
            return not (self.static and stop.keys["at"] == "0 m/s")
        return stop.value(0.0, *self.start) < 0

    def document(self) -> dict[str, Any]:
        """The sections of the file."""
        push = " + ".join(push.text for push in self.pushes)
        loads: list[dict[str, Any]] = [
            {"type": "gravity", "g": [0, 0, -9.81]},
            {"type": "force", "joint": "S", "value": push},
        ]
        if self.spring:
            stiffness = f"{self.spring} N/m"
            spring = {"type": "spring", "joint": "S", "coordinate": "s", "stiffness": stiffness}
            loads.append(spring)
        if self.static:
            coefficient = {"static": self.static, "sliding": self.sliding}
            loads.append({"type": "friction", "joint": "S", "coefficient": coefficient})
        guide = {"type": "P", "links": ["ground", "block"], "point": [0, 0, 0], "axis": [1, 0, 0]}
        place, rate = self.start
        run: dict[str, Any] = {
            "start": {"S.s": place, "S.s_dot": rate},
            "time": {"from": 0, "to": float(self.times[-1]), "count": len(self.times)},
        }
        if self.stops:
            run["stop"] = [stop.keys for stop in self.stops]
        return {
            "format": 1,
            "units": {"length": "m", "mass": "kg", "force": "N"},
            "links": {"block": {"mass": self.mass, "center_of_mass": [0, 0, 0]}},
            "joints": {"S": guide},
            "loads": loads,
            "responses": {"run": run},
        }  # fmt: skip

    def force(self, t: float, x: float, signs: list[float]) -> float:
        """All forces along the guide but friction, the switches' signs given."""
        total, first = -self.spring * x, 0
        for push in self.pushes:
            behind = first + len(push.switches)
            total += push.force(t, x, signs[first:behind])
            first = behind
        return total

    def motion(self) -> list[tuple[float, float, float]]:
        """Rows of time, place and rate, the last one where a stop ends it."""
        (x, v), t, end = self.start, 0.0, float(self.times[-1])
        rows = [(t, x, v)]
        passed, before = [0] * len(self.stops), [0.0] * len(self.stops)
        while t < end - 1e-13:
            signs = [self._sign(g, t, x, v) for g in self.switches]
            sense = float(np.sign(v)) if abs(v) > ZERO else 0.0
            if not sense:
                pull = self.force(t, x, signs)
                moves = abs(pull) > self.static * self.normal
                sense, v = float(np.sign(pull)) if moves else 0.0, 0.0
            sticks = bool(self.static) and not sense
            piece = self._piece((t, x, v), signs, sense, sticks)
            until, at_rest = self._next_event(piece, t, signs, sense, sticks)
            stop, before = self._stopped(piece, t, until, passed, before)
            last = until if stop is None else stop
            for time in self.times[len(rows) :]:
                if time > last + 1e-13:
                    break
                rows.append((float(time), *piece(min(float(time), until))))
            if stop is not None:
                return [row for row in rows if abs(row[0] - stop) > 1e-12] + [(stop, *piece(stop))]
            x, v = piece(until)
            t, v = until, 0.0 if at_rest else v
        return rows

    def _sign(self, g: Value, t: float, x: float, v: float) -> float:
        value = g(t, x, v)
        if abs(value) < 1e-9:
            value = g(t + 1e-6, x + 1e-6 * v, v)
            if abs(value) < 1e-12:
                raise Unclear("a switch is touched")
        return float(np.sign(value))

    def _piece(self, state: State, signs: list[float], sense: float, sticks: bool) -> Piece:
        t, x, v = state
        end = min(float(self.times[-1]), t + PIECE)
        if sticks:
            return lambda _: (x, 0.0)
        rub = self.sliding * self.normal * sense if self.static else 0.0

        def rates(time: float, y: Any) -> list[float]:
            return [y[1], (self.force(time, y[0], signs) - rub) / self.mass]

        solved = solve_ivp(
            rates, (t, end), [x, v], "DOP853", None, True, rtol=1e-13, atol=1e-14
        )  # fmt: skip
        along = solved.sol
        assert along is not None

        def piece(time: float) -> tuple[float, float]:
            place, rate = along(time)
            return float(place), float(rate)

        return piece

    def _next_event(
        self, piece: Piece, t: float, signs: list[float], sense: float, sticks: bool
    ) -> tuple[float, bool]:
        end = min(float(self.times[-1]), t + PIECE)

        watched: list[tuple[Value, bool]] = [
            (_times(g, sign), False) for g, sign in zip(self.switches, signs, strict=True)
        ]
        if self.static and sticks:
            limit = self.static * self.normal
            watched.append((lambda time, x, _: limit - abs(self.force(time, x, signs)), False))
        elif self.static:
            watched.append((lambda _, __, v: sense * v, True))
        grid = [(float(time), *piece(time)) for time in np.linspace(t, end, GRID)[1:]]
        found, rest = end, False
        for value, ends_at_rest in watched:
            below = next((i for i, state in enumerate(grid) if value(*state) < 0), None)
            if below is not None:
                first = grid[below - 1][0] if below else t + 1e-12
                root = _root(value, piece, first, grid[below][0])
                if root < found:
                    found, rest = root, ends_at_rest
        return found, rest

    def _stopped(
        self, piece: Piece, t: float, until: float, passed: list[int], before: list[float]
    ) -> tuple[float | None, list[float]]:
        """The moment of a stop in a piece, and the signs of all values at its end."""
        grid = [(float(time), *piece(time)) for time in np.linspace(t, until, GRID)]
        hits, after = [], []
        for k, stop in enumerate(self.stops):
            values = [stop.value(*state) for state in grid]
            if abs(values[0]) < ZERO:
                values[0] = -1e-300 * values[1] if before[k] * values[1] < 0 else 0.0
            ends = abs(values[-1]) < ZERO
            values[-1] = 0.0 if ends else values[-1]
            after.append(values[-2] if ends else values[-1])
            for i in range(GRID - 1):
                up = values[i + 1] > 0
                if values[i] * values[i + 1] < 0 and stop.direction in (0, 1 if up else -1):
                    at_start = abs(values[i]) < 1e-200
                    first, last = grid[i][0], grid[i + 1][0]
                    hits.append((first if at_start else _root(stop.value, piece, first, last), k))
        for moment, k in sorted(hits):
            passed[k] += 1
            if passed[k] == self.stops[k].count:
                return moment, after
        return None, after


def _times(value: Value, factor: float) -> Value:
    return lambda *state: factor * value(*state)


def _root(value: Value, piece: Piece, first: float, last: float) -> float:
    """Where a value passes zero in a piece; its first place where it is below already."""

    def of(time: float) -> float:
        return value(time, *piece(time))

    return first if of(first) * of(last) >= 0 else float(brentq(of, first, last, xtol=1e-15))


class Judged(NamedTuple):
    """How a motion ended, its error (moments in s, the rest in parts of the largest), a remark."""

    word: str
    error: float = 0.0
    remark: str = ""


def judge(seed: int) -> Judged:
    """The response of a seed's block against its motion: ok, wrong, lost or unclear."""
    block = Block(seed)
    try:
        rows = np.array(block.motion())
    except Unclear as told:
        return Judged("unclear", remark=str(told))
    found = mk.load(block.document()).respond("run")
    if set(found["row.status"]) != {"ok"}:
        return Judged("lost", remark="; ".join(map(str, found.diagnostics)))
    got = np.array([found["time"], found["S.s"], found["S.s_dot"]]).T
    if got.shape != rows.shape:
        return Judged("wrong", remark=f"{len(got)} rows instead of {len(rows)}")
    error = float((np.abs(got - rows) / [1, *np.abs(rows[:, 1:]).max(axis=0).clip(1e-3)]).max())
    return Judged("wrong" if error > WRONG else "ok", error, f"off by {error:.1e}")


def main(first: int, last: int) -> int:
    """Judges seeds; 1 where one is wrong or lost."""
    counts: Counter[str] = Counter()
    for seed in range(first, last):
        judged = judge(seed)
        counts[judged.word] += 1
        if judged.word in ("wrong", "lost"):
            print(seed, judged.word, judged.remark, flush=True)
    print(dict(counts))
    return int(counts["wrong"] + counts["lost"] > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1].split(":"))))
