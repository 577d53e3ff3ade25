"""Spatial and planar loops over up to 100 000 turns, in degrees, radians and revolutions.

Sweeps of many steps, fine and coarse, lists that jump to and fro, either way, from anywhere; some
end where they began. `MECHKIN_RANDOM` multiplies the number of loops.
"""

from __future__ import annotations

import os

import numpy as np
from mpmath import mp, mpf
from random_families.turning_loop import TURN, Array, TurningLoop, split

import mechkin_cli as mk

COUNT = 60 * int(os.environ.get("MECHKIN_RANDOM", "1"))
PERIODS = {"deg": mpf(360), "rad": 2 * mp.pi, "turn": mpf(1)}
FROM = (0.0, 0.0, 90.0, 12.3, 86.05, -720.0, 3600.0, 36e6, 1e6, 12345.678)
"""Degrees of the first row."""


def motion(rng: np.random.Generator, unit: str) -> str:
    """The crank's way in a unit."""
    turn = float(PERIODS[unit])
    first = float(np.round(rng.choice(FROM) * turn / 360, 4))
    turns = int(rng.choice([1, 3, 30, 300, 1000, 10000, 100000])) * int(rng.choice([1, -1]))
    count = int(10 ** rng.uniform(1.3, 2.8))
    kind = rng.integers(5)
    if kind == 0:
        return f"{{from: {first!r}, to: {first + turns * turn!r}, count: {count}}}"
    if kind == 1:
        step = float(rng.choice([10, 1, 7.3, 90, 36])) * turn / 360
        way = np.sign(turns) * min(abs(turns) * turn, 400 * step)
        return f"{{from: {first!r}, to: {float(first + way)!r}, step: {step!r}}}"
    if kind == 2:
        step = float(rng.choice([170, 180, 200, 350, 360, 361, 720, 5000])) * turn / 360
        way = 200 * step * np.sign(turns)
        return f"{{from: {first!r}, to: {float(first + way)!r}, count: 201}}"
    if kind == 3:
        values = np.round(
            first + np.cumsum(rng.normal(size=60)) * turn * 10 ** rng.uniform(-1, 2), 6
        )
    else:
        values = np.round(first + rng.uniform(-1, 1, 80) * turn * turns, 4)
    return f"{{values: [{', '.join(map(repr, values.tolist()))}]}}"


def rocker(loop: TurningLoop, crank: Array, unit: str) -> Array:
    """Its angle by row in the unit, but for whole turns of the first row."""
    reduced, turns = split(crank, PERIODS[unit])
    return loop.angle(reduced, turns - turns[0]) * float(PERIODS[unit]) / TURN


def fault(number: int) -> str:
    rng = np.random.default_rng(number)
    gap = 10 ** -rng.uniform(0.5, 6)
    loop = TurningLoop(rng, gap, planar=rng.random() < 0.6)
    unit = str(rng.choice(["deg", "deg", "rad", "turn"]))
    moved = motion(rng, unit)
    where = f"{number} ({''.join(loop.pairs)}, gap {gap:.1g}, {unit}, {moved[:60]})"
    result = mk.loads(loop.file(moved, unit)).analyze(["A.theta", "D.theta"])
    lost = np.flatnonzero(result["row.status"] != "ok")
    if len(lost):
        return f"{where}: row {lost[0]} of {len(result['row.status'])} is not ok"
    crank, have = result["A.theta"], result["D.theta"]
    want = rocker(loop, crank, unit)
    turn = float(PERIODS[unit])
    want += turn * np.round((have[0] - want[0]) / turn)
    # the closed form loses half the digits where its discriminant is small; far rows their own
    allowed = (
        turn * (1e-13 / gap**0.5 + 1e-14) + 4e-16 * np.abs(want) + 8 * np.spacing(np.abs(crank))
    )
    wrong = np.flatnonzero(np.abs(have - want) > allowed)
    if len(wrong):
        k = wrong[0]
        return f"{where}: row {k} at {crank[k]!r}: {have[k]!r} for {want[k]!r}"
    return ""


def test_every_row_of_every_turn() -> None:
    wrong = [words for n in range(COUNT) if (words := fault(n))]
    assert not wrong, "\n".join(wrong)
