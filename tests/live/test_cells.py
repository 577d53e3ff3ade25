"""A page's tables are those of Python, with the file's parameters and with others, bit for bit.

The page's program runs in node with the WebAssembly module that the page holds; Python's side is
`Model.with_parameters(...).analyze()`, which the native kernel computes. `MECHKIN_RANDOM` tries all
kept mechanisms that have parameters, so many variants of each.
"""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
import sys
from math import acos, degrees
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from references import FILE_OF

from mechkin_cli import load, loads
from mechkin_cli.tables import Words, rows_table
from mechkin_cli.verdict import SWEEP
from mechkin_cli.view.page import script_json
from mechkin_cli.view.scene import page_data

HERE = Path(__file__).resolve().parent
KERNEL = HERE.parent.parent / "mechkin_cli" / "kernel" / "wasm"
NODE = shutil.which("node")
RANDOM = int(os.environ.get("MECHKIN_RANDOM", "0"))
FEW = ("planar_four_bar", "rcsr", "planetary_gear", "swash_plate", "double_wishbone")

pytestmark = pytest.mark.skipif(NODE is None, reason="needs node")


def live_stems() -> list[str]:
    if not RANDOM:
        return [*FEW]
    return [stem for stem, file in FILE_OF.items() if "\nparameters:" in Path(file).read_text()]


def computed(data: dict[str, Any], cases: list[dict[str, float]]) -> list[dict[str, Any]]:
    """What the page's program makes of some parameters in the file's units."""
    given = json.dumps({"data": json.loads(script_json(data)), "cases": cases})
    command = [str(NODE), str(HERE / "compute.mjs"), str(KERNEL / "mechkin.wasm.gz")]
    done = subprocess.run(command, input=given, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


def test_cells_are_those_of_the_command() -> None:
    checked = 0
    for stem in live_stems():
        model = load(FILE_OF[stem])
        if SWEEP not in model.runs:
            continue
        analysis = model.analyze()
        data, _ = page_data([analysis], modes=False)
        live = data.get("live")
        if live is None:
            assert stem not in FEW
            continue
        random = np.random.default_rng(0)
        own = {one["name"]: one["value"] for one in live["parameters"]}
        cases: list[dict[str, float]] = [{}]
        for _ in range(RANDOM or 1):
            factors = 1.0 + 0.01 * random.standard_normal(len(own))
            cases.append(dict(zip(own, factors * list(own.values()), strict=True)))
        for case, found in zip(cases, computed(data, cases), strict=True):
            if found["end"] != "complete":
                assert case, f"{stem}: {found['words']}"
                continue
            wanted = model.with_parameters(case).analyze() if case else analysis
            checked += compared(stem, live, found, wanted)
    assert checked > 100


def compared(stem: str, live: dict[str, Any], found: dict[str, Any], wanted: Any) -> int:
    """Compares all cells that the page computes; how many columns there were."""
    texts = {table["name"]: table["rows"] for table in found["tables"]}
    values = {(one["table"], one["label"]): one for one in found["columns"]}
    checked = 0
    for record in live["tables"]:
        table = wanted.tables[record["name"]]
        rows = table.listing.rows
        for at, (column, own) in enumerate(zip(record["columns"], table.columns, strict=True)):
            if column is None:
                continue
            where = f"{stem}: {record['name']}: {own.label}"
            assert [row[at] for row in texts[record["name"]]] == [row[at] for row in rows], where
            one = values.get((record["name"], own.label))
            if one is not None and not isinstance(own.values, Words):
                numbers = np.frombuffer(base64.b64decode(one["values"]))
                assert np.array_equal(numbers, own.values, equal_nan=True), where
                # what the page leaves out has a part in it
                assert one["rounding"] == own.rounding or None in record["columns"], where
            checked += 1
    verdicts = rows_table(wanted.result)
    kept = [at for at, column in enumerate(verdicts.columns) if column.label != "mode"]
    theirs = [[row[at] for at in kept] for row in verdicts.listing.rows]
    assert [[row[at] for at in kept] for row in texts["rows"]] == theirs, stem
    return checked


POWER = """
tables:
  - name: balance
    columns: [O.theta, row.power_error, 1000*row.power_error]
"""


def test_the_power_error_needs_no_other_column_of_forces() -> None:
    text = Path(FILE_OF["planar_four_bar"]).read_text(encoding="utf-8")
    model = loads(text.partition("tables:")[0] + POWER)
    analysis = model.analyze()
    data, _ = page_data([analysis], modes=False)
    case = {"a": 41.0, "c": 92.5}
    own, changed = computed(data, [{}, case])
    varied = model.with_parameters(case).analyze()
    assert compared("balance", data["live"], own, analysis) == 3
    assert compared("balance", data["live"], changed, varied) == 3
    errors = varied.tables["balance"].columns[1].values
    assert 0.0 < errors.max() < 1e-12


def test_a_branch_that_ends_says_how_far_it_goes() -> None:
    # by Grashof's condition: 88 + 130 > 120 + 90, so that the crank cannot turn fully
    analysis = load(FILE_OF["planar_four_bar"]).analyze()
    data, _ = page_data([analysis], modes=False)
    own = {one["name"]: one["value"] for one in data["live"]["parameters"]}
    (found,) = computed(data, [{"a": 2.2 * own["a"]}])
    assert found["end"] == "incomplete"
    # there coupler and rocker lie in one line
    stretched = degrees(acos((88.0**2 + 130.0**2 - 210.0**2) / (2.0 * 88.0 * 130.0)))
    assert found["words"] == f"stops at a dead centre, O.theta = {stretched:.6g} deg"
    cells = next(table for table in found["tables"] if table["name"] == "rows")["rows"]
    solved = ["beyond-dead-centre" not in row for row in cells]
    assert True in solved
    assert False in solved


def test_the_module_is_of_these_sources() -> None:
    command = [sys.executable, str(KERNEL / "build.py"), "--check", "--quick"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
