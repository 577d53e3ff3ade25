"""What `mechkin analyze` writes, and where."""

import csv
import json
import re
from pathlib import Path

import pytest
from cli import files
from references import RCSR

LISTING = ".mechkin-files"
CRANK = files.CRANK + files.TABLES

TIP_MD = """\
# The tip

| O.theta [deg] | x [m] |
| ------------: | ----: |
|             0 |  2.00 |
|            45 |  1.41 |
|            90 |  0.00 |
"""


def names(folder: Path) -> list[str]:
    """The files of runs, without the listings of these files."""
    found = (path for path in folder.rglob("*") if path.is_file() and path.name != LISTING)
    return sorted(str(path.relative_to(folder)) for path in found)


def test_tables_and_rows_stand_in_out_stem(mechkin, write, folder) -> None:
    assert mechkin("analyze", write("crank.yaml", CRANK)).code == 0
    assert names(folder / "out") == [
        "crank/drive.csv",
        "crank/drive.md",
        "crank/rows.csv",
        "crank/tip.csv",
        "crank/tip.md",
    ]


def test_content_of_a_table(mechkin, write, folder) -> None:
    mechkin("analyze", write("crank.yaml", CRANK), "--table", "tip")
    header, *rows = (folder / "out/crank/tip.csv").read_text(encoding="utf-8").splitlines()
    cells = [row.split(",") for row in rows]
    assert header == "O.theta,x"
    assert [theta for theta, _ in cells] == ["0", "45", "90"]
    # 2 cos(theta)
    assert [float(x) for _, x in cells] == pytest.approx([2, 2**0.5, 0], abs=1e-15)
    assert (folder / "out/crank/tip.md").read_text(encoding="utf-8") == TIP_MD


def test_labels_with_commas_are_quoted(mechkin, write, folder) -> None:
    mechkin("analyze", write("crank.yaml", CRANK))
    content = (folder / "out/crank/drive.csv").read_bytes()
    assert content.startswith(b'"torque, motor"\n')
    assert b"\r" not in content


def test_rows_say_what_each_row_is_worth(mechkin, write, folder) -> None:
    mechkin("analyze", write("beyond.yaml", files.beyond_dead_centre()))
    lines = (folder / "out/beyond/rows.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "row,O1.theta,mode,status,residual,condition,power_error"
    rows = [line.split(",") for line in lines[1:]]
    assert [(row[0], row[1]) for row in rows] == [(str(i + 1), str(150 + 2 * i)) for i in range(31)]
    assert [row[3] for row in rows] == ["ok"] * 28 + ["beyond-dead-centre"] * 3
    assert all(float(row[4]) <= 1e-14 and float(row[6]) <= 1e-12 for row in rows[:28])
    assert all(row[4:] == ["", "", ""] for row in rows[28:])


def test_rows_that_are_missing_keep_their_inputs(mechkin, write, folder) -> None:
    mechkin("analyze", write("beyond.yaml", files.beyond_dead_centre()), "--table", "table_05")
    lines = (folder / "out/beyond/table_05.csv").read_text(encoding="utf-8").splitlines()
    assert lines[-3:] == ["206,,,,,,", "208,,,,,,", "210,,,,,,"]
    markdown = (folder / "out/beyond/table_05.md").read_text(encoding="utf-8")
    assert "\n- Rows 29-31 (O1.theta 206 to 210 deg): beyond-dead-centre: " in markdown


def test_a_file_without_tables_gives_the_table_sweep(mechkin, write, folder) -> None:
    assert mechkin("analyze", write("crank.yaml", files.CRANK)).code == 0
    assert names(folder / "out/crank") == ["rows.csv", "sweep.csv", "sweep.md"]
    lines = (folder / "out/crank/sweep.csv").read_text(encoding="utf-8").splitlines()
    assert lines[:2] == ["O.theta,O.theta_dot,O.effort", "0,3,0"]


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ("--format csv", ["drive.csv", "rows.csv", "tip.csv"]),
        ("--format md", ["drive.md", "rows.csv", "tip.md"]),
        ("--format json", ["analysis.json", "rows.csv"]),
        ("--format md --format csv --format md --table tip", ["rows.csv", "tip.csv", "tip.md"]),
        ("--table tip --table drive --format csv", ["drive.csv", "rows.csv", "tip.csv"]),
    ],
)
def test_formats_and_tables_wanted(mechkin, write, folder, options, expected) -> None:
    run = mechkin("analyze", write("crank.yaml", CRANK), "--out", "here", *options.split())
    assert run.code == 0
    assert names(folder / "here") == expected


def test_the_json_file_is_what_json_prints(mechkin, write, folder) -> None:
    path = write("crank.yaml", CRANK)
    printed = mechkin("analyze", path, "--json", "--format", "json").json
    written = json.loads((folder / "out/crank/analysis.json").read_text(encoding="utf-8"))
    assert {"file": "crank.yaml"} | written == printed


def test_out_names_the_folder_of_one_file(mechkin, write, folder) -> None:
    mechkin("analyze", write("crank.yaml", files.CRANK), "--out", "a/b")
    assert names(folder / "a") == ["b/rows.csv", "b/sweep.csv", "b/sweep.md"]


