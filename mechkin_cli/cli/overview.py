"""The overview page that `mechkin tables FOLDER` keeps: what it says of a file, and its check."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import put, say
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.overview import MARK, PAGE, OverviewRow, overview_page

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis, Model
    from mechkin_cli.tables.errata import PrintedTable


def overview_row(
    file: Path, analyses: Sequence[Analysis], printed: Sequence[PrintedTable]
) -> OverviewRow:
    """One file in a line."""
    from mechkin_cli.tables.errata import counts
    from mechkin_cli.view.drawing.picture import NAME as PICTURE

    model = analyses[0].model
    solved = sum(int(analysis.result.solved.sum()) for analysis in analyses)
    rows = sum(analysis.rows for analysis in analyses)
    return OverviewRow(
        file.stem,
        model.name,
        " ".join(joint.letter for joint in model.problem.mechanism.joints.values()),
        _mobility(model),
        _modes(model),
        str(solved) if solved == rows else f"{solved} of {rows}",
        counts(one.agreement for one in printed) if printed else "",
        model.source,
        PICTURE,
    )


def _mobility(model: Model) -> str:
    """The true mobility; Kutzbach's count and idle freedoms where they differ from it."""
    found = model.mobility()
    text = "unclear" if found.mobility is None else str(found.mobility)
    beside = [] if found.count == found.mobility else [f"count {found.count}"]
    if found.idle:
        beside.append(f"{len(found.idle)} idle")
    return f"{text} ({', '.join(beside)})" if beside else text


def _modes(model: Model) -> str:
    """Number of modes found, and whether it is proven to be all; of a file of responses alone those
    at the start of its first."""
    found = model.modes()
    count = len(found.modes)
    return f"{count} (all)" if found.complete else str(count)


def keep_overview(
    folder: Path, rows: Sequence[OverviewRow], check: bool, json: bool, quiet: bool
) -> tuple[ExitCode, str]:
    """Writes the page, or compares it; a README.md without the mark is left alone.

    Returns the exit code and what became of the page: `written`, `equal`, `different`, `missing` or
    `left`.
    """
    page, fresh = folder / PAGE, overview_page(rows).encode()
    old = _content(page) if page.is_file() else None
    if old is not None and not old.startswith(MARK.encode()):
        if not quiet:
            say(f"{page}: left alone, it does not begin with {MARK}")
        return ExitCode.OK, "left"
    if not check:
        from mechkin_cli.tables.files import write_files

        write_files(folder, {PAGE: fresh})
        return ExitCode.OK, "written"
    return _compared(page, fresh, old, json)


def _content(page: Path) -> bytes:
    from mechkin_cli.regular_file import MOST_TABLE_BYTES, read_regular

    try:
        return read_regular(page, MOST_TABLE_BYTES)
    except OSError as error:
        raise UsageError(f"cannot read {page}: {error.strerror}; make it readable") from None


def _compared(page: Path, fresh: bytes, old: bytes | None, json: bool) -> tuple[ExitCode, str]:
    from mechkin_cli.tables.compare import compare_files
    from mechkin_cli.tables.comparison_report import report

    (found,) = compare_files({PAGE: fresh}, {} if old is None else {PAGE: old})
    if found.verdict == "equal":
        return ExitCode.OK, "equal"
    say(f"{page}: the overview on disk is not what this version makes")
    if not json:
        put(report([found]))
    return ExitCode.DIFFERENCES, found.verdict
