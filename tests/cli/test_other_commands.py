"""`check`, `tables`, `schema`, help and version."""

import json
import re
import shutil
from pathlib import Path

import jsonschema
import pytest
import yaml
from cli import files
from references import FILE_OF, MECHANISMS, RCSR

COMMANDS = ("analyze", "check", "tables", "schema", "bench")


def test_check_says_what_a_file_holds(mechkin, write) -> None:
    run = mechkin("check", write("crank.yaml", files.CRANK + files.TABLES), RCSR)
    assert (
        run.out == f"crank.yaml: ok (0 loops, 3 rows, 2 tables)\n{RCSR}: ok (1 loop, 27 rows, "
        "11 tables)\n"
    )
    assert run.err == ""


def test_check_lists_every_error_in_order(mechkin, write) -> None:
    text = files.CRANK.replace("[ground, arm]", "[ground, amr]").replace("link: arm", "link: rma")
    run = mechkin("check", write("bad.yaml", text))
    assert run.out == ""
    assert [line.split(": ")[0] for line in run.err.splitlines()] == [
        "bad.yaml:5:39",
        "bad.yaml:6:22",
    ]


def test_check_quiet_says_nothing_of_a_sound_file(mechkin) -> None:
    run = mechkin("check", RCSR, "--quiet")
    assert (run.code, run.out, run.err) == (0, "", "")


def test_check_json(mechkin, write) -> None:
    good, odd = write("good.yaml", files.CRANK), write("odd.yaml", files.UNPHYSICAL)
    run = mechkin("check", good, odd, write("bad.yaml", files.INVALID), "--json")
    found = [(record["file"], record["valid"]) for record in run.json["files"]]
    assert found == [("good.yaml", True), ("odd.yaml", True), ("bad.yaml", False)]
    codes = [[d["code"] for d in record["diagnostics"]] for record in run.json["files"]]
    assert codes == [[], ["unphysical-inertia"], ["unknown-link"]]


@pytest.fixture
def committed(folder: Path) -> Path:
    """A copy of the RCSR tables beside their file, in `mechanisms/`, with the overview of it."""
    shutil.copytree(RCSR.with_suffix(""), folder / "mechanisms/rcsr")
    shutil.copy(RCSR, folder / "mechanisms")
    page = (MECHANISMS / "README.md").read_text(encoding="utf-8").splitlines(keepends=True)
    kept = [line for line in page if ".yaml)" not in line or "/rcsr.yaml)" in line]
    text = "".join(kept).replace("dissertation/", "")
    (folder / "mechanisms/README.md").write_text(text, encoding="utf-8")
    return folder / "mechanisms/rcsr"


def test_tables_as_committed(mechkin, committed) -> None:
    run = mechkin("tables", "--check")
    assert (run.code, run.out) == (0, "")
    count = sum(path.is_file() for path in committed.iterdir())
    assert run.err == f"mechanisms/rcsr: {count} files as committed\n"
    assert mechkin("tables", "--check", "--quiet").err == ""


def test_tables_keeps_an_overview(mechkin, committed, folder) -> None:
    page = folder / "mechanisms/README.md"
    page.unlink()
    run = mechkin("tables", "--check", "--json")
    assert (run.code, run.json["overview"]) == (1, "missing")
    assert not page.exists()
    mechkin("tables")
    (row,) = (line for line in page.read_text(encoding="utf-8").splitlines() if "rcsr" in line)
    assert row.startswith(
        "| ![RCSR](rcsr/picture.svg) | [RCSR](rcsr.yaml) | R C S R | 1 | 2 (all) | 27 | "
        "[1371 of 1998 cells agree,"
    )
    assert mechkin("tables", "--check").code == 0
    page.write_text(page.read_text(encoding="utf-8").replace("| 27 |", "| 26 |"), encoding="utf-8")
    run = mechkin("tables", "--check")
    assert run.code == 1
    assert "README.md: different" in run.out


