"""Plain command lines mean the same without typer as with it."""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import typer
from references import RCSR

from mechkin_cli.cli import analyze_command
from mechkin_cli.cli.app import app
from mechkin_cli.cli.run import OPTIONS, plain_analysis

WORDS = [
    *OPTIONS,
    *("a.yaml", "b.yaml", "-", "--", "-x", "--help", "--out=d", "--lan", "2", "02", "x", "csv"),
    *("P1=3", "P1=-3", "", " ", "-1", "1.0", "--no-json", "²", "٣"),
]


def by_typer(words: list[str], monkeypatch: pytest.MonkeyPatch) -> dict[str, Any] | None:
    """The fields of `AnalyzeCommand`; None where typer refuses or only helps."""
    seen: list[dict[str, Any]] = []
    monkeypatch.setattr(
        analyze_command, "analyze_files", lambda command: seen.append(command._asdict())
    )
    try:
        app(words, standalone_mode=False)
    except Exception:
        return None
    return seen[0] if seen else None


def test_the_options_are_those_declared() -> None:
    command = typer.main.get_command(app).commands["analyze"]  # type: ignore[attr-defined]
    declared = {
        option.opts[0]: (option.name, option.is_flag, option.multiple)
        for option in command.params
        if option.opts[0].startswith("--") and option.opts[0] != "--help"
    }
    assert declared == {
        name: (option.argument, option.value is None, option.repeated)
        for name, option in OPTIONS.items()
    }


@pytest.mark.parametrize("seed", range(40))
def test_what_is_plain_means_the_same_to_typer(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    dice = random.Random(seed)
    for _ in range(10):
        words = ["analyze", *dice.choices(WORDS, k=dice.randint(1, 6))]
        plain = plain_analysis(words)
        if plain is None:
            continue
        whole = by_typer(words, monkeypatch)
        assert whole is not None, words
        left_out = {name: value for name, value in whole.items() if name not in plain}
        assert {name: whole[name] for name in plain} == plain, words
        assert not any(left_out.values()), words


def test_some_lines_are_plain() -> None:
    words = ["analyze", "a.yaml", "--set", "P1=-3", "--out", "d", "--set", "q=1", "--lanes", "4"]
    assert plain_analysis(words) == {
        "files": [Path("a.yaml")],
        "set_": ["P1=-3", "q=1"],
        "out": Path("d"),
        "lanes": 4,
    }
    assert plain_analysis([*words, "--quiet", "b.yaml"]) is not None


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["analyze"],
        ["check", "a.yaml"],
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
        ["--version"],
    ],
)
def test_all_else_is_left_to_typer(words: list[str]) -> None:
    assert plain_analysis(words) is None


def test_a_plain_line_loads_no_typer(tmp_path: Path) -> None:
    script = (
        "import atexit, sys\n"
        "from mechkin_cli.cli.main import main\n"
        "heavy = ('typer', 'click', 'rich', 'pydantic', 'scipy')\n"
        "atexit.register(lambda: print([m for m in heavy if m in sys.modules], file=sys.stderr))\n"
        f"sys.argv[1:] = ['analyze', {str(RCSR)!r}, '--out', {str(tmp_path)!r}, '--quiet']\n"
        "main()\n"
    )
    command = [sys.executable, "-P", "-c", script]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    assert done.stderr == "[]\n"
    assert (tmp_path / "rows.csv").is_file()
