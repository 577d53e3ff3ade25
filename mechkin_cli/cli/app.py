"""The typer app: all commands, their help, and what is wrong with a command line."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import Any

import typer

from mechkin_cli.cli.analyze_command import analyze
from mechkin_cli.cli.answer import mobility, modes
from mechkin_cli.cli.bench import bench
from mechkin_cli.cli.check import check
from mechkin_cli.cli.messages import ExitCode, put, say
from mechkin_cli.cli.new import new, schema
from mechkin_cli.cli.plot import plot
from mechkin_cli.cli.ranges import ranges
from mechkin_cli.cli.study import study
from mechkin_cli.cli.tables import tables
from mechkin_cli.cli.view import view
from mechkin_cli.verdict import version as package_version

app = typer.Typer(
    name="mechkin",
    help="Positions, rates, reactions and drive efforts of mechanisms described in YAML files."
    "\n\nStart with: mechkin new NAME, then mechkin analyze NAME.yaml and mechkin view NAME.yaml.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
COMMANDS = (
    *(new, analyze, view, check, modes, ranges, mobility),
    *(plot, study, tables, schema, bench),
)
for command in COMMANDS:
    app.command()(command)


@app.callback(invoke_without_command=True)
def _options(
    version: bool = typer.Option(False, "--version", help="Print the version and exit."),
) -> None:
    if version:
        put(f"mechkin {package_version()}\n")
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
    with contextlib.suppress(OSError):
        if sys.stderr is not None:
            error.show()
