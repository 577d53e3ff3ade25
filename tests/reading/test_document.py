"""Where things stand: places of values, keys and characters; parameters set from outside."""

import pytest

from mechkin_cli.building.source import open_text
from mechkin_cli.diagnostics import InvalidFile, Place, UsageError
from mechkin_cli.reading.document import document_from_text

TEXT = """\
parameters:
  P1: 0.5 in
  alpha: 12 deg
tables:
  - name: t
    columns: [{label: a, value: "dot(a, b)"}, 'it''s', P1]
"""


@pytest.mark.parametrize(
    ("path", "value", "key"),
    [
        ((), (1, 1), (1, 1)),
        (("parameters",), (2, 3), (1, 1)),
        (("parameters", "P1"), (2, 7), (2, 3)),
        (("tables", 0), (5, 5), (5, 5)),
        (("tables", 0, "columns"), (6, 14), (6, 5)),
        (("tables", 0, "columns", 0, "value"), (6, 33), (6, 26)),
        (("tables", 0, "columns", 2), (6, 56), (6, 56)),
        (("tables", 0, "missing"), (5, 5), (5, 5)),
        (("tables", 7, "name"), (5, 3), (5, 3)),
        (("parameters", "P1", "deeper"), (2, 7), (2, 7)),
        (("parameters", 0), (2, 3), (2, 3)),
    ],
)
def test_places(path: tuple[str | int, ...], value: tuple[int, int], key: tuple[int, int]) -> None:
    document = document_from_text(TEXT, "f.yaml")
    assert document.place(path) == Place("f.yaml", *value)
    assert document.key_place(path) == Place("f.yaml", *key)


@pytest.mark.parametrize(
    ("written", "text", "offset", "line", "column"),
    [
        ("P1 + 0.5", "P1 + 0.5", 0, 1, 4),
        ("P1 + 0.5", "P1 + 0.5", 5, 1, 9),
        ("P1 + 0.5", "P1 + 0.5", 2, 1, 6),
        ("P1 + 0.5", "P1 + 0.5", 8, 1, 12),
        ('"P1 + 0.5"', "P1 + 0.5", 3, 1, 8),
        ('"P1 + 0.5"', "P1 + 0.5", 8, 1, 13),
        ("'it''s x'", "it's x", 3, 1, 9),
        ("'it''s x'", "it's x", 5, 1, 11),
        ('"a\\x2bb"', "a+b", 2, 1, 10),
        ('"a\\tb"', "a\tb", 2, 1, 8),
        ("P1 +\n  P2", "P1 + P2", 5, 2, 3),
        ('"P1 +\n   P2"', "P1 + P2", 6, 2, 5),
        ("|\n  P1\n  + P2", "P1\n+ P2\n", 5, 3, 5),
    ],
)
def test_places_inside_a_scalar(
    written: str, text: str, offset: int, line: int, column: int
) -> None:
    document = document_from_text(f"a: {written}\n", "f.yaml")
    assert document.data == {"a": text}
    assert document.place_in(("a",), offset) == Place("f.yaml", line, column)


def test_a_place_in_something_that_is_no_scalar_is_its_own_place() -> None:
    assert document_from_text("a: [1]", "f.yaml").place_in(("a",), 3) == Place("f.yaml", 1, 4)


def test_a_byte_order_mark_in_a_text_moves_no_place() -> None:
    assert document_from_text("\ufeffa: 1", "f.yaml").key_place(("a",)) == Place("f.yaml", 1, 1)


def test_parameters_from_outside_replace_values_and_places() -> None:
    document = document_from_text(TEXT, "f.yaml").with_parameters({"P1": "0.6in"})
    assert document.data["parameters"] == {"P1": "0.6in", "alpha": "12 deg"}
    assert str(document.place(("parameters", "P1"))) == "--set P1"
    assert document.place_in(("parameters", "P1"), 3) == Place("--set P1", 0, 4)
    assert str(document.place(("parameters", "alpha"))) == "f.yaml:3:10"


def test_later_parameters_win_and_the_first_document_stays() -> None:
    first = document_from_text(TEXT, "f.yaml")
    second = first.with_parameters({"P1": "1"}).with_parameters({"alpha": "2", "P1": "3"})
    assert second.data["parameters"] == {"P1": "3", "alpha": "2"}
    assert first.data["parameters"] == {"P1": "0.5 in", "alpha": "12 deg"}


@pytest.mark.parametrize(
    ("text", "parameters", "words"),
    [
        (TEXT, {"alpah": "1"}, "did you mean alpha?"),
        (TEXT, {"zzz": "1"}, "it has P1, alpha"),
        ("format: 1", {"P1": "1"}, "no parameters: section"),
        (TEXT, {"P1": " "}, "value is empty"),
    ],
)
def test_parameters_that_cannot_be_set(text: str, parameters: dict[str, str], words: str) -> None:
    with pytest.raises(UsageError, match=words.replace("?", r"\?")):
        document_from_text(text, "f.yaml").with_parameters(parameters)


def test_a_bad_value_from_outside_is_reported_there() -> None:
    text = "format: 1\nparameters: {P1: 1}\njoints: {w: {type: W, links: [ground, a]}}\n"
    with pytest.raises(InvalidFile, match=r"^--set P1: error: parameters\.P1: nan is not"):
        open_text(text, "f.yaml", {"P1": "nan"})