def test_a_folder_of_folders_has_one_overview(mechkin, write, folder) -> None:
    """Where it has no file of its own; what lies deeper is left alone."""
    for name in ("b/one", "a/two"):
        (folder / "kept" / name).parent.mkdir(parents=True)
        write(f"kept/{name}.yaml", files.CRANK + files.TABLES)
    (folder / "kept/a/studies").mkdir()
    write("kept/a/studies/study.yaml", "study: 1\n")
    run = mechkin("tables", "kept")
    said = [line.partition(": ")[0] for line in run.err.splitlines() if "written" in line]
    assert (run.code, said) == (0, ["kept/b/one", "kept/a/two"])
    rows = (folder / "kept/README.md").read_text(encoding="utf-8").splitlines()[-2:]
    for row, name in zip(rows, ("b/one", "a/two"), strict=True):
        assert f"({name}/picture.svg)" in row
        assert f"({name}.yaml)" in row
    assert not list((folder / "kept").glob("*/README.md"))
    assert mechkin("tables", "kept", "--check").code == 0
    write("kept/own.yaml", files.CRANK + files.TABLES)
    assert [one["file"] for one in mechkin("tables", "kept", "--json").json["files"]] == [
        "kept/own.yaml"
    ]


def test_tables_leaves_another_readme_alone(mechkin, committed, folder) -> None:
    page = folder / "mechanisms/README.md"
    page.write_text("# Mine\n", encoding="utf-8")
    for arguments in (["tables"], ["tables", "--check"]):
        run = mechkin(*arguments)
        assert run.code == 0
        assert "README.md: left alone" in run.err
    assert page.read_text(encoding="utf-8") == "# Mine\n"


def test_tables_of_one_file_make_no_overview(mechkin, committed, folder) -> None:
    (folder / "mechanisms/README.md").unlink()
    mechkin("tables", "mechanisms/rcsr.yaml")
    assert not (folder / "mechanisms/README.md").exists()


def test_tables_finds_a_changed_errata_page(mechkin, committed) -> None:
    page = committed / "errata.md"
    text = page.read_text(encoding="utf-8")
    page.write_text(text.replace("0 of 135 cells", "1 of 135 cells"), encoding="utf-8")
    run = mechkin("tables", "--check")
    assert run.code == 1
    assert "errata.md: different" in run.out
    assert 'committed "1 of 135 cells agree' in run.out
    assert (mechkin("tables", "--quiet").code, page.read_text(encoding="utf-8")) == (0, text)


def test_tables_with_a_printed_digit_changed(mechkin, committed) -> None:
    """The page follows the print, and the tables stay as they are."""
    path = committed / "published/table_09.csv"
    path.write_text(path.read_text(encoding="utf-8").replace("-0.288", "-0.289"), encoding="utf-8")
    record = mechkin("tables", "--check", "--json").json["files"][0]
    changed = [t["name"] for t in record["tables"] if t["verdict"] != "equal"]
    assert changed == ["errata.md", "disagreements.csv"]


def test_every_disagreeing_cell_can_be_listed(mechkin, committed) -> None:
    before = {path: path.read_bytes() for path in committed.iterdir() if path.is_file()}
    run = mechkin("tables", "mechanisms", "--against")
    assert run.code == 0
    assert run.out == (committed / "disagreements.csv").read_text(encoding="utf-8")
    assert (
        "mechanisms/rcsr.yaml: 1371 of 1998 cells agree, 25 one off, 602 differ; 108 more"
        in run.err
    )
    (record,) = mechkin("tables", "mechanisms/rcsr.yaml", "--against", "--json").json["files"]
    listed = sum(len(table["disagreements"]) for table in record["tables"])
    assert listed == len(run.out.splitlines()) - 1 == 627
    found = [(c["at"], c["column"], c["printed"]) for c in record["tables"][0]["disagreements"]]
    assert ("202", "theta4", "-103.842") in found
    assert {path: path.read_bytes() for path in before} == before
    assert "two questions" in mechkin("tables", "--against", "--check").err


