"""`mechkin tables`: regenerates the tables kept beside the mechanisms, or compares them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mechkin_cli.cli.completion import mechanism_files
from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.given_file import refuse_stdin
from mechkin_cli.cli.messages import (
    Record,
    put,
    put_json,
    refusal,
    say,
    say_diagnostics,
    tell_as,
)
from mechkin_cli.cli.options import Json, Messages, Quiet
from mechkin_cli.cli.progress import working
from mechkin_cli.cli.runs import run_all
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis, Model
    from mechkin_cli.tables.errata import PrintedTable
    from mechkin_cli.tables.files import OutputFolder
    from mechkin_cli.tables.overview import OverviewRow

MECHANISMS = Path("mechanisms")


def tables(
    path: Annotated[
        Path,
        typer.Argument(
            help="A mechanism file, or a folder of them.",
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
    that the file no longer has is removed; other files stay. FOLDER/README.md is an overview of
    its mechanisms; a README.md of your own is left alone.
    """
    tell_as(messages)
    refuse_stdin(path, "tables are kept beside a file, and - is none")
    files = _mechanism_files(path)
    if against:
        from mechkin_cli.cli.against import list_disagreements

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
                outcome, record, row = _one(file, check, json, quiet, overview=path.is_dir())
                rows += [row] if row else []
            except (InvalidFile, UsageError) as error:
                outcome, record = refusal(file, error)
            code = max(code, outcome)
            records.append(record)
    found: Record = {"files": records}
    if len(rows) == len(files):
        from mechkin_cli.cli.overview import keep_overview

        outcome, found["overview"] = keep_overview(path, rows, check, json, quiet)
        code = max(code, outcome)
    if json:
        put_json(found)
    if code:
        raise typer.Exit(code)


def _mechanism_files(path: Path) -> list[Path]:
    if path.is_dir():
        files = sorted(path.glob("*.yaml"))
        if not files:
            raise UsageError(f"{path} holds no mechanism files (*.yaml)")
        return files
    if not path.exists():
        raise UsageError(f"{path} does not exist; give a mechanism file or a folder of them")
    return [path]


def _one(
    file: Path, check: bool, json: bool, quiet: bool, *, overview: bool
) -> tuple[ExitCode, Record, OverviewRow | None]:
    """Computes one file's tables, and compares or writes them; alone in their folder if it does."""
    from mechkin_cli.interface import load
    from mechkin_cli.tables.files import OutputFolder

    model = load(file)
    if check:
        return _made(file, model, None, json, quiet, overview=overview)
    if not file.stem.strip("."):
        raise UsageError(f"{file}: a folder for its tables would be {file.stem}; rename the file")
    with OutputFolder(file.with_suffix("")) as output:
        return _made(file, model, output, json, quiet, overview=overview)


def _made(
    file: Path,
    model: Model,
    output: OutputFolder | None,
    json: bool,
    quiet: bool,
    *,
    overview: bool,
) -> tuple[ExitCode, Record, OverviewRow | None]:
    from mechkin_cli.cli.overview import overview_row
    from mechkin_cli.tables.against_print import against_print
    from mechkin_cli.tables.stale import stale_in

    analyses = run_all(model)
    said = tuple(dict.fromkeys(found for one in analyses for found in one.diagnostics))
    say_diagnostics(said, str(file))
    printed = [table for one in analyses for table in against_print(file, one.layouts, one.tables)]
    row = overview_row(file, analyses, printed) if overview else None
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
    from mechkin_cli.tables.csv_writer import COMMITTED_DIGITS, csv_bytes
    from mechkin_cli.tables.disagreements import NAME, disagreements_csv
    from mechkin_cli.tables.errata import PAGE, errata_page
    from mechkin_cli.tables.markdown import markdown_bytes

    fresh: dict[str, bytes] = {}
    for analysis in analyses:
        for table in (*analysis.tables, *analysis.coefficients, *analysis.balance_tables):
            fresh[f"{table.name}.csv"] = csv_bytes(table, COMMITTED_DIGITS)
            if table.summary is not None:
                from mechkin_cli.tables.summary import summary_table

                below = summary_table(table.name, table.title, table.summary)
                fresh[f"{below.name}.csv"] = csv_bytes(below, COMMITTED_DIGITS)
            fresh[f"{table.name}.md"] = markdown_bytes(table, analysis.result)
    from mechkin_cli.view.drawing.picture import NAME as PICTURE
    from mechkin_cli.view.drawing.picture import mechanism_picture

    fresh[PICTURE] = mechanism_picture(analyses[0].result).encode()
    if printed:
        fresh[PAGE] = errata_page(model.name, model.source, printed).encode()
        if listed := disagreements_csv(printed):
            fresh[NAME] = listed
    return fresh


def _compare(
    folder: Path, fresh: dict[str, bytes], json: bool, quiet: bool
) -> tuple[ExitCode, list[Record]]:
    from mechkin_cli.tables.compare import compare_files, read_committed
    from mechkin_cli.tables.comparison_report import report

    comparisons = compare_files(fresh, read_committed(folder, fresh))
    same = all(c.verdict == "equal" for c in comparisons)
    if same and not quiet:
        say(f"{folder}: {len(fresh)} files as committed")
    elif not same:
        say(f"{folder}: the tables on disk are not what this version computes")
        if not json:
            put(report(comparisons))
    return ExitCode.OK if same else ExitCode.DIFFERENCES, [asdict(c) for c in comparisons]
