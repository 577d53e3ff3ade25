"""Printed cells beside computed ones: the rounding rule, and how rows are found."""

from decimal import Decimal

import numpy as np
import pytest

from mechkin_cli.tables import Columns
from mechkin_cli.tables.columns import TableColumn
from mechkin_cli.tables.print import PrintedValues, TableAgreement, agreement


def table(**columns: list[float]) -> Columns:
    made = (TableColumn(label, "", np.array(values, float)) for label, values in columns.items())
    return Columns("t", "", tuple(made))


def printed(text: str) -> PrintedValues:
    labels, *rows = (line.split(",") for line in text.split())
    cells = (tuple(Decimal(cell) if cell else None for cell in row) for row in rows)
    return tuple(labels), tuple(cells)


def one_cell(computed: float, text: str) -> TableAgreement:
    return agreement(table(x=[1], y=[computed]), printed(f"x,y\n1,{text}"))


AGREE, ONE_OFF, DIFFER = (1, 0, 0), (0, 1, 0), (0, 0, 1)


@pytest.mark.parametrize(
    ("computed", "text", "verdict"),
    [
        (1.234, "1.23", AGREE),
        (1.236, "1.23", ONE_OFF),
        (1.2449, "1.23", ONE_OFF),
        (1.2451, "1.23", DIFFER),
        # ties, exact in binary and not: both neighbours are the rounded number
        (0.125, "0.12", AGREE),
        (0.125, "0.13", AGREE),
        (2.675, "2.67", AGREE),
        (2.675, "2.68", AGREE),
        # one last bit on either side of the tie
        (np.nextafter(0.125, 0), "0.13", AGREE),
        (np.nextafter(0.125, 1), "0.12", AGREE),
        (0.1250001, "0.12", ONE_OFF),
        # the printed digits count: zeros at the end, none after the point, exponents
        (1.3, "1.30", AGREE),
        (1.304, "1.3", AGREE),
        (1.306, "1.30", ONE_OFF),
        (104.4, "104", AGREE),
        (1.26e-3, "1.3e-3", AGREE),
        # zero has no sign
        (4e-4, "-0.000", AGREE),
        (-4e-4, "0.000", AGREE),
        (1e300, "0.001", DIFFER),
        (-7.0, "7.0", DIFFER),
    ],
)
def test_rounding(computed, text, verdict):
    found = one_cell(computed, text)
    assert (found.agreeing, found.one_off, found.differing) == verdict


def test_differences_are_exact():
    (cell,) = one_cell(-103.84448, "-103.842").cells
    assert (cell.units, cell.difference, cell.unit) == tuple(
        map(Decimal, ("2.48", "0.00248", "0.001"))
    )


def test_rows_are_found_by_the_first_column():
    computed = table(x=[150, 152, 154.04, 156], y=[1, 2, 3, np.nan])
    found = agreement(computed, printed("x,y\n154.0,3\n150,1\n156,4\n158,5\n152,"))
    assert [(str(c.key), str(c.printed), c.agrees) for c in found.cells] == [
        ("154.0", "3", True),
        ("150", "1", True),
    ]
    assert (found.without_row, found.without_value) == (1, 1)


def test_a_value_that_comes_twice_is_found_twice():
    found = agreement(table(x=[0, 5, 0], y=[1, 2, 3]), printed("x,y\n0,1\n0,3\n0,9"))
    assert [cell.agrees for cell in found.cells] == [True, True]
    assert found.without_row == 1


def test_rows_are_found_by_a_named_column():
    """A first column that repeats when rounded would pair the second row with the first."""
    computed = table(x=[20.0, 20.004, 20.03], y=[1, 2, 3], t=[0.0, 0.1, 0.2])
    text = "x,y,t\n20.00,2,0.1\n20.03,3,0.2\n20.00,1,0.0"
    found = agreement(computed, printed(text), "t")
    assert [(cell.row, str(cell.key), cell.label, cell.agrees) for cell in found.cells] == [
        (2, "0.1", "x", True),
        (2, "0.1", "y", True),
        (3, "0.2", "x", True),
        (3, "0.2", "y", True),
        (1, "0.0", "x", True),
        (1, "0.0", "y", True),
    ]
    assert not agreement(computed, printed(text)).cells[0].agrees


def test_rows_are_found_by_their_number():
    computed = table(x=[20.0, 20.004], y=[1, 2])
    found = agreement(computed, printed("x,y\n20.00,1\n20.00,2\n20.03,3"), "row.number")
    assert [(cell.row, str(cell.key), cell.label) for cell in found.off] == []
    assert [(cell.row, cell.label) for cell in found.cells] == [
        (1, "x"),
        (1, "y"),
        (2, "x"),
        (2, "y"),
    ]
    assert found.without_row == 1


@pytest.mark.parametrize(("rows_by", "who"), [("q", "table t"), ("y", "the print")])
def test_the_column_that_finds_rows_must_be_on_both_sides(rows_by, who):
    with pytest.raises(ValueError, match=f"'{rows_by}' finds the rows, and {who} has no"):
        agreement(table(x=[1], y=[1]), printed("x,z\n1,1"), rows_by)


def test_columns_that_one_side_lacks():
    found = agreement(table(x=[1], y=[2], z=[3]), printed("x,w,z,v\n1,7,3,8"))
    assert [cell.label for cell in found.cells] == ["z"]
    assert found.other_labels == ("w", "v")


def test_the_first_printed_column_must_be_one_of_the_table():
    with pytest.raises(ValueError, match="'q' finds the rows, and table t has no such column"):
        agreement(table(x=[1]), printed("q,x\n1,1"))


@pytest.mark.parametrize("count", [11, 1001, 10_001])
def test_the_nearest_of_the_rows_that_round_to_a_printed_key_is_found(count):
    times = np.linspace(0.0, 10.0, count).tolist()
    found = agreement(table(t=times, y=[5 * t for t in times]), printed("t,y\n1.0,5\n5.0,25.0"))
    assert [times[cell.row - 1] for cell in found.cells] == [1.0, 5.0]
    assert found.agreeing == 2


def test_a_key_that_is_printed_twice_finds_both_passes_in_their_order():
    times = [4.97, 5.04, 6.0, 5.04, 5.01]
    found = agreement(table(t=times, y=[1, 2, 3, 4, 5]), printed("t,y\n5.0,1\n6.0,3\n5.0,5"))
    assert [cell.row for cell in found.cells] == [1, 3, 5]


@pytest.mark.parametrize("digits", range(12, 18))
def test_keys_and_values_with_all_digits_of_a_double_are_found_and_agree(digits):
    times = [7.0 * k / 97.0 for k in range(98)]
    values = [np.sin(t) for t in times]
    lines = (f"{t:.{digits}g},{y:.{digits}g}" for t, y in zip(times, values, strict=True))
    found = agreement(table(t=times, y=values), printed("t,y\n" + "\n".join(lines)))
    assert (len(found.cells), found.agreeing, found.without_row) == (98, 98, 0)


def test_more_than_twelve_digits_are_compared_with_twelve():
    assert one_cell(1 / 3, "0.33333333333333337").agreeing == 1
    assert one_cell(1 / 3, "0.33333333333444444").one_off == 1