def test_tables_without_the_printed_values(mechkin, committed) -> None:
    (committed / "published/table_09.csv").unlink()
    run = mechkin("tables", "--check")
    assert run.code == 2
    assert "cannot read the printed values mechanisms/rcsr/published/table_09.csv" in run.err


def test_tables_with_wrong_printed_values(mechkin, committed) -> None:
    (committed / "published/table_09.csv").write_text("theta1,a_o2_x\n150,o.1\n", encoding="utf-8")
    run = mechkin("tables")
    assert run.code == 3
    assert "table_09.csv:2:5: error: a_o2_x: 'o.1' is no number; write the digits" in run.err
    (committed / "published/table_09.csv").write_text("theta,a_o2_x\n150,0.1\n", encoding="utf-8")
    run = mechkin("tables")
    assert run.code == 2
    assert "the column 'theta' finds the rows, and table table_09 has no" in run.err


def test_tables_finds_a_changed_digit(mechkin, committed) -> None:
    path = committed / "table_03.csv"
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    cells = lines[2].split(",")
    cells[3] = cells[3][:-1] + ("8" if cells[3][-1] == "7" else "7")
    lines[2] = ",".join(cells)
    path.write_text("".join(lines), encoding="utf-8")
    before = path.read_bytes()
    run = mechkin("tables", "--check")
    assert run.code == 1
    assert "table_03.csv: different, 1 cell; largest relative change " in run.out
    assert f"row 2, theta4: committed {cells[3]}, fresh 36.85" in run.out
    count = sum(path.is_file() for path in committed.iterdir())
    assert f"{count} table files: {count - 1} equal, 1 different" in run.out
    assert path.read_bytes() == before
    (record,) = mechkin("tables", "--check", "--json").json["files"]
    verdicts = {table["name"]: table["verdict"] for table in record["tables"]}
    assert {name for name, verdict in verdicts.items() if verdict != "equal"} == {"table_03.csv"}


def test_tables_finds_missing_and_surplus_files(mechkin, committed) -> None:
    (committed / "table_04.md").unlink()
    (committed / "old.csv").write_text("a\n1\n", encoding="utf-8")
    out = mechkin("tables", "mechanisms/rcsr.yaml", "--check").out
    assert "table_04.md: missing" in out
    assert "old.csv: extra" in out


def test_tables_removes_what_it_wrote_and_writes_no_more(mechkin, write, folder) -> None:
    mechkin("tables", write("crank.yaml", files.CRANK))
    notes = {"crank/notes.md": "# mine\n", "crank/measured.csv": "a\n1\n"}
    for name, text in notes.items():
        write(name, text)
    write("crank.yaml", files.CRANK + files.TABLES)
    told = mechkin("tables", "crank.yaml", "--check").out
    assert "sweep.csv: extra, no table makes this file any more; `mechkin tables` removes" in told
    assert "notes.md: extra, no table makes this file any more; it does not look like" in told
    run = mechkin("tables", "crank.yaml", "--json")
    (record,) = run.json["files"]
    assert record["removed"] == ["crank/sweep.csv", "crank/sweep.md"]
    assert "2 removed (sweep.csv, sweep.md)" in run.err
    kept = {path.name for path in (folder / "crank").iterdir()}
    assert not kept & {"sweep.csv", "sweep.md"}
    assert {name: (folder / name).read_text(encoding="utf-8") for name in notes} == notes
    assert mechkin("tables", "crank.yaml").err.endswith("files written\n")
    assert "sweep" not in mechkin("tables", "crank.yaml", "--check").out


def test_a_summary_goes_with_its_table(mechkin, write, folder) -> None:
    summed = files.TABLES.replace("{name: tip,", "{name: tip, summary: [max, rms],")
    mechkin("tables", write("crank.yaml", files.CRANK + summed))
    assert "tip.summary.csv" in {path.name for path in (folder / "crank").iterdir()}
    write("crank.yaml", files.CRANK + files.TABLES.replace("name: tip,", "name: point,"))
    run = mechkin("tables", "crank.yaml")
    assert "3 removed (tip.csv, tip.md, tip.summary.csv)" in run.err
    assert mechkin("tables", "crank.yaml", "--check").code == 0


