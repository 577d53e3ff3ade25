"""`mechkin view`: a page that shows a mechanism in motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import view as pages
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
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis


def view(
    file: Path,
    *,
    out: Path | None = None,
    set_: list[str] | None = None,
    mode: str | None = None,
    run: str | None = None,
    no_modes: bool = False,
    open_: bool = False,
    live: bool = False,
    no_open: bool = False,
    messages: str | None = None,
    quiet: bool = False,
) -> ExitCode:
    """Writes a page that shows a mechanism in motion."""

    tell_as(messages)
    if live:
        return _follow(file, out, set_, pages.Wish(run, mode, not no_modes), not no_open, quiet)
    try:
        with working(f"{shown(file)}: reading", quiet) as tell:
            model = model_of(file, parameters(set_))
            tell(f"{shown(file)}: rows")
            analyses = model.analyses(run, mode)
            tell(f"{shown(file)}: the page")
            page, notes = pages.view_page(analyses, not no_modes)
        target = pages.write_view(out or Path("out", stem_of(file), pages.PAGE_NAME), page)
    except (InvalidFile, UsageError) as error:
        return refusal(file, error)[0]
    diagnostics = [one for analysis in analyses for one in analysis.diagnostics]
    say_diagnostics(dict.fromkeys([*diagnostics, *notes]), shown(file))
    put(f"{target}\n")
    if not quiet:
        say(_summary(analyses, len(page)))
    if open_:
        _show(target)
    complete = all(analysis.complete for analysis in analyses)
    return ExitCode.OK if complete else ExitCode.ROWS_MISSING


def _follow(
    file: Path,
    out: Path | None,
    set_: list[str] | None,
    wish: pages.Wish,
    opens: bool,
    quiet: bool,
) -> ExitCode:
    from mechkin_cli.cli.live import follow

    try:
        if out is not None:
            raise UsageError("--live writes no page; leave --out away, or --live")
        if set_:
            raise UsageError("--live shows the file as it is; set parameters in it, or in the page")
        return follow(file, wish, opens, quiet)
    except UsageError as error:
        return refusal(file, error)[0]


def _summary(analyses: list[Analysis], size: int) -> str:
    model = analyses[0].model
    runs = ", ".join(f"{one.run} ({one.rows} rows)" for one in analyses)
    return f"{model.name}: {runs}; {size / 1000:.0f} kB, to be opened in a browser"


def _show(page: Path) -> None:
    """Opens a page in the user's browser, and says where there is none."""
    import webbrowser

    if not webbrowser.open(page.resolve().as_uri()):
        say(f"no browser was found; open {page} by hand")
