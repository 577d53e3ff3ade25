"""Shares of a study: merged they have the bytes of the whole, whatever their number, their order
and what stopped them; what does not make the whole is named."""

import json
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from documents.reading import blocks, page
from references import FILE_OF
from studies.studies import RCSR, study_text
from studies.test_folders import command

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.studies import folder as files, study as running

RANDOM = int(os.environ.get("MECHKIN_RANDOM", "1"))
STUDY = {k: v for k, v in RCSR.items() if k != "dead_centres"} | {"sample": {"count": 3, "seed": 3}}
"""Of 21 variants, in pieces of four."""

FEW = STUDY | {"sample": {"count": 1, "seed": 3}}
"""Seven variants."""


@pytest.fixture(scope="module")
def model() -> mk.Model:
    return mk.load(FILE_OF["rcsr"])


@pytest.fixture(autouse=True)
def small_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "MOST_IN_PIECE", 4)


def contents(folder: Path) -> dict[str, bytes]:
    """All files, the manifest too; folders have no bytes."""
    return {p.name: p.read_bytes() if p.is_file() else b"" for p in folder.iterdir()}


@pytest.mark.parametrize(
    ("data", "count", "file_format"),
    [
        *((STUDY, count, "csv") for count in (1, 2, 5)),
        (STUDY, 3, "parquet"),
        *((FEW, count, file_format) for count in (7, 11) for file_format in ("csv", "parquet")),
    ],
    ids=lambda value: "" if isinstance(value, dict) else str(value),
)
def test_merged_shares_are_the_whole(
    model: mk.Model, tmp_path: Path, data: dict[str, Any], count: int, file_format: str
) -> None:
    if file_format == "parquet":
        pytest.importorskip("pyarrow")
    whole = model.study(data, tmp_path / "whole", format=file_format)
    lines = []
    for number in np.random.default_rng(count).permutation(count).tolist():
        share = model.study(
            data, tmp_path / "parts", format=file_format, part=f"{number + 1}/{count}"
        )
        lines.append(share.overview.variants)
    assert sum(lines) == whole.overview.variants
    assert max(lines) - min(lines) <= 1, "shares are of one size"
    merged = model.study(data, tmp_path / "parts", format=file_format, merge=True)
    assert contents(tmp_path / "parts") == contents(tmp_path / "whole"), "and no share is left"
    # repr: numbers that are nan
    assert repr(merged.overview) == repr(whole.overview)
    # once more nothing is left to do
    model.study(data, tmp_path / "parts", format=file_format, merge=True)
    assert contents(tmp_path / "parts") == contents(tmp_path / "whole")


