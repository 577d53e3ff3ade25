"""The errata page of two small tables, in full."""

from decimal import Decimal

import numpy as np

from mechkin_cli.tables import Columns
from mechkin_cli.tables.columns import TableColumn
from mechkin_cli.tables.errata import (
    PrintedTable,
    against_print_record,
    counts,
    disagreements_csv,
    errata_page,
)
from mechkin_cli.tables.layout import PrintedSource, Remark
from mechkin_cli.tables.print import agreement


def printed_table(name: str, values: list[float], texts: list[str], *remarks: Remark):
    x = TableColumn("x", "deg", np.arange(float(len(values))))
    table = Columns(name, f"Table {name}", (x, TableColumn("y", "in", np.array(values))))
    rows = tuple((Decimal(k), Decimal(text)) for k, text in enumerate(texts))
    found = agreement(table, (("x", "y"), rows))
    path = f"m/published/{name}.csv"
    return PrintedTable(table, PrintedSource(path, remarks), found, f"published/{name}.csv")


RIGHT = printed_table("one", [1.0, 2.004], ["1.00", "2.00"])
WRONG = printed_table(
    "two",
    [1, 2, 3, 4, 5, 6, 7, 8, 1234.5],
    ["1.0", "2.1", "3.2", "4.3", "5.4", "6.5", "7.6", "8.7", "0.0"],
    Remark("a slip", ("y",)),
    Remark("and another"),
)

PAGE = """\
# Mechanism: printed and computed values

Source: a book.

A printed cell **agrees** when it is the computed number rounded to the printed digits, it is **one
off** when it is a neighbour of that number in the last digit, else it **differs**. Differences are
printed less computed; a *unit* is one unit of the last printed digit.

| table | cells | agree | one off | differ | largest, units |
| :---- | ----: | ----: | ------: | -----: | -------------: |
| one   |     2 |     2 |       0 |      0 |          -0.40 |
| two   |     9 |     1 |       1 |      7 |         -12345 |

## one: Table one

2 of 2 cells agree ([computed](one.csv), [printed](published/one.csv)).

## two: Table two

1 of 9 cells agree, 1 one off, 7 differ ([computed](two.csv), [printed](published/two.csv)).

| column | cells | agree | one off | differ | largest, units | as value |
| :----- | ----: | ----: | ------: | -----: | -------------: | -------: |
| y      |     9 |     1 |       1 |      7 |         -12345 | -1234 in |

| x   | column | printed | computed |  units |
| :-- | -----: | ------: | -------: | -----: |
| 8   |      y |     0.0 | 1234.500 | -12345 |
| 7   |      y |     8.7 |    8.000 |  +7.00 |
| 6   |      y |     7.6 |    7.000 |  +6.00 |
| 5   |      y |     6.5 |    6.000 |  +5.00 |
| 4   |      y |     5.4 |    5.000 |  +4.00 |

and 3 more cells that do not agree ([all](disagreements.csv)).

- y: a slip
- and another
"""


def test_the_page():
    assert errata_page("Mechanism", "a book", [RIGHT, WRONG]) == PAGE


def test_counts_of_several_tables():
    assert counts([RIGHT.agreement, WRONG.agreement]) == "3 of 11 cells agree, 1 one off, 7 differ"
    assert counts([RIGHT.agreement]) == "2 of 2 cells agree"


def test_a_difference_without_a_reason_says_so():
    page = errata_page("M", "", [printed_table("t", [1.0], ["2.0"])])
    assert page.endswith("- The reason is not known.\n")
    assert "Source" not in page


def test_data_that_the_source_does_not_give():
    remark = Remark("a fit gives 5", data=("s1", "s4"))
    page = errata_page("M", "", [printed_table("t", [1.0], ["2.0"], remark)])
    data = page.index("## Data that the source does not give, or gives otherwise")
    assert page.index("- s1, s4: a fit gives 5\n") > data
    assert data < page.index("## t: Table t")
    assert page.endswith("- The reason is not known.\n")


def test_every_disagreement_is_listed():
    lines = disagreements_csv([RIGHT, WRONG]).decode().splitlines()
    assert lines[0] == "table,row,found by,at,column,printed,computed,units"
    assert lines[1] == "two,2,x,1,y,2.1,2,1"
    assert len(lines) == 1 + len(WRONG.agreement.off) == 9
    assert disagreements_csv([RIGHT]) == b""


def test_disagreements_as_data():
    one, two = against_print_record([RIGHT, WRONG])
    assert (one["agree"], one["disagreements"]) == (2, [])
    assert (two["cells"], two["agree"], two["one_off"], two["differ"]) == (9, 1, 1, 7)
    assert two["disagreements"][0] == {
        "row": 2,
        "at": "1",
        "column": "y",
        "printed": "2.1",
        "computed": 2.0,
        "units": 1.0,
    }


def test_columns_of_zeros_are_counted_apart():
    """Zero in print and computed, but for rounding; a column that is zero on one side is not."""
    x = TableColumn("x", "deg", np.arange(3.0))
    columns = {
        "y": [1.0, 2.0, 30.0],
        "none": [0.0, 3e-15, 0.0],
        "small": [0.0, 3e-3, 0.0],
        "one": [0.0, 0.0, 0.0],
    }
    table = Columns("t", "T", (x, *(TableColumn(n, "in", np.array(v)) for n, v in columns.items())))
    texts = ["0 1.0 0.0 0.0 0.0", "1 2.0 0.0 0.0 0.1", "2 30.3 0.0 0.0 0.0"]
    rows = tuple(tuple(Decimal(text) for text in line.split()) for line in texts)
    found = agreement(table, (("x", *columns), rows))
    assert (len(found.cells), found.zero, found.agreeing) == (12, 3, 2 + 3 + 2)
    assert (found.one_off, found.differing) == (1, 1)
    assert {cell.label for cell in found.cells if cell.zero} == {"none"}
    words = "7 of 9 cells agree, 1 one off, 1 differs; 3 more in columns of zeros"
    assert counts([found]) == words
    one = PrintedTable(table, PrintedSource("m/t.csv"), found, "t.csv")
    page = errata_page("M", "", [one])
    assert "| table | cells | zero | agree |" in page
    assert f"\n{words} ([computed]" in page
    assert against_print_record([one])[0]["zero"] == 3
    assert "zero" not in errata_page("M", "", [RIGHT, WRONG])
