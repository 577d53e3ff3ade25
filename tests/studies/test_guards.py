"""What a study spares and refuses: files that are not its own, names that are none, values of
`set:`; and what is left when a signal ends it."""

import csv
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from references import FILE_OF
from studies.studies import RCSR, study_text

import mechkin_cli as mk
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.studies import formats

KEEP = [{"of": "O1.effort", "as": "peak"}]
SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP") if "MECHKIN_RANDOM" in os.environ else ("SIGTERM",)


@pytest.fixture(scope="module")
def model() -> mk.Model:
    return mk.load(FILE_OF["rcsr"])


def mechkin(*words: object) -> subprocess.CompletedProcess[str]:
    call = [sys.executable, "-P", "-m", "mechkin_cli", *map(str, words)]
    return subprocess.run(call, check=False, capture_output=True, text=True)


def test_a_table_that_is_read_is_not_replaced_by_the_results(tmp_path: Path) -> None:
    table = tmp_path / "variants.csv"
    table.write_text("P1\n0.48\n0.5\n")
    (tmp_path / "study.yaml").write_text(
        study_text({"table": "variants.csv", "keep": KEEP}, FILE_OF["rcsr"])
    )
    for more in ((), ("--again",)):
        found = mechkin("study", tmp_path / "study.yaml", "--out", tmp_path, *more)
        assert found.returncode == 2
        assert "variants.csv is read by the study and would be replaced" in found.stderr
    assert table.read_text() == "P1\n0.48\n0.5\n"
    assert not (tmp_path / "study.json").exists()


