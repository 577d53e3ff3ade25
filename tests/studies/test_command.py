"""`mechkin study` from the command line: what it writes, shows and refuses."""

import csv
import json
from pathlib import Path
from typing import Any

import pytest
import yaml
from references import FILE_OF
from studies.studies import KEPT, MECHANISMS, RCSR, study_text

import mechkin_cli as mk
from mechkin_cli.__main__ import main
from mechkin_cli.cli.progress import clock


class Run:
    def __init__(self, code: int, out: str, err: str) -> None:
        self.code, self.out, self.err = code, out, err


@pytest.fixture
def mechkin(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Any:
    def run(*words: object) -> Run:
        monkeypatch.setattr("sys.argv", ["mechkin", *map(str, words)])
        with pytest.raises(SystemExit) as left:
            main()
        said = capsys.readouterr()
        return Run(int(left.value.code or 0), said.out, said.err)

    return run


def written(folder: Path, data: dict[str, Any], mechanism: str = "rcsr") -> Path:
    file = folder / "study.yaml"
    file.write_text(study_text(data, FILE_OF[mechanism]))
    return file


@pytest.mark.parametrize("path", KEPT, ids=lambda path: path.stem)
def test_the_examples_run(mechkin: Any, tmp_path: Path, path: Path) -> None:
    run = mechkin("study", path, "--out", tmp_path)
    assert run.code in (0, 4)
    rows = list(csv.DictReader((tmp_path / "variants.csv").open()))
    data = yaml.safe_load(path.read_text())
    model = mk.load(path.parent / data["mechanism"])
    names = [name for name in model.problem.parameters if name in rows[0]]
    for row in (rows[0], rows[len(rows) // 2], rows[-1]):
        own = {name: float(row[name]) for name in names}
        own |= {name: text for name, text in data.get("set", {}).items() if name not in own}
        alone = model.with_parameters(own).analyze()
        assert (row["verdict"] == "ok") is bool(alone.result.sound)
        for kept in data["keep"]:
            if kept["as"] == "peak":
                assert float(row[kept["label"]]) == max(abs(alone[kept["of"]][alone.result.solved]))
    assert f"{len(rows)} variants" in run.err


def test_stroke_of_the_swash_plate(mechkin: Any, tmp_path: Path) -> None:
    from math import radians, tan

    mechkin("study", MECHANISMS / "classics/studies/plunger_tolerances.yaml", "--out", tmp_path)
    for row in csv.DictReader((tmp_path / "variants.csv").open()):
        expected = 2 * float(row["r"]) * tan(radians(float(row["tilt"])))
        assert float(row["stroke"]) == pytest.approx(expected, rel=1e-12)


def test_a_dry_run_shows_variants_and_writes_nothing(mechkin: Any, tmp_path: Path) -> None:
    run = mechkin("study", written(tmp_path, RCSR), "--out", tmp_path / "out", "--dry-run")
    assert run.code == 0
    assert "63 variants (7 of lists x 9 samples) of RCSR" in run.err
    assert run.out.splitlines()[0].split() == ["variant", "P1", "P2", "alpha1"]
    assert not (tmp_path / "out").exists()
    record = json.loads(mechkin("study", tmp_path / "study.yaml", "--dry-run", "--json").out)
    assert (record["variants"], record["lists"], record["samples"]) == (63, 7, 9)


def test_an_explanation_estimates_and_writes_nothing(mechkin: Any, tmp_path: Path) -> None:
    study = written(tmp_path, RCSR | {"sample": {"count": 100_000}})
    run = mechkin("study", study, "--out", tmp_path / "out", "--explain", "--json")
    record = json.loads(run.out)
    assert record["variants"] == 700_000
    assert record["estimate"]["seconds"] > record["trial"]["seconds"]
    assert not (tmp_path / "out").exists()
    # what a line of the results takes, from a study that was written
    written(tmp_path, RCSR)
    mechkin("study", study, "--out", tmp_path / "out")
    files = [tmp_path / "out" / name for name in ("variants.csv", "rows.csv")]
    size = sum(file.stat().st_size for file in files) / 63 * 700_000
    assert record["estimate"]["bytes"] == pytest.approx(size, rel=0.2)


def test_the_record_has_the_overview(mechkin: Any, tmp_path: Path) -> None:
    record = json.loads(
        mechkin("study", written(tmp_path, RCSR), "--out", tmp_path / "out", "--json").out
    )
    rows = list(csv.DictReader((tmp_path / "out/variants.csv").open()))
    verdicts = [row["verdict"] for row in rows]
    assert record["verdicts"] == {word: verdicts.count(word) for word in dict.fromkeys(verdicts)}
    (column,) = [c for c in record["columns"] if c["label"] == "peak(O1.effort)"]
    values = [float(row["peak(O1.effort)"]) for row in rows]
    assert (column["least"], column["largest"]) == (min(values), max(values))
    assert column["largest_at"] == values.index(max(values))
    assert column["mean"] == pytest.approx(sum(values) / len(values), rel=1e-12)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.2412, "240 ms"), (0.0024, "2.4 ms"), (0.99, "990 ms"), (75, "1.2 min"), (5e7, "580 days")],
)
def test_times_have_two_digits_and_no_power_of_ten(seconds: float, words: str) -> None:
    from mechkin_cli.cli.study import _time

    assert _time(seconds) == words


