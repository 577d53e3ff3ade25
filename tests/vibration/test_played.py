"""Modes as sweeps: for pages, pictures and tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError

ENGINE = Path(__file__).parents[2] / "mechanisms" / "vibration" / "engine_mounts.yaml"

TWO = """format: 1
plane: xy
parameters: {k: 30 N*m/rad}
links:
  a: {mass: 1, center_of_mass: [0, 0.5]}
  b: {mass: 1, center_of_mass: [0.5, 1.2]}
  c: {mass: 1, center_of_mass: [1, 0.7]}
  d: {mass: 1, center_of_mass: [1, 1.8], inertia: 0.1}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [0, 1]}
  C: {type: R, links: [b, c], point: [1, 1.4]}
  D: {type: R, links: [ground, c], point: [1.2, 0]}
  E: {type: R, links: [b, d], point: [1, 1.4]}
loads:
  - {type: spring, joint: A, coordinate: theta, stiffness: k}
  - {type: spring, joint: E, coordinate: theta, stiffness: 4}
equilibria: {rest: {near: {A.theta: 5, E.theta: 0}}}
tables: [{name: t, run: rest, columns: [A.theta]}]
"""


@pytest.mark.parametrize("mode", [1, 2])
def test_a_mode_of_a_loop(mode: int) -> None:
    model = mk.loads(TWO).with_parameters({"k": 20})
    v = model.vibration()
    r = v.played(mode, amplitude=0.1).analyze(["C.theta", "k"])
    assert (r.rows, r.complete) == (49, True)
    shape = v.shapes[:, mode - 1]
    shape = 0.1 * shape / np.abs(shape).max()
    phase = np.sin(np.linspace(0, 2 * np.pi, 49))
    here = model.equilibrium("rest", ["C.theta"])
    for name, part in zip(v.coordinates, shape, strict=True):
        told = here[name][0] + np.degrees(part * phase)
        assert r[name] == pytest.approx(told, abs=1e-10), name
    # the loop stays on its branch, with the parameter that was set
    assert r["C.theta"][0] == pytest.approx(here["C.theta"][0], abs=1e-9)
    assert r["k"][0] == 20


def test_in_a_page(tmp_path: Path) -> None:
    v = mk.load(ENGINE).vibration(row=2)
    page = v.played(6).view(tmp_path / "mode_6.html")
    assert page.stat().st_size > 100_000
    with pytest.raises(UsageError, match="modes are 1 to 6"):
        v.played(7)
