"""Balances and dense systems of a run whose rows pass by are those of all rows at once, bit for
bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from balances.test_balances import BODY, FLYWHEEL, LOADS, SHAKING, WORK
from streams.written import written_alike
from sweep.cut import cut

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.tables import Columns, Words

TURNS = "motion: {{inputs: {{A.theta: {{from: {first}, to: {last}, count: {count}, {rate}}}}}}}\n"
ALL = "balances:\n" + "".join(
    f"  - {section.removeprefix('balances: [').removesuffix(chr(10)).removesuffix(']')}\n"
    for section in (WORK, SHAKING.replace("1, 2, 4", "0.5, 1, 1.5"), FLYWHEEL)
)
DENSE = "coefficients: [{name: one, row: 1}, {name: inner, row: 12}, {name: last, row: 33}]\n"


def turns(first: float, last: float, count: int, rate: str = "rate: 30 rad/s") -> str:
    return BODY + LOADS + TURNS.format(first=first, last=last, count=count, rate=rate)


TEXTS = {
    "an even number of rows": turns(0, 720, 65) + ALL + DENSE,
    "an odd number of rows": turns(30, 750, 64) + ALL,
    "backwards": turns(360, -360, 65) + ALL,
    "half a turn on either side": turns(-180, 540, 49) + ALL,
    "no rate": turns(0, 720, 41, "rate: 0") + ALL.replace("0.02}", "0.02, rate: 5 rad/s}"),
    "in time": BODY + LOADS + """motion:
  time: {from: 0, to: 2, count: 65}
  inputs: {A.theta: {law: cycloidal, from: 0, to: 720}}
""" + WORK,
    "a law in time": BODY + LOADS + """motion:
  time: {from: 0, to: 2, count: 65}
  inputs: {A.theta: {with: "30 deg * sin(180 deg/s * time)"}}
""" + WORK,
    "inputs that follow": """
format: 1
links:
  upper: {mass: 2, center_of_mass: [0.3, 0, 0]}
  lower: {mass: 1, center_of_mass: [0.9, 0, 0]}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [upper, lower], point: [0.5, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 10, rate: 1 rad/s},
    B.theta: {with: -2*A.theta}}}
loads: [{type: damper, joint: B, coordinate: theta, damping: 2}, {type: gravity, g: [0, -9.81, 0]}]
""" + WORK,
    "rows without a solution": turns(0, 720, 65).replace("[0.1, 0, 0]", "[0.301, 0, 0]").replace(
        "point: [0.4, 0, 0]", "point: [0.6, 0, 0]") + ALL,
    "no cycle": turns(0, 720, 65) + WORK.replace("work}", "work}, {name: h, type: harmonics, "
        "of: [A.theta, sin(A.theta) * A.theta], orders: [1]}"),
    "friction": turns(0, 720, 65).replace(
        "  - {type: gravity", "  - {type: friction, joint: A, coefficient: 0.2, radius: 0.01}\n"
        "  - {type: gravity") + WORK,
}  # fmt: skip


CLOSED = [name for name in TEXTS if name not in ("no cycle", "rows without a solution")]


def cells(tables: object) -> list[tuple]:
    assert isinstance(tables, tuple)
    found = []
    for table in tables:
        assert isinstance(table, Columns)
        for column in table.columns:
            words = isinstance(column.values, Words)
            values = tuple(column.values.array()) if words else np.asarray(column.values).tobytes()
            found.append((table.name, table.title, column.label, column.unit, values))
    return found


@pytest.mark.parametrize("rows", [4, 7, 9, 16])
@pytest.mark.parametrize("name", TEXTS)
def test_what_passes_by_adds_up_to_the_whole(
    name: str, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    cut(monkeypatch, rows)
    model = mk.loads(TEXTS[name])
    whole = model.analyze()
    stream = model.stream(rows=5)
    assert (stream.in_blocks, stream.balance_tables, stream.coefficients) == (True, (), ())
    for _ in stream:
        pass
    assert cells(stream.balance_tables) == cells(whole.balance_tables)
    assert len(stream.balance_tables) == len(model.built.balances)
    assert cells(stream.coefficients) == cells(whole.coefficients)
    assert {str(one) for one in stream.diagnostics} == {str(one) for one in whole.diagnostics}
    assert stream.complete == whole.complete == (name in CLOSED)


def test_a_row_of_a_dense_system_without_a_solution_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cut(monkeypatch, 8)
    text = TEXTS["rows without a solution"].replace("balances:", DENSE + "balances:")
    model = mk.loads(text)
    stream = model.stream(tables=["inner"])
    assert stream.coefficients == ()
    for _ in stream:
        pass
    for found in (stream, model.analyze(tables=["inner"])):
        with pytest.raises(mk.UsageError, match="wanted at row 12, which has no solution"):
            _ = found.coefficients


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("to: 719", "to a full turn"),
        ("from: 0.5", "are missing to a full turn"),
    ],
)
def test_a_long_run_that_is_no_cycle_is_refused_with_the_words_of_a_short_one(
    change: str, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    key = change.split(":")[0]
    old = {"to": "to: 720", "from": "from: 0"}[key]
    text = TEXTS["an even number of rows"].replace(old, change)
    with pytest.raises(mk.InvalidFile, match=said) as short:
        mk.loads(text)
    cut(monkeypatch, 8)
    with pytest.raises(mk.InvalidFile, match=said) as long:
        mk.loads(text)
    assert str(long.value) == str(short.value)


def test_the_command_writes_what_it_does_of_a_whole_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    count = tolerances.LONG_RUN + 31
    text = turns(0, 360 * 64, count) + ALL.split("  - {name: f")[0] + DENSE
    found = written_alike(tmp_path, text, monkeypatch, capsys)
    assert {"work.csv", "h.csv", "inner.csv", "inner_unknowns.csv"} <= found


def test_a_flywheel_of_too_many_rows_is_refused() -> None:
    text = TEXTS["an even number of rows"].split("coefficients:")[0].replace("65", "50000001")
    with pytest.raises(mk.InvalidFile, match="a flywheel holds numbers of all rows") as refused:
        mk.loads(text)
    assert [one.code for one in refused.value.diagnostics if one.severity == "error"] == [
        "too-many-rows"
    ]
