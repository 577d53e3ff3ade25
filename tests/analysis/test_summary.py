"""Summaries of analyses: from Python, on the command line, and against numpy on the CSV files."""

from __future__ import annotations

import csv
import io
import os
import random

import numpy as np
import pytest
from means import mean_over_the_way, rms_over_the_way
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.tables.results import Results
from mechkin_cli.tables.writers import written_files

WORDS = ("max", "min", "peak", "mean", "rms", "range")
COUNT = 12 * int(os.environ.get("MECHKIN_RANDOM", "1"))
COLUMNS = (
    "A.theta",
    "C.theta",
    "D.theta_dot",
    "tip.position.x",
    "norm(tip.velocity)",
    "A.effort",
    "B.radial_force",
    "norm(B.force)",
    "1 mm/(D.theta_dot + 1 rad/s)",
    "row.condition",
    "row.status",
    "sqrt(C.theta/(1 deg) - 20)",
)


def four_bar(rng: random.Random) -> str:
    """A four-bar anywhere between crank-rocker and what does not close, with rows unequally far
    apart, backwards or not, and columns at random."""
    crank, rod, rocker = (rng.uniform(*part) for part in ((20, 60), (60, 110), (50, 110)))
    rows = sorted(rng.uniform(-170, 170) for _ in range(rng.randint(1, 30)))
    values = [round(v, 3) for v in (reversed(rows) if rng.random() < 0.3 else rows)]
    columns = rng.sample(COLUMNS, rng.randint(2, len(COLUMNS)))
    words = rng.sample(WORDS, rng.randint(1, len(WORDS)))
    listed = "".join(
        f'      - {{label: c{k}, value: "{text}"}}\n' for k, text in enumerate(columns)
    )
    pin = f"{{rod: [{crank + rod}, 0, 0], rocker: [90, {rocker}, 0]}}"
    return f"""\
format: 1
units: {{length: mm, angle: deg, force: N}}
links: {{crank: {{mass: 0.4, center_of_mass: [{crank / 2}, 3, 0]}}, rod: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [crank, rod], point: [{crank}, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [rod, rocker], point: {pin}, axis: [0, 0, 1]}}
  D: {{type: R, links: [ground, rocker], point: [90, 0, 0], axis: [0, 0, 1]}}
points: {{tip: {{link: rod, at: [{crank + rod / 3}, 12, 0]}}}}
motion: {{inputs: {{A.theta: {{values: {values}, rate: 3}}}}}}
loads: [{{type: gravity, g: [0, -9810, 0]}}, {{type: torque, joint: D, value: 120}}]
tables:
  - name: t
    summary: [{", ".join(words)}]
    columns:
{listed}"""


def read(text: bytes) -> tuple[list[str], list[list[str]]]:
    head, *lines = csv.reader(io.StringIO(text.decode(), newline=""))
    return head, lines


def by_numpy(values: np.ndarray, at: np.ndarray) -> dict[str, float]:
    """The rows of a summary from the cells of a CSV file, by other code."""
    known = np.isfinite(values)
    found = dict.fromkeys((*WORDS, *(f"{w} at" for w in WORDS[:3])), np.nan)
    found["rows"] = float(known.sum())
    if not known.any():
        return found
    v = values[known]
    found |= {"max": v.max(), "min": v.min(), "peak": np.abs(v).max(), "range": np.ptp(v)}
    found["mean"] = mean_over_the_way(np.where(known, values, np.nan), at)
    found["rms"] = rms_over_the_way(np.where(known, values, np.nan), at)
    moving = np.ptp(at) > 0
    places = at if moving else np.arange(1.0, at.size + 1)
    found["max at"] = places[np.nanargmax(values)]
    found["min at"] = places[np.nanargmin(values)]
    found["peak at"] = places[np.nanargmax(np.abs(values))]
    return found


