"""Texts that a spreadsheet or a page would take for more than words."""

from __future__ import annotations

import csv
import io
import re

import pytest
from hypothesis import given, strategies as st

import mechkin_cli as mk
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.layout import csv_text, link_target, markdown_line, markdown_text
from mechkin_cli.tables.markup import markdown_bytes
from mechkin_cli.tables.print import read_table_text

FORMULAS = [
    "=1+1",
    "+1",
    "-1+cmd|'/C calc'!A0",
    "@SUM(A1)",
    "\t=1",
    "\r=1",
    "\n=1",
    " =1",
    "＝1",
    '"=1"',
    "'=1",
    "a;=HYPERLINK(1)",
    "a\n=1",
    "\tx",
]
WORDS = ["theta", "a=b", "x - y", "max(a, -b)", "O1.theta_dot", "(-a)", "5 - 3", "", "e^-x"]
MARKUP = {
    "<script>alert(1)</script>": "&lt;script>alert(1)&lt;/script>",
    "[a](javascript:b)": r"\[a\](javascript:b)",
    "![a](b)": r"!\[a\](b)",
    "a | b": r"a \| b",
    "a\\": "a\\\\",
    "*a* **b**": r"\*a\* \*\*b\*\*",
    "_a_": r"\_a\_",
    "a_b": "a_b",
    "O1.theta_dot": "O1.theta_dot",
    "`a`": r"\`a\`",
    "~~a~~": r"\~\~a\~\~",
    "&lt;b&gt; &#60;": "&amp;lt;b&amp;gt; &amp;#60;",
    "R & D": "R & D",
    "a\n# b": "a # b",
    "theta'' (deg)": "theta'' (deg)",
    "ab\u202ecd": "abcd",
    "5 > 3": "5 > 3",
}


@pytest.mark.parametrize("text", FORMULAS)
def test_formulas_become_text_in_csv(text: str) -> None:
    assert csv_text(text) != text
    for piece in re.split(r"[;\n\r\t]", csv_text(text)):
        assert not re.match(r"[\s\"]*[=+\-@＝]", piece)
    assert csv_text(text).replace("'", "") == text.replace("'", "")


@pytest.mark.parametrize("text", WORDS)
def test_words_stay_as_they_are_in_csv(text: str) -> None:
    assert csv_text(text) == text


@pytest.mark.parametrize("text", MARKUP)
def test_markup_becomes_words(text: str) -> None:
    assert markdown_text(text) == MARKUP[text]


@pytest.mark.parametrize("text", ["# a", "- a", "+ a", "> a", "1. a", "12) a", "=== "])
def test_a_line_begins_no_block(text: str) -> None:
    assert markdown_line(text).startswith(("\\", "1\\", "12\\"))


@given(st.text(max_size=40))
def test_any_text_is_one_line_without_tags_or_open_bars(text: str) -> None:
    line = markdown_text(text)
    assert "\n" not in line
    assert "<" not in line
    without_pairs = re.sub(r"\\[\\|`*\[\]~_]", "", line)
    assert not re.search(r"[\\|`*\[\]~]", without_pairs)


@given(st.text(st.characters(exclude_categories=["Cs"]), max_size=30))
def test_any_label_reads_back_from_csv(text: str) -> None:
    field = csv_text(text).replace('"', '""')
    row = next(csv.reader(io.StringIO(f'"{field}"', newline="")))
    assert row[0].replace("'", "") == text.replace("'", "")
    assert not re.match(r"[=+\-@\t\r\n]", row[0])


def test_links_hold_any_name() -> None:
    assert link_target("a b/(c).csv") == "a%20b/%28c%29.csv"
    assert link_target("a\udcff") == "a%FF"


FILE = """\
format: 1
links: {arm: {mass: 2, center_of_mass: [3, 0, 0]}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
motion: {inputs: {O.theta: {from: -10, to: 10, step: 10}}}
tables:
  - {name: t, title: "<b>=1|_x_", columns: [{label: "=1+1", value: O.theta},
     {label: "-[x](y)|", value: -O.theta}, {label: "@a", value: O.theta_dot/O.theta}]}
"""


def test_tables_of_a_file() -> None:
    found = mk.loads(FILE).analyze()
    text = csv_bytes(found.tables[0]).decode()
    assert text.splitlines()[0] == "'=1+1,'-[x](y)|,'@a"
    assert [line.split(",")[0] for line in text.splitlines()[1:]] == ["-10", "0", "10"]
    page = markdown_bytes(found.tables[0], found.result).decode()
    assert page.startswith("# &lt;b>=1\\|\\_x\\_\n")
    assert "| =1+1 [deg] | -\\[x\\](y)\\| [deg] |" in page
    assert "no @a: the value" in page
    assert read_table_text("t.md", page.encode()).labels[1] == "-\\[x\\](y)\\| [deg]"
    assert found.tables[0].columns[0].label == "=1+1"  # only files are neutral
