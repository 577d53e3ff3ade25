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
        try:
            committed = path.read_text(encoding="utf-8")
        except OSError as error:
            raise UsageError(f"cannot read {path}: {error.strerror}") from None
        if committed != text:
            say(f"{path} is not up to date; run: mechkin schema --out {path}")
            raise typer.Exit(ExitCode.DIFFERENCES)
        say(f"{path} is up to date")
    elif out is not None:
        from mechkin_cli.tables.files import write_files

        write_files(out.parent, {out.name: text.encode()})
    else:
        put(text)
