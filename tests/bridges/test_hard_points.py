"""Tables of hard points put into templates."""

from __future__ import annotations

import os
import random
import re
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.bridges import with_hard_points
from mechkin_cli.cli.bridges import import_
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.templates import template_text

PAGE = Path(__file__).parents[2] / "docs" / "import.md"
SUSPENSION = template_text("suspension")
ROWS = """\
lower_front,100,380,203
lower_rear,-100,380,197
lower_ball,0,700,190
upper_front,90,440,445
upper_rear,-110,440,455
upper_ball,-12,660,465
rod_inner,-120,400,250
rod_outer,-130,690,248
wheel,0,760,310
contact,0,762,0
"""


NAMES = [row.partition(",")[0] for row in ROWS.split()]
SIZES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}


def put_in(table: str, template: str = SUSPENSION, **options: object):
    return with_hard_points(table, "points.csv", template, "suspension", **options)


def test_the_table_of_the_page_has_all_points_and_changes_nothing_else() -> None:
    (table,) = re.findall(r"```csv\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    found = put_in(table)
    assert found.text == SUSPENSION
    assert found.notes == ()


def test_points_stand_where_the_table_says() -> None:
    table = ROWS.replace("lower_ball,0,700,190", "lower_ball,5,705,188").replace(
        "rod_inner,-120,400,250", "rod_inner,-121,401.5,252"
    )
    found = put_in(table, unit="mm")
    row = mk.loads(found.text.replace("{from: -12, to: 12, step: 1}", "{at: 0}")).analyze()
    assert np.allclose(row["lower_ball.point"], [[5.0, 705.0, 188.0]], atol=1e-9)
    assert np.allclose(row["rod_inner.point"], [[-121.0, 401.5, 252.0]], atol=1e-9)
    assert found.text.count("\n") == SUSPENSION.count("\n")


@pytest.mark.parametrize(
    "table",
    [
        "name;x [in];y [in];z [in]\nLower-Ball;0;27,5;7,5\n",
        "z (in)\tNAME\ty (in)\tx (in)\tnote\n7.5\tlower ball\t27.5\t0\tnew\n",
        "# inches\n\nx [in],y [in],z [in],point\r\n0,27.5,7.5,LOWER_BALL\r\n",
    ],
)
def test_ways_to_write_a_table(table: str) -> None:
    found = put_in(table)
    assert "lower_ball_x: 0 in, lower_ball_y: 27.5 in, lower_ball_z: 7.5 in" in found.text
    (missing,) = [note for note in found.notes if note.code == "hard-points-missing"]
    assert "9 of the hard points: lower_front" in missing.message
    assert [note.code for note in found.notes if note.code == "left-out"] == (
        ["left-out"] if "note" in table else []
    )


def test_any_file_is_a_template_and_its_own_unit_needs_no_word() -> None:
    template = """\
format: 1
units: {length: mm}
parameters: {r: 40 mm}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 10], axis: [0, 0, 1]}  # the motor
  B: {type: S, links: [crank, rod], point: [r, 0, 10]}
points: {P: {link: rod, at: ["1", 2 mm, .5]}}
"""
    found = put_in("a, 1, 2.5, 3e-1\np,4,5,-6\n", template, unit="mm")
    changed = template.replace("[0, 0, 10]", "[1, 2.5, 0.3]").replace(
        '["1", 2 mm, .5]', '["4", 5, -6]'
    )
    assert found.text == changed
    assert "point: [1 in, " in put_in("A,1,2,3\n", template, unit="in").text
    with pytest.raises(InvalidFile, match="its hard points are A, P"):
        put_in("B, 1, 2, 3\n", template)
    with pytest.raises(UsageError, match="has no hard points"):
        put_in("B, 1, 2, 3\n", "format: 1\n")


def test_a_plane_takes_two_coordinates() -> None:
    template = "format: 1\nplane: xy\npoints: {P: {link: rod, at: [1, 2]}}\n"
    for table in ("P,3,4\n", "P,3,4,0\n", "name,x,y\nP,3,4\n"):
        assert "at: [3, 4]" in put_in(table, template, unit="m").text
    with pytest.raises(InvalidFile, match="z of P is not 0"):
        put_in("P,3,4,5\n", template)


def test_names_of_the_table_are_renamed() -> None:
    found = put_in("LCA outer,1,2,3\n", unit="mm", renamed={"LCA Outer": "lower_ball"})
    assert "lower_ball_x: 1 mm, lower_ball_y: 2 mm, lower_ball_z: 3 mm" in found.text
    with pytest.raises(UsageError, match="has no point 'UCA'"):
        put_in("LCA outer,1,2,3\n", renamed={"UCA": "lower_ball"})


@pytest.mark.parametrize(
    ("table", "place", "words"),
    [
        ("lower_bell,0,1,2\n", "points.csv:1:1", "did you mean lower_ball"),
        ("wheel,0,1,2\nwheel,0,1,2\n", "points.csv:2:1", "given twice, first in line 1"),
        ("wheel,0,x1,2\n", "points.csv:1:9", "y of wheel is no number: 'x1'"),
        ("wheel,0,1e999,2\n", "points.csv:1:9", "is no number"),
        ("wheel,nan,1,2\n", "points.csv:1:7", "is no number"),
        ("wheel,0,1\n", "points.csv:1:1", "a cell is missing: 3 cells"),
        (",0,1,2\n", "points.csv:1:1", "no name"),
        ("\n\n", "points.csv:1:1", "no rows"),
        ("name,x,y\nwheel,0,1\n", "points.csv:1:1", "no column z"),
        ("name,x [mm],y [in],z\nwheel,0,1,2\n", "points.csv:1:1", "several units"),
    ],
)
def test_faults_have_place_and_cure(table: str, place: str, words: str) -> None:
    with pytest.raises(InvalidFile) as caught:
        put_in(table)
    (diagnostic,) = caught.value.diagnostics
    assert str(diagnostic.place) == place
    assert words in str(diagnostic)
    assert diagnostic.hint


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("car.csv").write_text(ROWS, encoding="utf-8")
    assert import_(Path("car.csv"), template="suspension") == 0
    assert capsys.readouterr().out == "car.yaml\n"
    assert Path("car.yaml").read_text(encoding="utf-8") == SUSPENSION
    assert import_(Path("car.csv"), template="suspension") == 2
    assert "is there already" in capsys.readouterr().err
    assert import_(Path("car.csv")) == 2
    assert "--template suspension" in capsys.readouterr().err


@pytest.mark.parametrize("seed", range(8 * int(os.environ.get("MECHKIN_RANDOM", "1"))))
def test_random_tables(seed: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Separators, decimal commas, quotes, units, orders, empty rows and remarks change nothing."""
    dice = random.Random(seed)
    unit, size = dice.choice(list(SIZES.items()))
    separator = dice.choice([",", ", ", ";", "\t"])
    comma = separator in ";\t" and dice.random() < 0.5
    heads = ["name", f"x [{unit}]", f"Y ({unit})", f"z[{unit}]", "remark"]
    order = dice.sample(range(5), 5)
    wanted, lines = {}, [separator.join(heads[k] for k in order)]
    for name in dice.sample(NAMES, len(NAMES)):
        form = dice.choice([".3f", ".9g", ".4e"])
        texts = [f"{dice.uniform(-500, 800) / size:{form}}" for _ in "xyz"]
        wanted[name] = [float(text) * size for text in texts]
        shown = dice.choice([name, name.replace("_", "-").upper(), name.replace("_", " ")])
        written = [text.replace(".", ",") if comma else text for text in texts]
        cells = [shown, *written, dice.choice(["", "7"])]
        quoted = [f'"{cell}"' if dice.random() < 0.2 else cell for cell in cells]
        lines.append(separator.join(quoted[k] for k in order))
        lines += dice.choice([[], [], [separator.strip(" ") * 4], ["# front axle"]])
    table = tmp_path / "points.csv"
    end = dice.choice(["\n", "\r\n"])
    table.write_bytes((dice.choice(["", "\ufeff"]) + end.join(lines)).encode())
    out = tmp_path / "car.yaml"
    assert import_(table, out=out, template="suspension") == 0, capsys.readouterr().err
    found = mk.load(out).parameters
    for name, place in wanted.items():
        for axis, value in zip("xyz", place, strict=True):
            scale = SIZES[found.unit(f"{name}_{axis}")]
            assert found[f"{name}_{axis}"] * scale == pytest.approx(value, abs=1e-9)
