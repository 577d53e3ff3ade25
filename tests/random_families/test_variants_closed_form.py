"""Variants of random four-bars, one loop and two, against the closed form along the straight line.

The linkage lies in a plane and is drawn with R R R R, R S S R or R C S R. Its two assemblies
differ in the sign of one square root; along the straight line from the base to a variant the branch
goes on while the number below the root stays positive. `MECHKIN_RANDOM` multiplies the number of
linkages.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from math import inf

import numpy as np
import pytest
from numpy.typing import NDArray

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
PAIRS = {"RRRR": ("R", "R"), "RSSR": ("S", "S"), "RCSR": ("C", "S")}
Floats = NDArray[np.float64]

NEAR_FOLD = 1e-3
"""Below this part of the largest link squared nothing is asked of a verdict."""


@dataclass(frozen=True)
class FourBar:
    """Crank, coupler, rocker, ground, and the side of the coupler's joint."""

    lengths: Floats
    side: int

    def radicand(self, degrees: float) -> float:
        """What stands below the root, in parts of the largest link squared."""
        a, b, c, d = self.lengths
        e = np.sqrt(a * a + d * d - 2 * a * d * np.cos(np.radians(degrees)))
        along = (b * b - c * c + e * e) / (2 * e)
        return float((b * b - along * along) / max(b * b, c * c, d * d))

    def rocker(self, degrees: float) -> float:
        """The rocker's angle in degrees."""
        a, b, c, d = self.lengths
        x, y = a * np.cos(np.radians(degrees)), a * np.sin(np.radians(degrees))
        e = np.hypot(d - x, y)
        along = (b * b - c * c + e * e) / (2 * e)
        height = self.side * np.sqrt(b * b - along * along)
        across = ((d - x) / e, -y / e)
        return float(
            np.degrees(
                np.arctan2(
                    y + along * across[1] + height * across[0],
                    x + along * across[0] - height * across[1] - d,
                )
            )
        )


def joint(name: str, kind: str, links: str, place: str) -> str:
    """One joint, with an axis where it has one."""
    axis = "" if kind == "S" else ", axis: [0, 0, 1]"
    return f"  {name}: {{type: {kind}, links: [{links}], point: {place}{axis}}}\n"


def loop(number: int, pairs: tuple[str, str]) -> str:
    """Coupler, rocker and their joints."""
    a, b, c, d = "a", f"b{number}", f"c{number}", f"d{number}"
    coupler, rocker = f"coupler{number}", f"rocker{number}"
    meeting = f"{{{coupler}: [{a}+{b}, 0, 0], {rocker}: [{d}+{c}, 0, 0]}}"
    return (
        joint(f"B{number}", pairs[0], f"crank, {coupler}", f"[{a}, 0, 0]")
        + joint(f"C{number}", pairs[1], f"{coupler}, {rocker}", meeting)
        + joint(f"D{number}", "R", f"ground, {rocker}", f"[{d}, 0, 0]")
    )


def text_of(
    bars: list[FourBar], pairs: tuple[str, str], start: float, end: float, rows: int
) -> str:
    """A file of four-bars on one crank, their lengths and the sweep as parameters."""
    parameters = [f"a: {float(bars[0].lengths[0])!r} m", f"start: {start!r} deg"]
    parameters.append(f"end: {end!r} deg")
    near, links = [], ["crank: {}"]
    for number, bar in enumerate(bars):
        for name, value in zip("bcd", bar.lengths[1:], strict=True):
            parameters.append(f"{name}{number}: {float(value)!r} m")
        near.append(f"D{number}.theta: {bar.rocker(start)!r}")
        links += [f"coupler{number}: {{}}", f"rocker{number}: {{}}"]
    sweep = f"{{from: start, to: end, count: {rows}}}"
    return (
        "format: 1\nname: four-bars\nunits: {length: m, angle: deg}\n"
        f"parameters: {{{', '.join(parameters)}}}\nlinks: {{{', '.join(links)}}}\njoints:\n"
        + joint("A", "R", "ground, crank", "[0, 0, 0]")
        + "".join(loop(number, pairs) for number in range(len(bars)))
        + f"motion: {{inputs: {{A.theta: {sweep}}}}}\nassembly: {{near: {{{', '.join(near)}}}}}\n"
    )


def apart(one: float, other: float) -> float:
    """The angle between two angles in degrees."""
    return float(abs((one - other + 180) % 360 - 180))


def drawn(rng: np.random.Generator, count: int) -> tuple[list[FourBar], float]:
    """Four-bars on one crank that assemble well at a common angle."""
    while True:
        start = float(rng.uniform(-180, 180))
        crank = rng.uniform(0.3, 2)
        bars = [
            FourBar(np.array([crank, *rng.uniform(0.3, 2, 3)]), int(rng.choice([-1, 1])))
            for _ in range(count)
        ]
        if all(bar.radicand(start) > 0.05 for bar in bars):
            return bars, start


