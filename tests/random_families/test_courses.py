"""Five-bars whose cranks move by laws and ties, against the closed form along the same motion:
every row before the dead centre has its place, none behind it is given one."""

from __future__ import annotations

import random
from collections.abc import Callable

import numpy as np
import pytest
from random_families.five_bars import FiveBar, Motion, Numbers
from random_families.four_bars import cases

import mechkin_cli as mk

Written = tuple[str, Motion]
RAD = np.pi / 180.0


def modified_sine(u: Numbers) -> Numbers:
    """R. L. Norton, Cam Design and Manufacturing Handbook, chapter 3."""
    over = np.pi / (4.0 + np.pi)
    quick = over * (u - np.sin(4.0 * np.pi * u) / (4.0 * np.pi))
    slow = (2.0 + np.pi * u - 2.25 * np.sin(np.pi / 3.0 + 4.0 * np.pi * u / 3.0)) / (4.0 + np.pi)
    last = (4.0 + np.pi * u - 0.25 * np.sin(4.0 * np.pi * u)) / (4.0 + np.pi)
    return np.where(u < 0.125, quick, np.where(u < 0.875, slow, last))


RISES: dict[str, Motion] = {
    "harmonic": lambda u: (1.0 - np.cos(np.pi * u)) / 2.0,
    "cycloidal": lambda u: u - np.sin(2.0 * np.pi * u) / (2.0 * np.pi),
    "3-4-5": lambda u: u**3 * (10.0 - 15.0 * u + 6.0 * u * u),
    "modified-sine": modified_sine,
}


def segments(rng: random.Random, duration: float) -> Written:
    """A sequence of rises and rests over s = t/duration, zero at first."""
    at, value, words = 0.0, 0.0, []
    rises: list[tuple[float, float, float, float, str]] = []
    for _ in range(rng.randint(2, 5)):
        length = rng.uniform(0.05, 0.5)
        if rng.random() < 0.3:
            words.append(f"{{for: {length * duration!r}, law: dwell}}")
        else:
            name, to = rng.choice(list(RISES)), rng.uniform(-150, 150)
            words.append(f"{{for: {length * duration!r}, to: {to!r}, law: {name}}}")
            rises.append((at, length, value, to, name))
            value = to
        at += length

    def motion(s: Numbers) -> Numbers:
        total = 0.0 * s
        for begin, length, low, high, name in rises:
            total = total + (high - low) * RISES[name](np.clip((s - begin) / length, 0.0, 1.0))
        return total

    return f"{{law: sequence, segments: [{', '.join(words)}]}}", motion


def law(rng: random.Random, duration: float) -> Written:
    """A law over s = t/duration, zero at first."""
    kinds = ["rate", "fast", "power", "rise", "rise", "sequence", "sine"]
    kind, amount = rng.choice(kinds), rng.uniform(-200, 200)
    unit = "deg/s"
    if kind == "rate":
        text = f"{{law: constant-rate, at: 0, rate: {amount / duration!r} {unit}}}"
        return text, lambda s: amount * s
    if kind == "fast":
        more = rng.uniform(-300, 300)
        text = (
            f"{{law: constant-acceleration, at: 0, rate: {amount / duration!r} {unit}, "
            f"acceleration: {2.0 * more / duration**2!r} {unit}^2}}"
        )
        return text, lambda s: amount * s + more * s * s
    if kind == "power":
        terms = [rng.uniform(-150, 150) for _ in range(rng.randint(1, 5))]
        first = rng.choice([1, 2, 4])
        words = ["0 deg", "0 deg/s", "0 deg/s^2", "0 deg/s^3"][:first]
        words += [f"{c / duration**k!r} deg/s^{k}" for k, c in enumerate(terms, start=first)]
        text = f"{{law: polynomial, coefficients: [{', '.join(words)}]}}"
        return text, lambda s: sum(c * s**k for k, c in enumerate(terms, start=first))
    if kind == "sequence":
        return segments(rng, duration)
    if kind == "sine":
        periods, phase = rng.uniform(0.2, 3.0), rng.uniform(-180, 180)
        offset = -amount * float(np.sin(phase * RAD))
        text = (
            f"{{law: sine, amplitude: {amount!r}, period: {duration / periods!r}, "
            f"phase: {phase!r} deg, offset: {offset!r}}}"
        )
        turn = 2.0 * np.pi * periods
        return text, lambda s: amount * np.sin(turn * s + phase * RAD) + offset
    start, length = rng.choice([(0.0, 1.0), (rng.uniform(0, 0.5), rng.uniform(0.2, 0.9))])
    name = rng.choice(list(RISES))
    times = f"start: {start * duration!r}, duration: {length * duration!r}"

    def rise(s: Numbers) -> Numbers:
        return amount * RISES[name](np.clip((s - start) / length, 0.0, 1.0))

    return f"{{law: {name}, from: 0, to: {amount!r}, {times}}}", rise


