"""Variants of which a row stands at a dead centre: the same in files, arrays, `vary` and by itself.

A slider-crank that its slider drives from the upright crank, sqrt(l^2 - r^2) away, to 40 mm
further: it lies in line at l + r, which rods of 50 mm and cranks of 30 mm reach in the last row;
shorter cranks reach it before, longer ones not at all.
"""

from __future__ import annotations

import csv
from math import sqrt
from pathlib import Path

import numpy as np
import pytest
from pump import pump
from studies.studies import study_text
from typer.testing import CliRunner

import mechkin_cli as mk
from mechkin_cli.cli.app import app

TEXT = pump("3 N*m")
CRANKS = [28.0, 30.0, 32.0]
WORDS = ["max", "min", "peak", "range", "mean", "rms", "place_of_max", "place_of_peak"]
STUDY = {
    "vary": {"r": [f"{r} mm" for r in CRANKS]},
    "keep": [
        {"of": "D.effort", "as": WORDS},
        {"of": "D.effort", "as": "value", "at": "40 mm", "label": "last"},
    ],
    "rows": ["D.effort"],
    "dead_centres": "place",
}


def ends(r: float) -> float:
    return 50.0 + r - sqrt(50.0**2 - r**2)


def test_arrays_say_what_is_infinite_where_and_why() -> None:
    model = mk.loads(TEXT)
    found = model.study(STUDY)
    assert ends(30.0) == 40.0
    assert found["verdict"].tolist() == ["beyond-dead-centre", "dead-centre", "ok"]
    assert found["message"].tolist() == [
        "row 5 (D.s = 40 mm): this branch ends at a dead centre before this row",
        "row 5 (D.s = 40 mm): stands at a dead centre; infinite: D.effort in row 5",
        "",
    ]
    np.testing.assert_allclose(found["dead_centre"], [ends(28.0), 40.0, np.nan], rtol=1e-9)
    for word in ("max", "peak", "range"):
        assert np.isinf(found[f"{word}(D.effort)"]).tolist() == [False, True, False]
    for word in ("place_of_max", "place_of_peak"):
        assert found[f"{word}(D.effort)"][1] == 40.0
    assert np.isfinite(found["mean(D.effort)"]).all()
    assert found["last"].tolist()[:2] == pytest.approx([np.nan, np.inf], nan_ok=True)


def test_the_same_as_varied_and_alone() -> None:
    model = mk.loads(TEXT)
    found = model.study(STUDY)
    words = WORDS[:6]
    varied = model.vary({"r": CRANKS}, ["D.effort"], reduce=words)
    for number, word in enumerate(words):
        own = found[f"{word}(D.effort)"]
        np.testing.assert_array_equal(own, varied["D.effort"][:, number])
    for number, r in enumerate(CRANKS):
        alone = model.with_parameters({"r": r}).analyze(["D.effort"])
        below = alone.summary("D.effort")
        assert (found["max(D.effort)"][number], found["place_of_max(D.effort)"][number]) == (
            below.max
        )
        assert found["rms(D.effort)"][number] == below.rms
        assert varied.complete[number] == alone.complete
        assert found["verdict"][number] in {"ok", *alone["row.status"]}


def test_renamed_in_metres_and_with_rows_twice() -> None:
    own = mk.loads(TEXT).study(STUDY)
    other = TEXT.replace("D.", "slide.").replace("D:", "slide:").replace("length: mm", "length: m")
    rows = "0 mm, 10 mm, 20 mm, 30 mm, 40 mm"
    other = other.replace(rows, ", ".join(one for one in rows.split(", ") for _ in range(2)))
    keep = [{"of": "slide.effort", "as": WORDS}]
    found = mk.loads(other).study({**STUDY, "keep": keep, "rows": ["slide.effort"]})
    assert found["message"][1] == (
        "row 9 (slide.s = 0.04 m): stands at a dead centre; infinite: slide.effort in row 9"
    )
    np.testing.assert_allclose(found["dead_centre"], own["dead_centre"] / 1e3, rtol=1e-9)
    for word in WORDS[:6]:
        np.testing.assert_allclose(
            found[f"{word}(slide.effort)"], own[f"{word}(D.effort)"], rtol=1e-9
        )


def test_the_files_say_it_too(tmp_path: Path) -> None:
    (tmp_path / "pump.yaml").write_text(TEXT, encoding="utf-8")
    (tmp_path / "s.yaml").write_text(study_text(STUDY, tmp_path / "pump.yaml"), encoding="utf-8")
    parquet = pytest.importorskip("pyarrow.parquet")
    for name in ("csv", "parquet"):
        out = str(tmp_path / name)
        run = CliRunner().invoke(
            app, ["study", str(tmp_path / "s.yaml"), "--out", out, "--format", name]
        )
        assert run.exit_code == 4, run.output
    with (tmp_path / "csv" / "variants.csv").open(encoding="utf-8", newline="") as file:
        line = list(csv.DictReader(file))[1]
    assert line["max(D.effort)"] == line["peak(D.effort)"] == line["last"] == "inf"
    assert line["place_of_peak(D.effort)"] == line["dead_centre"] == "40"
    assert "stands at a dead centre" in line["message"]
    with (tmp_path / "csv" / "rows.csv").open(encoding="utf-8", newline="") as file:
        assert [row["D.effort"] for row in csv.DictReader(file)][9] == "inf"
    table = parquet.read_table(tmp_path / "parquet" / "variants.parquet").to_pylist()
    assert table[1]["max(D.effort)"] == table[1]["last"] == np.inf
    assert table[0]["last"] is None
    assert table[1]["message"] == line["message"]
