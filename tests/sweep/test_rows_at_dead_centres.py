"""Rows that stand at a dead centre of their input: what is infinite there says so, with its sign.

The expectations are closed forms: where the crank of a slider-crank that is driven by its slider
lies in line, and towards what its rates and its effort go as the slider comes near.
"""

from __future__ import annotations

import csv
import io
import os
import random
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from typer.testing import CliRunner

import mechkin_cli as mk
from mechkin_cli.cli.app import app
from mechkin_cli.verdict import Status

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
TEXT = """
format: 1
name: pump
plane: xy
units: {{length: mm, angle: deg}}
parameters: {{r: {r!r} mm, l: {l!r} mm}}
links: {{crank: {{}}, rod: {{}}, block: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, rod], point: [0, r]}}
  C: {{type: R, links: [rod, block], point: ["sqrt(l^2 - r^2)", 0]}}
  D: {{type: P, links: [ground, block], point: ["sqrt(l^2 - r^2)", 0], axis: [1, 0]}}
motion:
  inputs:
    D.s: {{values: [{values}], rate: {rate} mm/s}}
loads:
  - {{type: torque, link: crank, torque: {torque} N*m}}
tables:
  - name: t
    title: the pump
    columns:
      - {{label: s, value: D.s}}
      - {{label: theta, value: A.theta}}
      - {{label: omega, value: A.theta_dot}}
      - {{label: F, value: D.effort}}
      - {{label: N, value: norm(A.force)}}
    summary: [max, min, mean]
"""


def text_of(
    r: float = 30, rod: float = 50, rate: float = 100, torque: float = 3, *, inner: bool = False
) -> str:
    """The slide comes to the dead centre in four steps; `inner`: to the one with the crank back."""
    end = "l - r" if inner else "l + r"
    parts = [f'"{k}/4*({end} - sqrt(l^2 - r^2))"' for k in range(5)]
    return TEXT.format(r=r, l=rod, values=", ".join(parts), rate=rate, torque=torque)


def crank(x: mp.mpf, r: mp.mpf, rod: mp.mpf) -> mp.mpf:
    """The angle of the crank above the way of the slider, where that is at x."""
    return mp.acos((x**2 + r**2 - rod**2) / (2 * x * r))


def test_what_grows_is_infinite_with_its_sign() -> None:
    r = mk.loads(text_of()).analyze(["D.effort"])
    assert r["row.status"].tolist() == ["ok"] * 4 + ["dead-centre"]
    # near the end: theta = crank - 90 deg falls, F = -torque*dtheta/ds rises
    with mp.workdps(30):
        slope = mp.diff(lambda x: crank(x, mp.mpf(30), mp.mpf(50)), mp.mpf(80) - mp.mpf("1e-9"))
    assert slope < -1e3
    assert r["A.theta_dot"][-1] == -np.inf
    assert r["D.effort"][-1] == np.inf
    assert r["norm(A.force)"][-1] == r["abs(-2*D.effort)"][-1] == np.inf
    assert np.isnan(r["1/D.effort"][-1])
    assert np.isnan(r["D.effort - 2*D.effort + D.effort"][-1])
    assert abs(r["A.theta"][-1] + 90.0) < 1e-6
    assert r["D.s_dot"][-1] == 100.0
    assert r.diagnostics[-1].code == "at-dead-centre"


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9])
def test_rows_beside_it_have_their_numbers(gap: float) -> None:
    text = TEXT.format(r=30.0, l=50.0, values=f"0, {40 - gap!r}", rate=100, torque=3)
    r = mk.loads(text).analyze(["D.effort"])
    with mp.workdps(40):
        x = 40 + mp.mpf(repr(40 - gap))
        slope = mp.diff(lambda x: crank(x, mp.mpf(30), mp.mpf(50)), x)
    assert r["A.theta_dot"][-1] == pytest.approx(float(100 * slope), rel=1e-15 / gap * 40)
    # the torque's power, 3000 N*mm
    assert r["D.effort"][-1] == pytest.approx(float(-3000 * slope), rel=1e-15 / gap * 40)


def sizes() -> list[tuple[float, float, bool]]:
    chance = random.Random(7)
    found = []
    for _ in range(30 * TIMES):
        rod = 10 ** chance.uniform(-3, 4)
        found.append((rod * chance.uniform(0.05, 0.9), rod, chance.random() < 0.5))
    return found


