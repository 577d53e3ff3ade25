"""Other values in a text: what is not a value stays to the character, and PyYAML reads the rest."""

from __future__ import annotations

import os
import random
from collections.abc import Callable

import pytest
import yaml

from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.reading import edited, value_spans

CASES = 60 * int(os.environ.get("MECHKIN_RANDOM", "1"))
OLD = ["40 mm", "r/2", "-3", "1e-3 m", "2 N*m", "max(r, l)", "it's 5", 'say "5"', "a: b", "é 4"]
NEW = [
    "44 mm",
    "-0.5",
    "1.5e-07 m",
    "r + l",
    "cos(a, b)",
    "don't",
    'a "b"',
    "x: y",
    "a # b",
    "ü",
    "-",
]

Writing = Callable[[str], str]


def plain(text: str) -> str:
    return text


def single(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"


def double(text: str) -> str:
    return '"' + text.replace('"', '\\"') + '"'


def writing(random_: random.Random, text: str) -> Writing:
    """Quotes that a text may stand in; without any only where it means itself there."""
    simple = not any(sign in text for sign in "\"',:#")
    return random_.choice([single, double, *[plain] * (3 * simple)])


def layout(random_: random.Random) -> tuple[list[str], list[str], list[Writing], list[str]]:
    """A text in pieces, between which stand values; the values, their quotes and their names."""
    break_ = random_.choice(["\n", "\n", "\r\n"])
    names = random_.sample(["r", "l", "k1", "e", "Länge", "m"], random_.randint(1, 6))
    values = [random_.choice(OLD) for _ in names]
    quotes = [writing(random_, value) for value in values]
    comment = random_.choice(["", " # r: 40 mm", '  # it\'s "odd": {x'])
    head = f"# {random_.choice(OLD)}{break_}format: 1{break_}{break_}"
    tail = f"links: {{a: {{mass: 40 mm}}}}{random_.choice(['', break_])}"
    pieces = []
    if random_.random() < 0.5:
        blank = random_.choice(["", " ", "\n   ".replace("\n", break_)])
        before = f"{head}parameters: {{{blank}"
        for name in names:
            pieces.append(f"{before}{random_.choice([name, double(name)])}:{blank or ' '}")
            before = f"{random_.choice(['', ' '])},{blank}"
        pieces.append(f" }}{comment}{break_}{tail}")
    else:
        before = f"{head}parameters:{comment}{break_}"
        for name in names:
            gap = random_.choice([" ", "   ", f"{break_}    "])
            pieces.append(f"{before}  {name}:{gap}")
            extra = random_.choice(["", f"{break_}", f"  # {name}: 7{break_}"])
            before = f"{random_.choice(['', '  '])}{comment}{break_}{extra}"
        pieces.append(f"{before}{tail}")
    return pieces, values, quotes, names


def joined(pieces: list[str], values: list[str]) -> str:
    return "".join(a + b for a, b in zip(pieces, [*values, ""], strict=True))


def in_style(quote: Writing, text: str) -> list[str]:
    """How a new value may stand: one without quotes may need some."""
    return [plain(text), single(text)] if quote is plain else [quote(text)]


@pytest.mark.parametrize("seed", range(CASES))
def test_random_layouts(seed: int) -> None:
    random_ = random.Random(seed)
    pieces, values, quotes, names = layout(random_)
    text = joined(pieces, [quote(value) for quote, value in zip(quotes, values, strict=True)])
    spans = value_spans(text)
    for name, value, quote in zip(names, values, quotes, strict=True):
        span = spans["parameters", name]
        assert (text[span.start : span.end], span.text) == (quote(value), value)
    changed = {
        name: random_.choice(NEW) for name in random_.sample(names, random_.randint(1, len(names)))
    }
    mark = random_.choice(["", "\ufeff"])
    result = edited(mark + text, {("parameters", name): new for name, new in changed.items()})
    # all other bytes are as they were
    assert result.startswith(mark)
    rest = result.removeprefix(mark)
    for name, value, quote, piece in zip(names, values, quotes, pieces, strict=False):
        assert rest.startswith(piece)
        rest = rest.removeprefix(piece)
        allowed = in_style(quote, changed[name]) if name in changed else [quote(value)]
        found = [each for each in allowed if rest.startswith(each)]
        assert found
        rest = rest.removeprefix(max(found, key=len))
    assert rest == pieces[-1]
    # and another reader finds the new values
    before, after = (yaml.load(each, Loader=yaml.BaseLoader) for each in (text, result))
    assert after == before | {"parameters": before["parameters"] | changed}


@pytest.mark.parametrize(
    ("block", "after"),
    [
        ("  k: >-\n    r\n    + l\n  m: 1\n", "  k: 2 mm\n  m: 1\n"),
        ("  k: |  # why\n    r\n\n  # here\n  m: 1\n", "  k: 2 mm  # why\n\n  # here\n  m: 1\n"),
        ("  k: r +\n    l   # end\n  m: 1\n", "  k: 2 mm   # end\n  m: 1\n"),
        ("  ? k\n  : r\n  m: 1\n", "  ? k\n  : 2 mm\n  m: 1\n"),
    ],
)
def test_values_of_several_lines(block: str, after: str) -> None:
    text = "parameters:\n" + block
    assert edited(text, {("parameters", "k"): "2 mm"}) == "parameters:\n" + after


def test_values_anywhere() -> None:
    text = "links: {a: {}}\njoints:\n  - point: [1, 2, {b: 3}]\n  - 'x'\n"
    places = {
        ("joints", 0, "point", 1): "-2",
        ("joints", 0, "point", 2, "b"): "4",
        ("joints", 1): "y",
    }
    assert edited(text, places) == "links: {a: {}}\njoints:\n  - point: [1, -2, {b: 4}]\n  - 'y'\n"


@pytest.mark.parametrize(
    ("text", "value", "words"),
    [
        ("parameters: {l: 1}\n", "2", "no value at parameters.r"),
        ("parameters: {r: {x: 1}}\n", "2", "no value at parameters.r"),
        ("parameters: {r: 1}\n", " ", "it is empty"),
        ("parameters: {r: 1}\n", "2\nlinks: {}", "U\\+000A"),
        ("parameters: {r: 1}\n", "2\u2028", "U\\+2028"),
    ],
)
def test_what_cannot_be_is_refused(text: str, value: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        edited(text, {("parameters", "r"): value})


@pytest.mark.parametrize("text", ["parameters: {r: &a 1, l: *a}\n", "parameters: {r: 1\n", ""])
def test_what_the_reader_refuses_is_not_edited(text: str) -> None:
    with pytest.raises(InvalidFile):
        edited(text, {("parameters", "r"): "2"})
