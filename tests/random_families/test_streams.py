"""Streams of random runs: each column, balance, message and count is that of the run held whole,
bit for bit. MECHKIN_RANDOM=100 takes five thousand."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from random_families.four_bars import cases
from sweep.cut import cut

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.building import spacing
from mechkin_cli.sweep import RunVerdicts
from mechkin_cli.tables import Columns, Words

HEAD = "format: 1\n{plane}units: {{length: m, angle: deg}}\naccept: [unphysical-inertia]\n"
FOUR_BAR = """links:
  a: {mass: 2, center_of_mass: [0.2, 0.1], inertia: 0.1}
  b: {mass: 1, center_of_mass: [2, 2]}
  c: {mass: 1.5, center_of_mass: [4, 1]}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [0, CRANK]}
  C: {type: R, links: [b, c], point: [4, 3]}
  D: {type: R, links: [ground, c], point: [4, 0]}
points: {p: {link: b, at: [1, 3]}}
"""
SLIDER = """links:
  a: {mass: 2, center_of_mass: [0.03, 0.01, 0], inertia: {zz: .02}}
  b: {mass: 1.5, center_of_mass: [0.25, 0, 0], inertia: {zz: .03}}
  c: {mass: 3, center_of_mass: [0.4, 0, 0]}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [a, b], point: [CRANK, 0, 0]}
  C: {type: U, links: [b, c], point: [0.4, 0, 0], axis: [0, 0, 1], axis2: [0, 1, 0]}
  D: {type: P, links: [ground, c], point: [0.4, 0, 0], axis: [1, 0, 0]}
points: {p: {link: b, at: [0.2, 0.1, 0]}}
"""
FIVE_BAR = """links:
  a: {mass: 1, center_of_mass: [0, 0]}
  b: {}
  d: {}
  e: {mass: 1, center_of_mass: [0.6, 0.7]}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [-0.1, 0.45]}
  C: {type: R, links: [b, e], point: [0.3, 0.95]}
  D: {type: R, links: [d, e], point: [0.7, 0.45]}
  E: {type: R, links: [ground, d], point: [0.6, 0]}
points: {p: {link: b, at: [0.3, 0.95]}}
"""
"""Cranks that turn and that come to dead centres, and two inputs for a grid."""

BALANCES = """balances:
  - {name: work, type: work}
  - {name: shaking, type: harmonics, of: [A.effort], orders: [0, 1, 2]}