@pytest.mark.parametrize(("options", "place"), [([], "out"), (["--out", "all"], "all")])
def test_several_files_have_a_folder_each(mechkin, write, folder, options, place) -> None:
    one, two = write("one.yaml", files.CRANK), write("deep/two.yaml", files.CRANK)
    assert mechkin("analyze", one, two, "--format", "csv", *options).code == 0
    assert names(folder / place) == [
        "one/rows.csv",
        "one/sweep.csv",
        "two/rows.csv",
        "two/sweep.csv",
    ]


def test_one_bad_file_does_not_stop_the_others(mechkin, write, folder) -> None:
    bad, good = write("bad.yaml", files.INVALID), write("good.yaml", files.CRANK)
    run = mechkin("analyze", bad, "nowhere.yaml", good)
    assert run.code == 3
    assert names(folder / "out") == ["good/rows.csv", "good/sweep.csv", "good/sweep.md"]
    assert "bad.yaml:5:39: error: there is no link amr" in run.err
    assert "mechkin: there is no file nowhere.yaml" in run.err


def test_two_files_never_share_a_folder(mechkin, write, folder) -> None:
    one, two = write("a/crank.yaml", files.CRANK), write("b/crank.yaml", files.CRANK)
    run = mechkin("analyze", one, two)
    assert run.code == 2
    assert run.err.startswith("mechkin: a/crank.yaml and b/crank.yaml would both be written to")
    assert (
        mechkin("analyze", one, one).err == "mechkin: a/crank.yaml is given twice; name it once\n"
    )
    assert not (folder / "out").exists()


@pytest.mark.parametrize("place", ["crank.yaml", "crank.yaml/below", "/proc/mechkin"])
def test_a_place_that_cannot_be_written_to(mechkin, write, folder, place) -> None:
    run = mechkin("analyze", write("crank.yaml", files.CRANK), "--out", place)
    assert run.code == 2
    assert run.err.startswith(f"mechkin: cannot write {place}/sweep.csv: ")
    assert "--out" in run.err
    assert names(folder) == ["crank.yaml"]


def test_a_second_run_replaces_the_files_whole(mechkin, write, folder) -> None:
    path = write("crank.yaml", CRANK)
    mechkin("analyze", path)
    before = {name: (folder / "out" / name).read_bytes() for name in names(folder / "out")}
    assert mechkin("analyze", path, "--set", "r=1 m").code == 0
    assert names(folder / "out") == sorted(before)
    changed = {name for name in before if (folder / "out" / name).read_bytes() != before[name]}
    assert changed == {"crank/tip.csv", "crank/tip.md"}
    mechkin("analyze", path)
    assert all((folder / "out" / name).read_bytes() == content for name, content in before.items())


def test_nothing_is_written_for_a_file_that_is_refused(mechkin, write, folder) -> None:
    mechkin("analyze", write("bad.yaml", files.INVALID))
    mechkin("check", RCSR)
    assert names(folder) == ["bad.yaml"]


def test_json_on_stdout_writes_no_file(mechkin, write, folder) -> None:
    path = write("crank.yaml", CRANK)
    before = names(folder)
    printed = mechkin("analyze", path, "--json").out
    assert names(folder) == before
    assert mechkin("analyze", path, "--json", "--out", "here").out == printed
    assert "rows.csv" in names(folder / "here")


def test_json_begins_with_the_versions_of_program_and_format(mechkin, write) -> None:
    from importlib.metadata import version

    path = write("crank.yaml", CRANK)
    for words in (["analyze"], ["check"], ["modes"], ["ranges"], ["mobility"], ["tables"]):
        record = mechkin(*words, path, "--json").json
        assert list(record)[:2] == ["mechkin", "format"]
        assert (record["mechkin"], record["format"]) == (version("mechkin"), 1)


def test_units_in_the_headers_of_csv_on_request(mechkin, write, folder) -> None:
    path = write("crank.yaml", CRANK)
    mechkin("analyze", path, "--out", "bare")
    mechkin("analyze", path, "--units", "--out", "with")
    for bare in (folder / "bare").glob("*.csv"):
        head, *rows = bare.read_text(encoding="utf-8").splitlines()
        whole, *same = (folder / "with" / bare.name).read_text(encoding="utf-8").splitlines()
        assert same == rows
        assert head != whole
    assert whole_header(folder, "tip") == "O.theta [deg],x [m]"
    assert whole_header(folder, "drive") == '"torque, motor [N*m]"'
    assert whole_header(folder, "rows") == (
        "row,O.theta [deg],mode,status,residual,condition,power_error"
    )


def whole_header(folder, table: str) -> str:
    return (folder / "with" / f"{table}.csv").read_text(encoding="utf-8").splitlines()[0]


def test_help_is_short_as_well(mechkin) -> None:
    for words in ([], ["analyze"], ["check"], ["modes"], ["tables"], ["bench"], ["schema"]):
        assert mechkin(*words, "-h").out == mechkin(*words, "--help").out != ""


# One folder holds one run.

