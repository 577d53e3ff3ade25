"""Both YAML parsers give the same nodes and messages; limits end in messages."""

from pathlib import Path

import pytest
import yaml
from reading.bad_files import BAD_FILES

from mechkin_cli.diagnostics import InvalidFile
from mechkin_cli.reading.text import MOST_EVENTS, MOST_LEVELS
from mechkin_cli.reading.yaml import Mapping, ScalarNode, Style, parse, plain_data

GOOD = sorted((Path(__file__).parent / "good").glob("*.yaml"))
needs_libyaml = pytest.mark.skipif(not yaml.__with_libyaml__, reason="PyYAML without libyaml")


def outcome(text: str, loader: type) -> Mapping | str:
    try:
        return parse(text, "f.yaml", loader=loader)
    except InvalidFile as invalid:
        return str(invalid)


@needs_libyaml
@pytest.mark.parametrize("path", GOOD, ids=lambda path: path.stem)
def test_both_parsers_read_the_same_nodes(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    fast = outcome(text, yaml.CSafeLoader)
    assert isinstance(fast, Mapping)
    assert fast == outcome(text, yaml.SafeLoader)


@needs_libyaml
@pytest.mark.parametrize("text", [bad.text for bad in BAD_FILES], ids=lambda text: repr(text[-40:]))
def test_both_parsers_give_the_same_messages(text: str) -> None:
    assert outcome(text, yaml.CSafeLoader) == outcome(text, yaml.SafeLoader)


@pytest.mark.parametrize(
    "written", ["1e-3", "on", "010", "0x10", "1_000", "12:30:00", "2001-01-01", "yes", "+.5", "-P1"]
)
def test_scalars_stay_text(written: str) -> None:
    assert plain_data(parse(f"a: {written}", "f.yaml")) == {"a": written}


def test_marks_styles_and_order() -> None:
    root = parse("b: 'x'\na: {c: [1, \"2\"]}\n", "f.yaml")
    assert list(root.entries) == ["b", "a"]
    assert root.entries["b"] == ((1, 1), ScalarNode("x", (1, 4), Style.SINGLE_QUOTED))
    _, inner = root.entries["a"]
    assert isinstance(inner, Mapping)
    assert inner.entries["c"][0] == (2, 5)
    assert plain_data(inner) == {"c": ["1", "2"]}


@pytest.mark.parametrize("opening", ["[", "{a: ", "- ", "? "])
def test_deep_nesting_ends_in_a_message(opening: str) -> None:
    with pytest.raises(InvalidFile, match=f"more than {MOST_LEVELS} deep"):
        parse(opening * 200_000, "f.yaml")


def test_nesting_up_to_the_limit_is_read() -> None:
    levels = MOST_LEVELS - 1
    root = parse("a: " + "[" * levels + "]" * levels, "f.yaml")
    assert str(plain_data(root)).count("[") == levels


def test_too_many_values_end_in_a_message() -> None:
    text = "a: [" + "1," * MOST_EVENTS + "1]"
    with pytest.raises(InvalidFile, match="too long for a mechanism file"):
        parse(text, "f.yaml")


@pytest.mark.parametrize("length", range(1, 60, 7))
def test_a_file_cut_off_anywhere_never_crashes(length: int) -> None:
    text = "a: {b: [1, \"2\"], c: 'x'}\nd: |\n  text\ne:\n  - f: 1\n"[:length]
    assert isinstance(outcome(text, yaml.SafeLoader), Mapping | str)
