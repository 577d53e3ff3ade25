"""What the page of commands says is what the commands take and give."""

import re
from functools import cache

import pytest
import typer
from documents.commands.page import PAGE, page as made_anew
from documents.reading import page

from mechkin_cli.cli.app import app
from mechkin_cli.cli.messages import ExitCode

COMMANDS = page("docs/commands.md")
BY_HAND = COMMANDS.partition("## Every option")[0]


@cache
def options() -> dict[str, set[str]]:
    """The options of every command, without --help."""
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    return {
        name: {
            option for parameter in command.params for option in parameter.opts if "--" in option
        }
        for name, command in commands.items()
    }


def described_commands() -> dict[str, str]:
    """The first cell of each row of the table of commands, by command."""
    cells = re.findall(r"^\| `(mechkin [^`]*)` \|", BY_HAND, re.MULTILINE)
    return {cell.split()[1]: cell for cell in cells}


def test_every_option_is_told_as_the_commands_tell_it() -> None:
    again = "run `python -P tests/documents/commands`"
    assert PAGE.read_text(encoding="utf-8") == made_anew(), again


def test_every_command_is_described_and_exists() -> None:
    assert set(described_commands()) == set(options())


@pytest.mark.parametrize("command", described_commands())
def test_options_in_the_table_of_commands_exist(command: str) -> None:
    named = set(re.findall(r"--[a-z]+", described_commands()[command]))
    assert named <= options()[command]


def test_every_option_of_analyze_is_described_and_exists() -> None:
    (table,) = re.findall(
        r"^The options of `mechkin analyze`:\n\n(.*?)\n\n", BY_HAND, re.M | re.DOTALL
    )
    assert set(re.findall(r"`(--[a-z-]+)", table)) == options()["analyze"]


@pytest.mark.parametrize("name", ["README.md", *(f"docs/{x}.md" for x in ("commands", "verdicts"))])
def test_every_option_named_anywhere_exists(name: str) -> None:
    group = typer.main.get_command(app)
    own = {option for parameter in group.params for option in parameter.opts}
    of_the_tests = {"--dist"}  # which pytest takes
    known = {"--help"} | of_the_tests | own.union(*options().values())
    assert set(re.findall(r"(?<![-\w<])--[a-z]+[a-z-]*", page(name))) <= known


def test_exit_codes() -> None:
    (sentence,) = re.findall(r"Exit codes:\*\* (.*?)\.", COMMANDS, re.DOTALL)
    codes = {int(code) for code in re.findall(r"\b\d+\b", sentence)}
    assert codes == {code for code in ExitCode if code != ExitCode.INTERRUPTED}
