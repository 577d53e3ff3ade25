"""`mechkin tables --against`: printed cells that do not agree with what the files compute."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import Record, put, put_json, refusal, say, say_diagnostics
from mechkin_cli.cli.runs import run_all
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.tables.errata import PrintedTable


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
    from mechkin_cli.interface import load
    from mechkin_cli.tables.against_print import against_print

    model = load(file)
    if not any(table.published for table in model.tables):
        return []
    analyses = run_all(model)
    said = tuple(dict.fromkeys(found for one in analyses for found in one.diagnostics))
    say_diagnostics(said, str(file))
    return [table for one in analyses for table in against_print(file, one.layouts, one.tables)]


def _told(file: Path, printed: Sequence[PrintedTable], json: bool, quiet: bool) -> Record:
    from mechkin_cli.tables.disagreements import against_print_record, disagreements_csv
    from mechkin_cli.tables.errata import counts

    if not quiet:
        say(f"{file}: {counts(one.agreement for one in printed)}")
    if not json:
        put(disagreements_csv(printed).decode())
    return {"file": str(file), "tables": against_print_record(printed)}