def test_a_summary_alone_goes_as_well(mechkin, write, folder) -> None:
    summed = files.TABLES.replace("{name: tip,", "{name: tip, summary: [max, rms],")
    mechkin("tables", write("crank.yaml", files.CRANK + summed))
    write("crank.yaml", files.CRANK + files.TABLES)
    assert "1 removed (tip.summary.csv)" in mechkin("tables", "crank.yaml").err


def test_the_errata_go_with_the_print_that_they_compare(mechkin, write, folder) -> None:
    write("printed.csv", "O.theta,x\n0,2.1\n45,1.4\n")
    table = "  - {{name: tip{}, columns: [O.theta, {{label: x, value: tip.position.x}}]}}\n"
    text = f"{files.CRANK}tables:\n"
    write("crank.yaml", text + table.format(", published: printed.csv"))
    assert mechkin("tables", "crank.yaml").code == 0
    pages = {"errata.md", "disagreements.csv"}
    assert pages <= {path.name for path in (folder / "crank").iterdir()}
    write("crank.yaml", text + table.format(""))
    assert mechkin("tables", "crank.yaml").code == 0
    assert {path.name for path in (folder / "crank").iterdir()} == {
        "picture.svg",
        "tip.csv",
        "tip.md",
    }


def test_tables_regenerates_what_is_committed(mechkin, committed) -> None:
    written = [path for path in committed.iterdir() if path.is_file()]
    expected = {path.name: path.read_bytes() for path in written}
    for path in written:
        path.unlink()
    run = mechkin("tables")
    assert (run.code, run.out, run.err) == (
        0,
        "",
        f"mechanisms/rcsr: {len(written)} files written\n",
    )
    assert {name: (committed / name).read_bytes() for name in expected} == expected


def test_committed_cells_have_twelve_digits(mechkin, write, folder) -> None:
    mechkin("tables", write("crank.yaml", files.CRANK + files.TABLES))
    cells = (folder / "crank/tip.csv").read_text(encoding="utf-8").split()
    assert cells[1:3] == ["0,2", "45,1.41421356237"]


def test_schema_is_json_schema_and_accepts_the_mechanisms(mechkin) -> None:
    schema = mechkin("schema").json
    jsonschema.Draft202012Validator.check_schema(schema)
    data = yaml.safe_load(RCSR.read_text(encoding="utf-8"))
    jsonschema.validate(data, schema)


def test_schema_check(mechkin, folder) -> None:
    place = folder / "schemas/mechanism.schema.json"
    assert mechkin("schema", "--out", place).code == 0
    assert json.loads(place.read_text(encoding="utf-8")) == mechkin("schema").json
    run = mechkin("schema", "--check")
    assert (run.code, run.out) == (0, "")
    place.write_text(place.read_text(encoding="utf-8").replace("format", "farmat", 1))
    run = mechkin("schema", "--check")
    assert run.code == 1
    assert "is not up to date; run: mechkin schema --out schemas/mechanism.schema.json" in run.err


