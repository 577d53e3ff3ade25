"""The typer app: all commands, their help, what is wrong with a command line, and what shells offer
while one is typed: files, and the names that the file holds.

For an offer a file is only read, and one that cannot be read offers nothing. Assembly modes alone
are searched for, in a process that is given two seconds.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from inspect import Parameter, Signature
from pathlib import Path
from typing import Annotated, Any

import typer

from mechkin_cli.cli.commands import COMMANDS, all_formats
from mechkin_cli.cli.messages import ExitCode, discard, put, say, tell_notes, version_text
from mechkin_cli.cli.words import Command, Word
from mechkin_cli.diagnostics import UsageError

Offers = list[str]


MODES_TIME = 2.0
"""Seconds in which assembly modes are searched for."""

HEAD = 65536
"""Characters of a file that tell whether it is a study."""


STUDY_FORMATS = ("csv", "parquet")
"""As `studies.FORMATS`; a shell that asks for them does not wait for numpy."""


def mechanism_files(incomplete: str) -> Offers:
    """Mechanism files, and the folders on the way to them."""
    return _yaml_files(incomplete)


def study_files(incomplete: str) -> Offers:
    """Study files, and the folders on the way to them."""
    return [path for path in _yaml_files(incomplete) if path.endswith("/") or _is_study(path)]


def _is_study(path: str) -> bool:
    try:
        with open(path, encoding="utf-8", errors="replace") as stream:
            return re.search(r"^study\s*:", stream.read(HEAD), re.MULTILINE) is not None
    except (OSError, ValueError):
        return False


def _yaml_files(incomplete: str) -> Offers:
    folder, _, start = incomplete.rpartition("/")
    above = f"{folder}/" if "/" in incomplete else ""
    try:
        with os.scandir(above or ".") as entries:
            found = [
                f"{above}{entry.name}{'/' if entry.is_dir() else ''}"
                for entry in entries
                if entry.name.startswith(start)
                and (start.startswith(".") or not entry.name.startswith("."))
                and (entry.is_dir() or entry.name.endswith((".yaml", ".yml")))
            ]
    except (OSError, ValueError):
        return []
    return sorted(found)


def table_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Tables and coefficients of the files."""
    sections = [data.get(name) for data in _files(ctx) for name in ("tables", "coefficients")]
    names = [table.get("name") for section in sections for table in _mappings(section)]
    return _beginning(names, incomplete)


def response_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Responses of the file."""
    return _beginning(_keys(ctx, "responses"), incomplete)


def run_names(ctx: typer.Context, incomplete: str) -> Offers:
    """The sweep of the file, where it has one, and its responses."""
    from mechkin_cli.verdict import SWEEP

    sweep = [SWEEP] if any("motion" in data for data in _files(ctx)) else []
    return _beginning([*sweep, *_keys(ctx, "responses")], incomplete)


def mode_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Assembly modes of the file's first row, or of the start of the run on the line."""
    import json
    import subprocess
    import sys

    paths = _paths(ctx)
    settings = [word for text in ctx.params.get("set_") or () for word in ("--set", text)]
    run = ctx.params.get("run")
    at = ["--run", run] if run in _keys(ctx, "responses") else []
    if len(paths) != 1 or str(paths[0]) == "-":
        return []
    # the shell's words for completion would make the process complete, too
    own = {name: text for name, text in os.environ.items() if name != "_MECHKIN_COMPLETE"}
    command = [sys.executable, "-P", "-m", "mechkin_cli", "modes", str(paths[0]), "--json"]
    try:
        done = subprocess.run(
            [*command, *settings, *at], capture_output=True, timeout=MODES_TIME, env=own, check=True
        )
        modes = json.loads(done.stdout).get("modes", [])
    except (subprocess.SubprocessError, OSError, ValueError):
        return []
    return _beginning([mode.get("name") for mode in _mappings(modes)], incomplete)


