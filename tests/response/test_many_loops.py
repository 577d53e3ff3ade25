"""Responses of many loops: their own motion by geometry and energy, whatever the order in which
they are written; steps that do not depend on that, nor on how many loops there are."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from response.four_bar_rows import GRAVITY, FourBars, misses, unequal
from response.motions import has_same_bits
from response.parallel_cranks import CompoundPendulum

import mechkin_cli as mk
from mechkin_cli.response import stretches

RATE = 0.8
ROWS = "time: {from: 0, to: 0.3, step: 0.05}"


def lines(first: str, rate: float = RATE) -> tuple[str, ...]:
    return f"start: {{{first}.theta: 0, {first}.theta_dot: {rate!r} rad/s}}", ROWS


def equal(loops: int, angle: float) -> FourBars:
    """Parallel cranks."""
    count = loops + 1
    return FourBars([float(k) for k in range(count)], [1.0] * count, [angle] * count)


@pytest.mark.parametrize("loops", [4, 10, 30])
def test_the_motion_is_that_of_geometry_and_energy(loops: int) -> None:
    bars = unequal(loops, loops)
    found = mk.loads(bars.text(*lines("A0"), "tolerance: 1e-12")).respond("run")
    assert set(found["row.status"]) == {"ok"}
    assert np.all(np.diff(found["A0.theta"]) > 0.01)
    off = misses(bars, found, RATE, range(loops + 1))
    assert off["angle"] < 1e-12 * loops
    assert off["rate"] < 1e-11
    assert off["time"] < 1e-11
    assert np.max(found["row.energy_error"]) < 1e-11


def changed(bars: FourBars, how: str) -> tuple[str, list[int], float, float]:
    """The row written otherwise; the names of its cranks, the rate of the first, the sense."""
    last = bars.loops
    names = list(range(last + 1))
    if how == "mirrored":
        return bars.text(*lines("A0", -RATE), mirrored=True), names, -RATE, -1.0
    if how == "shuffled":
        return bars.text(*lines("A0"), shuffled=1), names, RATE, 1.0
    if how == "backwards":
        names.reverse()
        return bars.text(*lines(f"A{last}"), names=names), names, RATE, 1.0
    other = {"by the last": last, "by the middle": last // 2}[how]
    return bars.text(*lines(f"A{other}", RATE * bars.rates(0.0)[other])), names, RATE, 1.0


HOW = ["mirrored", "shuffled", "backwards", "by the last", "by the middle"]


@pytest.fixture
def effort(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Evaluations of the equations of motion in each run."""
    counts: list[int] = []
    real = stretches.integrate

    def counting(*given: Any, **named: Any) -> Any:
        motions = real(*given, **named)
        counts.extend(motion.report.evaluations for motion in motions)
        return motions

    monkeypatch.setattr(stretches, "integrate", counting)
    return counts


@pytest.mark.parametrize("how", HOW)
def test_it_does_not_matter_how_the_row_is_written(how: str, effort: list[int]) -> None:
    bars = unequal(20, 5)
    plain = mk.loads(bars.text(*lines("A0"))).respond("run")
    text, names, _, sense = changed(bars, how)
    found = mk.loads(text).respond("run")
    for k, name in enumerate(names):
        off = sense * np.asarray(found[f"A{name}.theta"]) - np.asarray(plain[f"A{k}.theta"])
        assert np.max(np.abs(off)) < 1e-9
    assert effort[1] <= 1.2 * effort[0]


def test_many_loops_take_no_more_steps_than_few(effort: list[int]) -> None:
    for loops in (10, 40, 120):
        bars = equal(loops, 3.7)
        text = bars.text("start: {A0.theta: 0}", "time: {values: [0, 2]}")
        found = mk.loads(text).respond("run")
        assert set(found["row.status"]) == {"ok"}
    # tolerances are of the chart's coordinate, the root of the sum of all squares
    assert max(effort) <= 1.3 * effort[0]