SUMMARY = CRANK.replace("columns: [{", "summary: [peak], columns: [{")


def test_files_of_the_run_before_are_removed(mechkin, write, folder) -> None:
    file = write("crank.yaml", SUMMARY)
    (folder / "out/crank").mkdir(parents=True)
    write("out/crank/notes.md", "mine")
    write("out/crank/drive.tex", "mine, too")
    first = mechkin("analyze", file, "--view")
    assert first.code == 0
    assert "removed" not in first.err
    before = ["drive.csv", "drive.md", "drive.summary.csv", "rows.csv", "tip.csv", "tip.md"]
    mine = ["drive.tex", "notes.md"]
    assert names(folder / "out/crank") == sorted([*before, "view.html", *mine])
    run = mechkin("analyze", file, "--set", "r=3 m", "--format", "json", "--errors")
    assert run.code == 0
    assert names(folder / "out/crank") == sorted(["analysis.json", "errors.csv", "rows.csv", *mine])
    line = next(line for line in run.err.splitlines() if line.startswith("  files"))
    for name in (*before[:3], *before[4:], "view.html"):
        assert name in line
    assert "notes" not in line
    assert (folder / "out/crank/drive.tex").read_text(encoding="utf-8") == "mine, too"


def test_a_file_that_somebody_changed_stays_with_a_warning(mechkin, write, folder) -> None:
    file = write("crank.yaml", CRANK)
    assert mechkin("analyze", file).code == 0
    changed = folder / "out/crank/tip.md"
    text = changed.read_text(encoding="utf-8")
    changed.write_text(text.replace("2.00", "2.01"), encoding="utf-8")
    (folder / "out/crank/drive.md").unlink()
    run = mechkin("analyze", file, "--format", "tex", "--quiet")
    assert run.code == 0
    assert names(folder / "out/crank") == ["drive.tex", "rows.csv", "tip.md", "tip.tex"]
    assert "warning: in out/crank tip.md is of an earlier run, but not as it was written" in run.err
    assert "2.01" in changed.read_text(encoding="utf-8")
    assert mechkin("analyze", file, "--format", "tex").err.count("warning") == 0


def test_a_listing_removes_nothing_outside_its_folder(mechkin, write, folder) -> None:
    file = write("crank.yaml", CRANK)
    write("kept.txt", "")
    folders = folder / "out/crank"
    folders.mkdir(parents=True)
    (folders / "link.txt").symlink_to("../../kept.txt")
    listed = ["../../kept.txt", str(folder / "kept.txt"), "..", ".", "link.txt", "\x00", ""]
    write(f"out/crank/{LISTING}", "".join(f"00000000 0 {name}\n" for name in listed))
    run = mechkin("analyze", file)
    assert run.code == 0
    assert (folder / "kept.txt").exists()
    assert (folders / "link.txt").is_symlink()
    assert "link.txt is of an earlier run" in run.err
    (folders / LISTING).write_bytes(b"\xff\xfe 00000000")
    assert mechkin("analyze", file).code == 0


def test_a_decimal_comma_changes_marks_and_separators_alone(mechkin, write, folder) -> None:
    path = write("crank.yaml", CRANK)
    mechkin("analyze", path, "--out", "point")
    mechkin("analyze", path, "--decimal", "comma", "--out", "comma")
    for one in (folder / "point").glob("*.csv"):
        with one.open(encoding="utf-8", newline="") as stream:
            head, *rows = csv.reader(stream)
        with (folder / "comma" / one.name).open(encoding="utf-8", newline="") as stream:
            found, *cells = csv.reader(stream, delimiter=";")
        assert found == head
        number = re.compile(r"(-?\d+)\.(\d+(e-?\d+)?)")
        assert cells == [[number.sub(r"\1,\2", text) for text in row] for row in rows]
    assert (folder / "comma" / "tip.csv").read_text().splitlines()[:2] == ["O.theta;x", "0;2"]


def test_a_decimal_comma_stands_in_all_cells_of_markdown_and_latex(mechkin, write, folder) -> None:
    """The same lines as with a point, but for the marks in numbers of cells."""
    text = CRANK.replace("title: The tip", "title: Tip at 1.5, summary: [max, rms]")
    path = write("crank.yaml", text)
    for mark in ("point", "comma"):
        mechkin("analyze", path, "--format", "md,tex", "--decimal", mark, "--out", mark)
    number = re.compile(r"(\d)\.(\d)")
    for name, is_cells in (("tip.md", "| "), ("tip.tex", "")):
        lines = (folder / "point" / name).read_text(encoding="utf-8").splitlines()
        found = (folder / "comma" / name).read_text(encoding="utf-8").splitlines()
        expected = [
            number.sub(r"\1,\2", line)
            if line.startswith(is_cells) and "Tip at" not in line
            else line
            for line in lines
        ]
        assert found == expected
        assert found != lines


def test_an_unknown_decimal_mark_is_refused(mechkin, write) -> None:
    run = mechkin("analyze", write("crank.yaml", CRANK), "--decimal", "dot")
    assert run.code == 2
    assert "--decimal dot: marks are point and comma" in run.err
