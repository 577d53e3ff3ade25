"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Files = Annotated[
    list[Path], typer.Argument(help="Mechanism files (YAML, format 1).", metavar="FILE")
]
File = Annotated[Path, typer.Argument(help="Mechanism file (YAML, format 1).", metavar="FILE")]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="NAME=VALUE", help="Replace a parameter, as P1=0.6in; repeatable."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="One JSON object on stdout and nothing else.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Only warnings and errors.")]
