"""`mechkin plot`."""

from __future__ import annotations

import subprocess
import sys

import pytest
from cli import files

PLOTTED = files.CRANK + (
    "tables:\n  - {name: tip, plot: {x: x}, columns: [O.theta, {label: x, value: tip.position.x}, "
    '{label: "y", value: tip.position.y}]}\n'
    "  - {name: drive, columns: [O.theta, O.effort]}\n"
)


def test_a_picture_for_each_table(mechkin, write, folder) -> None:
    run = mechkin("plot", write("crank.yaml", PLOTTED))
    assert (run.code, run.out) == (0, "out/crank/tip.svg\nout/crank/drive.svg\n")
    for name in ("tip", "drive"):
        assert b"<svg" in (folder / "out/crank" / f"{name}.svg").read_bytes()


def test_pictures_of_several_tables_share_the_name_given(mechkin, write, folder) -> None:
    run = mechkin("plot", write("crank.yaml", PLOTTED), "-o", "pic/a.png")
    assert (run.code, run.out) == (0, "pic/a_tip.png\npic/a_drive.png\n")
    assert (folder / "pic/a_tip.png").read_bytes().startswith(b"\x89PNG")


def test_what_is_named_goes_to_one_picture(mechkin, write, folder) -> None:
    file = write("crank.yaml", PLOTTED)
    run = mechkin("plot", file, "--y", "O.effort, norm(tip.velocity)", "-o", "pic/a.pdf")
    assert (run.code, run.out) == (0, "pic/a.pdf\n")
    assert (folder / "pic/a.pdf").read_bytes().startswith(b"%PDF")
    assert mechkin("plot", file, "--y", "tip.position", "--quiet").out == ""
    assert (folder / "out/crank/crank.svg").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("-o", "a.gif", "--table", "tip"), "a.gif: pictures end in .svg, .png, .pdf"),
        (("--y", "O.efort"), "did you mean O.effort"),
        (("--y", "O.effort", "--table", "tip"), "leave one of them out"),
        (("--y", "row.status"), "row.status is words"),
        (("--table", "top"), "there is no table top; tables are tip, drive"),
        (("--y", "O.effort", "--run", "x"), "the file has no responses"),
    ],
)
def test_mistakes_are_told_and_nothing_is_written(mechkin, write, folder, arguments, words) -> None:
    run = mechkin("plot", write("crank.yaml", PLOTTED), *arguments)
    assert run.code == 2
    assert words in run.err
    assert sorted(path.name for path in folder.iterdir()) == ["crank.yaml"]


def test_a_plot_of_no_column_is_told_at_its_place(mechkin, write) -> None:
    run = mechkin("plot", write("crank.yaml", PLOTTED.replace("{x: x}", "{x: x, y: [z]}")))
    assert run.code == 3
    assert "the table has no column 'z' to draw" in run.err


def test_without_matplotlib_it_says_what_to_install(write, folder) -> None:
    script = (
        "import sys\nsys.modules['matplotlib'] = None\n"
        "from mechkin_cli.__main__ import main\nmain()\n"
    )
    file = write("crank.yaml", PLOTTED)
    run = subprocess.run(
        [sys.executable, "-P", "-c", script, "plot", str(file)], capture_output=True, text=True
    )
    assert run.returncode == 2
    assert "pip install 'mechkin[plot]'" in run.stderr
    assert not (folder / "out").exists()


def test_missing_rows_are_drawn_as_gaps_and_told(mechkin, write, folder) -> None:
    file = write("rcsr.yaml", files.beyond_dead_centre())
    run = mechkin("plot", file, "--y", "O4.theta", "-o", "a.svg")
    assert run.code == 4
    assert "the branch ends at a dead centre" in run.err
    assert (folder / "a.svg").exists()