def study_format_names(incomplete: str) -> Offers:
    """Formats of a study's results."""
    return _beginning(STUDY_FORMATS, incomplete)


def input_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Inputs of the file's sweep."""
    names = [
        name
        for data in _files(ctx)
        if isinstance(motion := data.get("motion"), dict)
        and isinstance(inputs := motion.get("inputs"), dict)
        for name in inputs
    ]
    return _beginning(names, incomplete)


def parameter_names(ctx: typer.Context, incomplete: str) -> Offers:
    """Parameters of the files, or of a study's mechanism, each with the sign behind which its value
    stands."""
    return _beginning([f"{name}=" for name in _keys(ctx, "parameters")], incomplete)


def format_names(incomplete: str) -> Offers:
    """Formats of results."""
    from mechkin_cli.tables import WRITERS

    return _beginning(WRITERS, incomplete)


def message_forms(incomplete: str) -> Offers:
    """Forms of messages."""
    from mechkin_cli.cli.messages import FORMS

    return _beginning(FORMS, incomplete)


def _files(ctx: typer.Context) -> list[Mapping[str, Any]]:
    """The files named so far, as plain data; those that are no mechanism files are left out."""
    from mechkin_cli.diagnostics import MechkinError
    from mechkin_cli.reading import read_document

    found: list[Mapping[str, Any]] = []
    for path in _paths(ctx):
        try:
            data = read_document(path).data
            if "study" in data and isinstance(mechanism := data.get("mechanism"), str):
                data = read_document(path.parent / mechanism).data
        except (MechkinError, ValueError):
            continue
        found.append(data)
    return found


def _paths(ctx: typer.Context) -> list[Path]:
    """The files on the line."""
    # behind an option that still lacks its value, files are words that nothing has taken yet
    given = ctx.params.get("files") or ctx.params.get("file") or ctx.args
    return [Path(path) for path in ([given] if isinstance(given, str | Path) else given)]


def _keys(ctx: typer.Context, section: str) -> list[str]:
    found = [data.get(section) for data in _files(ctx)]
    return [name for names in found if isinstance(names, dict) for name in names]


def _mappings(section: object) -> list[dict[str, Any]]:
    items = section if isinstance(section, list) else []
    return [item for item in items if isinstance(item, dict)]


def _beginning(names: Iterable[object], start: str) -> Offers:
    return [
        name for name in dict.fromkeys(names) if isinstance(name, str) and name.startswith(start)
    ]


def folder(text: str) -> Path:
    """A folder to write to.

    Raises:
        UsageError: it has no name, as that of a variable of the shell that is not set.
    """
    if not text:
        raise UsageError("--out has no name; write a folder behind it, as --out results")
    return Path(text)


OFFERS: dict[str, Callable[..., Offers]] = {
    offer.__name__: offer
    for offer in (
        mechanism_files,
        study_files,
        table_names,
        response_names,
        run_names,
        mode_names,
        study_format_names,
        input_names,
        parameter_names,
        format_names,
        message_forms,
    )
}
"""What words of a command line are offered, by name."""


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
        "autocompletion": None if word.offers is None else OFFERS[word.offers],
    }
    if word.kind == "folder":
        told["parser"] = folder
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
        tell_notes(not given.get("quiet"))
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
    version: bool = typer.Option(
        False, "--version", help="Print the versions of program, kernel and file format, and exit."
    ),
) -> None:
    if version:
        put(version_text())
        raise typer.Exit()


def run() -> int:
    """Runs the command of the process's command line; its exit code."""
    try:
        return int(app(standalone_mode=False, prog_name="mechkin") or 0)
    except typer.Abort:
        return ExitCode.INTERRUPTED
    except SystemExit as ended:
        # help whose reader has gone away is no failure, though typer ends with 1
        if isinstance(ended.__context__, BrokenPipeError):
            discard(sys.stdout)
            return ExitCode.OK
        raise
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
