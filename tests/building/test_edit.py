"""Other values of parameters in a file: units and expressions as they were written."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.building import edit_parameters, value_text
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.units import UnitSystem

MM = UnitSystem.from_mapping({"length": "mm", "angle": "deg"})
FILE = """\
format: 1
units: {length: mm}
parameters:
  r: 40 mm  # the crank
  l: 12cm   # the rod
  e: r/2    # half the crank
  n: 3
links: {arm: {}}
joints: {O: {type: R, links: [ground, arm], point: [r + e, l, 0], axis: [0, 0, 1]}}
"""


@pytest.mark.parametrize(
    ("written", "value", "text"),
    [
        ("40 mm", 44.0, "44 mm"),
        ("40mm", 44.25, "44.25mm"),
        ("4 cm", 44.0, "4.4 cm"),
        ("1 in", 12.7, "0.5 in"),
        ("-0.5 in", 25.4, "1 in"),
        ("180 deg", 90.5, "90.5 deg"),
        ("7", -1e-7, "-1e-07"),
        ("r/2", 44.0, None),
        ("2*3", 44.0, None),
        ("pi", 44.0, None),
        ("40 mm + 1 mm", 44.0, None),
        ("(", 44.0, None),
    ],
)
def test_a_value_keeps_its_unit(written: str, value: float, text: str | None) -> None:
    assert value_text(written, value, MM) == text


@pytest.mark.parametrize(
    ("unit", "in_mm"), [("cm", "10"), ("in", "25.4"), ("ft", "304.8"), ("um", "1/1000")]
)
def test_another_unit_says_the_same_length(unit: str, in_mm: str) -> None:
    for value in (1.0, 44.1, 1e-5, 12345.678, 1 / 3):
        text = value_text(f"1 {unit}", value, MM)
        assert text is not None
        found = Fraction(text.split()[0]) * Fraction(in_mm)
        assert abs(found / Fraction(value) - 1) < Fraction(1, 10**14)


def test_expressions_are_replaced_when_they_are_named() -> None:
    built = mk.loads(FILE).built
    values = {"r": 44.0, "l": 132.0, "e": 21.5, "n": 3.0}
    first = edit_parameters(FILE, built, values)
    assert first.written == {"r": "44 mm", "l": "13.2cm"}
    assert first.expressions == {"e": "r/2"}
    assert first.text == FILE.replace("40 mm", "44 mm").replace("12cm", "13.2cm")
    second = edit_parameters(FILE, built, values, replace=["e"])
    assert second.text == first.text.replace("r/2", "21.5 mm")
    assert dict(mk.loads(second.text).parameters) == values


def test_an_expression_that_follows_has_its_value() -> None:
    found = edit_parameters(FILE, mk.loads(FILE).built, {"r": 44.2, "e": 22.1})
    assert (found.written, found.expressions) == ({"r": "44.2 mm"}, {})


def test_values_that_are_there_already_change_nothing() -> None:
    m = mk.loads(FILE)
    found = edit_parameters(FILE, m.built, dict(m.parameters), replace=["e"])
    assert (found.text, found.written, found.expressions) == (FILE, {}, {})


@pytest.mark.parametrize("name", ["rcsr", "planar_four_bar"])
def test_a_kept_file_reads_as_what_was_set(name: str) -> None:
    path = Path(FILE_OF[name])
    text = path.read_bytes().decode("utf-8")
    m = mk.load(path)
    values = {each: 1.0625 * value for each, value in m.parameters.items()}
    found = edit_parameters(text, m.built, values)
    again = mk.loads(found.text, folder=path.parent)
    assert found.written or not values
    for each in found.written:
        assert again.parameters[each] == pytest.approx(values[each], rel=1e-15)
        assert again.parameters.unit(each) == m.parameters.unit(each)
    assert [line.partition("#")[2] for line in found.text.splitlines()] == [
        line.partition("#")[2] for line in text.splitlines()
    ]


@pytest.mark.parametrize(
    ("values", "words"), [({"rr": 1.0}, "did you mean r"), ({"r": float("nan")}, "not a number")]
)
def test_what_cannot_be_is_refused(values: dict[str, float], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        edit_parameters(FILE, mk.loads(FILE).built, values)