@pytest.mark.parametrize("name", ["variants.csv", "rows.csv"])
def test_a_file_that_no_study_wrote_stays(model: mk.Model, tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("mine")
    with pytest.raises(UsageError, match=rf"{name} is there already, .*; choose another folder"):
        model.study(RCSR, tmp_path)
    assert (tmp_path / name).read_text() == "mine"
    model.study(RCSR, tmp_path, again=True)
    assert (tmp_path / name).read_text() != "mine"


def test_files_are_read_a_stretch_at_a_time(
    model: mk.Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for kind in ("csv", "parquet"):
        if kind == "parquet":
            pytest.importorskip("pyarrow")
        whole = model.study(RCSR, tmp_path / kind, format=kind).overview
        monkeypatch.setattr(formats, "LINES_AT_ONCE", 7)
        held: list[int] = []
        own = formats.format_of(kind)
        headings = [formats.Heading("variant", kind="whole"), *_headings(tmp_path / kind, kind)]
        for records in own.read(tmp_path / kind / f"variants.{kind}", headings):
            held.append(len(records["variant"]))
        assert max(held) == 7
        assert sum(held) == whole.variants
        assert model.study(RCSR, tmp_path / kind, format=kind).overview.verdicts == whole.verdicts
        monkeypatch.undo()


def _headings(folder: Path, kind: str) -> list[formats.Heading]:
    import json

    tables = json.loads((folder / "study.json").read_text())["tables"]["variants"]
    return [formats.Heading(**one) for one in tables if one["label"] != "variant"]


def test_set_counts_in_python_as_in_the_file(model: mk.Model, tmp_path: Path) -> None:
    data: dict[str, Any] = {"vary": {"P1": [0.48, 0.5]}, "keep": KEEP}
    label = "peak(O1.effort)"
    other = model.with_parameters({"P3": "0.99 in"}).study(data)[label]
    given = data | {"set": {"P3": "0.99 in"}}
    assert model.study(given)[label].tobytes() == other.tobytes()
    assert model.study(data)[label].tobytes() != other.tobytes()
    (tmp_path / "study.yaml").write_text(study_text(given, FILE_OF["rcsr"]))
    assert mechkin("study", tmp_path / "study.yaml", "--out", tmp_path / "out").returncode == 0
    lines = list(csv.DictReader((tmp_path / "out/variants.csv").open()))
    assert [float(line[label]) for line in lines] == pytest.approx(other.tolist(), rel=1e-12)
    # neither file nor data say a name that is none, or a value of another kind
    for bad in ({"none": 1}, {"P3": "1 s"}, {"P3": "O1.theta"}, {"P3": "2*("}):
        with pytest.raises(InvalidFile) as refused:
            model.study(data | {"set": bad})
        assert str(refused.value).startswith(f"study at set.{next(iter(bad))}: error: ")
        if bad in ({"P3": "1 s"}, {"P3": "2*("}):
            continue
        text = study_text(data | {"set": bad}, FILE_OF["rcsr"])
        (tmp_path / "bad.yaml").write_text(text)
        line = text[: text.index('"set"')].count("\n") + 2
        found = mechkin("study", tmp_path / "bad.yaml", "--dry-run")
        assert (found.returncode, f"bad.yaml:{line}:" in found.stderr) == (3, True), found.stderr


@pytest.mark.parametrize("words", [("study", "s.yaml"), ("analyze", "m.yaml"), ("bench",)])
def test_a_folder_has_a_name(words: tuple[str, ...]) -> None:
    found = mechkin(*words, "--out", "")
    assert (found.returncode, found.stdout) == (2, "")
    assert (
        found.stderr == "mechkin: --out has no name; write a folder behind it, as --out results\n"
    )


@pytest.mark.parametrize("address", ["", "here", "host:", "tcp://host", "tcp://a b:1", "a:1:2"])
def test_what_is_no_address_is_told_at_once(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without looking for a scheduler there."""
    distributed = pytest.importorskip("distributed")
    from mechkin_cli.studies.workers import cluster

    monkeypatch.setattr(distributed, "Client", lambda *_, **__: pytest.fail("it is asked"))
    with pytest.raises(UsageError, match=r"expected an address such as tcp://host:8786"):
        cluster(address, str).__enter__()


@pytest.mark.parametrize("name", SIGNALS)
def test_a_signal_ends_processes_quietly(tmp_path: Path, name: str) -> None:
    if not hasattr(signal, name):
        pytest.skip("no such signal here")
    data = RCSR | {"sample": {"count": 12_000}}
    (tmp_path / "study.yaml").write_text(study_text(data, FILE_OF["rcsr"]))
    words = ("study", tmp_path / "study.yaml", "--out", tmp_path / "out", "--processes", "2")
    call = [sys.executable, "-P", "-m", "mechkin_cli", *map(str, words)]
    with subprocess.Popen(
        call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as running:
        begun = time.monotonic()
        while not list(tmp_path.glob("out/pieces/variants-*.csv")):
            assert running.poll() is None
            assert time.monotonic() - begun < 120.0
            time.sleep(0.02)
        running.send_signal(getattr(signal, name))
        # ends of pipes are there when every process that writes to them has ended
        out, err = running.communicate(timeout=60)
    assert (running.returncode, out) == (130, "")
    assert err == (
        "mechkin: interrupted; files written so far are whole, and the same command goes on with "
        "them\n"
    )


def test_a_value_that_counts_nowhere_is_told(model: mk.Model, tmp_path: Path) -> None:
    def notes(vary: object) -> list[str]:
        study = {"set": {"P1": "0.5 in"}, "vary": {"P1": vary}, "keep": KEEP}
        study |= {"sample": {"count": 2}} if isinstance(vary, dict) else {}
        return [str(n) for n in model.study(study, tmp_path / repr(len(str(vary)))).diagnostics]

    (told,) = notes([0.4, 0.6])
    assert "P1 is varied, so what set: gives it counts in no variant" in told
    assert not notes({"tolerance": "0.01 in"})  # about the value that is set


def test_a_tolerance_is_positive(model: mk.Model, tmp_path: Path) -> None:
    study = {"vary": {"P1": {"tolerance": "-0.01 in"}}, "sample": {"count": 2}, "keep": KEEP}
    with pytest.raises(InvalidFile, match=r"the tolerance -0.01 in is not larger than 0"):
        model.study(study, tmp_path / "out")