def between(bar: FourBar, target: Floats, start: float, end: float) -> float:
    """The smallest radicand along the straight line in lengths and angle."""
    return min(
        FourBar(bar.lengths + s * (target - bar.lengths), bar.side).radicand(
            start + s * (end - start)
        )
        for s in np.linspace(0, 1, 1001)
    )


def check(seed: int, kind: str, count: int, moving: bool = False, variants: int = 15) -> None:
    """Draws one mechanism and compares all its variants with the closed form."""
    rng = np.random.default_rng([seed, count, *kind.encode()])
    bars, start = drawn(rng, count)
    rows = int(rng.integers(1, 9)) + 1
    end = start + float(rng.uniform(-120, 120))
    model = mk.loads(text_of(bars, PAIRS[kind], start, end, rows))
    base = model.analyze(tables=[])
    for number, bar in enumerate(bars):
        assert apart(base[f"D{number}.theta"][0], bar.rocker(start)) < 1e-6
    wide = seed % 2 == 0
    scale = rng.uniform(0.3, 2.5, (variants, 1 + 3 * count))
    scale = scale if wide else 1 + 0.2 * (scale - 1)
    parameters = {"a": bars[0].lengths[0] * scale[:, 0]}
    for number, bar in enumerate(bars):
        for index, name in enumerate("bcd"):
            column = scale[:, 1 + 3 * number + index]
            parameters[f"{name}{number}"] = bar.lengths[1 + index] * column
    starts = start + (rng.uniform(-40, 40, variants) if moving else np.zeros(variants))
    if moving:
        parameters |= {"start": starts, "end": starts + (end - start)}
    names = [f"D{number}.theta" for number in range(count)]
    varied = model.vary(parameters, names)
    assert not varied.errors
    for i in range(variants):
        status = varied.status[i]
        targets = [
            np.array([parameters["a"][i], *(parameters[f"{name}{n}"][i] for name in "bcd")])
            for n in range(count)
        ]
        lows = [
            between(bar, target, start, starts[i])
            for bar, target in zip(bars, targets, strict=True)
        ]
        here = f"seed {seed}, variant {i}, lowest {min(lows)}"
        if min(lows) < 0:
            assert set(status) <= {"branch-lost", "not-assembled"}, here
            continue
        if min(lows) < NEAR_FOLD and status[0] != "ok":
            continue
        finals = [FourBar(t, bar.side) for t, bar in zip(targets, bars, strict=True)]
        angles = np.linspace(starts[i], starts[i] + (end - start), rows)
        lowest = inf
        for j, angle in enumerate(angles):
            way = np.linspace(angles[max(j - 1, 0)], angle, 201)
            lowest = min(lowest, *(final.radicand(at) for final in finals for at in way))
            if lowest < 0:
                assert status[j] not in ("ok", "near-singular"), f"{here}, row {j}"
                assert all(np.isnan(varied[name][i, j]) for name in names), f"{here}, row {j}"
                break
            if lowest < NEAR_FOLD:
                break
            assert status[j] in ("ok", "near-singular"), f"{here}, row {j}"
            for name, final in zip(names, finals, strict=True):
                assert apart(varied[name][i, j], final.rocker(angle)) < 1e-7, f"{here}, row {j}"


@pytest.mark.parametrize("kind", PAIRS)
@pytest.mark.parametrize("seed", range(4 * TIMES))
def test_far_variants_stay_on_their_branch_or_are_lost(seed: int, kind: str) -> None:
    """Lengths vary by a few times; nothing jumps to the other assembly."""
    check(seed, kind, 1, moving=False)


@pytest.mark.parametrize("seed", range(4 * TIMES))
def test_two_loops_on_one_crank_are_judged_each(seed: int) -> None:
    """Two independent loops, one of which may fold, or both at once."""
    check(seed, "RCSR", 2, moving=False)


@pytest.mark.parametrize("kind", PAIRS)
@pytest.mark.parametrize("seed", range(100, 100 + 2 * TIMES))
def test_a_sweep_that_moves_too_is_continued_all_the_same(seed: int, kind: str) -> None:
    """The first row's input is a parameter as the lengths are."""
    check(seed, kind, 1, moving=True, variants=15 if TIMES > 1 else 5)


def test_naming_the_start_of_the_sweep_changes_nothing() -> None:
    """Far lengths alone, and with the file's own value of the sweep's start."""
    rng = np.random.default_rng(7)
    bars, start = drawn(rng, 1)
    model = mk.loads(text_of(bars, PAIRS["RRRR"], start, start + 1.0, 2))
    scale = rng.uniform(0.8, 1.25, (40, 4))
    lengths = {n: bars[0].lengths[i] * scale[:, i] for i, n in enumerate(["a", "b0", "c0", "d0"])}
    alone = model.vary(lengths, ["D0.theta"])
    named = model.vary(lengths | {"start": np.full(40, start)}, ["D0.theta"])
    assert (alone.status == named.status).all()
    both = alone.codes[:, 0] == 0
    assert both.sum() > 10
    assert np.abs(alone["D0.theta"] - named["D0.theta"])[both].max() < 1e-9
