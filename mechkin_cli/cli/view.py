"""`mechkin view`: a page that shows a mechanism in motion, or the pages of a folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import tables, view as pages
from mechkin_cli.cli.messages import (
    ExitCode,
    is_stdin,
    mechanism_files,
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


INDEX = "index.yaml"
"""A file at the top of a folder that has no page in a gallery: its name is that of the index."""


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
    if not is_stdin(file) and file.is_dir():
        if set_ or mode or run:
            raise UsageError(
                f"--set, --mode and --run are about one mechanism, and {file} is a folder; leave "
                "them out, or name a file"
            )
        return _gallery(file, out or Path("out", stem_of(file.absolute())), no_modes, open_, quiet)
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


def _gallery(folder: Path, out: Path, no_modes: bool, open_: bool, quiet: bool) -> ExitCode:
    """Writes a page for each mechanism of a folder and the index that links them, last; a file that
    cannot be used is left out, and its faults are told."""
    files = mechanism_files(folder)
    if folder / INDEX in files:
        raise UsageError(f"{folder / INDEX}: the index takes the name of its page; rename it")
    code, cards, size = ExitCode.OK, [], 0
    with working("", quiet) as tell:
        for number, file in enumerate(files, 1):
            tell(f"{file} ({number} of {len(files)})")
            try:
                model = model_of(file, {})
                analyses = model.analyses()
                page, notes = pages.view_page(analyses, not no_modes)
            except (InvalidFile, UsageError) as error:
                code = max(code, refusal(file, error)[0])
                continue
            said = [one for analysis in analyses for one in analysis.diagnostics]
            worth = [one for one in (*said, *notes) if one.severity != "note"]
            say_diagnostics(dict.fromkeys(worth), shown(file))
            if not all(analysis.complete for analysis in analyses):
                code = max(code, ExitCode.ROWS_MISSING)
            card, picture = pages.card_of(analyses, file.relative_to(folder))
            tables.write_files(
                (out / card.page).parent,
                {Path(card.page).name: page, Path(card.picture).name: picture.encode()},
            )
            cards.append(card)
            size += len(page)
    if not cards:
        return code
    title = folder.absolute().name.replace("_", " ")
    index = tables.write_files(out, {pages.INDEX_NAME: pages.index_page(title, cards)})[0]
    put(f"{index}\n")
    if not quiet:
        counted = f"{len(cards)} of {len(files)} mechanisms"
        say(f"{counted}; {size / 1000:.0f} kB, to be opened in a browser")
    if open_:
        _show(index)
    return code


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
