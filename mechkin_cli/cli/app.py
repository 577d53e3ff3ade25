"""The typer app: all commands, their help, and what is wrong with a command line."""

from __future__ import annotations

import os
import sys
from inspect import Parameter, Signature
from pathlib import Path
from typing import Annotated, Any

import typer

from mechkin_cli.cli import offers
from mechkin_cli.cli.commands import COMMANDS, Command, Word, all_formats
from mechkin_cli.cli.messages import ExitCode, discard, put, say
from mechkin_cli.verdict import __version__

app = typer.Typer(
    name="mechkin",
    help="Positions, rates, reactions and drive efforts of mechanisms described in YAML files."
    "\n\nStart with: mechkin new NAME, then mechkin analyze NAME.yaml and mechkin view NAME.yaml.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
TYPES: dict[str, type] = {
    "flag": bool,
    "text": str,
    "whole": int,
    "path": Path,
    "folder": Path,
}
"""What typer makes of a word, by its kind."""


def _parameter(word: Word) -> Parameter:
    """A word of a command line as typer wants it."""
    told: dict[str, Any] = {
        "help": word.help.format(formats=all_formats()),
        "metavar": word.metavar,
        "autocompletion": None if word.offers is None else getattr(offers, word.offers),
    }
    if word.kind == "folder":
        told["parser"] = offers.folder
    kind: Any = TYPES[word.kind]
    default: Any = word.default
    if word.kind == "flag":
        default = False
    elif word.default is not None:
        default = kind(word.default)
    else:
        kind = list[kind] if word.repeated else kind
        kind = kind if word.required else kind | None
    info = typer.Option(*word.names, **told) if word.names else typer.Argument(**told)
    return Parameter(
        word.parameter,
        Parameter.KEYWORD_ONLY,
        default=Parameter.empty if word.required else default,
        annotation=Annotated[kind, info],
    )


def _add(command: Command) -> None:
    """Tells typer of a command."""

    def call(**given: Any) -> None:
        code = command.call(given)
        if code:
            raise typer.Exit(code)

    parameters = [_parameter(word) for word in command.words]
    call.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    call.__annotations__ = {one.name: one.annotation for one in parameters}
    app.command(command.name, help=command.help)(call)


for command in COMMANDS.values():
    _add(command)


@app.callback(invoke_without_command=True)
def _options(
    version: bool = typer.Option(False, "--version", help="Print the version and exit."),
) -> None:
    if version:
        put(f"mechkin {__version__}\n")
        raise typer.Exit()


def run() -> int:
    """Runs the command of the process's command line; its exit code."""
    try:
        return int(app(standalone_mode=False, prog_name="mechkin") or 0)
    except typer.Abort:
        return ExitCode.INTERRUPTED
    except Exception as error:
        if not (hasattr(error, "exit_code") and hasattr(error, "show")):
            raise
        _show(error)
        for file in filter(os.path.isfile, sys.argv[1:2]):
            say(f"To run a mechanism file: mechkin analyze {file}")
        return int(error.exit_code)


def _show(error: Any) -> None:
    """A usage error of the command line itself, as typer words it."""
    if sys.stderr is None:
        return
    try:
        error.show()
    except OSError:
        discard(sys.stderr)