"""
LEDGER = ("row.work", "row.dissipated", "row.energy_error")
ALWAYS = ("row.status", "row.condition", "row.residual")
NOISE = ("row.residual", "row.power_error", "row.energy_error")
"""Rounding alone, in a run that is well resolved."""


def body(rng: random.Random, kind: str) -> tuple[str, list[str]]:
    """The head, links and joints of a mechanism, and its loads."""
    plane = "" if kind == "slider" else "plane: xy\n"
    text = {"four-bar": FOUR_BAR, "slider": SLIDER, "five-bar": FIVE_BAR}[kind]
    sizes = (0.1, 0.19, 0.25) if kind == "slider" else (1, 1.5, 3)
    text = text.replace("CRANK", str(rng.choice(sizes)))
    loads = [f"{{type: gravity, g: [0, -9.81{'' if plane else ', 0'}]}}"]
    if rng.random() < 0.5:
        loads.append("{type: damper, joint: A, coordinate: theta, damping: 0.2}")
    if rng.random() < 0.5 and kind != "slider":
        loads.append("{type: spring, joint: B, coordinate: theta, stiffness: 3}")
    if rng.random() < 0.25 and kind != "five-bar":
        loads.append("{type: friction, joint: A, coefficient: 0.2, radius: 0.01}")
    return HEAD.format(plane=plane) + text, loads


def sweep(rng: random.Random) -> str:
    """A sweep with loads, whole turns of which have balances."""
    kind = rng.choice(["four-bar", "four-bar", "slider", "slider", "five-bar"])
    text, loads = body(rng, kind)
    count, balances = rng.randint(12, 70), ""
    rate = rng.choice(["", ", rate: 3 rad/s"])
    if kind == "five-bar":
        (a, b), (c, d) = (sorted(rng.uniform(-150, 150) for _ in "ab") for _ in "ab")
        one, other = rng.randint(3, 9), rng.randint(3, 9)
        inputs = (
            f"A.theta: {{from: {a:.3f}, to: {b:.3f}, count: {one}}}, "
            f"E.theta: {{from: {c:.3f}, to: {d:.3f}, count: {other}}}"
        )
        return f"{text}loads: [{', '.join(loads)}]\nmotion: {{grid: true, inputs: {{{inputs}}}}}\n"
    way = rng.choice(["turns", "values", "time"])
    if way == "turns":
        turns, first = rng.randint(1, 3), rng.choice([0, -180, round(rng.uniform(-200, 200), 3)])
        last, rows = first + rng.choice([360, -360]) * turns, rng.choice([8, 9, 16]) * turns + 1
        motion = (
            f"motion: {{inputs: {{A.theta: {{from: {first}, to: {last}, count: {rows}{rate}}}}}}}\n"
        )
        balances = BALANCES if rng.random() < 0.7 else ""
    elif way == "values":
        values = np.cumsum([round(rng.uniform(-8, 12), 3) for _ in range(count)]).tolist()
        motion = f"motion: {{inputs: {{A.theta: {{values: {values}{rate}}}}}}}\n"
    else:
        law = rng.choice(
            [
                f"{{law: cycloidal, from: 0, to: {rng.uniform(20, 800):.3f}}}",
                f'{{with: "{rng.uniform(10, 100):.3f} deg*sin(180 deg/s*time + 30 deg)"}}',
            ]
        )
        motion = (
            f"motion:\n  time: {{from: 0, to: 2, count: {count}}}\n  inputs: {{A.theta: {law}}}\n"
        )
    return f"{text}loads: [{', '.join(loads)}]\n{motion}{balances}"


def response(rng: random.Random) -> str:
    """A fall, perhaps to a stop."""
    text, loads = body(rng, rng.choice(["four-bar", "slider"]))
    stop = f"    stop: [{{value: A.theta, at: {rng.uniform(-60, 60):.3f}, count: 2}}]\n"
    return (
        f"{text}loads: [{', '.join(loads)}]\nresponses:\n  fall:\n"
        f"    start: {{A.theta: {rng.uniform(-30, 60):.3f}}}\n"
        f"    time: {{from: 0, to: {rng.uniform(0.2, 2):.3f}, count: {rng.randint(9, 90)}}}\n"
        + (stop if rng.random() < 0.5 else "")
    )


def cells(tables: Sequence[Columns]) -> list[Any]:
    return [
        (
            table.name,
            column.label,
            column.values.array().tolist()
            if isinstance(column.values, Words)
            else column.values.tobytes(),
        )
        for table in tables
        for column in table.columns
    ]


def test_most_of_the_runs_have_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    cut(monkeypatch, 5)
    runs = [mk.loads(sweep(rng)).stream(["row.condition"]) for rng in cases(4103, 20)]
    assert sum(stream.in_blocks for stream in runs) > len(runs) / 2


def are_near(parts: mk.Analysis, once: mk.Analysis, names: Sequence[str]) -> None:
    """A run whose parts are joined is that in one part up to the rounding of its states, and to the
    sign of quaternions, which is either where they begin at half a turn."""
    for name in names:
        values, expected = np.asarray(parts[name]), np.asarray(once[name])
        if values.dtype.kind != "f":
            assert values.tolist() == expected.tolist(), name
        elif name not in NOISE and ".q" not in name:
            assert np.array_equal(np.isnan(values), np.isnan(expected)), name
            size = np.abs(expected[np.isfinite(expected)]).max(initial=0.0)
            off = np.abs(np.where(values == expected, 0.0, values - expected))
            assert np.nanmax(off, initial=0.0) <= 1e-6 * size + 1e-7, name
    told, wanted = (
        {str(one) for one in run.diagnostics if one.code == "no-rate"} for run in (parts, once)
    )
    # a run with an error keeps this to itself; a part cannot know of an error behind it
    if not any(one.severity == "error" for one in once.diagnostics):
        assert told == wanted
    codes = ({one.code for one in run.diagnostics} - {"no-rate"} for run in (parts, once))
    assert next(codes) == next(codes)


def are_same(stream: mk.Stream, whole: mk.Analysis, names: Sequence[str]) -> None:
    found: dict[str, list[Any]] = {name: [] for name in names}
    for block in stream:
        for name in names:
            found[name].append(block[name])
    for name in names:
        values, expected = np.concatenate(found[name]), np.asarray(whole[name])
        if values.dtype.kind == "f":
            assert values.tobytes() == expected.tobytes(), name
        else:
            assert values.tolist() == expected.tolist(), name
    assert {str(one) for one in stream.diagnostics} == {str(one) for one in whole.diagnostics}


@pytest.mark.parametrize("rng", [*cases(4101, 40)])
def test_sweeps(rng: random.Random, monkeypatch: pytest.MonkeyPatch) -> None:
    text = sweep(rng)
    known = list(mk.loads(text).problem.quantities())
    names = [name for name in LEDGER if name in known and rng.random() < 0.6]
    names = list(dict.fromkeys([*names, *rng.sample(known, 8), *ALWAYS]))
    once = mk.loads(text).analyze(names)
    cut(monkeypatch, rng.choice([4, 5, 7, 11, 16, 25]))
    # the first assembly is that of the run in one part
    monkeypatch.setattr(spacing, "SAMPLE", 1000)
    model = mk.loads(text)
    whole = model.analyze(names)
    are_near(whole, once, names)
    stream = model.stream(names, rows=rng.choice([1, 3, 7, 4096]), threads=rng.choice([0, 1, 2]))
    are_same(stream, whole, names)
    assert cells(stream.balance_tables) == cells(whole.balance_tables)
    assert stream.complete == whole.complete
    expected = RunVerdicts.of(whole.result)
    assert (stream.verdicts.counts, stream.verdicts.worst) == (expected.counts, expected.worst)


@pytest.mark.parametrize("rng", [*cases(4102, 12)])
def test_responses(rng: random.Random, monkeypatch: pytest.MonkeyPatch) -> None:
    text = response(rng)
    few = ["A.theta", "A.theta_dot", "C.force.x", "p.position.x", "D.force.x", "row.kinetic_energy"]
    names = [*rng.sample(few, 3), "row.energy_error", "row.event", *ALWAYS]
    whole = mk.loads(text).respond("fall", names)
    rows = rng.choice([1, 2, 5, 8, 17])
    monkeypatch.setattr(tolerances, "PART_ROWS", rows)
    monkeypatch.setattr(tolerances, "LEAST_PART_ROWS", rows)
    stream = mk.loads(text).stream(names, run="fall", rows=rng.choice([1, 3, 7, 4096]))
    are_same(stream, whole, names)