def test_a_mapping_in_place_of_words_is_told_once(mechkin: Any, tmp_path: Path) -> None:
    keep = [{"of": "O4.theta", "as": {"from": 1, "to": 2}}]
    run = mechkin("study", written(tmp_path, {"vary": {"P1": [0.5]}, "keep": keep}))
    (said,) = run.err.splitlines()
    assert "keep#1.as: expected one of the words max, min, peak" in said
    assert said.endswith("found a mapping {key: value}")


BAD: tuple[tuple[dict[str, Any], str], ...] = (
    ({"vary": {"P9": [1, 2]}}, "has no parameter P9; parameters are"),
    ({"vary": {"P1": ["12 deg"]}}, "bad"),
    ({"table": "P1"}, "not a CSV file beside or below the file that names it"),
    ({"vary": {"P1": ["twelve"]}}, ""),
    ({"vary": {"P1": {"from": 1, "to": 2}}}, "need a step or a count"),
    ({"vary": {"P1": {"from": 1, "to": 2, "step": 0}}}, "the step is 0"),
    ({"vary": {"P1": {"between": [1, 2]}}}, "are drawn: how many?"),
    ({"vary": {"P1": {"between": [2, 1]}}, "sample": {"count": 3}}, "nothing between 2 and 1"),
    ({"vary": {"P1": {"deviation": 0}}, "sample": {"count": 3}}, "not larger than 0"),
    ({"vary": {"P1": {"tolerance": 0}}, "sample": {"count": 3}}, "tolerance 0 is not larger"),
    ({"vary": {"P1": [1]}, "sample": {"count": 3}}, "nothing in vary: is drawn"),
    ({"vary": {"P1": {"between": [1, 2]}}, "sample": {"count": 10**12}}, "too many (limit"),
    (
        {"vary": {f"P{k}": {"from": 1, "to": 2, "count": 1000} for k in (1, 2, 3, 4)}},
        "1000000000000 variants",
    ),
    ({"vary": {}}, "the study varies nothing"),
    ({"vary": {"P1": [1], "P2": [1, 2]}, "lists": "together"}, "different lengths: P1 1, P2 2"),
    ({"keep": [{"of": "O9.theta", "as": "max"}]}, "O9"),
    ({"keep": [{"of": "O1.torque", "as": "max"}]}, "did you mean O1.effort?"),
    ({"keep": [{"of": "O3.force", "as": "max"}]}, "is a vector, not one number"),
    ({"keep": [{"of": "row.status", "as": "max"}]}, "is words, no number"),
    ({"keep": [{"of": "O4.theta", "as": "value"}]}, "value needs a place"),
    ({"keep": [{"of": "O4.theta", "as": "value", "at": 171}]}, "no row has O1.theta = 171 deg"),
    ({"keep": [{"of": "O4.theta", "as": "max", "at": 170}]}, "at goes with as: value"),
    ({"keep": [{"of": "O4.theta", "as": "maxi"}]}, "did you mean max?"),
    ({"keep": [{"of": "O4.theta", "as": ["max", "max"]}]}, "max is named twice"),
    ({"keep": [{"of": "O4.theta", "as": "max", "label": "P1"}]}, "two columns 'P1'"),
    ({"run": "start_up"}, "there is no run start_up"),
    ({"set": {"P9": 1}}, "defines no parameter 'P9'"),
    ({"table": "nowhere.csv"}, "does not exist"),
    ({"colour": "red"}, "colour"),
)


