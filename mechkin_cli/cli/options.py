"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mechkin_cli.cli.completion import mechanism_files, message_forms, parameter_names
from mechkin_cli.cli.messages import FORMS
from mechkin_cli.diagnostics import UsageError


def folder(text: str) -> Path:
    """A folder to write to.

    Raises:
        UsageError: it has no name, as that of a variable of the shell that is not set.
    """
    if not text:
        raise UsageError("--out has no name; write a folder behind it, as --out results")
    return Path(text)


Files = Annotated[
    list[Path],
    typer.Argument(
        help="Mechanism files (YAML, format 1); - reads stdin.",
        metavar="FILE",
        autocompletion=mechanism_files,
    ),
]
File = Annotated[
    Path,
    typer.Argument(
        help="Mechanism file (YAML, format 1); - reads stdin.",
        metavar="FILE",
        autocompletion=mechanism_files,
    ),
]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="NAME=VALUE",
        help="Set a parameter, as P1=0.6in; repeatable.",
        autocompletion=parameter_names,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON object on stdout and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Only warnings and errors.")]
MESSAGES_HELP = f"Form of the messages: {' or '.join(FORMS)} (annotations for CI)."
Messages = Annotated[
    str | None,
    typer.Option(
        "--messages",
        metavar="FORM",
        help=MESSAGES_HELP,
        autocompletion=message_forms,
    ),
]
