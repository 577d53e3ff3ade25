"""What `mechkin analyze` prints: data on stdout, messages on stderr."""

import json
import re

import pytest
from cli import files
from references import FILE_OF, RCSR

CRANK = files.CRANK + files.TABLES


@pytest.fixture(autouse=True)
def _width(monkeypatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")


def test_tables_on_stdout_summary_on_stderr(mechkin, write) -> None:
    run = mechkin("analyze", write("crank.yaml", CRANK))
    assert run.out == (
        "tip: The tip\n\n"
        "O.theta     x\n"
        "  [deg]   [m]\n"
        "      0  2.00\n"
        "     45  1.41\n"
        "     90  0.00\n\n"
        "drive\n\n"
        "torque, motor\n"
        "        [N*m]\n"
        "            0\n"
        "            0\n"
        "            0\n\n"
    )
    assert run.err.splitlines()[:2] == ["crank (crank.yaml)", "  driven   1 freedom by O.theta"]


def test_summary_of_the_rcsr_mechanism(mechkin) -> None:
    err = mechkin("analyze", RCSR).err
    assert "  driven   1 freedom by O1.theta\n" in err
    assert "  loops    1, closed at O3 (S); 3 unknowns\n" in err
    assert "  rows     27 of 27 solved\n" in err
    assert "  files    out/rcsr (14 csv, 13 md)\n" in err
    worst = re.search(r"worst +residual (\S+), power error (\S+), condition (\S+)", err)
    assert worst is not None
    residual, power_error, _ = map(float, worst.groups())
    assert 0 < residual <= 1e-14
    assert 0 < power_error <= 1e-12


def test_summary_counts_rows_that_are_not_ok(mechkin, write) -> None:
    err = mechkin("analyze", write("beyond.yaml", files.beyond_dead_centre())).err
    assert "  rows     28 of 31 solved (3 beyond-dead-centre)\n" in err


def test_the_dead_centre_is_named_with_its_place(mechkin, write) -> None:
    run = mechkin("analyze", write("beyond.yaml", files.beyond_dead_centre()), "--quiet")
    assert run.out == ""
    # the printed values of RCSR do not lie beside this copy, and analysis needs none
    (of_the_branch,) = run.err.splitlines()
    assert of_the_branch.startswith(
        "beyond.yaml: warning: the branch ends at a dead centre; rows 29 to"
    )
    place = re.search(r"O1\.theta = (\S+) deg", run.err)
    assert place is not None
    # tests/rcsr pins it to all digits
    assert float(place[1]) == pytest.approx(205.14, abs=5e-3)


def test_an_assembly_that_does_not_exist(mechkin, write) -> None:
    run = mechkin("analyze", write("apart.yaml", files.WITHOUT_ASSEMBLY), "--quiet")
    assert re.match(
        r"apart\.yaml: error: .* cannot be assembled at the first row: the loop through O, A, B, D",
        run.err,
    )
    assert "check the dimensions" in run.err


def test_quiet_keeps_warnings_only(mechkin, write) -> None:
    run = mechkin("analyze", write("crank.yaml", CRANK), "--quiet")
    assert (run.out, run.err) == ("", "")
    run = mechkin("analyze", write("odd.yaml", files.UNPHYSICAL), "--quiet")
    assert run.out == ""
    assert run.err.startswith("odd.yaml:4:60: warning: the inertia of arm belongs to no real body")
    assert run.err.count("\n") == 1


STRUCK = """\
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {m: {mass: 1, center_of_mass: [0, 0]}}
joints: {S: {type: P, links: [ground, m], point: [0, 0], axis: [1, 0]}}
limits: {S.s: {max: 0.5, restitution: 1}}
responses: {r: {start: {S.s: 0, S.s_dot: 1}, time: {from: 0, to: 0.75, count: 4}}}
"""
"""A slider without forces: it comes to its limit once, of which a note tells."""


@pytest.mark.parametrize("out", [("--out", "out"), ("--out=out",)], ids=["plain", "typer"])
@pytest.mark.parametrize("command", ["analyze", "view"])
def test_quiet_leaves_notes_to_the_record(mechkin, write, command, out) -> None:
    file = write("struck.yaml", STRUCK)
    if command == "view":
        out = tuple(word.replace("=out", "=out/page.html") for word in out)
    assert "note: S.s comes to its limit once" in mechkin(command, file, *out).err
    run = mechkin(command, file, "--quiet", *out)
    assert (run.code, run.err) == (0, "")
    if command == "analyze":
        run = mechkin(command, file, "--quiet", "--json", *out)
        assert run.err == ""
        (response,) = run.json["responses"]
        assert [one["severity"] for one in response["diagnostics"]] == ["note"]


@pytest.mark.parametrize("columns", [80, 200])
def test_tables_fit_the_width(mechkin, monkeypatch, columns) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    lines = mechkin("analyze", RCSR, "--table", "table_03").out.splitlines()
    assert max(map(len, lines)) <= columns
    assert sum("theta1" in line for line in lines) == (2 if columns == 80 else 1)
    assert "   150  -103.881  -8.961    37.231    0.143" in "\n".join(lines)


def test_long_tables_are_shortened_in_the_middle(mechkin, write) -> None:
    text = CRANK.replace("to: 90, step: 45", "to: 99, step: 1")
    out = mechkin("analyze", write("crank.yaml", text), "--table", "tip").out
    thetas = [int(line.split()[0]) for line in out.splitlines() if re.match(r" +\d+ ", line)]
    assert thetas == [*range(30), *range(70, 100)]
    assert "(40 of 100 rows left out here; all are in out/crank)" in out


@pytest.mark.parametrize("columns", [18, 30, 200])
def test_the_gap_of_a_shortened_table_is_marked(mechkin, write, monkeypatch, columns) -> None:
    """Between the rows beside it, in every group of columns; a whole table has no mark."""
    monkeypatch.setenv("COLUMNS", str(columns))
    more = "decimals: 2}, {label: y, value: tip.position.y, decimals: 2}]"
    text = CRANK.replace("decimals: 2}]", more).replace("to: 90, step: 45", "to: 99, step: 1")
    path = write("crank.yaml", text)
    lines = mechkin("analyze", path, "--table", "tip").out.splitlines()
    marks = [k for k, line in enumerate(lines) if line.strip() == "..."]
    heads = [line for line in lines if "O.theta" in line.split()]
    assert len(marks) == len(heads) == (2 if columns == 18 else 1)
    for mark in marks:
        assert (lines[mark - 1].split()[0], lines[mark + 1].split()[0]) == ("29", "70")
    whole = write("whole.yaml", CRANK)
    assert "..." not in mechkin("analyze", whole, "--table", "tip").out


def test_set_replaces_a_parameter(mechkin, write) -> None:
    path = write("crank.yaml", CRANK)
    run = mechkin("analyze", path, "--set", "r=500 mm", "--table", "tip", "--json")
    x = run.json["tables"][0]["columns"][1]
    assert (x["label"], x["unit"], x["values"][0]) == ("x", "m", 0.5)


def test_a_bare_number_is_in_the_file_s_unit(mechkin, write) -> None:
    path = write("crank.yaml", CRANK.replace("format: 1", "format: 1\nunits: {length: cm}"))
    printed = [
        mechkin("analyze", path, "--set", f"r={text}", "--table", "tip", "--json").out
        for text in ("30", " 3e1", "30 cm", "0.3 m")
    ]
    assert printed[0] == printed[1] == printed[2] == printed[3]
    assert json.loads(printed[0])["tables"][0]["columns"][1]["values"][0] == 30


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("r", "expected NAME=VALUE"),
        ("=1", "expected NAME=VALUE"),
        ("rr=1 m", "did you mean r?"),
        ("r=0.5*2", "--set r: error: r is a length in the file, this is a dimensionless number"),
        ("r=1 kg", "in the file, this is a mass"),
        ("r=2 *m", "--set r: error: there is nothing named m (at character 4 of the value); "),
        ("r=nan", "--set r: error: "),
    ],
)
def test_a_setting_that_cannot_be(mechkin, write, setting, words) -> None:
    run = mechkin("analyze", write("crank.yaml", CRANK), "--set", setting)
    assert words in run.err
    assert run.err.count("\n") == 1


