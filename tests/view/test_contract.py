"""The data of every mechanism kept here have the form that pages read, and fit together."""

from __future__ import annotations

import csv
import io

import jsonschema
import numpy as np
import pytest
from references import FILE_OF
from view.contract import DATA
from view.seen import array, data

import mechkin_cli as mk
from mechkin_cli.tables.columns import TableColumn, Words, column_texts
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.markup import rows_table
from mechkin_cli.view.page import script_json

FILES = list(FILE_OF.values())
LARGEST = 1_000_000
"""Bytes of the data of a mechanism kept here."""


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_mechanism_has_a_page(path) -> None:
    model = mk.load(path)
    shown = data(model)
    jsonschema.validate(shown, DATA)
    assert len(script_json(shown)) <= LARGEST
    links = len(shown["links"])
    assert [run["name"] for run in shown["runs"]] == list(model.runs)
    for run in shown["runs"]:
        assert [one["own"] for one in run["branches"]] == [
            number == 0 for number in range(len(run["branches"]))
        ]
        for one in run["branches"]:
            rows, posed = one["rows"], array(one["poses"]["rows"])
            assert array(one["x"]).size == array(one["status"]["codes"]).size == rows
            assert array(one["poses"]["values"]).size == posed.size * links * 7
            assert np.isfinite(array(one["poses"]["values"])).all()
            assert (np.diff(posed) > 0).all()
            assert {array(column["values"]).size for column in one["columns"]} <= {rows}
            for arrow in one["arrows"]:
                assert array(arrow["values"]).size == posed.size * 3
                assert arrow["link"] < links
            assert (array(one["status"]["codes"]) < len(one["status"]["words"])).all()
    for joint in shown["joints"]:
        assert max(joint["links"]) < links
    for table in shown["tables"]:
        assert {len(row) for row in table["rows"]} <= {len(table["columns"])}
        assert len(table["status"]) in (0, len(table["rows"]))


def test_the_form_is_told_from_another() -> None:
    shown = data(mk.load(FILE_OF["rcsr"]))
    for key in DATA["required"]:
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate({k: v for k, v in shown.items() if k != key}, DATA)
    shown["joints"][0]["halves"].pop()
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(shown, DATA)


def shown_cell(column: TableColumn, row: int) -> str:
    """A cell as the terminal prints it."""
    if isinstance(column.values, Words):
        return column.values.texts([row])[0]
    return column.texts(column_texts(column.values, column.decimals, column.rounding))[row]


@pytest.mark.parametrize("stem", ["rcsr", "rcsr_response", "stewart", "bennett"])
def test_tables_are_those_of_the_files(stem: str) -> None:
    model = mk.load(FILE_OF[stem])
    shown = data(model, modes=False)
    for analysis in model.analyses():
        every = (*analysis.tables, *analysis.coefficients, *analysis.balance_tables)
        tables = [one for one in shown["tables"] if one["run"] == analysis.run]
        rows = rows_table(analysis.result, analysis.run)
        assert [one["name"] for one in tables] == [one.name for one in (*every, rows)]
        for table, found in zip((*every, rows), tables, strict=True):
            text = csv_bytes(table).decode()
            labels, *cells = csv.reader(io.StringIO(text, newline=""))
            assert found["exact"] == [row or [""] for row in cells]
            printed = [[shown_cell(c, k) for c in table.columns] for k in range(len(cells))]
            assert found["rows"] == printed
            assert [one["label"] for one in found["columns"]] == [c.label for c in table.columns]
            assert [one["unit"] for one in found["columns"]] == [c.unit for c in table.columns]
            assert len(labels) == len(found["columns"])
            if table.of_rows:
                assert found["status"] == analysis.result.status.tolist()


def test_curves_are_the_columns_of_the_tables() -> None:
    model = mk.load(FILE_OF["rcsr"])
    shown = data(model, modes=False)
    (own,) = shown["runs"][0]["branches"]
    analysis = model.analyze()
    curves = {(one["table"], one["label"]): array(one["values"]) for one in own["columns"]}
    for table in analysis.tables:
        for column in table.columns:
            np.testing.assert_array_equal(curves[table.name, column.label], column.values)
    np.testing.assert_array_equal(curves["rows", "condition"], analysis.result.condition)
    np.testing.assert_array_equal(array(own["x"]), analysis["O1.theta"])


def test_arrows_are_the_reactions_in_the_files_units() -> None:
    model = mk.load(FILE_OF["rcsr"])
    (own,) = data(model, modes=False)["runs"][0]["branches"]
    analysis = model.analyze()
    arrows = {one["name"]: one for one in own["arrows"]}
    for name in ("O3.force", "O1.moment"):
        want = analysis[name].astype(np.float32)
        np.testing.assert_array_equal(array(arrows[name]["values"]).reshape(-1, 3), want)
    effort = analysis["O1.effort"][:, None] * analysis["O1.axis"]
    found = array(arrows["O1.effort"]["values"]).reshape(-1, 3)
    np.testing.assert_array_equal(found, effort.astype(np.float32))
    assert arrows["O1.effort"]["kind"] == "moment"
    assert arrows["O3.force"]["unit"] == "lbm*in/s^2"


def test_what_is_not_unique_is_no_arrow() -> None:
    """A planar linkage in space: forces in its plane are unique, those along z are not."""
    (own, *_) = data(mk.load(FILE_OF["slider_crank"]))["runs"][0]["branches"]
    names = {one["name"].split(" (")[0]: one for one in own["arrows"]}
    force = names["B.force"]
    assert force["name"] == "B.force (x, y)"
    assert (array(force["values"]).reshape(-1, 3)[:, 2] == 0.0).all()
    assert "A.moment" not in names
