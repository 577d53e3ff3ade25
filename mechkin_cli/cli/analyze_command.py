"""`mechkin analyze`: its options, for help and for command lines that are not plain."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mechkin_cli.cli.analyze import FORMATS, AnalyzeCommand, analyze_files
from mechkin_cli.cli.options import (
    Files,
    Json,
    Messages,
    Quiet,
    Set,
    folder,
    format_names,
    mode_names,
    table_names,
)


def analyze(
    files: Files,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", parser=folder, help="Folder to write to (default: out/STEM)."
        ),
    ] = None,
    format: Annotated[
        list[str] | None,
        typer.Option(
            "--format",
            metavar="FORMAT",
            help=f"{FORMATS}; may be repeated.",
            autocompletion=format_names,
        ),
    ] = None,
    units: Annotated[
        bool, typer.Option("--units", help="Write units into CSV headers: theta [deg].")
    ] = False,
    set_: Set = None,
    mode: Annotated[
        str | None,
        typer.Option(
            "--mode",
            metavar="NAME",
            help="Assembly mode at the first row.",
            autocompletion=mode_names,
        ),
    ] = None,
    table: Annotated[
        list[str] | None,
        typer.Option(
            "--table",
            metavar="NAME",
            help="Only this table; may be repeated.",
            autocompletion=table_names,
        ),
    ] = None,
    lanes: Annotated[
        int,
        typer.Option(
            "--lanes",
            metavar="N",
            help="Rows computed at a time: 2, 4 or 8; 0: the most the machine can.",
        ),
    ] = 0,
    threads: Annotated[
        int,
        typer.Option("--threads", metavar="N", help="Threads that split the rows; 0: all cores."),
    ] = 0,
    certify: Annotated[
        bool,
        typer.Option(
            "--certify", help="Prove a sweep's positions, and that they lie on one branch."
        ),
    ] = False,
    strict: Annotated[
        bool,
        typer.Option(
            "--strict",
            help="Exit with 4 also if a row is near-singular, rank-unclear or at a dead centre.",
        ),
    ] = False,
    errors: Annotated[
        bool,
        typer.Option("--errors", help="Measure the true error of every cell; write errors.csv."),
    ] = False,
    view: Annotated[
        bool,
        typer.Option("--view", help="Also write view.html, a page that shows all runs in motion."),
    ] = False,
    explain: Annotated[
        bool,
        typer.Option("--explain", help="Show how the loops are solved, what is skipped and why."),
    ] = False,
    messages: Messages = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Run sweeps and responses; show and write their tables.

    Tables go to stdout and to files in out/STEM, messages to stderr. With --json no files are
    written, unless --out or --format asks for them. The exit code is 4 if rows are missing.
    """
    command = AnalyzeCommand(
        files=files,
        out=out,
        format=format,
        units=units,
        set_=set_,
        mode=mode,
        table=table,
        lanes=lanes,
        threads=threads,
        certify=certify,
        strict=strict,
        errors=errors,
        view=view,
        explain=explain,
        messages=messages,
        json=json,
        quiet=quiet,
    )
    code = analyze_files(command)
    if code:
        raise typer.Exit(code)
