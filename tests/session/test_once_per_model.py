"""What a run needs of its model is worked out once: a second run only runs, with the same bytes."""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.runs import NAMES
from references import FILE_OF
from work import calls

import mechkin_cli as mk
from benchmarks.scenes import texts

MOST_CALLS = 450
"""Of Python functions in one sweep of positions; before it was worked out once: 1009 (RCSR), 5400
(Stewart with forces)."""


@pytest.mark.parametrize("name", ["RCSR", "7R", "Stewart", "platform on laws"])
def test_a_second_run_only_runs(name: str) -> None:
    model = mk.loads(texts()[name]())
    names = [n for n in model.problem.mechanism.coordinates if n in model.quantities]
    forces = [*names, *(n for n in model.quantities if n.endswith((".force", ".effort")))]
    for asked in (names, forces):
        model.analyze(asked, tables=[])
    assert calls(lambda: model.analyze(names, tables=[]), of_c=False) <= MOST_CALLS
    # how many quantities are read must not count; 40 are some list comprehensions more
    assert calls(lambda: model.analyze(forces, tables=[]), of_c=False) <= 2 * MOST_CALLS


def test_rows_and_tables_cost_no_calls() -> None:
    text = FILE_OF["rcsr"].read_text(encoding="utf-8")
    long = text.replace("step: 2,", "step: 0.02,")
    assert long != text
    few, many = mk.loads(text), mk.loads(long)
    found = [calls(model.analyze, of_c=False) for model in (few, many, few, many)]
    assert found[2] == found[3] <= MOST_CALLS
    assert found[2] < found[0] / 5


def answers(model: mk.Model, **choice: object) -> dict[str, bytes]:
    """Everything that the tables read, the verdicts and what is said."""
    found = model.analyze(**choice)  # type: ignore[arg-type]
    cells = {
        f"{table.name}, {column.label}": column.values.array()
        if hasattr(column.values, "array")
        else column.values
        for table in found.tables
        for column in table.columns
    }
    told = {"said": "\n".join(map(str, found.diagnostics)).encode()}
    told["residual"] = found.result.residual.tobytes()
    told["condition"] = found.result.condition.tobytes()
    return {name: np.asarray(values).tobytes() for name, values in cells.items()} | told


@pytest.mark.parametrize("stem", NAMES)
def test_answers_do_not_depend_on_what_was_asked_before(stem: str) -> None:
    path = FILE_OF[stem]
    if "sweep" not in mk.load(path).runs:
        pytest.skip("no sweep")
    first = answers(mk.load(path))
    model = mk.load(path)
    every = [n for n in model.problem.mechanism.coordinates if n in model.quantities]
    model.analyze(every[:1], tables=[], threads=1)
    model.analyze([], tables=[])
    for choice in ({"lanes": 2}, {"threads": 2}, {}):
        assert answers(model, **choice) == first
        assert answers(model, **choice) == first


def test_each_mode_keeps_its_own() -> None:
    """Runs of two modes in turns, and of a variant, are those of fresh models."""
    path = FILE_OF["rcsr"]
    fresh = {mode: answers(mk.load(path), mode=mode) for mode in ("A", "B")}
    varied = answers(mk.load(path).with_parameters({"P1": "0.52 in"}))
    assert fresh["A"] != fresh["B"]
    model = mk.load(path)
    other = model.with_parameters({"P1": "0.52 in"})
    for mode in ("B", "A", "B", "A"):
        assert answers(model, mode=mode) == fresh[mode]
        assert answers(other) == varied
