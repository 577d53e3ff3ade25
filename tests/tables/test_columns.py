"""Columns: expressions over rows, in file units, with empty cells where a row has no solution."""

import numpy as np
import pytest

from mechkin_cli.expressions.quantity import ExpressionError
from mechkin_cli.tables import evaluate
from mechkin_cli.verdict import Status

NAN = float("nan")


@pytest.mark.parametrize(
    ("expression", "unit", "values"),
    [
        ("O2.s", "in", [1, 2, -4, NAN]),
        ("2*O2.s - P1", "in", [1.5, 3.5, -8.5, NAN]),
        ("O2.force.x", "N", [3, 0, 6, NAN]),
        ("norm(O2.force)*1 m", "N*in", [3 / 0.0254, 0, 6 / 0.0254, NAN]),
        ("P1", "in", [0.5, 0.5, 0.5, NAN]),
        ("7", "", [7, 7, 7, NAN]),
        ("row.condition", "", [2, 2.5, 1e7, NAN]),
        ("P1/O2.force.x*1 N/1 in", "", [0.5 / 3, NAN, 0.5 / 6, NAN]),
    ],
)
def test_values_are_in_file_units(source, layout, expression, unit, values):
    (column,) = evaluate(layout({"c": expression}), source).columns
    assert column.unit == unit
    np.testing.assert_allclose(column.values, values, rtol=4e-16)


@pytest.mark.parametrize("expression", ["O1.theta", " O1.theta "])
def test_an_input_is_printed_as_written_in_every_row(source, layout, expression):
    (column,) = evaluate(layout({"theta1": expression}), source).columns
    assert column.values.tolist() == [190, 191, 192, 193]
    assert column.unit == "deg"


def test_mode_and_status_are_texts(source, layout):
    mode, status = evaluate(layout({"m": "row.mode", "v": "row.status"}), source).columns
    assert mode.values.array().tolist() == ["A", "A", "A", "A"]
    assert status.values.array().tolist() == ["ok", "ok", "near-singular", "beyond-dead-centre"]


def test_labels_decimals_and_title_come_from_the_layout(source, layout):
    table = evaluate(layout({"a": ("P1", 2), "b": "P1"}, title="Sizes"), source)
    assert (table.name, table.title) == ("table", "Sizes")
    assert [(column.label, column.decimals) for column in table.columns] == [("a", 2), ("b", None)]


@pytest.mark.parametrize("status", [status for status in Status if not status.has_solution])
def test_rows_without_solution_have_empty_cells(source, layout, status):
    source.status[1] = status
    (column,) = evaluate(layout({"s": "O2.s"}), source).columns
    assert np.isnan(column.values).tolist() == [False, True, False, True]


def test_results_are_left_as_they_are(source, layout):
    before = source.quantities["O2.force"].value.x.copy()
    evaluate(layout({"x": "O2.force.x", "c": "row.condition"}), source)
    assert source.quantities["O2.force"].value.x.tolist() == before.tolist()


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        ("O2.force", ["'c'", "vector", "O2.force.x"]),
        ("O2.force + O2.force", ["vector", "(O2.force + O2.force).x"]),
        ("O2.t", ["O2.t"]),
        ("row.status + 1", ["row.status", "text", "column of its own"]),
    ],
)
def test_columns_that_are_no_numbers_are_refused(source, layout, expression, words):
    with pytest.raises(ExpressionError) as caught:
        evaluate(layout({"c": expression}), source)
    assert all(word in str(caught.value) for word in words)
