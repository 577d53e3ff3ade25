"""Markdown of a table as a person reads it."""

import numpy as np

from mechkin_cli.tables import evaluate
from mechkin_cli.tables.markup import markdown_bytes
from mechkin_cli.verdict import Status

EXPECTED = """\
# SLIDE OF THE RCSR

| theta1 [deg] | s2 [in] | verdict            |
| -----------: | ------: | :----------------- |
|          190 |   1.000 | ok                 |
|          191 |   2.000 | ok                 |
|          192 |  -4.000 | near-singular      |
|          193 |         | beyond-dead-centre |

- Row 3 (O1.theta 192 deg): near-singular: solved, but close to a singular position: fewer digits \
of rates and loads are reliable.
- Row 4 (O1.theta 193 deg): beyond-dead-centre: this branch ends at a dead centre before this row.
"""


def text(columns, source, layout, title=""):
    return markdown_bytes(evaluate(layout(columns, title=title), source), source).decode()


def test_title_units_decimals_footnotes(source, layout):
    columns = {"theta1": ("O1.theta", 0), "s2": ("O2.s", 3), "verdict": "row.status"}
    assert text(columns, source, layout, title="SLIDE OF THE RCSR") == EXPECTED


def test_rows_in_runs_and_without_swept_input(all_ok, layout):
    all_ok.inputs = {"O1.theta": np.full(4, 30.0)}
    all_ok.status[[0, 2, 3]] = Status.not_assembled
    lines = text({"s": "O2.s"}, all_ok, layout).splitlines()
    assert lines[-1] == (
        "- Rows 1, 3-4: not-assembled: no start of the first row led to an assembled position."
    )


def test_a_run_of_rows_names_both_ends(all_ok, layout):
    all_ok.status[1:] = Status.beyond_dead_centre
    assert "- Rows 2-4 (O1.theta 191 to 193 deg): beyond" in text({"s": "O2.s"}, all_ok, layout)


def test_an_empty_cell_of_an_ok_row_is_explained(all_ok, layout):
    found = text({"ratio": "O2.s/O2.force.x"}, all_ok, layout)
    assert found.splitlines()[-1] == (
        "- Row 2 (O1.theta 191 deg): no ratio: the value is not finite or not unique there."
    )


def test_no_footnotes_when_all_is_well(all_ok, layout):
    assert text({"s": ("O2.s", 1)}, all_ok, layout) == (
        "# table\n\n| s [in] |\n| -----: |\n|    1.0 |\n|    2.0 |\n|   -4.0 |\n|   99.0 |\n"
    )


def test_many_separate_rows_are_cut_short(source, layout):
    count = 20
    source.rows = count
    source.inputs = {}
    source.status = np.array([0, 4] * 10, dtype=np.int8)
    found = text({"P1": "P1"}, source, layout)
    assert "- Rows 2, 4, 6, 8, 10, 12, and 4 more: not-converged: " in found


def test_bars_and_line_ends_cannot_break_the_table(all_ok, layout):
    found = text({"a|b\nc": "P1"}, all_ok, layout, title="two\nlines")
    assert found.startswith("# two lines\n\n| a\\|b c [in] |\n")


def test_no_trailing_spaces(source, layout):
    found = text({"s2": "O2.s", "m": "row.mode"}, source, layout, title="T")
    assert all(line == line.rstrip() for line in found.split("\n"))
    assert found.endswith("\n")
    assert not found.endswith("\n\n")
