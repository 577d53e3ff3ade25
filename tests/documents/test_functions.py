"""docs/functions.md lists every function as it is written, and its examples are right."""

import re
from pathlib import Path

import pytest

from mechkin_cli.expressions.expression import constant, parse
from mechkin_cli.expressions.functions import FUNCTIONS
from mechkin_cli.expressions.quantity import MAX_DEPTH, MAX_NODES, MAX_TEXT_LENGTH
from mechkin_cli.units.units import UnitSystem

PAGE = (Path(__file__).parents[2] / "docs" / "functions.md").read_text(encoding="utf-8")
ROWS = [line.split("|")[1:-1] for line in PAGE.splitlines() if re.match(r"\| `\w+\(", line)]
EXAMPLES = [match for row in ROWS for match in re.findall(r"`([^`]+)` is (.+?) *$", row[-1])]


def test_every_function_has_its_row() -> None:
    listed = [usage for row in ROWS for usage in re.findall(r"`([^`]+)`", row[0])]
    assert sorted(listed) == sorted(function.usage for function in FUNCTIONS.values())
    assert len(EXAMPLES) == len(ROWS)


@pytest.mark.parametrize(("text", "result"), EXAMPLES)
def test_examples(text: str, result: str) -> None:
    found, units = parse(text).evaluate({}.__getitem__), UnitSystem()
    expected = constant(f"1*{result}", found.dimension, units)
    assert found.value == pytest.approx(expected, rel=1e-15, abs=1e-15)


def test_limits_are_those_of_the_reader() -> None:
    words = f"at most {MAX_TEXT_LENGTH} characters, {MAX_NODES} parts and {MAX_DEPTH} levels"
    assert words in " ".join(PAGE.split())
