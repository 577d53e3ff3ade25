"""What `mechkin analyze` does: runs mechanism files and writes their tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli.cli.messages import (
    FORMS,
    ExitCode,
    Record,
    model_of,
    put,
    put_json,
    refusal,
    say,
    say_diagnostics,
    shown,
    stem_of,
    tell_as,
)
from mechkin_cli.cli.options import parameters
from mechkin_cli.cli.progress import Tell, working
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, InvalidFile, UsageError
from mechkin_cli.tables import USUAL_FORMATS, WRITERS, Results, written_files
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.model import Analysis, Model


# The runs of one file: its sweep and its responses.


def run_all(
    model: Model,
    tables: Sequence[str] | None = None,
    mode: str | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> list[Analysis]:
    """Every run that has one of the tables wanted (None: all), the sweep first; `tell` hears which
    is under way.

    Raises:
        UsageError: no run has a table of a name.
        InvalidFile: a run cannot be solved as it is driven.
    """
    runs = dict.fromkeys(model.runs)
    wanted = None if tables is None else {run: _of_run(model, tables, run) for run in runs}
    if wanted is not None:
        _refuse_unknown(model, tables or ())
        runs = {run: None for run in runs if wanted[run]}
    found = []
    for run in runs:
        chosen = None if wanted is None else wanted[run]
        tell(_words(model, run))
        if run == SWEEP:
            found.append(model.analyze(tables=chosen, mode=mode))
        else:
            found.append(model.respond(run, tables=chosen, mode=mode))
    return found


def _words(model: Model, run: str) -> str:
    if run != SWEEP:
        return f"integrating {run}"
    return f"following {model.problem.motion.rows} rows"


def certify_sweeps(analyses: Sequence[Analysis]) -> tuple[Diagnostic, ...]:
    """Makes the proofs of sweeps; a note for each response, whose rows have none."""
    notes = []
    for analysis in analyses:
        if analysis.run == SWEEP:
            _ = analysis.certificate
            continue
        text = f"the rows of response {analysis.run} are not proven: --certify proves sweeps"
        notes.append(Diagnostic("not-proven", "note", text))
    return tuple(notes)


def _of_run(model: Model, tables: Sequence[str], run: str) -> list[str]:
    own = {table.name for table in model.tables if table.run == run}
    own |= {one.name for one in model.built.coefficients} if run == SWEEP else set()
    return [name for name in tables if name in own]


def _refuse_unknown(model: Model, tables: Sequence[str]) -> None:
    known = [table.name for table in model.tables]
    known += sorted(one.name for one in model.built.coefficients)
    for name in tables:
        if name not in known:
            raise UsageError(
                f"there is no table {name[:LONGEST_NAME]}; tables are {', '.join(known)}"
            )


FORMATS = f"{', '.join(tuple(WRITERS)[:-1])} or {tuple(WRITERS)[-1]}"


@dataclass(frozen=True, slots=True)
class _Request:
    """What is wanted of every file."""

    settings: dict[str, str]
    mode: str | None
    tables: list[str] | None
    formats: tuple[str, ...]
    threads: int
    units: bool
    explain: bool
    json: bool
    writes: bool
    quiet: bool
    strict: bool
    errors: bool
    certify: bool
    view: bool


def analyze_files(
    files: list[Path],
    out: Path | None = None,
    format: list[str] | None = None,
    units: bool = False,
    set_: list[str] | None = None,
    mode: str | None = None,
    table: list[str] | None = None,
    lanes: int = 0,
    threads: int = 0,
    certify: bool = False,
    strict: bool = False,
    errors: bool = False,
    view: bool = False,
    explain: bool = False,
    messages: str | None = None,
    json: bool = False,
    quiet: bool = False,
) -> ExitCode:
    """Runs the sweep and the responses of each file and writes their tables.

    The arguments are the options of the command, as `analyze_command` declares them.

    Raises:
        UsageError: an option that cannot be.
    """
    from mechkin_cli.kernel.functions import force_threads, force_width

    tell_as(messages)
    force_width(lanes)
    force_threads(threads)
    request = _Request(
        settings=parameters(set_),
        mode=mode,
        tables=table,
        formats=_formats(format),
        threads=threads,
        units=units,
        explain=explain,
        json=json,
        writes=not json or out is not None or bool(format) or view,
        quiet=quiet,
        strict=strict,
        errors=errors,
        view=view,
        certify=certify,
    )
    code = ExitCode.OK
    records: list[Record] = []
    folders = _folders(files, out)
    with working("", quiet) as tell:
        for number, (path, folder) in enumerate(folders.items(), 1):
            count = f" ({number} of {len(files)})" if len(files) > 1 else ""
            words = f"{shown(path)}{count}"

            def at(what: str, words: str = words) -> None:
                tell(f"{words}: {what}")

            outcome, record = _one(path, folder, request, at)
            code = max(code, outcome)
            records.append(record)
    if json:
        put_json(records[0] if len(files) == 1 else {"files": records})
    return code


def _one(path: Path, folder: Path, request: _Request, tell: Tell) -> tuple[ExitCode, Record]:
    """Runs one file; what is wrong with it does not stop the others."""
    try:
        tell("reading")
        model = model_of(path, request.settings)
        if request.errors:
            _refuse_own_errors(model, request.tables)
        analyses, notes, written = _run(model, folder, request, tell)
    except (InvalidFile, UsageError) as error:
        return refusal(path, error)
    said = dict.fromkeys(found for analysis in analyses for found in analysis.diagnostics)
    say_diagnostics((*said, *notes), shown(path))
    record: Record = {}
    if request.json:
        from mechkin_cli.tables import runs_record

        results = [_results(analysis, request) for analysis in analyses]
        record = {"file": shown(path)} | runs_record(results)
        if request.explain:
            from mechkin_cli.cli.explanation import explanation

            texts = [explanation(analysis) for analysis in analyses]
            record["explanation"] = "\n".join(texts).split("\n")
    else:
        _report(shown(path), analyses, folder, written, request)
    enough = all(_is_enough(analysis, request) for analysis in analyses)
    return ExitCode.OK if enough else ExitCode.ROWS_MISSING, record


def _run(
    model: Model, folder: Path, request: _Request, tell: Tell
) -> tuple[list[Analysis], tuple[Diagnostic, ...], list[Path]]:
    """The runs, notes on what is not proven, and the files written: alone in their folder from
    before the work on, so that nothing is computed that cannot be written."""
    from mechkin_cli.tables import OutputFolder

    with OutputFolder(folder) if request.writes else nullcontext() as output:
        analyses = run_all(model, request.tables, request.mode, tell)
        tell("proving rows" if request.certify else "evaluating tables")
        notes = certify_sweeps(analyses) if request.certify else ()
        if output is None:
            return analyses, notes, []
        tell("measuring true errors" if request.errors else "writing tables")
        results = [_results(analysis, request) for analysis in analyses]
        files = written_files(results, request.formats)
        if request.view:
            notes = (*notes, *_add_page(files, analyses))
        return analyses, notes, output.write(files)


def _add_page(files: dict[str, bytes], analyses: list[Analysis]) -> list[Diagnostic]:
    """Adds the page of some runs to the files; notes on what it leaves out."""
    from mechkin_cli.view import PAGE_NAME, view_page

    files[PAGE_NAME], notes = view_page(analyses)
    return notes


def _refuse_own_errors(model: Model, wanted: list[str] | None) -> None:
    """Refuses a table of the file whose files `--errors` writes."""
    from mechkin_cli.tables import chosen, clashing

    built = model.built
    named = [table.name for table in chosen(built.tables, wanted)]
    named += [table.name for table in chosen((*built.coefficients, *built.balances), wanted)]
    name = clashing(named, model.runs)
    if name is not None:
        raise UsageError(
            f"--errors writes a table {name.casefold()}, and so does the file; rename the file's, "
            "choose others with --table, or leave --errors out"
        )


def _is_enough(analysis: Analysis, request: _Request) -> bool:
    proofs = request.strict and request.certify and analysis.run == SWEEP
    if proofs and not analysis.certificate.is_one_branch:
        return False
    return analysis.complete and (analysis.result.sound or not request.strict)


def _formats(given: list[str] | None) -> tuple[str, ...]:
    formats = tuple(dict.fromkeys(given or USUAL_FORMATS))
    for name in formats:
        if name not in WRITERS:
            cure = f"; for messages write --messages {name}" if name in FORMS else ""
            raise UsageError(f"--format {name}: formats are {', '.join(WRITERS)}{cure}")
    return formats


def _folders(files: list[Path], out: Path | None) -> dict[Path, Path]:
    """The folder of each file; no two files share one."""
    folders: dict[Path, Path] = {}
    for path in files:
        folder = out if out and len(files) == 1 else (out or Path("out")) / stem_of(path)
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


def _results(analysis: Analysis, request: _Request) -> Results:
    name, result = analysis.model.name, analysis.result
    tables = (*analysis.tables, *analysis.coefficients, *analysis.balance_tables)
    errors = analysis.errors.columns if request.errors else None
    return Results(
        name,
        tables,
        result,
        analysis.diagnostics,
        request.threads,
        analysis.run,
        errors,
        request.units,
    )


def _report(
    file: str, analyses: list[Analysis], folder: Path, written: list[Path], request: _Request
) -> None:
    from mechkin_cli.cli.show import files_line, shown_tables, summary

    for analysis in analyses:
        if request.explain:
            from mechkin_cli.cli.explanation import explanation

            put(f"{explanation(analysis)}\n")
        for part in () if request.quiet else shown_tables(analysis, folder):
            put(part)
    if request.quiet:
        return
    for analysis in analyses:
        for line in summary(file, analysis, errors=request.errors):
            say(line)
    say(files_line(folder, written))
