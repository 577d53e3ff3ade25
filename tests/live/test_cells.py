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
from live.slider_crank import slider_crank
from references import FILE_OF

from mechkin_cli import Model, load, loads
from mechkin_cli.live.numbers import with_numbers
from mechkin_cli.live.record import MOST_PARAMETERS
from mechkin_cli.tables import Words, rows_table
from mechkin_cli.verdict import SWEEP
from mechkin_cli.view.page import script_json
from mechkin_cli.view.scene import page_data

HERE = Path(__file__).resolve().parent
KERNEL = HERE.parent.parent / "mechkin_cli" / "kernel" / "wasm"
NODE = shutil.which("node")
RANDOM = int(os.environ.get("MECHKIN_RANDOM", "0"))
FEW = (
    "planar_four_bar",
    "rcsr",
    "planetary_gear",
    "swash_plate",
    "double_wishbone",
    "rcsr_response",
)

pytestmark = pytest.mark.skipif(NODE is None, reason="needs node")


def live_stems() -> list[str]:
    if not RANDOM:
        return [*FEW]
    return [stem for stem, file in FILE_OF.items() if "\nparameters:" in Path(file).read_text()]


def computed(
    data: dict[str, Any], cases: list[dict[str, float]], mode: str | None = None
) -> list[dict[str, Any]]:
    """What the page's program makes of some parameters in the file's units, with another assembly
    mode shown."""
    shown = None if mode is None else {"run": SWEEP, "name": mode}
    given = json.dumps({"data": json.loads(script_json(data)), "cases": cases, "shown": shown})
    command = [str(NODE), str(HERE / "compute.mjs"), str(KERNEL / "mechkin.wasm.gz")]
    done = subprocess.run(command, input=given, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


def test_cells_are_those_of_the_command() -> None:
    checked = 0
    for stem in live_stems():
        model = load(FILE_OF[stem])
        checked += sum(checked_run(stem, model, run) for run in model.runs)
    assert checked > 100


@pytest.mark.parametrize("run", ["swing", "until", "off"])
def test_responses_are_those_of_the_command(run: str) -> None:
    """A spring and an effort that go by parameters, a stop between two rows, a start that moves."""
    assert checked_run(run, loads(slider_crank(run)), run, spread=0.1) > 10


def checked_run(
    stem: str, model: Model, run: str, spread: float = 0.01, variants: int = RANDOM or 1
) -> int:
    """Compares the file's own run and random variants; how many columns there were."""

    def ran(of: Model) -> Any:
        return of.analyze() if run == SWEEP else of.respond(run)

    analysis = ran(model)
    own_verdicts = verdict_texts(analysis)
    data, _ = page_data([analysis], modes=False)
    live = data.get("live")
    if live is None:
        assert stem not in FEW
        assert data["still"][0]["why"]
        return 0
    random, checked = np.random.default_rng(0), 0
    own = {one["name"]: one["value"] for one in live["parameters"]}
    cases: list[dict[str, float]] = [{}]
    for _ in range(variants):
        factors = 1.0 + spread * random.standard_normal(len(own))
        cases.append(dict(zip(own, factors * list(own.values()), strict=True)))
    for case, found in zip(cases, computed(data, cases), strict=True):
        if found["end"] != "complete" and not (live["ends_early"] and found["tables"]):
            assert case, f"{stem}: {found['words']}"
            continue
        wanted = ran(with_values(model, case)) if case else analysis
        verdicts = verdict_texts(wanted) if case else own_verdicts
        checked += compared(stem, live, found, wanted, verdicts)
    return checked


def with_values(model: Model, values: dict[str, float]) -> Any:
    """The mechanism with a page's values, which may be those of numbers that are no parameters."""
    if set(values) <= set(model.parameters):
        return model.with_parameters(values) if values else model
    lifted = with_numbers(model.design, MOST_PARAMETERS)
    assert lifted is not None
    names = {one.name: parameter for parameter, one in lifted.numbers.items()}
    given = {names[name]: value for name, value in values.items()}
    return model.of(lifted.design).with_parameters(given)


def verdict_texts(analysis: Any) -> dict[str, list[str]]:
    """The table of rows and verdicts as the command writes it, by column. It is to be read before
    a page is made of the run, whose arrows may read forces that no table has."""
    for table in analysis.tables:
        assert table.listing
    table = rows_table(analysis.result, analysis.run)
    labels = [one.label for one in table.columns]
    return dict(zip(labels, map(list, zip(*table.listing.rows, strict=True)), strict=True))


def compared(
    stem: str,
    live: dict[str, Any],
    found: dict[str, Any],
    wanted: Any,
    verdicts: dict[str, list[str]] | None = None,
) -> int:
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
    name = rows_table(wanted.result, wanted.run).name
    left = {one["label"] for one in live["left"] if one["table"] == name}
    assert left <= {"mode", "proof"}
    columns = zip(*texts[name], strict=True)
    for mine, (label, theirs) in zip(
        columns, (verdicts or verdict_texts(wanted)).items(), strict=True
    ):
        wanted_texts = [""] * len(theirs) if label in left else theirs
        assert list(mine) == wanted_texts, f"{stem}: {label}"
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


WORDS = """
tables:
  - name: words
    columns: [O.theta, row.mode, row.proof, row.status]
"""


def test_a_letter_that_dimensions_may_change_is_not_written() -> None:
    """Of two modes A is the one with the smaller angles: longer parts exchange them."""
    model = load(FILE_OF["rssr"])
    assert model.analyze().result.mode == "A"
    # found among variants by chance
    case = {"r": 29.46, "x": 170.0, "y": 154.0, "z": 70.55, "d": 161.1, "tilt": 15.87, "m": 0.467}
    assert model.with_parameters(case).analyze().result.mode == "B"
    data, _ = page_data([model.analyze()], modes=False)
    (found,) = computed(data, [case])
    assert found["end"] == "complete"
    cells = next(table for table in found["tables"] if table["name"] == "rows")
    at = [one["label"] for one in data["tables"][-1]["columns"]].index("mode")
    assert {row[at] for row in cells["rows"]} == {""}
    assert cells["why"][at] == "only a search of all assembly modes tells the letter of one"


def test_letters_and_proofs_are_left_to_the_command_in_tables_of_the_file() -> None:
    text = Path(FILE_OF["planar_four_bar"]).read_text(encoding="utf-8")
    model = loads(text.partition("tables:")[0] + WORDS)
    data, _ = page_data([model.analyze()], modes=False)
    (found,) = computed(data, [{"a": 41.0}])
    assert [found["tables"][0]["rows"][0][at] for at in (1, 2, 3)] == ["", "", "ok"]
    left = {(one["table"], one["label"]): one["why"] for one in data["live"]["left"]}
    proofs = [left[table, label] for table, label in (("rows", "proof"), ("words", "row.proof"))]
    assert proofs == ["it is proven in intervals"] * 2
    assert ("rows", "mode") in left
    assert ("words", "row.mode") in left


@pytest.mark.parametrize("stem", ["planetary_gear", "lecture_section5_spherical"])
def test_the_only_assembly_keeps_its_letter(stem: str) -> None:
    """No loop, or one that couplings alone close: the structure leaves no other."""
    model = load(FILE_OF[stem])
    data, _ = page_data([model.analyze()], modes=False)
    assert not [one for one in data["live"]["left"] if one["label"] == "mode"]
    case = {one["name"]: 1.1 * one["value"] for one in data["live"]["parameters"]}
    (found,) = computed(data, [case])
    cells = next(table for table in found["tables"] if table["name"] == "rows")["rows"]
    at = [one["label"] for one in data["tables"][-1]["columns"]].index("mode")
    assert {row[at] for row in cells} == {"A"}


def test_another_mode_follows_the_parameters() -> None:
    """The command finds it anew: the same numbers but for rounding."""
    model = load(FILE_OF["planar_four_bar"])
    data, _ = page_data([model.analyze()], modes=True)
    letters = [branch["name"] for branch in data["runs"][0]["branches"]]
    assert len(letters) == 2
    case = {"b": 1.05 * next(p["value"] for p in data["live"]["parameters"] if p["name"] == "b")}
    (found,) = computed(data, [case], letters[1])
    wanted = model.with_parameters(case).analyze(mode=letters[1].removeprefix("mode "))
    own = model.with_parameters(case).analyze()
    compared_columns = 0
    for one in found["other"]:
        if one["table"] == "rows":
            continue
        (column,) = [c for c in wanted.tables[one["table"]].columns if c.label == one["label"]]
        (away,) = [c for c in own.tables[one["table"]].columns if c.label == one["label"]]
        numbers = np.frombuffer(base64.b64decode(one["values"]))
        largest = np.abs(column.values).max()
        np.testing.assert_allclose(numbers, column.values, atol=1e-9 * largest)
        compared_columns += not np.allclose(numbers, away.values, atol=1e-3 * largest)
    assert compared_columns > 1


@pytest.mark.parametrize("start", [-140, 0, 20])
def test_rows_without_a_solution_are_those_of_the_command(start: int) -> None:
    """A crank that cannot turn fully, driven from a dead centre, through one, and to one."""
    text = Path(FILE_OF["planar_four_bar"]).read_text()
    assert "from: 0" in text
    model = loads(text.replace("from: 0", f"from: {start}"), parameters={"a": "88 mm"})
    assert not model.analyze().result.solved.all()
    assert checked_run("ends", model, SWEEP) > 5


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
