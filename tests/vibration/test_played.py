"""Modes of vibration as they are played in a page: places of a closed loop, in the mode's ratio."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.vibration import freed, played

MECHANISMS = Path(__file__).parents[2] / "mechanisms"
TWO_PENDULUMS = """
format: 1
name: two_pendulums
units: {length: m, force: N, angle: rad}
links:
  a: {mass: 1, center_of_mass: [0, -1, 0]}
  b: {mass: 1, center_of_mass: [0, -2, 0]}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [0, -1, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
equilibria:
  hangs: {near: {A.theta: 0, B.theta: 0}}
"""


def test_modes_of_two_pendulums_swing_in_their_ratio() -> None:
    # equal masses and lengths: the second angle against the vertical is sqrt(2) times the first in
    # the slow mode and -sqrt(2) times in the fast one
    m = mk.loads(TWO_PENDULUMS)
    v = m.vibration()
    (run,) = m.analyses("hangs")
    place = freed(run.result, 0, None, ())
    for k, ratio in enumerate((np.sqrt(2.0), -np.sqrt(2.0))):
        shape = v.shapes[:, k]
        rows = played(place, run.result, 0, (shape, np.zeros(2)), float(v.frequencies[k]))
        assert rows.solved.all()
        rows.read([rows.problem.quantities()[name] for name in ("A.theta", "B.theta")])
        a, b = (np.asarray(rows.quantity(name).value) for name in ("A.theta", "B.theta"))
        np.testing.assert_allclose(a + b, ratio * a, atol=1e-12)
        assert max(np.abs(a).max(), np.abs(b).max()) == pytest.approx(0.25, rel=1e-12)
        # a period: there and back, and back on the other side
        np.testing.assert_allclose(a[-1], a[0], atol=1e-14)
        np.testing.assert_allclose(a[24], -a[0], atol=1e-14)
        time = np.asarray(rows.quantity("time").value)
        assert time[-1] == pytest.approx(1.0 / v.frequencies[k], rel=1e-14)


def test_loops_are_closed_where_a_mode_swings() -> None:
    m = mk.load(MECHANISMS / "statics" / "ride_height.yaml")
    v = m.vibration()
    run = m.analyses(next(name for name in m.runs if name != "sweep"))[0]
    place = freed(run.result, 0, v.coordinates, ())
    shape = np.asarray(v.shapes[:, 0].real)
    rows = played(place, run.result, 0, (shape, np.zeros(shape.size)), float(v.frequencies[0]))
    rows.read([])
    assert rows.solved.all()
    assert np.nanmax(rows.residual) < 1e-12


def test_the_page_has_each_mode(tmp_path: Path) -> None:
    m = mk.load(MECHANISMS / "vibration" / "engine_mounts.yaml")
    v = m.vibration(row=2)
    page = v.view(tmp_path / "modes.html").read_text(encoding="utf-8")
    for k, frequency in enumerate(v.frequencies):
        assert f"mode {k + 1}, {frequency:.4g} Hz" in page
    assert "mode 7," not in page
    assert v.view().html == page