def tie(rng: random.Random) -> tuple[str, Callable[[Numbers], Numbers]]:
    """An expression of A.theta that is zero with it."""
    a, b, c = rng.uniform(-1.5, 1.5), rng.uniform(0.3, 2.5), rng.uniform(-150, 150)
    low, high = min(0.0, c), max(0.0, c)
    bump = float(np.exp(-b * b))
    return rng.choice(
        [
            (f"{a!r}*A.theta", lambda x: a * x),
            (f"{a!r} rad*sin({b!r}*A.theta)", lambda x: a * np.sin(b * x * RAD) / RAD),
            (
                f"{a!r}*(abs(A.theta - ({c!r} deg)) - {abs(c)!r} deg)",
                lambda x: a * (abs(x - c) - abs(c)),
            ),
            (
                f"max({a!r}*A.theta, {c!r} deg) - {high!r} deg",
                lambda x: np.maximum(a * x, c) - high,
            ),
            (
                f"{a!r}*(min({b!r}*A.theta, {c!r} deg) - ({low!r} deg))",
                lambda x: a * (np.minimum(b * x, c) - low),
            ),
            (
                f"{a!r} rad*(exp(-(A.theta/1rad - {b!r})^2) - {bump!r})",
                lambda x: a * (np.exp(-((x * RAD - b) ** 2)) - bump) / RAD,
            ),
            (
                f"atan2({a!r}*sin(A.theta), 2 + cos(A.theta))",
                lambda x: np.arctan2(a * np.sin(x * RAD), 2.0 + np.cos(x * RAD)) / RAD,
            ),
        ]
    )


def drawn(rng: random.Random) -> tuple[FiveBar, str, Motion, Motion, int]:
    """A five-bar, its motion in words and as functions, and its rows."""
    angle, rod = rng.uniform(0.3, 2.8), rng.uniform(0.8, 2.6)
    bar = FiveBar(1.0 + rod * float(np.cos(angle)), rod * float(np.sin(angle)))
    rows, duration = rng.randint(2, 12), rng.choice([0.001, 1.0, 4.0, 100.0])
    kind = rng.choice(["sweep", "law and tie", "two laws", "one law"])
    time = f"time: {{from: 0, to: {duration!r}, count: {rows}}}"
    if kind == "sweep":
        to = rng.choice([-1, 1]) * rng.uniform(30, 500)
        words, tied = tie(rng)
        swept = f"A.theta: {{from: 0, to: {to!r}, count: {rows}}}"
        motion = f'{{inputs: {{{swept}, E.theta: {{with: "{words}"}}}}}}'
        return bar, motion, lambda s: to * s, lambda s: tied(to * s), rows
    text, first = law(rng, duration)
    if kind == "law and tie":
        words, tied = tie(rng)
        motion = f'{{{time}, inputs: {{A.theta: {text}, E.theta: {{with: "{words}"}}}}}}'
        return bar, motion, first, lambda s: tied(first(s)), rows
    if kind == "two laws":
        other, second = law(rng, duration)
        motion = f"{{{time}, inputs: {{A.theta: {text}, E.theta: {other}}}}}"
        return bar, motion, first, second, rows
    motion = f"{{{time}, inputs: {{A.theta: {text}, E.theta: {{at: 0}}}}}}"
    return bar, motion, first, lambda s: 0.0 * s, rows


def test_rows_along_laws_and_ties() -> None:
    decided = ended = 0
    for rng in cases(11, 60):
        bar, motion, a, e, rows = drawn(rng)
        way = bar.along(a, e, rows)
        if not way.is_clear:
            continue
        found = mk.loads(bar.text(motion)).analyze()
        good = np.array([status in ("ok", "near-singular") for status in found["row.status"]])
        assert good.tolist() == (np.arange(rows) < way.reached).tolist(), motion
        want = way.angle[way.rows][: way.reached]
        assert found["B.theta"][: way.reached] == pytest.approx(want, abs=1e-6), motion
        decided += 1
        if way.reached == rows:
            continue
        assert set(found["row.status"][way.reached :]) == {"beyond-dead-centre"}, motion
        (note,) = (d for d in found.diagnostics if d.code == "dead-centre")
        named = {number.name: number.value for number in note.numbers}
        first, second = bar.dead_centre(way, a, e)
        assert named.get("A.theta", first) == pytest.approx(first, abs=1e-6), motion
        assert named.get("E.theta", second) == pytest.approx(second, abs=1e-6), motion
        ended += 1
    assert decided > 30
    assert ended > 5
