"""Verdicts that mean something: residuals against their limit, rows next to singular positions."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli import tolerances

CARRIED = """
format: 1
links: {base: {}, crank: {}, rod: {}, slider: {}}
joints:
  Z: {type: P, links: [ground, base], point: [0, 0, 0], axis: [1, 2, 0.5]}
  A: {type: R, links: [base, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: U, links: [crank, rod], point: [0.1, 0, 0], axis: [0, 0, 1], axis2: [0, 1, 0]}
  C: {type: S, links: [rod, slider], point: [0.4, 0.1, 0.05]}
  D: {type: P, links: [base, slider], point: [0.4, 0.1, 0.05], axis: [1, 0, 0]}
motion: {inputs: {Z.s: {at: WHERE}, A.theta: {from: 10, to: 170, step: 1}}}
"""

FOUR_BAR = """
format: 1
links: {a: {}, b: {}, c: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [a, b], point: [1, 0, 0]}
  C: {type: S, links: [b, c], point: [1, 1, 0]}
  D: {type: R, links: [ground, c], point: [2, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {D.theta: {values: [0, VALUES]}}}
tables: [{name: t, columns: [D.theta, A.theta, row.condition]}]
"""


@pytest.mark.parametrize("where", [0, 30, 100])
def test_residuals_are_told_on_the_scale_of_their_limit(where: float) -> None:
    """A loop far from the origin rounds by its own coordinates; what passes is below the limit."""
    analysis = mk.loads(CARRIED.replace("WHERE", str(where))).analyze(["D.s"])
    assert set(analysis["row.status"]) == {"ok"}
    assert 0.0 < analysis["row.residual"].max() <= tolerances.RESIDUAL_ACCEPT / 10


def fold() -> float:
    """The dead centre of the four-bar as `analyze` finds it, in degrees."""
    found = mk.loads(FOUR_BAR.replace("VALUES", "-40, -80")).analyze([])
    (note,) = [d for d in found.diagnostics if d.code == "dead-centre"]
    return note.numbers[0].value


def near_singular(tmp_path: Path) -> Path:
    """A file with a row so close to a dead centre that it is near-singular."""
    path = tmp_path / "near.yaml"
    path.write_text(FOUR_BAR.replace("VALUES", repr(fold() + 5e-13)), encoding="utf-8")
    return path


def test_a_near_singular_row_is_a_diagnostic(tmp_path: Path) -> None:
    analysis = mk.load(near_singular(tmp_path)).analyze()
    assert analysis["row.status"].tolist() == ["ok", "near-singular"]
    (note,) = analysis.diagnostics
    assert (note.code, note.severity) == ("near-singular", "warning")
    assert note.message.startswith("row 2 is near-singular")
    (number,) = note.numbers
    assert number.value == analysis["row.condition"][1] > tolerances.CONDITION_NEAR_SINGULAR
    assert number.limit == tolerances.CONDITION_NEAR_SINGULAR


@pytest.mark.parametrize(("options", "code"), [([], 0), (["--strict"], 4)])
def test_strict_makes_it_an_exit_code(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], options: list[str], code: int
) -> None:
    from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files

    path = near_singular(tmp_path)
    strict = bool(options)
    for more in ({"quiet": True}, {"json": True}):
        found = analyze_files(AnalyzeCommand([path], tmp_path / "out", strict=strict, **more))
        said = capsys.readouterr()
        assert found == code
        assert "near-singular" in said.err
        if "json" in more:
            record = json.loads(said.out)
            assert [d["code"] for d in record["diagnostics"]] == ["near-singular"]


def test_strict_does_not_mind_sound_rows(tmp_path: Path) -> None:
    from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files

    path = tmp_path / "sound.yaml"
    path.write_text(FOUR_BAR.replace("VALUES", "5"), encoding="utf-8")
    assert analyze_files(AnalyzeCommand([path], tmp_path / "out", quiet=True, strict=True)) == 0


def test_what_a_joint_leaves_free_is_zero_and_does_not_blink() -> None:
    """A plane four-bar in space: pins take no moment about themselves, whatever is redundant."""
    text = FOUR_BAR.replace("VALUES", "2, 4, 6, 8").replace("S, links", "R, links")
    text = text.replace("point: [1, 0, 0]}", "point: [1, 0, 0], axis: [0, 0, 1]}")
    text = text.replace("point: [1, 1, 0]}", "point: [1, 1, 0], axis: [0, 0, 1]}")
    text += "loads: [{type: torque, joint: A, value: 3}]\n"
    analysis = mk.loads(text).analyze([f"{n}.{q}" for n in "ABCD" for q in ("force", "moment")])
    for name in "ABCD":
        force, moment = analysis[f"{name}.force"], analysis[f"{name}.moment"]
        assert np.array_equal(moment[:, 2], np.zeros(5))
        assert np.isfinite(force[:, :2]).all()
        assert np.isnan(force[:, 2]).all()
        assert np.isnan(moment[:, :2]).all()


def test_an_unloaded_loop_beside_a_loaded_one_is_judged_by_the_load() -> None:
    """Redundant constraints of a linkage that nothing loads are as arbitrary as those of one that
    is; reactions that are unique are small beside the load and stay."""
    plane = FOUR_BAR.replace("VALUES", "2, 4").replace("S, links", "R, links")
    plane = plane.replace("point: [1, 0, 0]}", "point: [1, 0, 0], axis: [0, 0, 1]}")
    plane = plane.replace("point: [1, 1, 0]}", "point: [1, 1, 0], axis: [0, 0, 1]}")
    weight = plane.replace("c: {}}", "c: {}, w: {mass: 1000, center_of_mass: [5, 5, 5]}}")
    weight = weight.replace("motion:", "  W: {type: W, links: [ground, w]}\nmotion:")
    weight += "loads: [{type: gravity, g: [0, 0, -9.81]}]\n"
    analysis = mk.loads(weight).analyze(["B.force", "B.moment", "W.force"])
    assert np.isnan(analysis["B.force"][:, 2]).all()
    assert np.abs(analysis["B.force"][:, :2]).max() < 1e-9
    assert np.array_equal(analysis["B.moment"][:, 2], np.zeros(3))
    assert np.abs(analysis["W.force"][:, 2]).min() > 9000
