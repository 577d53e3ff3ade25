"""Plain command lines mean the same without typer as with it."""

from __future__ import annotations

import random
import re
import subprocess
import sys
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any

import pytest
from references import RCSR
from typer.testing import CliRunner

from mechkin_cli.cli.analyze import AnalyzeCommand
from mechkin_cli.cli.app import app
from mechkin_cli.cli.commands import COMMANDS
from mechkin_cli.cli.run import plain_line
from mechkin_cli.cli.words import Command


def words_of(command: Command) -> list[str]:
    return [
        *(name for word in command.words for name in word.names),
        *("a.yaml", "b.yaml", "-", "--", "-x", "--help", "--out=d", "--lan", "2", "02", "x", "csv"),
        *("P1=3", "P1=-3", "", " ", "-1", "1.0", "--no-json", "²", "٣"),
    ]


def by_typer(words: list[str], monkeypatch: pytest.MonkeyPatch) -> dict[str, Any] | None:
    """The values of the parameters; None where typer refuses or only helps."""
    seen: list[dict[str, Any]] = []
    monkeypatch.setattr(Command, "call", lambda self, given: seen.append(given) or 0)
    try:
        app(words, standalone_mode=False)
    except Exception:
        return None
    return seen[0] if seen else None


@pytest.mark.parametrize("name", COMMANDS)
def test_the_functions_have_the_parameters(name: str) -> None:
    """And the defaults of those that may be left out."""
    module, function = COMMANDS[name].home.split(":")
    work = getattr(import_module(f"mechkin_cli.cli.{module}"), function)
    taken = signature(AnalyzeCommand if name == "analyze" else work).parameters
    if name == "analyze":
        assert [word.parameter for word in COMMANDS[name].words] == list(AnalyzeCommand._fields)
        defaults = AnalyzeCommand._field_defaults
    else:
        assert [word.parameter for word in COMMANDS[name].words] == list(taken)
        defaults = {one.name: one.default for one in taken.values() if one.default is not one.empty}
    assert {word.parameter for word in COMMANDS[name].words if not word.required} == set(defaults)
    for word in COMMANDS[name].words:
        if not word.required:
            default = False if word.kind == "flag" else word.default
            found = defaults[word.parameter]
            assert found == default or str(found) == default


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("seed", range(12))
def test_what_is_plain_means_the_same_to_typer(
    name: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    dice = random.Random(seed)
    for _ in range(12):
        words = [name, *dice.choices(words_of(COMMANDS[name]), k=dice.randint(0, 6))]
        plain = plain_line(words)
        if plain is None:
            continue
        given = plain[1]
        whole = by_typer(words, monkeypatch)
        assert whole is not None, words
        defaults = {word.parameter: word.default for word in COMMANDS[name].words}
        left_out = {one: value for one, value in whole.items() if one not in given}
        assert {one: whole[one] for one in given} == given, words
        assert not any(
            value and str(value) != str(defaults[one]) for one, value in left_out.items()
        ), words


@pytest.mark.parametrize("name", COMMANDS)
def test_some_lines_of_every_command_are_plain(name: str) -> None:
    dice = random.Random(1)
    words = words_of(COMMANDS[name])
    lines = [[name, *dice.choices(words, k=dice.randint(1, 4))] for _ in range(400)]
    assert sum(plain_line(line) is not None for line in lines) > 5


def test_values_of_a_plain_line() -> None:
    words = ["analyze", "a.yaml", "--set", "P1=-3", "--out", "d", "--set", "q=1", "--lanes", "4"]
    command, given = plain_line(words) or (None, None)
    assert command == COMMANDS["analyze"]
    assert given == {
        "files": [Path("a.yaml")],
        "set_": ["P1=-3", "q=1"],
        "out": Path("d"),
        "lanes": 4,
    }
    assert plain_line([*words, "--quiet", "b.yaml"]) is not None
    assert plain_line(["view", "a.yaml", "-o", "x"]) == (
        COMMANDS["view"],
        {"file": Path("a.yaml"), "out": Path("x")},
    )


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["analyze"],
        ["analyse", "a.yaml"],
        ["analyze", "--json"],
        ["analyze", "a.yaml", "--out"],
        ["analyze", "a.yaml", "--out", "-d"],
        ["analyze", "a.yaml", "--out=d"],
        ["analyze", "a.yaml", "--out", "d", "--out", "e"],
        ["analyze", "a.yaml", "--json", "--json"],
        ["analyze", "a.yaml", "--lanes", "four"],
        ["analyze", "a.yaml", "--lanes", "-1"],
        ["analyze", "a.yaml", "--help"],
        ["analyze", "--", "a.yaml"],
        ["modes", "a.yaml", "b.yaml"],
        ["modes"],
        ["schema", "a"],
        ["--version"],
    ],
)
def test_all_else_is_left_to_typer(words: list[str]) -> None:
    assert plain_line(words) is None


def test_a_plain_line_loads_no_typer(tmp_path: Path) -> None:
    script = (
        "import atexit, sys\n"
        "from mechkin_cli.__main__ import main\n"
        "heavy = ('typer', 'click', 'rich', 'pydantic_core', 'scipy')\n"
        "atexit.register(lambda: print([m for m in heavy if m in sys.modules], file=sys.stderr))\n"
        f"sys.argv[1:] = ['analyze', {str(RCSR)!r}, '--out', {str(tmp_path)!r}, '--quiet']\n"
        "main()\n"
    )
    command = [sys.executable, "-P", "-c", script]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    assert done.stderr == "[]\n"
    assert (tmp_path / "rows.csv").is_file()


@pytest.mark.parametrize("name", COMMANDS)
def test_help_says_what_each_word_takes(name: str) -> None:
    told = CliRunner().invoke(app, [name, "--help"], env={"COLUMNS": "200"}).output
    assert not re.search(r"\b(TEXT|INTEGER|FLOAT)\b", told), "typer's words for a type"
    for word in COMMANDS[name].words:
        if word.kind == "flag":
            continue
        assert word.metavar, f"{word.parameter} of {name}"
        assert word.metavar in told