def test_mode_chooses_the_assembly(mechkin) -> None:
    chosen = mechkin("analyze", RCSR, "--table", "table_03", "--json").json
    mode = mechkin("modes", RCSR, "--json").json["assembly"]
    other = "A" if mode == "B" else "B"
    by_name = mechkin("analyze", RCSR, "--table", "table_03", "--json", "--mode", mode).json
    found = mechkin("analyze", RCSR, "--table", "table_03", "--json", "--mode", other).json
    theta4 = [r["tables"][0]["columns"][3]["values"][0] for r in (chosen, by_name, found)]
    assert theta4[0] == pytest.approx(37.231, abs=5e-4)
    assert theta4[1] == pytest.approx(theta4[0], abs=1e-12)
    assert abs(theta4[2] - theta4[0]) > 1


def test_an_unknown_mode_names_those_there_are(mechkin) -> None:
    run = mechkin("analyze", RCSR, "--mode", "Q", "--quiet")
    assert "there is no mode Q at the first row: modes A, B" in run.err


def test_an_unknown_table_names_those_there_are(mechkin, write) -> None:
    run = mechkin("analyze", write("crank.yaml", CRANK), "--table", "tipp")
    assert run.err == "mechkin: there is no table tipp; tables are tip, drive\n"


def test_json_is_one_object(mechkin, write) -> None:
    run = mechkin("analyze", write("crank.yaml", CRANK), "--json")
    assert run.err == ""
    record = run.json
    assert (record["file"], record["name"], record["row_count"]) == ("crank.yaml", "crank", 3)
    assert [table["name"] for table in record["tables"]] == ["tip", "drive"]
    assert record["tables"][0]["columns"][0] == {
        "label": "O.theta",
        "unit": "deg",
        "values": [0, 45, 90],
    }
    assert record["rows"][3]["values"] == ["ok", "ok", "ok"]
    assert record["diagnostics"] == []


