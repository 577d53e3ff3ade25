"""Rounding of zero is shown as 0 where decimals are chosen, told by the size of the column."""

from __future__ import annotations

import re

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.tables.columns import column_texts
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.errors import ZERO as ZERO_BUT_FOR_ROUNDING, column_errors
from mechkin_cli.tables.markup import latex_bytes, markdown_bytes
from mechkin_cli.tape import DoubleDoubles

# A crank in the plane square to (2, 1, 2): what is square to its plane is zero but for rounding.
FILE = """\
format: 1
units: {length: LENGTH, angle: deg, mass: kg, force: N}
links: {arm: {mass: 2, center_of_mass: [30 mm, -60 mm, 0]}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [2, 1, 2]}}
points: {tip: {link: arm, at: [30 mm, -60 mm, 0]}}
directions: {n: {link: ground, vector: [2, 1, 2]}, e: {link: arm, vector: [1, -2, 0]}}
motion: {inputs: {O.theta: {from: 7, to: 67, step: 15, rate: 3 rad/s}}}
loads: [{type: gravity, g: [1 m/s^2, 2 m/s^2, -2 m/s^2]}]
tables:
  - name: t
    summary: [peak, mean]
    columns:
      - O.theta
      - {label: off plane, value: "dot(tip.position, n)"}
      - {label: rate, value: "dot(tip.velocity, n)"}
      - {label: acceleration, value: "dot(tip.acceleration, n)"}
      - {label: force, value: "dot(O.force, n)"}
      - {label: size, value: norm(O.force)}
      - {label: turn, value: "asin(dot(e, n))"}
      - {label: cosine, value: "dot(e, n)"}
      - {label: small, value: "1e-9*tip.position.x"}
      - row.residual
"""
ZERO = ("off plane", "rate", "acceleration", "force", "turn", "cosine")


@pytest.mark.parametrize("length", ["mm", "m", "in", "km"])
def test_what_is_zero_is_shown_as_zero(length: str) -> None:
    (table,) = mk.loads(FILE.replace("LENGTH", length)).analyze().tables
    columns = {column.label: column for column in table.columns}
    assert any(np.any(columns[label].values != 0.0) for label in ZERO)
    texts = dict(zip(columns, zip(*table.listing.rows, strict=True), strict=True))
    for label in ZERO:
        assert set(texts[label]) == {"0"}, label
    # a true number is shown however small it is, and all digits of rounding stay in the CSV
    assert all(re.fullmatch(r"-?\d\.\d{5}e-\d\d", text) for text in texts["small"])
    numbers = np.loadtxt(csv_bytes(table).splitlines(), delimiter=",", skiprows=1).T
    for values, column in zip(numbers, table.columns, strict=True):
        assert values.tolist() == column.values.tolist()


def test_pages_and_summaries_show_it_too() -> None:
    lines = FILE.replace("LENGTH", "mm").splitlines(keepends=True)
    text = "".join(line for line in lines if "small" not in line and "residual" not in line)
    analysis = mk.loads(text).analyze()
    (table,) = analysis.tables
    for page in (markdown_bytes(table, analysis.result), latex_bytes(table, analysis.result)):
        assert not re.search(r"e-\d\d|10\^", page.decode())
    assert table.summary is not None
    for column in table.summary.columns:
        if column.label in ZERO:
            texts = dict(zip(table.summary.lines, table.summary.texts(column), strict=True))
            assert texts["peak"] == texts["mean"] == "0"


@pytest.mark.parametrize(
    ("values", "rounding", "texts"),
    [
        ([-1.73e-15, 2e-16], 1e-14, ["0", "0"]),
        ([-1.73e-15, 2e-14], 1e-14, ["0", "2.00000e-14"]),
        ([-1.73e-15, np.nan], 1e-14, ["0", ""]),
        ([1.5e9, 1e-6], 1e-5, ["1.50000e+09", "0"]),
        ([-1.73e-15], 0.0, ["-1.73000e-15"]),
    ],
)
def test_texts(values: list[float], rounding: float, texts: list[str]) -> None:
    assert column_texts(np.array(values), rounding=rounding) == texts


@pytest.mark.parametrize(("true", "why"), [(4.9e-32, ZERO_BUT_FOR_ROUNDING), (1e-9, ""), (0.0, "")])
def test_zero_in_all_doubles_is_right_but_for_what_double_doubles_round(
    true: float, why: str
) -> None:
    exact = DoubleDoubles(np.array([true, 0.0]), np.zeros(2))
    assert column_errors("t", "a", "m/s^2", np.zeros(2), exact).why == why