def fault(seed: int) -> str:
    """Where the summary is not what numpy makes of the table; "" if nowhere."""
    text = four_bar(random.Random(seed))
    try:
        model = mk.loads(text)
    except mk.InvalidFile as refused:
        return f"{seed}: {refused}"
    analysis = model.analyze()
    files = written_files([Results("t", analysis.tables, analysis.result)], ["csv"])
    head, lines = read(files["t.csv"])
    _, rows = read(files["rows.csv"])
    at = np.array([float(row[1]) for row in rows])
    labels, below = read(files["t.summary.csv"])
    by_row = {line[0]: dict(zip(labels[1:], line[1:], strict=True)) for line in below}
    for number, label in enumerate(head):
        cells = [line[number] for line in lines]
        column = model.tables[0].columns[number].expression.text
        if column in ("A.theta", "row.status"):
            if label in labels:
                return f"{seed}: {column} is summed up"
            continue
        values = np.array([float(cell) if cell else np.nan for cell in cells])
        expected = by_numpy(values, at)
        for word, cells_below in by_row.items():
            cell = float(cells_below[label]) if cells_below[label] else np.nan
            size = np.nanmax(np.abs(values), initial=0.0)
            limit = 0.0 if "at" in word or word in ("max", "min", "peak", "rows") else 1e-14 * size
            right = (
                np.isnan(cell) if np.isnan(expected[word]) else abs(cell - expected[word]) <= limit
            )
            if not right:
                return f"{seed}: {word} of {column} is {cell}, not {expected[word]}"
    return ""


def test_random_tables_have_the_summaries_that_numpy_gives_them():
    wrong = [words for seed in range(COUNT) if (words := fault(seed))]
    assert not wrong, "\n".join(wrong)


@pytest.fixture(scope="module")
def analysis() -> mk.Analysis:
    return mk.load("mechanisms/dissertation/rcsr.yaml").analyze()


def test_peak_is_a_value_and_its_place(analysis):
    value, place = analysis.peak("O1.effort")
    efforts = np.abs(analysis["O1.effort"])
    row = int(np.argmax(efforts))
    assert (value, place) == (efforts[row], analysis["O1.theta"][row])


def test_a_vector_counts_by_its_norm(analysis):
    assert analysis.summary("O3.force") == analysis.summary("norm(O3.force)")


def test_every_computed_column_of_every_table_has_one(analysis):
    found = analysis.summary()
    assert list(found) == [table.name for table in analysis.tables]
    assert "theta1" not in found["table_03"]
    assert found["table_03"]["theta4"] == analysis.summary("O4.theta")


def test_words_have_none(analysis):
    with pytest.raises(mk.UsageError, match=r"row\.status is words"):
        analysis.peak("row.status")
    with pytest.raises(mk.ExpressionError, match="nothing named"):
        analysis.peak("O9.effort")


def test_max_of_one_says_where_extremes_over_the_rows_stand(analysis):
    with pytest.raises(mk.ExpressionError) as error:
        analysis["max(O1.effort)"]
    assert "summary: [max]" in str(error.value)
    assert 'r.summary("...").max' in str(error.value)


def test_errors_say_that_summaries_are_not_repeated():
    errors = mk.loads(four_bar(random.Random(3))).analyze().errors
    assert "off by no more than twice" in errors.why["t.summary.all columns"]


def test_a_response_is_summed_up_over_its_time():
    text = """\
format: 1
links: {bob: {mass: 2, center_of_mass: [0, -0.25, 0]}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}
responses:
  turn: {start: {A.theta: 0, A.theta_dot: 2}, time: {values: [0, 0.1, 0.5, 2]}}
tables: [{name: t, run: turn, summary: [mean, max], columns: [time, A.theta, A.theta_dot]}]
"""
    below = mk.loads(text).respond("turn").summary()["t"]
    # nothing acts: 2 rad/s for ever, the angle grows with time
    assert below["A.theta_dot"].mean == pytest.approx(2.0, rel=1e-9)
    assert below["A.theta"].max.place == 2.0
    assert below["A.theta"].mean == pytest.approx(np.degrees(2.0), rel=1e-9)


def test_writing_into_a_table_changes_no_later_answer() -> None:
    model = mk.load(FILE_OF["slider_crank"])
    first = model.analyze()
    expected = first["A.theta"].copy()
    for table in first.tables:
        for column in table.columns:
            if isinstance(column.values, np.ndarray):
                column.values[...] = 77.0
    again = model.analyze()
    np.testing.assert_array_equal(again["A.theta"], expected)
    np.testing.assert_array_equal(again.tables[0].columns[0].values, expected)