def test_json_of_missing_rows_has_null_cells_and_the_diagnostic(mechkin, write) -> None:
    path = write("beyond.yaml", files.beyond_dead_centre())
    run = mechkin("analyze", path, "--json", "--table", "table_05")
    assert run.code == 4
    assert run.json["tables"][0]["columns"][1]["values"][-3:] == [None, None, None]
    codes = [(each["code"], each["severity"]) for each in run.json["diagnostics"]]
    assert codes == [("dead-centre", "warning")]
    assert "dead centre" in run.err


def test_json_of_several_files_is_one_object_as_well(mechkin, write) -> None:
    good, bad = write("good.yaml", files.CRANK), write("bad.yaml", files.INVALID)
    run = mechkin("analyze", good, bad, "nowhere.yaml", "--json")
    assert run.code == 3
    first, second, third = run.json["files"]
    assert first["row_count"] == 3
    (error,) = second["diagnostics"]
    assert (error["code"], error["severity"]) == ("unknown-link", "error")
    assert error["place"] == {"file": "bad.yaml", "line": 5, "column": 39}
    assert (third["file"], third["diagnostics"][0]["code"]) == ("nowhere.yaml", "usage")


def test_json_of_an_invalid_file_is_one_object(mechkin, write) -> None:
    run = mechkin("analyze", write("bad.yaml", "format: [1\n"), "--json")
    assert run.code == 3
    assert run.json["file"] == "bad.yaml"
    assert run.json["diagnostics"][0]["severity"] == "error"


def test_labels_and_titles_of_several_lines_stay_on_one(mechkin, write):
    tables = 'tables: [{name: t, title: "a\\nb", columns: [{label: "x\\ny", value: 1}]}]\n'
    run = mechkin("analyze", write("crank.yaml", files.CRANK + tables))
    assert run.out.splitlines()[:4] == ["t: a b", "", "x y", ""]


SUMMED = files.CRANK + (
    "tables:\n  - {name: tip, summary: [max, peak, mean], columns: [O.theta, "
    "{label: x, value: tip.position.x, decimals: 2}]}\n"
    "  - {name: both, summary: [min], columns: [{label: x, value: tip.position.x, decimals: 2}, "
    "O.theta]}\n"
)


def test_a_summary_stands_below_its_table(mechkin, write, folder) -> None:
    run = mechkin("analyze", write("crank.yaml", SUMMED), "--format", "csv")
    # over 0, 45, 90 degrees by the trapezoidal rule: (1 + 1.41)*2/2/2
    assert run.out == (
        "tip\n\n"
        "O.theta     x\n"
        "  [deg]   [m]\n"
        "      0  2.00\n"
        "     45  1.41\n"
        "     90  0.00\n\n"
        "    max  2.00\n"
        "     at     0\n"
        "   peak  2.00\n"
        "     at     0\n"
        "   mean  1.21\n"
        "   rows     3\n"
        "(at: O.theta [deg]; mean and rms over O.theta)\n\n"
        "both\n\n"
        "         x  O.theta\n"
        "       [m]    [deg]\n"
        "      2.00        0\n"
        "      1.41       45\n"
        "      0.00       90\n\n"
        " min  0.00\n"
        "  at    90\n"
        "rows     3\n"
        "(at: O.theta [deg])\n\n"
    )
    text = (folder / "out" / "crank" / "both.summary.csv").read_text()
    assert [line.partition(",")[0] for line in text.splitlines()] == [
        "summary",
        "min",
        "min at",
        "rows",
    ]


@pytest.mark.parametrize(
    ("written", "words"),
    [("[max, max]", "max is named twice"), ("[median]", "median"), ("[]", "summary")],
)
def test_a_summary_that_cannot_be(mechkin, write, written, words) -> None:
    file = write("crank.yaml", SUMMED.replace("[max, peak, mean]", written))
    run = mechkin("analyze", file)
    assert run.code == 3
    assert words in run.err


@pytest.mark.parametrize(
    ("name", "loops"),
    [
        ("tackle", "none, coupled by cable K"),
        ("cylinder_boom", "1, closed at cylinder lift"),
        ("geared_five_bar", "1, closed at P (R), coupled by G"),
    ],
)
def test_loops_are_those_that_the_file_has(mechkin, name, loops) -> None:
    """The stretches of a cable make none, a cylinder between two links one."""
    err = mechkin("analyze", FILE_OF[name]).err
    assert f"  loops    {loops}; " in err
    count = loops.partition(",")[0].replace("none", "0")
    assert f"  loops      {count}\n" in mechkin("mobility", FILE_OF[name]).out
    assert f"ok ({count} loop" in mechkin("check", FILE_OF[name]).out
