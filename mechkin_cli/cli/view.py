"""`mechkin view`: a page that shows a mechanism in motion."""

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
    say,
    say_diagnostics,
    shown,
    stem_of,
    tell_as,
)
from mechkin_cli.cli.options import File, Messages, Quiet, Set, mode_names, run_names
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis


def view(
    file: File,
    out: Annotated[
        Path | None,
        typer.Option(
            "-o", "--out", metavar="PAGE", help="File to write (default: out/STEM/view.html)."
        ),
    ] = None,
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
    run: Annotated[
        str | None,
        typer.Option(
            "--run",
            metavar="NAME",
            help="Show only this run: sweep, or the name of a response.",
            autocompletion=run_names,
        ),
    ] = None,
    no_modes: Annotated[
        bool, typer.Option("--no-modes", help="Leave out the other assembly modes.")
    ] = False,
    open_: Annotated[
        bool, typer.Option("--open", help="Also open the page in the browser.")
    ] = False,
    messages: Messages = None,
    quiet: Quiet = False,
) -> None:
    """Write a page that shows a mechanism in motion.

    One file of HTML that works offline: the mechanism in three dimensions along its sweep and its
    responses, in all assembly modes, with curves, tables, verdicts and notes.
    """
    from mechkin_cli.view import PAGE_NAME, view_page, write_view

    tell_as(messages)
    try:
        with working(f"{shown(file)}: reading", quiet) as tell:
            model = model_of(file, parameters(set_))
            tell(f"{shown(file)}: rows")
            analyses = model.analyses(run, mode)
            tell(f"{shown(file)}: the page")
            page, notes = view_page(analyses, not no_modes)
        target = write_view(out or Path("out", stem_of(file), PAGE_NAME), page)
    except (InvalidFile, UsageError) as error:
        raise typer.Exit(refusal(file, error)[0]) from None
    said = [found for analysis in analyses for found in analysis.diagnostics]
    say_diagnostics(dict.fromkeys([*said, *notes]), shown(file))
    put(f"{target}\n")
    if not quiet:
        say(_summary(analyses, len(page)))
    if open_:
        _show(target)
    if not all(analysis.complete for analysis in analyses):
        raise typer.Exit(ExitCode.ROWS_MISSING)


def _summary(analyses: list[Analysis], size: int) -> str:
    """What is on the page, and how large it is."""
    model = analyses[0].model
    runs = ", ".join(f"{one.run} ({one.rows} rows)" for one in analyses)
    return f"{model.name}: {runs}; {size / 1000:.0f} kB, to be opened in a browser"


def _show(page: Path) -> None:
    """Opens a page in the user's browser, and says where there is none."""
    import webbrowser

    if not webbrowser.open(page.resolve().as_uri()):
        say(f"no browser was found; open {page} by hand")
