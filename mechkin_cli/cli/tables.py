"""`mechkin tables`: regenerates the tables kept beside the mechanisms, or compares them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mechkin_cli.cli.analyze import run_all
from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    put,
    put_json,
    refusal,
    refuse_stdin,
    say,
    say_diagnostics,
    tell_as,
)
from mechkin_cli.cli.options import Json, Messages, Quiet, mechanism_files
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.tables import MARK, OVERVIEW_PAGE, OverviewRow, overview_page

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.model import Model
    from mechkin_cli.tables import OutputFolder, PrintedTable


MECHANISMS = Path("mechanisms")


def tables(
    path: Annotated[
        Path,
        typer.Argument(
            help="A mechanism file, or a folder of them or of such folders.",
            metavar="PATH",
            autocompletion=mechanism_files,
        ),
    ] = MECHANISMS,
    check: Annotated[
        bool, typer.Option("--check", help="Compare with the tables on disk; write nothing.")
    ] = False,
    against: Annotated[
        bool,
        typer.Option("--against", help="List printed cells that do not agree; write nothing."),
    ] = False,
    messages: Messages = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Regenerate the tables kept beside mechanism files.

    Writes the tables of FOLDER/STEM.yaml to FOLDER/STEM/TABLE.csv and .md, and a small picture to
    FOLDER/STEM/picture.svg. If tables name printed values, FOLDER/STEM/errata.md compares them and
    disagreements.csv lists every printed cell that does not agree. What mechkin wrote for a table
    that the file no longer has is removed; other files stay. A folder without mechanism files of
    its own stands for those of the folders in it. FOLDER/README.md is an overview of its
    mechanisms; a README.md of your own is left alone.
    """
    tell_as(messages)
    refuse_stdin(path, "tables are kept beside a file, and - is none")
    files = _mechanism_files(path)
    overview = path if path.is_dir() else None
    if against:
        if check:
            raise UsageError("--against and --check are two questions; ask them one by one")
        list_disagreements(files, json, quiet)
        return
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
    if code:
        raise typer.Exit(code)


def _mechanism_files(path: Path) -> list[Path]:
    if path.is_dir():
        files = [*path.glob("*.yaml")] or [*path.glob("*/*.yaml")]
        if not files:
            raise UsageError(f"{path} holds no mechanism files (*.yaml)")
        return sorted(files, key=lambda file: (file.name, file))
    if not path.exists():
        raise UsageError(f"{path} does not exist; give a mechanism file or a folder of them")
    return [path]


def _one(
    file: Path, check: bool, json: bool, quiet: bool, overview: Path | None
) -> tuple[ExitCode, Record, OverviewRow | None]:
    """Computes one file's tables, and compares or writes them; alone in their folder if it does.

    Args:
        overview: the folder whose overview has the file in it.
    """
    from mechkin_cli.model import load
    from mechkin_cli.tables import OutputFolder

    model = load(file)
    if check:
        return _made(file, model, None, json, quiet, overview)
    if not file.stem.strip("."):
        raise UsageError(f"{file}: a folder for its tables would be {file.stem}; rename the file")
    with OutputFolder(file.with_suffix("")) as output:
        return _made(file, model, output, json, quiet, overview)


def _made(
    file: Path,
    model: Model,
    output: OutputFolder | None,
    json: bool,
    quiet: bool,
    overview: Path | None,
) -> tuple[ExitCode, Record, OverviewRow | None]:
    from mechkin_cli.tables import against_print, stale_in

    analyses = run_all(model)
    said = tuple(dict.fromkeys(found for one in analyses for found in one.diagnostics))
    say_diagnostics(said, str(file))
    printed = [table for one in analyses for table in against_print(file, one.layouts, one.tables)]
    row = (
        None
        if overview is None
        else overview_row(model, file.relative_to(overview), analyses, printed)
    )
    fresh = _fresh_files(model, analyses, printed)
    complete = all(one.complete for one in analyses)
    code = ExitCode.OK if complete else ExitCode.ROWS_MISSING
    record: Record = {
        "file": str(file),
        "diagnostics": [diagnostic.record() for diagnostic in said],
    }
    if output is None:
        outcome, compared = _compare(file.with_suffix(""), fresh, json, quiet)
        return max(code, outcome), record | {"tables": compared}, row
    stale = stale_in(output.folder, fresh)
    written = output.write(fresh, stale)
    if not quiet:
        gone = f", {len(stale)} removed ({', '.join(stale)})" if stale else ""
        say(f"{output.folder}: {len(written)} files written{gone}")
    record |= {"written": [str(path) for path in written]}
    return code, record | {"removed": [str(output.folder / name) for name in stale]}, row


