"""A program of the same stack that computes nothing: what a process costs without mechkin's work.

    python tests/benchmark/do_nothing.py analyze mechanisms/rcsr.yaml

A typer app with as many commands and options as mechkin; it imports numpy, yaml and the schema's
models, reads the file with yaml's own loader into plain text data, validates it and exits.
"""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
Files = Annotated[list[Path], typer.Argument(help="Mechanism files.")]
Folder = Annotated[Path | None, typer.Option("--out", help="Folder.")]
Names = Annotated[list[str] | None, typer.Option(help="Names.")]
Flag = Annotated[bool, typer.Option(help="Flag.")]


@app.command()
def analyze(
    files: Files,
    out: Folder = None,
    format: Names = None,
    set: Names = None,
    mode: Annotated[str | None, typer.Option(help="Mode.")] = None,
    table: Names = None,
    explain: Flag = False,
    json: Flag = False,
    quiet: Flag = False,
) -> None:
    import numpy  # noqa: F401
    import yaml

    from mechkin_cli.schema.file import MechanismFile

    loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
    for file in files:
        MechanismFile.model_validate(yaml.load(file.read_text(encoding="utf-8"), Loader=loader))


@app.command()
def check(files: Files, set: Names = None, json: Flag = False, quiet: Flag = False) -> None:
    pass


@app.command()
def tables(path: Path | None = None, check: Flag = False, json: Flag = False) -> None:
    pass


@app.command()
def schema(out: Folder = None, check: Flag = False) -> None:
    pass


@app.command()
def bench(yardstick: Folder = None, stress: Flag = False, json: Flag = False) -> None:
    pass


if __name__ == "__main__":
    app()