def test_a_row_of_parallel_cranks_is_a_pendulum() -> None:
    """Through the bottom and back, by an elliptic integral."""
    loops, drawn = 25, 4.2  # from upright on: 0.41 rad before it hangs, and at rest
    bars = equal(loops, drawn)
    pendulum = CompoundPendulum(loops, 1.0)
    half = 1.5 * mp.pi - mp.mpf(drawn)
    quarter = mp.ellipk(mp.sin(half / 2) ** 2) / mp.sqrt(pendulum.a)
    times = ", ".join(mp.nstr(k * quarter, 17) for k in range(1, 5))
    text = bars.text("start: {A0.theta: 0}", f"time: {{values: [0, {times}]}}", "tolerance: 1e-12")
    found = mk.loads(text).respond("run")
    expected = [float(x) for x in (0, half, 2 * half, half, 0)]
    fastest = float(2 * mp.sqrt(pendulum.a) * mp.sin(half / 2))
    for k in (0, loops):
        assert np.max(np.abs(found[f"A{k}.theta"] - expected)) < 1e-10
        rates = found[f"A{k}.theta_dot"]
        assert np.max(np.abs(rates - [0.0, fastest, 0.0, -fastest, 0.0])) < 1e-9


def test_no_bit_depends_on_lanes_or_threads() -> None:
    text = unequal(12, 3).text(*lines("A0"))
    names = ["A12.theta", "A0.theta_dot", "row.energy_error", "row.condition", "C3.force.x"]
    has_same_bits(text, names)


def test_variants_in_lanes_are_as_alone() -> None:
    text = unequal(9, 4).text(*lines("A0"))
    begin = text.index("crank0: {mass: ") + len("crank0: {mass: ")
    mass = text[begin : text.index(",", begin)]
    text = f"{text[:begin]}m * 1 kg{text[begin + len(mass) :]}"
    text = text.replace("links:\n", f"parameters: {{m: {mass}}}\nlinks:\n", 1)
    masses = [0.7, 1.1, 3.0]
    together = mk.loads(text).vary({"m": masses}, ["A9.theta"], run="run")["A9.theta"]
    for row, value in zip(together, masses, strict=True):
        alone = mk.loads(text.replace(f"{{m: {mass}}}", f"{{m: {value}}}")).respond("run")
        assert row.tobytes() == alone["A9.theta"].tobytes()


def test_rows_beside_each_other_move_as_alone() -> None:
    """Three freedoms in one matrix, two of them of rows of loops."""
    first, second = unequal(7, 21), unequal(5, 22)
    names = range(50, 56)
    texts = [
        first.text(*lines("A0"), "tolerance: 1e-12"),
        second.text(*lines("A50", -0.4), "tolerance: 1e-12", names=names),
    ]
    alone = [mk.loads(text).respond("run") for text in texts]
    parts = [text.partition("joints:\n") for text in texts]
    links = "".join(part[0].partition("links:\n")[2] for part in parts)
    joints = "".join(part[2].partition("loads:")[0] for part in parts)
    head, end = texts[0].partition("links:\n")[0], texts[0].partition("loads:")[2]
    weight = "  weight: {mass: 1, center_of_mass: [0, 1]}\n"
    slide = "  S: {type: P, links: [ground, weight], point: [0, 0], axis: [0, 1]}\n"
    both = f"{head}links:\n{links}{weight}joints:\n{joints}{slide}loads:{end}"
    start = "S.s: 0, S.s_dot: 1 m/s, A50.theta: 0, A50.theta_dot: -0.4 rad/s, A0.theta: 0,"
    found = mk.loads(both.replace("start: {A0.theta: 0,", f"start: {{{start}")).respond("run")
    assert set(found["row.status"]) == {"ok"}
    for run, numbers in zip(alone, (range(8), names), strict=True):
        for k in numbers:
            assert np.max(np.abs(found[f"A{k}.theta"] - run[f"A{k}.theta"])) < 1e-11
    time = found["time"]
    assert np.max(np.abs(found["S.s"] - (time - 0.5 * GRAVITY * time**2))) < 1e-12


@pytest.mark.parametrize("loops", [1, 10, 20])
def test_crossed_cranks_never_become_parallel(loops: int) -> None:
    """The first loop of a row is crossed, the others are not; none changes its side."""
    bars = FourBars(
        [float(k) for k in range(loops + 1)], [1.0] * (loops + 1), [1.8, *([1.75] * loops)]
    )
    found = mk.loads(bars.text(*lines("A0"))).respond("run")
    good = np.isfinite(found["A0.theta"])
    assert good.sum() > 3
    for turn, row in zip(found["A0.theta"][good], np.flatnonzero(good), strict=True):
        for k, exact in enumerate(bars.turns(turn)):
            assert abs(found[f"A{k}.theta"][row] - exact) < 1e-10
