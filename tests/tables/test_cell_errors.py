"""Errors of cells from what they should be, with numbers small enough to work out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from mechkin_cli.tables.columns import Words
from mechkin_cli.tables.errors import (
    ZERO,
    cells_table,
    column_errors,
    least_digits,
    not_repeated,
    worst_column,
    worst_table,
)
from mechkin_cli.tape.double_double import DoubleDoubles


def of(values: list[float], true: list[float], low: list[float] | None = None, label: str = "a"):
    exact = DoubleDoubles(np.array(true), np.zeros(len(true)) if low is None else np.array(low))
    return column_errors("t", label, "mm", np.array(values), exact)


def column(table, label):
    (found,) = [c for c in table.columns if c.label == label]
    values = found.values
    return values.array().tolist() if isinstance(values, Words) else values.tolist()


def test_errors_are_in_file_units_and_parts_of_the_largest():
    found = of([1.0, -4.0, 2.0], [1.5, -4.0, 2.25])
    assert found.error.tolist() == [0.5, 0.0, 0.25]
    assert found.relative.tolist() == [0.125, 0.0, 0.0625]
    assert found.worst == 0


def test_an_error_below_the_last_digit_is_seen():
    assert of([1.0], [1.0], [3e-17]).error.tolist() == [3e-17]


@pytest.mark.parametrize(
    ("error", "digits"), [(3e-13, 12), (1e-12, 12), (2e-12, 11), (0.2, 0), (0.0, 16), (1e-20, 16)]
)
def test_right_digits(error, digits):
    found = column_errors("t", "a", "", np.array([1.0]), DoubleDoubles([1.0], [error]))
    assert found.digits.tolist() == [digits]


def test_empty_cells_and_lost_ones():
    found = of([np.nan, 1.0, 2.0], [1.0, np.nan, 2.0])
    assert np.isnan(found.error).tolist() == [True, True, False]
    assert found.digits.tolist() == [-1, -1, 16]
    assert found.lost == 1
    lines = cells_table([found])
    assert column(lines, "why") == ["empty", "no value in double-double", ""]
    assert column(lines, "row") == [1.0, 2.0, 3.0]


def test_a_column_of_rounding_has_no_digits():
    found = of([1e-17, -3e-17], [0.0, 1e-33])
    assert found.why == ZERO
    assert least_digits([found]) is None
    assert column(cells_table([found]), "error") == pytest.approx([1e-17, 3e-17])
    assert of([1e-17, 0.0], [2e-17, 0.0]).why == ""
    assert of([0.0, 0.0], [0.0, 0.0]).digits.tolist() == [16, 16]


def test_the_worst_of_all():
    good, bad = of([1.0, 2.0], [1.0, 2.0], [1e-15, 0.0]), of([1.0], [1.0], [3e-13], "b")
    assert least_digits([good, bad]) == 12
    assert worst_column([good, bad]) is bad
    table = worst_table([good, bad])
    assert column(table, "digits") == [15.0, 12.0]
    assert column(table, "row") == [1.0, 1.0]
    assert column(table, "largest") == [2.0, 1.0]


def test_what_is_not_repeated_has_one_line():
    whole, other = of([1.0, 2.0], [1.0, 2.0]), not_repeated("t", "f", "N", np.ones(2), "friction")
    table = cells_table([whole, other])
    assert column(table, "column") == ["a", "a", "f"]
    assert column(table, "why") == ["", "", "friction"]
    assert np.isnan(column(table, "row")).tolist() == [False, False, True]
    assert column(worst_table([whole, other]), "why") == ["", "friction"]
    assert worst_column([other]) is None


def test_a_response_has_a_name_of_its_own():
    assert cells_table([], "start_up").name == "start_up.errors"
    assert cells_table([]).name == "errors"