@pytest.mark.parametrize(("change", "said"), BAD, ids=lambda value: str(value)[:40])
def test_bad_studies_are_told_with_place_and_cure(
    mechkin: Any, tmp_path: Path, change: dict[str, Any], said: str
) -> None:
    good: dict[str, Any] = {"vary": {"P1": [0.5]}, "keep": [{"of": "O4.theta", "as": "max"}]}
    study = written(tmp_path, good | change)
    run = mechkin("study", study, "--out", tmp_path / "out")
    assert run.code == 3, run.err
    first = run.err.splitlines()[0]
    assert first.startswith(f"{study}:"), run.err
    line, column = first.removeprefix(f"{study}:").split(":")[:2]
    assert int(line) > 1 or "varies nothing" in said or "how many" in said
    assert int(column) > 0
    assert "; " in run.err, "a cure"
    assert said == "bad" or said in run.err
    assert "Traceback" not in run.err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("P1,P9\n1,2\n", "1:1: error: RCSR has no parameter P9"),
        ("P1,P1\n1,2\n", "1:1: error: P1 stands there twice"),
        ("P1,P2\n1,2\n1\n", "3:1: error: this line has 1 cells, not 2"),
        ("P1,P2\n1,2\n1,two\n", "3:1: error: P2 = two"),
        ("P1,P2\n", "1:1: error: there is no variant below the header"),
        ("P3,P2\n1,1\n", "1:1: error: P3 varies in vary:, too"),
    ],
)
def test_bad_tables_are_told_with_their_line(
    mechkin: Any, tmp_path: Path, text: str, said: str
) -> None:
    (tmp_path / "variants.csv").write_text(text)
    data = {"vary": {"P3": [0.4]}, "table": "variants.csv"}
    run = mechkin("study", written(tmp_path, data), "--out", tmp_path / "out")
    assert run.code == 3
    assert f"{tmp_path / 'variants.csv'}:{said}" in run.err


def test_a_study_without_a_mechanism(mechkin: Any, tmp_path: Path) -> None:
    file = tmp_path / "study.yaml"
    file.write_text("study: 1\nvary: {P1: [1]}\n")
    assert "names no mechanism; add mechanism: FILE" in mechkin("study", file).err
    file.write_text("study: 1\nmechanism: nowhere.yaml\nvary: {P1: [1]}\n")
    assert f"{file}:2:12: error:" in mechkin("study", file).err
    assert "there is no file" in mechkin("study", tmp_path / "none.yaml").err


def test_times_as_clocks_have_them() -> None:
    assert [clock(s) for s in (0.4, 59.6, 3599.4, 36000)] == ["0:00", "1:00", "59:59", "10:00:00"]


@pytest.mark.parametrize("option", ["--processes", "--threads"])
@pytest.mark.parametrize("count", ["-1", "1000000"])
def test_a_count_that_is_none_is_refused(
    mechkin: Any, tmp_path: Path, option: str, count: str
) -> None:
    study = written(tmp_path, {"vary": {"P1": [0.5]}, "keep": [{"of": "O4.theta", "as": "max"}]})
    assert mechkin("study", study, "--out", tmp_path / "out").code == 0
    for more in ((), ("--again",)):
        run = mechkin("study", study, "--out", tmp_path / "out", option, count, *more)
        assert (run.code, run.out) == (2, "")
        assert option.removeprefix("--") in run.err
