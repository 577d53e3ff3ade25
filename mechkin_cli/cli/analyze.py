"""What `mechkin analyze` does: runs mechanism files and writes their tables."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.messages import Progress, Record, put, put_json, refusal, say, say_diagnostics
from mechkin_cli.cli.parameters import parameters
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.tables.writers import USUAL_FORMATS, WRITERS, Results, written_files

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis

FORMATS = f"{', '.join(tuple(WRITERS)[:-1])} or {tuple(WRITERS)[-1]}"


@dataclass(frozen=True, slots=True)
class _Request:
    """What is wanted of every file."""

    settings: dict[str, str]
    mode: str | None
    tables: list[str] | None
    formats: tuple[str, ...]
    threads: int
    explain: bool
    json: bool
    quiet: bool
    strict: bool


def analyze_files(
    files: list[Path],
    out: Path | None = None,
    format: list[str] | None = None,
    set_: list[str] | None = None,
    mode: str | None = None,
    table: list[str] | None = None,
    lanes: int = 0,
    threads: int = 0,
    explain: bool = False,
    json: bool = False,
    quiet: bool = False,
    strict: bool = False,
) -> ExitCode:
    """Runs the sweep of each file and writes its tables.

    The arguments are the options of the command, as `analyze_command` declares them.

    Raises:
        UsageError: an option that cannot be.
    """
    from mechkin_cli.kernel.width import force_threads, force_width

    force_width(lanes)
    force_threads(threads)
    request = _Request(
        parameters(set_), mode, table, _formats(format), threads, explain, json, quiet, strict
    )
    code = ExitCode.OK
    records: list[Record] = []
    progress = Progress(len(files), "files", quiet)
    for number, (path, folder) in enumerate(_folders(files, out).items(), 1):
        outcome, record = _one(path, folder, request)
        code = max(code, outcome)
        records.append(record)
        progress.step(number)
    progress.end()
    if json:
        put_json(records[0] if len(files) == 1 else {"files": records})
    return code


def _one(path: Path, folder: Path, request: _Request) -> tuple[ExitCode, Record]:
    """Runs one file; what is wrong with it does not stop the others."""
    from mechkin_cli.interface import load
    from mechkin_cli.tables.files import OutputFolder

    try:
        model = load(path, request.settings)
        with OutputFolder(folder) as output:
            analysis = model.analyze(tables=request.tables, mode=request.mode)
            written = output.write(_files(analysis, request))
    except (InvalidFile, UsageError) as error:
        return refusal(path, error)
    say_diagnostics(analysis.diagnostics, str(path))
    record: Record = {}
    if request.json:
        record = {"file": str(path)} | _record(analysis)
        if request.explain:
            from mechkin_cli.cli.explanation import explanation

            record["explanation"] = explanation(analysis).split("\n")
    else:
        _report(path, analysis, folder, written, request)
    result = analysis.result
    enough = result.complete and (result.sound or not request.strict)
    return ExitCode.OK if enough else ExitCode.ROWS_MISSING, record


def _formats(given: list[str] | None) -> tuple[str, ...]:
    formats = tuple(dict.fromkeys(given or USUAL_FORMATS))
    for name in formats:
        if name not in WRITERS:
            raise UsageError(f"--format {name}: formats are {', '.join(WRITERS)}")
    return formats


def _folders(files: list[Path], out: Path | None) -> dict[Path, Path]:
    """The folder of each file; no two files share one."""
    folders: dict[Path, Path] = {}
    for path in files:
        # a file called ...yaml has the stem .., which leads out of the folder
        stem = path.stem if path.stem.strip(".") else path.name
        folder = out if out and len(files) == 1 else (out or Path("out")) / stem
        twin = next((other for other, taken in folders.items() if taken == folder), None)
        if twin == path:
            raise UsageError(f"{path} is given twice; name it once")
        if twin is not None:
            raise UsageError(
                f"{twin} and {path} would both be written to {folder}; analyze them one by one, "
                "each with its own --out"
            )
        folders[path] = folder
    return folders


def _files(analysis: Analysis, request: _Request) -> dict[str, bytes]:
    """The tables and rows.csv."""
    name, result = analysis.model.name, analysis.result
    tables = (*analysis.tables, *analysis.coefficients)
    results = Results(name, tables, result, analysis.diagnostics, request.threads)
    return written_files(results, request.formats)


def _record(analysis: Analysis) -> Record:
    from mechkin_cli.tables.json_writer import analysis_record

    name = analysis.model.name
    tables = (*analysis.tables, *analysis.coefficients)
    return analysis_record(name, tables, analysis.result, analysis.diagnostics)


def _report(
    path: Path, analysis: Analysis, folder: Path, written: list[Path], request: _Request
) -> None:
    from mechkin_cli.cli.summary import summary

    if request.explain:
        from mechkin_cli.cli.explanation import explanation

        put(f"{explanation(analysis)}\n")
    if request.quiet:
        return
    from mechkin_cli.cli.show import shown_tables

    for part in shown_tables(analysis, folder):
        put(part)
    for line in summary(path, analysis, folder, written):
        say(line)
