"""Tables on parallel legs of equal length: constraints repeat each other wherever the table stands,
and its tree has a ball, whose orientation has four numbers for three freedoms."""

from __future__ import annotations

import math
import os
import random
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.assembly import at_unit_rate, choose_start

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

STEWART = Path(__file__).parents[2] / "mechanisms" / "classics" / "stewart.yaml"


def text(seed: int) -> tuple[str, list[str], float]:
    """A table on three to five legs of length 1, drawn displaced; its inputs; the legs' length."""
    rng = random.Random(seed)
    x, y = rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6)
    z = -math.sqrt(1.0 - x * x - y * y)
    feet = [(rng.uniform(-1, 1), rng.uniform(-1, 1)) for _ in range(rng.randint(3, 5))]
    links = ", ".join(f"l{k}: {{}}" for k in range(len(feet)))
    lines = [
        "format: 1",
        "units: {length: m, angle: deg}",
        f"links: {{top: {{mass: 10, center_of_mass: [{x!r}, {y!r}, {z!r}]}}, {links}}}",
        "joints:",
    ]
    for k, (a, b) in enumerate(feet):
        lines.append(f"  A{k}: {{type: S, links: [ground, l{k}], point: [{a!r}, {b!r}, 0]}}")
        top = f"[{a + x!r}, {b + y!r}, {z!r}]"
        lines.append(f"  B{k}: {{type: S, links: [l{k}, top], point: {top}}}")
    lines.append(f"points: {{c: {{link: top, at: [{x!r}, {y!r}, {z!r}]}}}}")
    names = rng.sample(["x", "y", "z"], rng.randint(1, 2))
    step = {"x": x, "y": y, "z": z}
    inputs = ", ".join(
        f"c.position.{name}: {{values: [{step[name]!r}, {step[name] + 0.01!r}]}}" for name in names
    )
    lines.append(f"motion: {{inputs: {{{inputs}}}}}")
    return "\n".join(lines), names, 1.0


@pytest.mark.parametrize("seed", range(12 * TIMES))
def test_rows_are_right_or_have_a_status(seed: int) -> None:
    file, names, length = text(seed)
    try:
        analysis = mk.loads(file).analyze(["c.position"])
    except mk.InvalidFile:
        return  # inputs that do not fit its freedoms
    ok = analysis["row.status"] == "ok"
    distance = analysis["norm(c.position)"]
    assert np.isfinite(distance[ok]).all()
    if len(names) == 2 and ok.any():
        assert np.abs(distance[ok] - length).max() < 1e-9


def test_states_move_along_their_columns() -> None:
    """Of a platform on six legs, whose tree has a ball: what is predicted for an input's next place
    misses it by the square of the step."""
    session = mk.load(STEWART).session
    start = choose_start(session).state
    assert start is not None
    state = np.ascontiguousarray(start[:, None])
    misses = []
    for step in (1e-3, 5e-4):
        values = session.inputs.reduced[:, :1]
        run = at_unit_rate(session, values, state, 0)
        assert run.first is not None
        ahead = session.moved_along(state, step * run.first)
        moved = values.copy()
        moved[0] += step
        misses.append(np.abs(session.close(moved, ahead).states - ahead).max())
    assert 3.5 < misses[0] / misses[1] < 4.5
