"""What stands below a table, against numbers worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mechkin_cli.expressions.quantity import Quantity
from mechkin_cli.tables import evaluate, summary_table
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.json import table_record
from mechkin_cli.tables.layout import ROW_NUMBER
from mechkin_cli.tables.markup import markdown_bytes
from mechkin_cli.tables.summary import statistics
from mechkin_cli.units.dimension import LENGTH

WORDS = ("max", "min", "peak", "mean", "rms", "range")
INCH = 0.0254

# slides 1, 2, -4 at 190, 191, 192 degrees; the row at 193 lies beyond the dead centre
MARKDOWN = """\
| summary | s2 [in] |
| :------ | ------: |
| max     |   2.000 |
| at      |     191 |
| min     |  -4.000 |
| at      |     192 |
| peak    |   4.000 |
| at      |     192 |
| mean    |   0.250 |
| rms     |   2.500 |
| range   |   6.000 |
| rows    |       3 |

- at: O1.theta \\[deg\\]; mean and rms over O1.theta
- 1 of 4 rows has no cell of any column and does not count
- 1 of the rows is near-singular
"""


def summed(source, layout, words=WORDS, **columns):
    columns = columns or {"theta1": ("O1.theta", 0), "s2": ("O2.s", 3), "v": "row.status"}
    return evaluate(layout(columns)._replace(summary=words), source)


def test_markdown_has_a_second_table_below(source, layout):
    table = summed(source, layout)
    assert f"\n\n{MARKDOWN}\n- Row 3" in markdown_bytes(table, source).decode()


def test_means_weigh_rows_by_their_way(source, layout):
    """The row beyond the dead centre has no cell: 190, 191 and 192 count 1/2, 1 and 1/2."""
    (column,) = summed(source, layout).summary.columns
    found = column.statistics
    assert found.mean == pytest.approx((0.5 + 2 - 2) / 2, rel=1e-15)
    assert found.rms == pytest.approx(math.sqrt((0.5 + 4 + 8) / 2), rel=1e-15)


@pytest.mark.parametrize("backwards", [False, True])
def test_a_mean_is_the_trapezoidal_rule_over_unequal_steps(all_ok, backwards):
    at = np.array([0.0, 1.0, 4.0, 10.0])
    values = np.array([2.0, -6.0, 0.0, 5.0])
    turn = slice(None, None, -1 if backwards else 1)
    all_ok.inputs = {"O2.s": np.full(4, 7.0), "O1.theta": at[turn]}
    found = statistics(values[turn], all_ok)
    # by hand: 1*(2-6)/2 + 3*(-6+0)/2 + 6*(0+5)/2 = 4 over 10
    assert found.mean == pytest.approx(0.4, rel=1e-15)
    # 1*(4+36)/2 + 3*(36+0)/2 + 6*(0+25)/2 = 149
    assert found.rms == pytest.approx(math.sqrt(14.9), rel=1e-15)
    assert found.max == (5.0, 10.0)
    assert found.min == found.peak._replace(value=-6.0) == (-6.0, 1.0)
    assert found.range == 11.0


def test_rows_in_between_change_nothing_of_what_is_linear(all_ok):
    """Twice as many rows on one part of the way, on straight lines: the same mean."""
    at, values = np.array([0.0, 2.0, 3.0, 7.0]), np.array([1.0, 5.0, -2.0, 2.0])
    all_ok.inputs = {"O1.theta": at}
    few = statistics(values, all_ok)
    more = np.sort(np.concatenate([at, np.linspace(0.25, 1.75, 7), [5.0]]))
    all_ok.inputs, all_ok.rows = {"O1.theta": more}, more.size
    many = statistics(np.interp(more, at, values), all_ok)
    assert many.mean == pytest.approx(few.mean, rel=1e-14)
    assert (many.max, many.min, many.peak) == (few.max, few.min, few.peak)


def test_places_of_what_stands_still_are_numbers_of_rows(all_ok, layout):
    all_ok.inputs = {"O1.theta": np.full(4, 30.0)}
    all_ok.quantities["O2.s"] = Quantity(np.array([3.0, -7.0, 7.0, 1.0]) * INCH, LENGTH)
    table = summed(all_ok, layout)
    (column,) = table.summary.columns
    assert table.summary.parameter == ROW_NUMBER
    assert column.statistics.peak == (7.0, 2.0)  # the first of two as large
    assert column.statistics.mean == pytest.approx(1.0, rel=1e-15)
    assert table.summary.written_notes() == ["at: row.number"]


def test_a_column_without_cells_has_an_empty_summary(source, layout):
    source.quantities["O2.s"] = Quantity(np.full(4, np.nan), LENGTH)
    table = summed(source, layout)
    (column,) = table.summary.columns
    assert table.summary.texts(column) == [""] * 9 + ["0"]
    text = csv_bytes(summary_table("t", "", table.summary)).decode()
    assert text.splitlines()[:3] == ["summary,s2", "max,", "max at,"]
    assert table_record(table)["summary"]["columns"][0]["peak"] == {"value": None, "at": None}
    assert "4 of 4 rows have no cell of any column and do not count" in table.summary.notes


def test_csv_has_all_digits_and_names_what_a_place_is_of(source, layout):
    table = summed(source, layout, ("peak", "mean"))
    text = csv_bytes(summary_table("t", "", table.summary)).decode()
    assert text == "summary,s2\npeak,4\npeak at,192\nmean,0.25\nrows,3\n"


def test_json_has_each_number_with_its_place(source, layout):
    found = table_record(summed(source, layout, ("max", "range")))["summary"]
    assert found == {
        "at": "O1.theta",
        "at_unit": "deg",
        "columns": [
            {
                "label": "s2",
                "unit": "in",
                "max": {"value": 2.0, "at": 191.0},
                "range": 6.0,
                "rows": 3,
                "infinite": 0,
            }
        ],
    }


@pytest.mark.parametrize("scale", [1e-180, 1.0, 1e180])
def test_squares_do_not_run_over(all_ok, scale):
    all_ok.inputs = {"O1.theta": np.arange(4.0)}
    found = statistics(np.array([3.0, -3.0, 3.0, 3.0]) * scale, all_ok)
    assert found.rms == pytest.approx(3.0 * scale, rel=1e-15)


def test_what_is_missing_is_told_column_by_column(all_ok, layout):
    all_ok.quantities["O2.s"] = Quantity(np.array([1.0, np.nan, 3.0, np.nan]), LENGTH)
    table = summed(all_ok, layout, s="O2.s", p="O2.s*0 + P1", f="norm(O2.force)")
    assert table.summary.notes == (
        "2 of 4 rows have no cell of s and do not count",
        "2 of 4 rows have no cell of p and do not count",
    )
