"""A folder of results: whole at any moment, resumed, and of one study alone."""

import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from references import FILE_OF
from studies.studies import RCSR, study_text

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.studies import study as running

KILLS = int(os.environ.get("MECHKIN_RANDOM", "1")) * 3


@pytest.fixture(scope="module")
def model() -> mk.Model:
    return mk.load(FILE_OF["rcsr"])


@pytest.fixture
def small_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "MOST_IN_PIECE", 8)


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "study.json"}


@pytest.mark.parametrize("file_format", ["csv", "parquet"])
def test_bytes_do_not_depend_on_pieces_or_workers(
    model: mk.Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file_format: str
) -> None:
    if file_format == "parquet":
        pytest.importorskip("pyarrow")
    model.study(RCSR, tmp_path / "whole", format=file_format)
    whole = contents(tmp_path / "whole")
    assert set(whole) == {f"variants.{file_format}", f"rows.{file_format}"}
    for size in (1, 8, 29):
        monkeypatch.setattr(running, "MOST_IN_PIECE", size)
        model.study(RCSR, tmp_path / str(size), format=file_format, threads=2)
        assert contents(tmp_path / str(size)) == whole
    model.study(RCSR, tmp_path / "processes", format=file_format, processes=2)
    assert contents(tmp_path / "processes") == whole


@pytest.mark.usefixtures("small_pieces")
def test_files_have_what_comes_back_as_arrays(model: mk.Model, tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    arrays = model.study(RCSR)
    model.study(RCSR, tmp_path)
    for name, columns in (("variants", {k: arrays[k] for k in arrays}), ("rows", arrays.rows)):
        frame = pandas.read_csv(tmp_path / f"{name}.csv", keep_default_na=False, na_values=[""])
        for label, values in columns.items():
            if values.dtype == object:
                assert frame[label].astype(object).fillna("").tolist() == values.tolist()
            else:
                assert np.array_equal(frame[label], values, equal_nan=True)


@pytest.mark.usefixtures("small_pieces")
def test_others_read_parquet(model: mk.Model, tmp_path: Path) -> None:
    polars = pytest.importorskip("polars")
    duckdb = pytest.importorskip("duckdb")
    pandas = pytest.importorskip("pandas")
    arrays = model.study(RCSR)
    model.study(RCSR, tmp_path, format="parquet")
    file = tmp_path / "variants.parquet"
    label = "peak(O1.effort)"
    assert np.array_equal(pandas.read_parquet(file)[label], arrays[label], equal_nan=True)
    assert polars.read_parquet(file)[label].to_list() == [
        None if np.isnan(value) else value for value in arrays[label].tolist()
    ]
    (counted,) = duckdb.sql(
        f"select count(dead_centre), count(*) from '{file}' where verdict <> 'ok'"
    ).fetchall()
    ended = np.count_nonzero(~np.isnan(arrays["dead_centre"]))
    assert counted == (ended, np.count_nonzero(arrays["verdict"] != "ok"))


@pytest.mark.usefixtures("small_pieces")
def test_what_was_stopped_goes_on(model: mk.Model, tmp_path: Path) -> None:
    model.study(RCSR, tmp_path / "undisturbed")
    seen: list[int] = []

    def stop(done: int, whole: int) -> None:
        seen.append(done)
        if len(seen) == 4:  # the first time before any piece
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        model.study(RCSR, tmp_path / "stopped", progress=stop)
    pieces = sorted((tmp_path / "stopped/pieces").glob("variants-*.csv"))
    assert len(pieces) == 3
    before = [path.stat().st_mtime_ns for path in pieces]
    pieces[1].unlink()
    (tmp_path / "stopped/pieces/rows-000000005.csv.unfinished").write_text("half of")
    again: list[int] = []
    model.study(RCSR, tmp_path / "stopped", progress=lambda done, whole: again.append(done))
    assert again[:2] == [2 * 8, 3 * 8], "pieces that are there are not computed again"
    assert before
    assert contents(tmp_path / "stopped") == contents(tmp_path / "undisturbed")
    # a finished study is not computed again, either
    model.study(RCSR, tmp_path / "stopped", progress=lambda done, whole: pytest.fail("again"))


@pytest.mark.usefixtures("small_pieces")
@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"sample": {"count": 9, "seed": 4}}, "study"),
        ({"sample": {"count": 10, "seed": 3}}, "study, variants"),
        ({"rows": []}, "study"),
    ],
)
def test_another_study_is_refused(
    model: mk.Model, tmp_path: Path, change: dict[str, Any], named: str
) -> None:
    model.study(RCSR, tmp_path)
    with pytest.raises(UsageError, match=f"holds results of another study: different {named};"):
        model.study(RCSR | change, tmp_path)
    kept = contents(tmp_path)
    model.study(RCSR | change, tmp_path, again=True)
    assert contents(tmp_path) != kept