@pytest.mark.parametrize(("r", "rod", "inner"), sizes())
def test_no_number_without_a_digit(r: float, rod: float, inner: bool) -> None:
    """The last row is as near as doubles come: it is at the dead centre, or just beyond it. Its
    effort is never a number."""
    analysis = mk.loads(text_of(r, rod, inner=inner)).analyze(["D.effort"])
    assert analysis["row.status"][:-1].tolist() == ["ok"] * 4
    last = analysis["row.status"][-1]
    assert last in ("dead-centre", "beyond-dead-centre", "not-converged")
    if last == "dead-centre":
        # the angle falls as x rises, from both ends of the way
        assert analysis["D.effort"][-1] == np.inf
        assert analysis["A.theta_dot"][-1] == -np.inf
        side = 90.0 if inner else -90.0
        assert analysis["A.theta"][-1] == pytest.approx(side, abs=1e-5)
    else:
        assert np.isnan(analysis["D.effort"][-1])


def test_turned_renamed_reversed_and_with_more() -> None:
    def ends(text: str, row: int = -1, effort: str = "D.effort") -> tuple[float, ...]:
        r = mk.loads(text).analyze([effort])
        return (r["A.theta_dot"][row], r[effort][row])

    base = text_of()
    assert ends(base.replace("torque: 3", "torque: -3")) == (-np.inf, -np.inf)
    assert ends(base.replace("torque: 3", "torque: 0")) == pytest.approx(
        (-np.inf, np.nan), nan_ok=True
    )
    assert ends(base.replace("rate: 100", "rate: -100")) == (np.inf, np.inf)
    slide = 'point: ["sqrt(l^2 - r^2)", 0], axis: [1, 0]'
    assert ends(base.replace("D:", "slide:").replace("D.", "slide."), -1, "slide.effort")[1] == (
        np.inf
    )
    other = base.replace(slide, slide.replace("[1, 0]", "[-1, 0]")).replace("values", "was")
    parts = [f'"-{k}/4*(l + r - sqrt(l^2 - r^2))"' for k in range(5)]
    was = other[other.index("was:") : other.index(", rate")]
    assert ends(other.replace(was, f"values: [{', '.join(parts)}]")) == (np.inf, -np.inf)
    # backwards: the drawing stands at the last row, the dead centre is the first
    rows = base[base.index("values: [") + 9 : base.index("], rate")].split(", ")
    assert ends(base.replace(", ".join(rows), ", ".join(rows[::-1])), 0) == (-np.inf, np.inf)
    more = base.replace("parameters: {", "parameters: {idle: 3 mm, ")
    assert ends(more) == ends(base)


def test_variants_say_the_same() -> None:
    model = mk.loads(text_of())
    lengths = [30.0, 30.5, 31.0]
    run = model.vary({"r": lengths}, ["D.effort", "A.theta_dot"])
    for number, length in enumerate(lengths):
        alone = model.with_parameters({"r": length}).analyze(["D.effort"])
        assert run.codes[number].tolist() == alone.result.status.tolist()
        np.testing.assert_array_equal(run["D.effort"][number], alone["D.effort"])
    assert run.codes[0][-1] == Status.dead_centre


def test_cells_of_files_say_so(tmp_path: Path) -> None:
    (tmp_path / "pump.yaml").write_text(text_of(), encoding="utf-8")
    formats = [word for name in ("csv", "md", "tex", "json") for word in ("--format", name)]
    run = CliRunner().invoke(
        app, ["analyze", str(tmp_path / "pump.yaml"), "--out", str(tmp_path / "out"), *formats]
    )
    assert run.exit_code == 0, run.output
    shown = run.output.split("[N]")[-1]
    assert shown.split("\n")[5].split()[2:] == ["-inf", "inf", "inf"]
    out = tmp_path / "out"
    rows = list(csv.reader(io.StringIO((out / "t.csv").read_text(encoding="utf-8"))))
    assert rows[-1][2:] == ["-inf", "inf", "inf"]
    page = (out / "t.md").read_text(encoding="utf-8")
    assert "dead-centre: stands at a dead centre" in page
    assert page.count(" inf |") >= 2
    assert (out / "t.tex").read_text(encoding="utf-8").count(r"$\infty$") >= 2
    assert "Infinity" not in (out / "analysis.json").read_text(encoding="utf-8")
    # the largest effort is the one that a designer has to know of
    below = list(csv.reader(io.StringIO((out / "t.summary.csv").read_text(encoding="utf-8"))))
    assert below[1][below[0].index("F")] == "inf"
