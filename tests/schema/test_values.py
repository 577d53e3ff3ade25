"""Single values: from text and from Python numbers."""

from typing import Any

import pytest
from pydantic_core import PydanticCustomError

from mechkin_cli.expressions.functions import FUNCTIONS
from mechkin_cli.schema import scalars
from mechkin_cli.schema.errors import known_keys
from mechkin_cli.schema.file import MechanismFile
from mechkin_cli.schema.scalars import FORMS, expression_text, plain_text, whole_number
from mechkin_cli.schema.validation import RESERVED, InvalidDataError, name_errors, validate


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("0.5 in", "0.5 in"),
        (" P1 ", "P1"),
        (3, "3"),
        (-0.1, "-0.1"),
        (1e-7, "1e-07"),
        ("inf2", "inf2"),
    ],
)
def test_expressions_stay_text(value: Any, text: str) -> None:
    assert expression_text(value) == text


@pytest.mark.parametrize(
    "value",
    [
        "",
        " ",
        "nan",
        ".NaN",
        "-.inf",
        "+Infinity",
        float("nan"),
        float("-inf"),
        10**400,
        True,
        None,
        [],
    ],
)
def test_what_is_no_expression(value: Any) -> None:
    with pytest.raises(PydanticCustomError):
        expression_text(value)


@pytest.mark.parametrize(
    ("value", "number"), [("3", 3), (" -4 ", -4), ("010", 10), (7, 7), ("1000000000", 10**9)]
)
def test_whole_numbers(value: Any, number: int) -> None:
    assert whole_number(value) == number


@pytest.mark.parametrize(
    "value", ["3.0", "1e3", "", "1_000", "9" * 301, 10**300, 2.0, True, None, "\u0663"]
)
def test_what_is_no_whole_number(value: Any) -> None:
    with pytest.raises(PydanticCustomError):
        whole_number(value)


@pytest.mark.parametrize(("value", "text"), [("on", "on"), (1986, "1986"), ("", "")])
def test_texts(value: Any, text: str) -> None:
    assert plain_text(value) == text


def test_functions_of_expressions_are_reserved() -> None:
    assert set(FUNCTIONS) <= RESERVED


@pytest.mark.parametrize("data", [None, [], {"links": [], "chain": {}}, {"joints": {1: {}}}])
def test_names_of_shapeless_data(data: object) -> None:
    assert name_errors(data) == []


def test_python_numbers_are_data_too() -> None:
    hinge = {"type": "R", "links": ["ground", "a"], "point": [0, 0.5, 0], "axis": [0, 0, 1]}
    file = validate({"format": 1, "links": {"a": {}}, "joints": {"hinge": hinge}})
    assert file.joints["hinge"].point == ("0", "0.5", "0")


def test_python_names_of_fields_are_not_keys() -> None:
    motion = {"inputs": {"w.theta": {"first": 0, "last": 1, "count": 2}}}
    joint = {"type": "W", "links": ["ground", "a"]}
    with pytest.raises(InvalidDataError):
        validate({"format": 1, "joints": {"w": joint}, "motion": motion})


@pytest.mark.parametrize(
    ("location", "key"),
    [
        ((), "joints"),
        (("joints", "O1", "(H)"), "lead"),
        (("links", "a", "inertia", "axes"), "y"),
        (("loads", 3, "(spring at joint)"), "coordinate"),
        (("motion", "inputs", "O1.theta", "(swept)"), "from"),
        (("tables", 0, "columns", 2), "decimals"),
    ],
)
def test_keys_known_at_a_location(location: tuple[str | int, ...], key: str) -> None:
    known = known_keys(MechanismFile, location)
    assert known is not None
    assert known[1][key]


@pytest.mark.parametrize("location", [("joints",), ("links", "a", "mass"), ("nothing", 1)])
def test_places_without_fixed_keys(location: tuple[str | int, ...]) -> None:
    assert known_keys(MechanismFile, location) is None


def test_every_pattern_has_words_for_what_should_have_been() -> None:
    patterns = {value for name, value in vars(scalars).items() if name.endswith("_PATTERN")}
    assert patterns == FORMS.keys()


def test_a_cycle_that_is_no_coordinate_is_told_so() -> None:
    balance = {"name": "w", "type": "work", "cycle": "1/A.theta"}
    with pytest.raises(InvalidDataError) as caught:
        validate({"format": "1", "joints": {}, "balances": [balance]})
    told = [e["ctx"] for e in caught.value.errors if e["type"] == "string_pattern_mismatch"]
    assert [context["expected"] for context in told] == ["an input that turns, or time"]