def test_another_mechanism_is_refused(model: mk.Model, tmp_path: Path) -> None:
    model.study(RCSR, tmp_path)
    with pytest.raises(UsageError, match="different parameters; choose"):
        model.with_parameters({"P3": 0.41}).study(RCSR, tmp_path)
    text = model.built.document.text.replace("mass:", "mass:  ", 1)
    other = mk.loads(text, "rcsr.yaml", folder=FILE_OF["rcsr"].parent)
    with pytest.raises(UsageError, match="different mechanism; choose"):
        other.study(RCSR, tmp_path)
    pytest.importorskip("pyarrow")
    with pytest.raises(UsageError, match="different format; choose"):
        model.study(RCSR, tmp_path, format="parquet")


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        *(
            json.dumps({"sources": {}, "piece": piece, "complete": complete})
            for piece, complete in [
                *((piece, True) for piece in (None, "x", [], {}, 0, -1, 1e300, True)),
                *((8, complete) for complete in ("x", -1, 1e300, None)),
            ]
        ),
        json.dumps({"sources": [], "piece": 8, "complete": True}),
    ],
    ids=lambda text: text[:60],
)
def test_a_damaged_record_is_refused(model: mk.Model, tmp_path: Path, text: str) -> None:
    (tmp_path / "study.json").write_text(text)
    with pytest.raises(UsageError, match=r"does not say what the folder holds; .* --again"):
        model.study(RCSR, tmp_path)


@pytest.mark.parametrize("file_format", ["csv", "parquet"])
def test_damaged_results_are_told(model: mk.Model, tmp_path: Path, file_format: str) -> None:
    if file_format == "parquet":
        pytest.importorskip("pyarrow")
    model.study(RCSR, tmp_path, format=file_format)
    path = tmp_path / f"variants.{file_format}"
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(UsageError, match=r"is not as it was written: .*; start over with --again"):
        model.study(RCSR, tmp_path, format=file_format)
    model.study(RCSR, tmp_path, format=file_format, again=True)
    assert path.read_bytes() == whole


def test_a_folder_with_other_files_keeps_them(model: mk.Model, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    model.study(RCSR, tmp_path)
    model.study(RCSR, tmp_path, again=True)
    assert (tmp_path / "notes.txt").read_text() == "mine"
    (tmp_path / "study.json").write_text("{]")
    with pytest.raises(UsageError, match="does not say what the folder holds"):
        model.study(RCSR, tmp_path)


@pytest.mark.usefixtures("small_pieces")
def test_a_full_disk_keeps_what_was_written(
    model: mk.Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model.study(RCSR, tmp_path / "undisturbed")
    real, calls = os.fsync, []

    def fsync(descriptor: int) -> None:
        calls.append(descriptor)
        if len(calls) == 6:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        real(descriptor)

    monkeypatch.setattr(os, "fsync", fsync)
    with pytest.raises(UsageError, match="the disk is full; free some space; the variants comp"):
        model.study(RCSR, tmp_path / "full")
    assert not list((tmp_path / "full").rglob("*.unfinished"))
    monkeypatch.undo()
    model.study(RCSR, tmp_path / "full")
    assert contents(tmp_path / "full") == contents(tmp_path / "undisturbed")


def command(study: Path, out: Path, *more: str) -> list[str]:
    code = (
        "import sys; from mechkin_cli.studies import study; study.MOST_IN_PIECE = 4; "
        "from mechkin_cli.__main__ import main; sys.exit(main())"
    )
    words = ["study", str(study), "--out", str(out), "--quiet", *more]
    # -P: the installed package, not the source folder that the tests may be started in
    return [sys.executable, "-P", "-c", code, *words]


@pytest.mark.parametrize("processes", ["0", "2"])
def test_killed_at_any_moment_it_goes_on(tmp_path: Path, processes: str) -> None:
    study = tmp_path / "study.yaml"
    study.write_text(study_text(RCSR | {"sample": {"count": 12}}, FILE_OF["rcsr"]))
    begin = time.perf_counter()
    subprocess.run(command(study, tmp_path / "whole"), check=False, capture_output=True)
    seconds = time.perf_counter() - begin
    expected = contents(tmp_path / "whole")
    generator = np.random.default_rng(1)
    stopped = 0
    for kill in range(KILLS):
        folder = tmp_path / f"killed {kill}"
        more = ("--processes", processes) if processes != "0" else ()
        for _ in range(2):
            with subprocess.Popen(
                command(study, folder, *more), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            ) as running:
                time.sleep(seconds * generator.uniform(0.3, 1.0))
                stopped += running.poll() is None
                running.send_signal(signal.SIGKILL)
        left = subprocess.run(command(study, folder), check=False, capture_output=True, text=True)
        assert left.returncode == 4, left.stderr  # some variants meet a dead centre
        assert contents(folder) == expected
        assert json.loads((folder / "study.json").read_text())["complete"]
    assert stopped


def test_two_cannot_write_to_one_folder(model: mk.Model, tmp_path: Path) -> None:
    from mechkin_cli.tables.folder import Claim

    claim = Claim(tmp_path / "out")
    try:
        if not claim.locked:
            pytest.skip("this file system has no locks")
        with pytest.raises(UsageError, match="another run of mechkin is writing to"):
            model.study(RCSR, tmp_path / "out")
    finally:
        claim.release()