def test_help_names_every_command(mechkin) -> None:
    for arguments in ((), ("--help",)):
        run = mechkin(*arguments)
        text = run.out + run.err
        assert re.match(r"Usage: mechkin \[OPTIONS\] \[?COMMAND", text)
        listed = text.split("Commands:\n")[1].split()
        assert all(command in listed for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(mechkin, command) -> None:
    run = mechkin(command, "--help")
    assert run.code == 0
    assert run.out.startswith(f"Usage: mechkin {command} [OPTIONS]")
    options = run.out.split("Options:\n")[1].splitlines()
    bare = [line for line in options if line.startswith("  --") and len(line.split("  ")) < 3]
    assert not bare, "options without help"


def test_an_unknown_option_is_named(mechkin) -> None:
    run = mechkin("analyze", RCSR, "--quite")
    assert run.out == ""
    assert re.search(r"No such option:? '?--quite", run.err)
    assert "--quiet" in run.err


def test_a_file_without_a_command_gets_the_cure(mechkin, write) -> None:
    run = mechkin(write("crank.yaml", files.CRANK))
    assert run.code == 2
    assert run.err.endswith("To run a mechanism file: mechkin analyze crank.yaml\n")


def test_modes_json(mechkin) -> None:
    run = mechkin("modes", RCSR, "--at", "170", "--json")
    assert (run.code, run.err) == (0, "")
    assert [set(mode) for mode in run.json["modes"]] == [
        {"name", "coordinates", "residual", "condition", "places"}
    ] * 2
    assert run.json["modes"][1]["coordinates"]["O1.theta"] == 170
    assert run.json["assembly"] == "B"
    assert run.json["bound"] == 4
    assert run.json["complete"]


def test_modes_shown(mechkin) -> None:
    run = mechkin("modes", RCSR)
    assert run.out.splitlines()[0].split()[:3] == ["mode", "O1.theta", "O2.theta"]
    assert "2 modes: all, the loops' equations have no other real root" in run.err
    assert "mode B is the one that the file takes" in run.err


def test_no_mode_is_exit_code_4(mechkin) -> None:
    run = mechkin("modes", RCSR, "--at", "O1.theta=0")
    assert (run.code, run.out) == (4, "")
    assert "cannot be assembled there: the loop through O1, O2, O3, O4 does not close" in run.err


def test_a_place_that_is_no_input_is_a_usage_error(mechkin) -> None:
    assert mechkin("modes", RCSR, "--at", "O2.theta=0").code == 2
    assert mechkin("modes", RCSR, "--at", "O1.theta=").code == 2


def test_mobility(mechkin) -> None:
    run = mechkin("mobility", FILE_OF["bennett"])
    assert run.code == 0
    assert run.out.startswith("Bennett: one freedom; Kutzbach's count is -2")
    record = mechkin("mobility", FILE_OF["bennett"], "--json").json
    assert (record["count"], record["mobility"], record["redundant"][0]["number"]) == (-2, 1, 3)


def test_printed_values_that_are_not_there_are_warned_of(mechkin, committed) -> None:
    """Tables need none until they are compared."""
    (committed / "published/table_09.csv").unlink()
    run = mechkin("check", "mechanisms/rcsr.yaml")
    assert run.code == 0
    (warning,) = [line for line in run.err.splitlines() if "printed values" in line]
    assert "there are no printed values in mechanisms/rcsr/published/table_09.csv" in warning
    place = warning.split(": warning")[0].removeprefix("mechanisms/rcsr.yaml:")
    line = int(place.split(":")[0])
    text = (committed.parent / "rcsr.yaml").read_text(encoding="utf-8").splitlines()[line - 1]
    assert "table_09.csv" in text
    assert "printed values" not in mechkin("analyze", "mechanisms/rcsr.yaml", "--quiet").err


def test_a_copied_file_leaves_its_printed_values_behind(mechkin, committed, folder) -> None:
    """Where none is there a check has a note, and nothing else speaks of them."""
    text = (committed.parent / "rcsr.yaml").read_text(encoding="utf-8")
    (folder / "copy.yaml").write_text(text, encoding="utf-8")
    for command in (("analyze", "--quiet"), ("modes",), ("mobility",), ("view",), ("plot",)):
        run = mechkin(command[0], "copy.yaml", *command[1:])
        assert run.code == 0
        assert "printed values" not in run.err
    run = mechkin("check", "copy.yaml", "--json")
    (found,) = run.json["files"][0]["diagnostics"]
    assert (found["code"], found["severity"]) == ("published-missing", "note")
    assert "there are no printed values in rcsr/published/table_03.csv, nor in 10 others" in run.err
