"""`mechkin schema`: the JSON Schema of mechanism files, for editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import put, say
from mechkin_cli.diagnostics import UsageError

COMMITTED = Path("schemas/mechanism.schema.json")


def schema(
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="Write to a file instead of stdout."),
    ] = None,
    check: Annotated[
        bool, typer.Option("--check", help=f"Compare with {COMMITTED} (or --out) instead.")
    ] = False,
) -> None:
    """Print the JSON Schema of mechanism files."""
    from mechkin_cli.schema.json_schema import json_schema_text

    text = json_schema_text()
    if check:
        path = out or COMMITTED
        if _content(path) != text.encode():
            say(f"{path} is not up to date; run: mechkin schema --out {path}")
            raise typer.Exit(ExitCode.DIFFERENCES)
        say(f"{path} is up to date")
    elif out is not None:
        from mechkin_cli.tables.files import write_files

        write_files(out.parent, {out.name: text.encode()})
    else:
        put(text)


def _content(path: Path) -> bytes:
    from mechkin_cli.regular_file import MOST_TABLE_BYTES, read_regular

    try:
        return read_regular(path, MOST_TABLE_BYTES)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"cannot read {path}: {reason}") from None
