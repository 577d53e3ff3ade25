"""The data of every mechanism kept here have the form that pages read, and fit together."""

from __future__ import annotations

import csv
import io
import os

import jsonschema
import numpy as np
import pytest
from references import FILE_OF
from view.contract import DATA, FORM
from view.seen import array, data

import mechkin_cli as mk
from mechkin_cli.tables.columns import TableColumn, Words, column_texts
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.markup import rows_table
from mechkin_cli.view.page import script_json

FILES = list(FILE_OF.values())[:: 2 if os.environ.get("MECHKIN_RANDOM", "1") == "1" else 1]
"""Every second of the kept mechanisms, or all with `MECHKIN_RANDOM=2`."""
LARGEST = 1_000_000
"""Bytes of the data of a mechanism kept here."""


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_mechanism_has_a_page(path) -> None:
    model = mk.load(path)
    shown = data(model)
    FORM.validate(shown)
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
    FORM.check_schema(DATA)
    shown = data(mk.load(FILE_OF["planar_four_bar"]))
    for key in DATA["required"]:
        with pytest.raises(jsonschema.ValidationError):
            FORM.validate({k: v for k, v in shown.items() if k != key})
    shown["joints"][0]["halves"].pop()
    with pytest.raises(jsonschema.ValidationError):
        FORM.validate(shown)


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
            (run,) = (one for one in shown["runs"] if one["name"] == analysis.run)
            own = run["branches"][0]["columns"]
            curves = {one["label"]: one["values"] for one in own if one["table"] == table.name}
            for column, told in zip(table.columns, found["columns"], strict=True):
                if isinstance(column.values, Words):
                    assert told["exact"] is None
                else:
                    exact = array(told["exact"] or curves[column.label])
                    finite = np.isfinite(column.numbers)
                    np.testing.assert_array_equal(exact[finite], column.numbers[finite])
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


LOADED = """\
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {arm: {mass: 1, center_of_mass: [50, 0, 0]}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
points: {post: {link: ground, at: [0, 300, 0]}, tip: {link: arm, at: [100, 0, 0]}}
motion: {inputs: {O.theta: {from: 0, to: 90, step: 30, rate: 0}}}
loads:
  - {type: force, link: arm, point: [100, 0, 0], force: [3, -4, 0]}
  - {type: force, link: arm, point: [100, 0, 0], force: [0, 5 N, 0], axes: link}
  - {type: torque, link: arm, torque: [0, 0, 2 N*m]}
  - {type: torque, joint: O, value: "-(3 N*mm/rad)*O.theta"}
  - {type: spring, between: [post, tip], stiffness: 2 N/mm, free: 10}
tables: [{name: t, columns: [O.theta, O.effort]}]
"""


def test_loads_are_arrows_where_they_act() -> None:
    """A crank of 100 mm: closed forms of every load."""
    (own,) = data(mk.loads(LOADED), modes=False)["runs"][0]["branches"]
    arrows = {one["name"]: one for one in own["arrows"]}
    turn = np.radians([0.0, 30.0, 60.0, 90.0])
    zero, ones = 0.0 * turn, np.ones(4)
    tip = 100.0 * np.stack([np.cos(turn), np.sin(turn), zero], axis=1)
    apart = np.array([0.0, 300.0, 0.0]) - tip
    length = np.linalg.norm(apart, axis=1)[:, None]
    spring = 2.0 * (length - 10.0) * apart / length
    expected = {
        "force on arm": ("force", np.outer(ones, [3.0, -4.0, 0.0])),
        "force on arm, 2": ("force", 5.0 * np.stack([-np.sin(turn), np.cos(turn), zero], axis=1)),
        "torque on arm": ("moment", np.outer(ones, [0.0, 0.0, 2000.0])),
        "load at O.theta": ("moment", np.stack([zero, zero, -3.0 * turn], axis=1)),
        "spring on arm": ("force", spring),
        "spring on ground": ("force", -spring),
    }
    for name, (kind, values) in expected.items():
        assert arrows[name]["kind"] == kind
        found = array(arrows[name]["values"]).reshape(-1, 3)
        np.testing.assert_allclose(found, values, rtol=1e-6, atol=1e-4, err_msg=name)
    assert arrows["force on arm"]["place"] == [100.0, 0.0, 0.0]
    assert arrows["spring on ground"]["place"] == [0.0, 300.0, 0.0]


@pytest.mark.parametrize("count", [2, 3])
def test_pretension_is_an_arrow_on_each_pulley(count: int) -> None:
    """200 N in both strands at equal pulleys: 400 N, or by an angle of 60 degrees 200 sqrt(3) N."""
    text = """
format: 1
plane: xy
units: {length: mm, angle: deg, mass: kg, force: N}
links: {a: {}, b: {}, c: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [ground, b], point: [100, 0]}
  C: {type: R, links: [ground, c], point: [50, 50 mm*sqrt(3)]}
couplings: {K: {type: belt, joints: JOINTS, pretension: 200}}
motion: {inputs: {A.theta: {from: 0, to: 40, step: 10}}}
loads: [{type: torque, joint: B, value: 1}]
"""
    if count == 2:
        text = text.replace("JOINTS", "[A, B], radii: [9, 9]")
        text = text.replace("inputs: {", "inputs: {C.theta: {with: A.theta}, ")
    else:
        text = text.replace("JOINTS", "[A, B, C], radii: [9, 9, 9], tensioner: C")
    (branch, *_) = data(mk.loads(text), modes=False)["runs"][0]["branches"]
    arrows = {one["name"]: one for one in branch["arrows"]}
    for link in "abc"[:count]:
        found = array(arrows[f"pretension on {link}"]["values"]).reshape(-1, 3)
        expected = 400.0 if count == 2 else 200.0 * np.sqrt(3.0)
        np.testing.assert_allclose(np.linalg.norm(found, axis=1), expected, rtol=1e-6)
    assert not any(word in name for name in arrows for word in ("spring", "pretension on ground"))
