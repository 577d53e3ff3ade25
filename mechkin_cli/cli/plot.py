"""`mechkin plot`: pictures of a run, of its tables or of what is named."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mechkin_cli.cli.messages import (
    ExitCode,
    model_of,
    parameters,
    put,
    refusal,
    say_diagnostics,
    shown,
    stem_of,
)
from mechkin_cli.cli.options import File, Quiet, Set, mode_names, run_names, table_names
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.model import Model
    from mechkin_cli.plots import Picture


if TYPE_CHECKING:
    Drawn = tuple[Analysis, str | None]
    """A run, and the table of it that is drawn; None: what is named."""

ENDING = "svg"
"""Format of pictures whose file is not named."""


def plot(
    file: File,
    x: Annotated[
        str | None,
        typer.Option(
            "--x",
            metavar="NAME",
            help="What the horizontal axis shows (default: the input or time).",
        ),
    ] = None,
    y: Annotated[
        list[str] | None,
        typer.Option(
            "--y", metavar="NAMES", help="What is drawn, separated by commas; repeatable."
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
    run: Annotated[
        str | None,
        typer.Option(
            "--run",
            metavar="NAME",
            help="Run to draw: sweep, or a response (default: the first).",
            autocompletion=run_names,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", metavar="PICTURE", help="File to write: .svg, .png or .pdf."),
    ] = None,
    mode: Annotated[
        str | None,
        typer.Option(
            "--mode",
            metavar="NAME",
            help="Assembly mode at the first row.",
            autocompletion=mode_names,
        ),
    ] = None,
    set_: Set = None,
    quiet: Quiet = False,
) -> None:
    """Draw curves, coupler curves and polar diagrams of a file.

    Without --y, one picture for each table, as its `plot:` says, in out/STEM/TABLE.svg. --y takes
    labels of columns, quantities or expressions. Vectors are drawn in a plane: a point's position
    as a coupler curve, a force as a polar diagram. Needs matplotlib: pip install 'mechkin[plot]'.
    """
    from mechkin_cli.plots import format_of, image

    ending = ENDING if out is None else format_of(out)
    names = [name for text in y or () for name in listed(text)]
    if names and table:
        raise UsageError("--y names what is drawn, --table too; leave one of them out")
    try:
        with working(f"{shown(file)}: reading", quiet) as tell:
            model = model_of(file, parameters(set_))
            tell(f"{shown(file)}: rows")
            analyses = _tables(model, table, run, mode) if not names else {}
            if names:
                analyses[stem_of(file)] = _run(model, run, mode), None
            if out is not None and len(analyses) > 1:
                tables = ", ".join(analyses)
                raise UsageError(f"-o is one picture; choose one of {tables} with --table")
            files = {}
            for name, drawn in analyses.items():
                tell(f"{shown(file)}: picture of {name}")
                picture = _picture(drawn, names, x)
                files[f"{name}.{ending}" if out is None else out.name] = image(picture, ending)
    except (InvalidFile, UsageError) as error:
        code, _ = refusal(file, error)
        raise typer.Exit(code) from error
    _write(file, out, files, quiet)
    found = [analysis for analysis, _ in analyses.values()]
    said = dict.fromkeys(one for analysis in found for one in analysis.diagnostics)
    say_diagnostics(tuple(said), shown(file))
    if not all(analysis.complete for analysis in found):
        raise typer.Exit(ExitCode.ROWS_MISSING)


def _picture(drawn: Drawn, names: list[str], x: str | None) -> Picture:
    """The picture of a run: of what is named, or of its table."""
    from mechkin_cli.expressions import ExpressionError

    analysis, table = drawn
    try:
        return analysis.picture(tuple(names), x, table)
    except ExpressionError as error:
        raise UsageError(str(error)) from error


def listed(text: str) -> list[str]:
    """Names with commas between them; those in brackets part nothing.

    >>> listed("A.effort, dot(A.force, d)")
    ['A.effort', 'dot(A.force, d)']
    """
    parts, depth = [""], 0
    for character in text:
        depth += (character in "([") - (character in ")]")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts if part.strip()]


def _run(model: Model, run: str | None, mode: str | None) -> Analysis:
    """The run that is named, or the first."""
    name = model.runs[0] if run is None else run
    if name == SWEEP:
        return model.analyze(mode=mode)
    return model.respond(name, mode=mode)


def _tables(
    model: Model, names: list[str] | None, run: str | None, mode: str | None
) -> dict[str, Drawn]:
    """The tables that are drawn, by name, with their runs."""
    from mechkin_cli.cli.analyze import run_all

    return {
        layout.name: (analysis, layout.name)
        for analysis in run_all(model, names, mode)
        for layout in analysis.layouts
        if run in (None, analysis.run)
    }


def _write(file: Path, out: Path | None, files: dict[str, bytes], quiet: bool) -> None:
    from mechkin_cli.tables import write_files

    folder = Path("out") / stem_of(file) if out is None else out.parent
    written = write_files(folder, files)
    for path in () if quiet else written:
        put(f"{path}\n")