def _fresh_files(
    model: Model, analyses: Sequence[Analysis], printed: Sequence[PrintedTable]
) -> dict[str, bytes]:
    """All that stands beside a mechanism file, by name: tables, the picture, the errata page."""
    from mechkin_cli.tables import (
        COMMITTED_DIGITS,
        NAME,
        PAGE,
        csv_bytes,
        disagreements_csv,
        errata_page,
        markdown_bytes,
    )

    fresh: dict[str, bytes] = {}
    for analysis in analyses:
        for table in (*analysis.tables, *analysis.coefficients, *analysis.balance_tables):
            fresh[f"{table.name}.csv"] = csv_bytes(table, COMMITTED_DIGITS)
            if table.summary is not None:
                from mechkin_cli.tables import summary_table

                below = summary_table(table.name, table.title, table.summary)
                fresh[f"{below.name}.csv"] = csv_bytes(below, COMMITTED_DIGITS)
            fresh[f"{table.name}.md"] = markdown_bytes(table, analysis.result)
    from mechkin_cli.view import PICTURE_NAME as PICTURE, mechanism_picture

    fresh[PICTURE] = mechanism_picture(analyses[0].result).encode()
    if printed:
        fresh[PAGE] = errata_page(model.name, model.source, printed).encode()
        if listed := disagreements_csv(printed):
            fresh[NAME] = listed
    return fresh


def _compare(
    folder: Path, fresh: dict[str, bytes], json: bool, quiet: bool
) -> tuple[ExitCode, list[Record]]:
    from mechkin_cli.tables import compare_files, read_committed, report

    comparisons = compare_files(fresh, read_committed(folder, fresh))
    same = all(c.verdict == "equal" for c in comparisons)
    if same and not quiet:
        say(f"{folder}: {len(fresh)} files as committed")
    elif not same:
        say(f"{folder}: the tables on disk are not what this version computes")
        if not json:
            put(report(comparisons))
    return ExitCode.OK if same else ExitCode.DIFFERENCES, [asdict(c) for c in comparisons]


# `mechkin tables --against`: printed cells that do not agree with what the files compute.


def list_disagreements(files: Sequence[Path], json: bool, quiet: bool) -> None:
    """Counts to stderr and every disagreeing cell to stdout, as CSV or as one JSON object.

    Files without printed values are passed over. That cells disagree is an answer, no failure: the
    exit code is 0 unless a file cannot be used.
    """
    code, records = ExitCode.OK, []
    for file in files:
        try:
            printed = _printed(file)
        except (InvalidFile, UsageError) as error:
            outcome, record = refusal(file, error)
            code = max(code, outcome)
            records.append(record)
            continue
        if printed:
            records.append(_told(file, printed, json, quiet))
    if json:
        put_json({"files": records})
    if code:
        raise typer.Exit(code)


def _printed(file: Path) -> list[PrintedTable]:
    from mechkin_cli.model import load
    from mechkin_cli.tables import against_print

    model = load(file)
    if not any(table.published for table in model.tables):
        return []
    analyses = run_all(model)
    said = tuple(dict.fromkeys(found for one in analyses for found in one.diagnostics))
    say_diagnostics(said, str(file))
    return [table for one in analyses for table in against_print(file, one.layouts, one.tables)]


def _told(file: Path, printed: Sequence[PrintedTable], json: bool, quiet: bool) -> Record:
    from mechkin_cli.tables import against_print_record, counts, disagreements_csv

    if not quiet:
        say(f"{file}: {counts(one.agreement for one in printed)}")
    if not json:
        put(disagreements_csv(printed).decode())
    return {"file": str(file), "tables": against_print_record(printed)}


# The overview page that `mechkin tables FOLDER` keeps: what it says of a file, and its check.


def overview_row(
    model: Model, file: Path, analyses: Sequence[Analysis], printed: Sequence[PrintedTable]
) -> OverviewRow:
    """A line of the overview of a folder; `file` is the path in it."""
    from mechkin_cli.tables import counts
    from mechkin_cli.view import PICTURE_NAME as PICTURE

    solved = sum(int(analysis.result.solved.sum()) for analysis in analyses)
    rows = sum(analysis.rows for analysis in analyses)
    return OverviewRow(
        file.with_suffix("").as_posix(),
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
    page, fresh = folder / OVERVIEW_PAGE, overview_page(rows).encode()
    old = _content(page) if page.is_file() else None
    if old is not None and not old.startswith(MARK.encode()):
        if not quiet:
            say(f"{page}: left alone, it does not begin with {MARK}")
        return ExitCode.OK, "left"
    if not check:
        from mechkin_cli.tables import write_files

        write_files(folder, {OVERVIEW_PAGE: fresh})
        return ExitCode.OK, "written"
    return _compared(page, fresh, old, json)


def _content(page: Path) -> bytes:
    from mechkin_cli.reading import MOST_TABLE_BYTES, read_regular

    try:
        return read_regular(page, MOST_TABLE_BYTES)
    except OSError as error:
        raise UsageError(f"cannot read {page}: {error.strerror}; make it readable") from None


def _compared(page: Path, fresh: bytes, old: bytes | None, json: bool) -> tuple[ExitCode, str]:
    from mechkin_cli.tables import compare_files, report

    (found,) = compare_files({OVERVIEW_PAGE: fresh}, {} if old is None else {OVERVIEW_PAGE: old})
    if found.verdict == "equal":
        return ExitCode.OK, "equal"
    say(f"{page}: the overview on disk is not what this version makes")
    if not json:
        put(report([found]))
    return ExitCode.DIFFERENCES, found.verdict
