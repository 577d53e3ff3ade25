"""`mechkin tables`: regenerates the tables kept beside the mechanisms, or compares them.

In reading order: the command, the files of one mechanism, `--against` (printed cells that do not
agree), the overview page of a folder.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import model as models, tables as room, view
from mechkin_cli.cli.analyze import run_all
from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    content_of,
    mechanism_files,
    put,
    put_json,
    refusal,
    refuse_stdin,
    say,
    say_diagnostics,
    tell_as,
)
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.mechanism import is_told
from mechkin_cli.record import asdict
from mechkin_cli.tables import MARK, OVERVIEW_PAGE, OverviewRow, overview_page

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.model import Model
    from mechkin_cli.tables import OutputFolder, PrintedTable

MECHANISMS = Path("mechanisms")


def tables(
    path: Path = MECHANISMS,
    check: bool = False,
    against: bool = False,
    messages: str | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """Regenerates the tables kept beside mechanism files, or compares them."""
    tell_as(messages)
    refuse_stdin(path, "tables are kept beside a file, and - is none")
    files = mechanism_files(path)
    overview = path if path.is_dir() else None
    if against:
        if check:
            raise UsageError("--against and --check are two questions; ask them one by one")
        return list_disagreements(files, json, quiet)
    code = ExitCode.OK
    records: list[Record] = []
    rows: list[OverviewRow] = []
    with working("", quiet) as tell:
        for number, file in enumerate(files, 1):
            tell(f"{file} ({number} of {len(files)})")
            try:
                outcome, record, row = _one(file, check, json, quiet, overview)
                rows += [row] if row else []
            except (InvalidFile, UsageError) as error:
                outcome, record = refusal(file, error)
            code = max(code, outcome)
            records.append(record)
    found: Record = {"files": records}
    if overview is not None and len(rows) == len(files):
        outcome, found["overview"] = keep_overview(overview, rows, check, json, quiet)
        code = max(code, outcome)
    if json:
        put_json(found)
    return code


def _one(
    file: Path, check: bool, json: bool, quiet: bool, overview: Path | None
) -> tuple[ExitCode, Record, OverviewRow | None]:
    """Computes one file's tables, and compares or writes them; alone in their folder if it does.

    Args:
        overview: the folder whose overview has the file in it.
    """
    model = models.load(file)
    if check:
        return _made(file, model, None, json, quiet, overview)
    if not file.stem.strip("."):
        raise UsageError(f"{file}: a folder for its tables would be {file.stem}; rename the file")
    with room.OutputFolder(file.with_suffix("")) as output:
        return _made(file, model, output, json, quiet, overview)


def _made(
    file: Path,
    model: Model,
    output: OutputFolder | None,
    json: bool,
    quiet: bool,
    overview: Path | None,
) -> tuple[ExitCode, Record, OverviewRow | None]:
    analyses, diagnostics, printed = _analyses(file, model)
    row = (
        None
        if overview is None
        else overview_row(model, file.relative_to(overview), analyses, printed)
    )
    fresh = _fresh_files(model, analyses, printed)
    complete = all(analysis.complete for analysis in analyses)
    code = ExitCode.OK if complete else ExitCode.ROWS_MISSING
    record: Record = {"file": str(file), "diagnostics": [one.record() for one in diagnostics]}
    if output is None:
        outcome, compared = _compare(file.with_suffix(""), fresh, json, quiet)
        return max(code, outcome), record | {"tables": compared}, row
    stale = room.stale_in(output.folder, fresh)
    written = output.write(fresh, stale)
    if not quiet:
        gone = f", {len(stale)} removed ({', '.join(stale)})" if stale else ""
        say(f"{output.folder}: {len(written)} files written{gone}")
    record |= {"written": [str(path) for path in written]}
    return code, record | {"removed": [str(output.folder / name) for name in stale]}, row


def _analyses(
    file: Path, model: Model
) -> tuple[list[Analysis], list[Diagnostic], list[PrintedTable]]:
    """The runs of a file, what they have to say, and the tables that have printed values."""
    analyses = run_all(model)
    diagnostics = list(dict.fromkeys(one for run in analyses for one in run.diagnostics))
    say_diagnostics(diagnostics, str(file))
    printed = [
        table for run in analyses for table in room.against_print(file, run.layouts, run.tables)
    ]
    return analyses, diagnostics, printed


def _fresh_files(
    model: Model, analyses: Sequence[Analysis], printed: Sequence[PrintedTable]
) -> dict[str, bytes]:
    """All that stands beside a mechanism file, by name: tables, the picture, the errata page."""
    fresh: dict[str, bytes] = {}
    for analysis in analyses:
        for table in (*analysis.tables, *analysis.coefficients, *analysis.balance_tables):
            fresh[f"{table.name}.csv"] = room.csv_bytes(table, room.COMMITTED_DIGITS)
            if table.summary is not None:
                below = room.summary_table(table.name, table.title, table.summary)
                fresh[f"{below.name}.csv"] = room.csv_bytes(below, room.COMMITTED_DIGITS)
            fresh[f"{table.name}.md"] = room.markdown_bytes(table, analysis.result)
    picture = view.mechanism_picture(analyses[0].result, model.view_settings)
    fresh[view.PICTURE_NAME] = picture.encode()
    if printed:
        fresh[room.PAGE] = room.errata_page(model.name, model.source, printed).encode()
        if listed := room.disagreements_csv(printed):
            fresh[room.NAME] = listed
    return fresh


def _compare(
    folder: Path, fresh: dict[str, bytes], json: bool, quiet: bool
) -> tuple[ExitCode, list[Record]]:
    comparisons = room.compare_files(fresh, room.read_committed(folder, fresh))
    same = all(c.verdict == "equal" for c in comparisons)
    if same and not quiet:
        say(f"{folder}: {len(fresh)} files as committed")
    elif not same:
        say(f"{folder}: the tables on disk are not what this version computes")
        if not json:
            put(room.report(comparisons))
    return ExitCode.OK if same else ExitCode.DIFFERENCES, [asdict(c) for c in comparisons]


# `mechkin tables --against`: printed cells that do not agree with what the files compute.


def list_disagreements(files: Sequence[Path], json: bool, quiet: bool) -> ExitCode:
    """Counts to stderr and every disagreeing cell to stdout, as CSV or as one JSON object.

    Files without printed values are passed over. That cells disagree is an answer, no failure: the
    exit code is 0 unless a file cannot be used.
    """
    code, records = ExitCode.OK, []
    for file in files:
        try:
            model = models.load(file)
            has_print = any(table.published for table in model.tables)
            printed = _analyses(file, model)[2] if has_print else []
        except (InvalidFile, UsageError) as error:
            outcome, record = refusal(file, error)
            code = max(code, outcome)
            records.append(record)
            continue
        if printed:
            if not quiet:
                say(f"{file}: {room.counts(one.agreement for one in printed)}")
            if not json:
                put(room.disagreements_csv(printed).decode())
            records.append({"file": str(file), "tables": room.against_print_record(printed)})
    if json:
        put_json({"files": records})
    return code


def overview_row(
    model: Model, file: Path, analyses: Sequence[Analysis], printed: Sequence[PrintedTable]
) -> OverviewRow:
    """A line of the overview of a folder; `file` is the path in it."""
    solved = sum(int(analysis.result.solved.sum()) for analysis in analyses)
    rows = sum(analysis.rows for analysis in analyses)
    return OverviewRow(
        file.with_suffix("").as_posix(),
        model.name,
        " ".join(
            joint.letter
            for name, joint in model.problem.mechanism.joints.items()
            if is_told(name) and not joint.is_play
        ),
        _mobility(model),
        _modes(model),
        str(solved) if solved == rows else f"{solved} of {rows}",
        room.counts(one.agreement for one in printed) if printed else "",
        model.source,
        view.PICTURE_NAME,
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
    modes = model.modes()
    return f"{len(modes.modes)} (all)" if modes.complete else str(len(modes.modes))


def keep_overview(
    folder: Path, rows: Sequence[OverviewRow], check: bool, json: bool, quiet: bool
) -> tuple[ExitCode, str]:
    """Writes the page, or compares it; a README.md without the mark is left alone.

    Returns the exit code and what became of the page: `written`, `equal`, `different`, `missing` or
    `left`.
    """
    page, fresh = folder / OVERVIEW_PAGE, overview_page(rows).encode()
    old = content_of(page) if page.is_file() else None
    if old is not None and not old.startswith(MARK.encode()):
        if not quiet:
            say(f"{page}: left alone, it does not begin with {MARK}")
        return ExitCode.OK, "left"
    if not check:
        room.write_files(folder, {OVERVIEW_PAGE: fresh})
        return ExitCode.OK, "written"
    committed = {} if old is None else {OVERVIEW_PAGE: old}
    (comparison,) = room.compare_files({OVERVIEW_PAGE: fresh}, committed)
    if comparison.verdict == "equal":
        return ExitCode.OK, "equal"
    say(f"{page}: the overview on disk is not what this version makes")
    if not json:
        put(room.report([comparison]))
    return ExitCode.DIFFERENCES, comparison.verdict
