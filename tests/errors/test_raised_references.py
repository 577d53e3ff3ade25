"""Rows in double-double against the kept references, raised to sixty digits by
`python -P tests/errors/raised`."""

from __future__ import annotations

import csv
from functools import cache
from typing import Any

import pytest
from errors.raised.tables import TABLES, path_of, raise_row, rows_of
from errors.test_references import BY_CONDITION, CLOSE, condition_of, numbers
from mechanisms.runs import edited, run
from mechanisms.test_exact import CASES, ROW_BY_ROW, Case
from oracle import mp
from oracle_checks.test_rcsr import COORDINATES

from mechkin_cli.errors.rows import Repeated, wide_run
from mechkin_cli.sweep.result import Result

WORDS = {"": "position", "v_": "velocity", "a_": "acceleration"}


@cache
def raised(table: str) -> list[dict[str, str]]:
    with path_of(table).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("table", TABLES)
def test_a_row_is_raised_as_it_is_kept(table: str) -> None:
    row = len(raised(table)) // 2
    assert raise_row(table, list(rows_of(table))[row]) == raised(table)[row]


def test_a_wrong_digit_among_seventeen_is_seen() -> None:
    row = next(rows_of("rspp"))
    row["s_B"] = row["s_B"][:-1] + str((int(row["s_B"][-1]) + 5) % 10)
    with pytest.raises(ValueError, match="s_B is"):
        raise_row("rspp", row)


def rcsr_columns() -> dict[str, str]:
    found = {label: quantity for label, (quantity, _) in COORDINATES.items()}
    for axis in "xyz":
        for prefix, word in WORDS.items():
            found |= {f"{prefix}{p}_{axis}": f"{p}.{word}.{axis}" for p in ("pm1", "pm2", "pm3")}
        found |= {f"ne_F21_{axis}": f"O2.force.{axis}"}
        found |= {f"ne_M21_{axis}": f"O2.moment_about_origin.{axis}"}
    return found


def in_parts(
    results: list[tuple[Result, int]], columns: dict[str, str], rows: list[dict[str, str]]
) -> dict[str, float]:
    """The largest error of each column, in parts of what it may be: of the column's largest, of
    vectors of all three columns'."""
    runs = {id(result): Repeated(result, wide_run(result)) for result, _ in results}
    found = {}
    for label, quantity in columns.items():
        name, _, axis = quantity.rpartition(".")
        name, part = (name, "xyz".index(axis)) if axis in ("x", "y", "z") else (quantity, 0)
        is_angle = quantity.endswith(".theta")
        unit = mp.pi / 180 if is_angle and not label.endswith("_rad") else mp.one
        wanted = [mp.mpf(row[label]) * unit for row in rows]
        vector = [label[:-1] + x for x in "xyz"] if name != quantity else [label]
        largest = max(abs(float(mp.mpf(row[x]) * unit)) for row in rows for x in vector)
        worst = 0.0
        for (result, row), value in zip(results, wanted, strict=True):
            off = numbers(runs[id(result)], name, row)[part] - value
            if is_angle:
                off -= 2 * mp.pi * mp.nint(off / (2 * mp.pi))
            power = 1 if quantity.endswith((".theta", ".s", ".position.x")) else 2
            limit = max(CLOSE, BY_CONDITION * condition_of(result, row) ** power)
            worst = max(worst, float(abs(off)) / (largest * limit))
        found[label] = worst
    return found


def rows_for(case: Case) -> list[dict[str, str]]:
    return [raised(case.table)[k] for k in case.chosen]


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_sweeps(case: Case) -> None:
    result = edited(case.name, [*case.quantities, "row.condition"], **case.edits).result
    results = [(result, row) for row in range(len(case.chosen))]
    found = in_parts(results, case.columns, rows_for(case))
    assert max(found.values()) < 1.0, found


@pytest.mark.parametrize(("case", "driven", "label", "edits"), ROW_BY_ROW.values(), ids=ROW_BY_ROW)
def test_rows_with_rates_of_their_own(case: Case, driven: str, label: str, edits: Any) -> None:
    place, results = f"{label}_deg" if driven.endswith("theta") else label, []
    for row in rows_for(case):
        at, rate, bend = (row[name] for name in (place, f"{label}_dot", f"{label}_ddot"))
        motion = {"inputs": {driven: {"at": at, "rate": rate, "acceleration": bend}}}
        quantities = [*case.quantities, "row.condition"]
        results.append((edited(case.name, quantities, motion=motion, **edits).result, 0))
    found = in_parts(results, case.columns, rows_for(case))
    assert max(found.values()) < 1.0, found


def test_rcsr_with_places_and_loads() -> None:
    result = run("rcsr").result
    rows = raised("rcsr")
    found = in_parts([(result, row) for row in range(len(rows))], rcsr_columns(), rows)
    assert len(found) > 40
    assert max(found.values()) < 1.0, found


def test_an_error_of_1e_26_is_seen() -> None:
    case = CASES["R-Sg-C"]
    result = edited(case.name, [*case.quantities, "row.condition"]).result
    rows = [dict(row) for row in rows_for(case)]
    rows[4]["s_B"] = mp.nstr(mp.mpf(rows[4]["s_B"]) + mp.mpf("1e-26"), 60)
    found = in_parts([(result, row) for row in range(len(rows))], case.columns, rows)
    assert found["s_B"] > 1.0