def test_stopped_at_any_write_shares_and_merge_go_on(
    model: mk.Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process may end before, in or after each of its writes and removals."""
    model.study(STUDY, tmp_path / "whole")
    generator = np.random.default_rng(5)
    real_write, real_clear = files._write_whole, files.StudyFolder.clear
    left = 0

    def may_stop(real: Callable[..., None]) -> Callable[..., None]:
        def stopping(*given: Any) -> None:
            nonlocal left
            left -= 1
            if left == 0 and generator.random() < 0.5:
                raise KeyboardInterrupt
            real(*given)
            if left == 0:
                raise KeyboardInterrupt

        return stopping

    monkeypatch.setattr(files, "_write_whole", may_stop(real_write))
    monkeypatch.setattr(files.StudyFolder, "clear", may_stop(real_clear))
    for case in range(2 * RANDOM):
        count = int(generator.integers(1, 5))
        folder = tmp_path / str(case)
        jobs: list[dict[str, Any]] = [{"part": f"{n}/{count}"} for n in range(1, count + 1)]
        generator.shuffle(jobs)  # type: ignore[arg-type]
        stops = 0
        for job in (*jobs, {"merge": True}):
            for attempt in range(100):
                left = 0 if attempt == 3 else int(generator.integers(1, 12))
                try:
                    model.study(STUDY, folder, **job)
                    break
                except KeyboardInterrupt:
                    stops += 1
        assert stops
        assert contents(folder) == contents(tmp_path / "whole")


def test_killed_at_any_moment_a_share_goes_on(tmp_path: Path) -> None:
    study = tmp_path / "study.yaml"
    study.write_text(study_text(STUDY, FILE_OF["rcsr"]))
    subprocess.run(command(study, tmp_path / "whole"), check=False, capture_output=True)
    generator = np.random.default_rng(2)
    for kill in range(RANDOM):
        parts = tmp_path / str(kill)
        for part in ("--part 1/1", "--merge"):
            words = command(study, parts, *part.split())
            with subprocess.Popen(words, stderr=subprocess.DEVNULL) as process:
                until = time.monotonic() + 60.0
                # whole pieces of the share, or the merge's own folder of them
                begun = parts / ("part-1-of-1/pieces/*.csv" if "1/1" in part else "pieces")
                while process.poll() is None and time.monotonic() < until:
                    if list(begun.parent.glob(begun.name)):
                        break
                    time.sleep(0.001)
                time.sleep(generator.uniform(0.0, 0.05))
                process.send_signal(signal.SIGKILL)
            done = subprocess.run(words, check=False, capture_output=True, text=True)
            assert done.returncode in (0, 4), done.stderr
        assert contents(parts) == contents(tmp_path / "whole")


def damaged(folder: Path, what: str) -> None:
    """What may become of the fourth of four shares."""
    part, other = folder / "part-4-of-4", folder / "part-3-of-4"
    record = json.loads((part / "study.json").read_text())
    if what == "missing":
        shutil.rmtree(part)
    elif what == "copied twice":
        shutil.rmtree(part)
        shutil.copytree(other, part)
    elif what == "cut off":
        os.truncate(part / "rows.csv", 100)
    elif what == "changed":
        text = (part / "variants.csv").read_text()
        (part / "variants.csv").write_text(text.replace("1", "2", 1))
    elif what == "without a result":
        (part / "rows.csv").unlink()
    elif what == "unfinished":
        (part / "study.json").write_text(json.dumps(record | {"complete": False}))
    elif what == "of another version":
        record["sources"]["version"] = "0.0.1"
        (part / "study.json").write_text(json.dumps(record))
    elif what == "no record":
        (part / "study.json").write_text("{]")
    elif what == "divided otherwise":
        shutil.copytree(part, folder / "part-4-of-5")


@pytest.mark.parametrize(
    ("what", "named"),
    [
        ("missing", r"parts 4 of 4 are missing; run --part I/4 for I = 4"),
        ("copied twice", "part 4/4 is part 3/4 by what its study.json says"),
        ("cut off", "part 4/4 is damaged"),
        ("changed", "part 4/4 is damaged"),
        ("without a result", "part 4/4 is not finished"),
        ("unfinished", "part 4/4 is not finished"),
        ("of another version", r"part 4/4 is of another study \(different version\)"),
        ("no record", "part 4/4 cannot be used"),
        ("divided otherwise", "divided into 4 and into 5"),
    ],
)
def test_what_is_not_the_whole_is_named(
    model: mk.Model, tmp_path: Path, what: str, named: str
) -> None:
    for number in range(1, 5):
        model.study(FEW, tmp_path, part=f"{number}/4")
    damaged(tmp_path, what)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(UsageError, match=named):
        model.study(FEW, tmp_path, merge=True)
    assert sorted(tmp_path.rglob("*")) == before, "nothing is written, nothing is lost"


def test_shares_of_another_study_or_mechanism_are_named(model: mk.Model, tmp_path: Path) -> None:
    model.study(FEW, tmp_path, part="1/3")
    model.study(FEW | {"rows": []}, tmp_path, part="2/3")
    text = model.built.document.text.replace("mass:", "mass:  ", 1)
    other = mk.loads(text, "rcsr.yaml", folder=FILE_OF["rcsr"].parent)
    other.study(FEW, tmp_path, part="3/3")
    with pytest.raises(UsageError) as refused:
        model.study(FEW, tmp_path, merge=True)
    assert "part 2/3 is of another study (different study)" in str(refused.value)
    assert "part 3/3 is of another study (different mechanism)" in str(refused.value)
    assert "for I = 2-3" in str(refused.value)


@pytest.mark.parametrize(
    "text", ["", "3", "0/4", "5/4", "1/0", "-1/4", "1/4/2", "a/b", "1/9999999"]
)
def test_what_is_no_share_is_refused(model: mk.Model, tmp_path: Path, text: str) -> None:
    with pytest.raises(UsageError, match="part"):
        model.study(FEW, tmp_path / "out", part=text)
    assert not (tmp_path / "out").exists()


def test_a_share_needs_a_folder(model: mk.Model, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="out="):
        model.study(FEW, part="1/2")
    with pytest.raises(UsageError, match="leave part out"):
        model.study(FEW, tmp_path, part="1/2", merge=True)
    with pytest.raises(UsageError, match="no parts to merge"):
        model.study(FEW, tmp_path, merge=True)


def test_scripts_of_the_page_name_their_shares(tmp_path: Path) -> None:
    """What a job of each array runs, by a `mechkin` that only says its words."""
    stub = tmp_path / "mechkin"
    stub.write_text('#!/bin/sh\necho "$*"\n')
    stub.chmod(0o755)
    scripts = [text for text in blocks(page("docs/studies.md"), "sh") if "#!/bin/sh" in text]
    assert len(scripts) == 2
    environment = {
        "PATH": f"{tmp_path}:{os.environ['PATH']}",
        "SLURM_CPUS_PER_TASK": "4",
        "SLURM_ARRAY_TASK_ID": "7",
        "SLURM_ARRAY_TASK_COUNT": "100",
        "PBS_ARRAY_INDEX": "7",
        "PBS_O_WORKDIR": str(tmp_path),
    }
    for text in scripts:
        done = subprocess.run(
            ["sh", "-e"], input=text, env=environment, capture_output=True, text=True, check=True
        )
        assert "study study.yaml --out results --threads 4 --part 7/100" in done.stdout
