"""`mechkin schema`: the JSON Schemas of mechanism files and of studies, for editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import put, say
from mechkin_cli.diagnostics import UsageError

MECHANISM = "mechanism"


def committed(name: str) -> Path:
    """Where the schema of a name is kept."""
    return Path(f"schemas/{name}.schema.json")


def schema(
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="Write to a file instead of stdout."),
    ] = None,
    check: Annotated[
        bool,
        typer.Option("--check", help="Compare with the files in schemas/ (or --out) instead."),
    ] = False,
    study: Annotated[
        bool, typer.Option("--study", help="Print the schema of study files instead.")
    ] = False,
) -> None:
    """Print the JSON Schema of mechanism files."""
    from mechkin_cli.schema.json_schema import SCHEMAS, json_schema_text

    name = "study" if study else MECHANISM
    if check:
        names = [name]
        if not study and out is None:
            # studies are not everybody's
            names += [one for one in SCHEMAS if one != name and committed(one).exists()]
        found = [_is_up_to_date(one, out or committed(one)) for one in names]
        if not all(found):
            raise typer.Exit(ExitCode.DIFFERENCES)
        return
    text = json_schema_text(name)
    if out is not None:
        from mechkin_cli.tables.files import write_files

        write_files(out.parent, {out.name: text.encode()})
    else:
        put(text)


def _is_up_to_date(name: str, path: Path) -> bool:
    """Whether the file has the schema; says so, or what to do."""
    from mechkin_cli.schema.json_schema import json_schema_text

    if _content(path) == json_schema_text(name).encode():
        say(f"{path} is up to date")
        return True
    option = "" if name == MECHANISM else f"--{name} "
    say(f"{path} is not up to date; run: mechkin schema {option}--out {path}")
    return False


def _content(path: Path) -> bytes:
    from mechkin_cli.regular_file import MOST_TABLE_BYTES, read_regular

    try:
        return read_regular(path, MOST_TABLE_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"cannot read {path}: {reason}") from None
