"""How many digits rows with a bad condition have: what is told, against a closed form."""

from __future__ import annotations

import numpy as np
import pytest
from errors.test_errors import ROCKER
from errors.test_references import crank_of
from oracle.numerics import mpmath_context as mp

import mechkin_cli as mk
from mechkin_cli.row_notes import RowSet
from mechkin_cli.sweep import dead_centre
from mechkin_cli.tape import TraceLost

PLACES = ["0", "10", "39.93", "39.931180949", "39.9311809496", "39.93118094965"]
"""Down to 2e-11 degrees before a dead centre."""


def analysis(places: list[str]) -> mk.Analysis:
    values = f"{{values: [{', '.join(places)}], rate: 1 rad/s}}"
    text = ROCKER.replace("UNIT", "mm").replace("VALUES", values)
    return mk.loads(text).analyze(["A.theta_dot", "A.theta_ddot"], tables=[])


def told(r: mk.Analysis) -> dict[str, float]:
    found = [d for d in r.result.diagnostics if d.code == "few-digits"]
    return {number.name: number.value for d in found for number in d.numbers}


@pytest.mark.parametrize("place", PLACES[3:])
def test_digits_are_those_of_the_closed_form(place: str):
    r = analysis(["0", place])
    digits = told(r)
    with mp.workdps(90):
        at = mp.mpf(place) * mp.pi / 180
        step = mp.mpf(10) ** -36
        exact = [mp.diff(crank_of, at, n, h=step) for n in (1, 2)]
    for name, quantity, value in zip(
        ("rates", "accelerations"), ("A.theta_dot", "A.theta_ddot"), exact, strict=True
    ):
        cell = float(np.asarray(r.result.quantity(quantity).value)[1])
        part = abs(float((cell - value) / value))
        number = digits[f"digits of {name}"]
        assert 10.0 ** -(number + 1) < part <= 10.0**-number, name


def test_rows_with_digits_enough_say_nothing():
    assert not told(analysis(PLACES[:3]))


def test_the_worst_row_is_named():
    r = analysis(PLACES)
    (note,) = [d for d in r.result.diagnostics if d.code == "few-digits"]
    assert note.severity == "warning"
    assert note.message.startswith("rows 4 to 6 have few digits; fewest has row ")


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ([0], "row 1"),
        ([3, 8], "rows 4 and 9"),
        ([3, 4, 5, 8], "rows 4 to 6 and 9"),
        ([0, 1, 4, 7, 8], "rows 1 to 2, 5 and 8 to 9"),
        (range(0, 40, 4), "rows 1, 5, 9, 13, 17, 21 and 4 more up to row 37"),
    ],
)
def test_rows_are_named_by_their_ranges(rows: list[int], words: str):
    assert str(RowSet.of(rows)) == words


def test_what_is_not_measured_is_said(monkeypatch: pytest.MonkeyPatch):
    def lost(*_: object) -> None:
        raise TraceLost("a number that no tape holds")

    monkeypatch.setattr(dead_centre, "_in_double_double", lost)
    r = analysis(PLACES)
    (note,) = [d for d in r.result.diagnostics if d.code == "few-digits"]
    assert "could not be measured: a number that no tape holds" in note.message
    assert note.limit == "100000"
