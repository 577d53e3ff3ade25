"""What `mechkin analyze` does: runs mechanism files and writes their tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mechkin_cli import tables as table_room, view
from mechkin_cli.cli.analyze_options import AnalyzeCommand, with_labels
from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    model_of,
    parameters,
    put,
    put_json,
    refusal,
    say,
    say_diagnostics,
    shown,
    stem_of,
    tell_as,
)
from mechkin_cli.cli.progress import Tell, working
from mechkin_cli.diagnostics import (
    LONGEST_NAME,
    Diagnostic,
    InvalidFile,
    UsageError,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.structure import listed
from mechkin_cli.tables import (
    Columns,
    Results,
    write_results,
)
from mechkin_cli.tolerances import LONG_RUN
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis
    from mechkin_cli.cli.long_runs import StreamedRun
    from mechkin_cli.model import Model


def run_all(
    model: Model,
    tables: Sequence[str] | None = None,
    mode: str | None = None,
    tell: Callable[[str], None] = lambda _: None,
    done: Sequence[str] = (),
) -> list[Analysis]:
    """Every run that has one of the tables wanted (None: all), the sweep first.

    Args:
        tell: is called with words for the run that is under way.
        done: runs that are left out.

    Raises:
        UsageError: no run has a table of a name.
        InvalidFile: a run cannot be solved as it is driven.
    """
    runs = dict.fromkeys(run for run in model.runs if run not in done)
    wanted = None if tables is None else {run: _of_run(model, tables, run) for run in runs}
    if wanted is not None:
        _refuse_unknown(model, tables or ())
        runs = {run: None for run in runs if wanted[run]}
    analyses = []
    for run in runs:
        chosen = None if wanted is None else wanted[run]
        if run == SWEEP:
            tell(f"following {model.problem.motion.rows} rows")
            analyses.append(model.analyze(tables=chosen, mode=mode))
        else:
            rests = model.response(run).search is not None
            tell(f"looking for {run}" if rests else f"integrating {run}")
            analyses.append(model.run_free(run, tables=chosen, mode=mode))
    return analyses


def certify_sweeps(analyses: Sequence[Analysis]) -> tuple[Diagnostic, ...]:
    """Makes the proofs of sweeps; a note for each response, whose rows have none."""
    notes = []
    for analysis in analyses:
        if analysis.run == SWEEP:
            _ = analysis.certificate
            continue
        text = f"the rows of {analysis.run} are not proven: --certify proves sweeps"
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


def analyze(**given: Any) -> ExitCode:
    """Runs the sweep and the responses of each file and writes their tables.

    Args:
        given: the fields of `AnalyzeCommand`.
    """
    return analyze_files(AnalyzeCommand(**given))


def analyze_files(command: AnalyzeCommand) -> ExitCode:
    """Runs the sweep and the responses of each file and writes their tables.

    Raises:
        UsageError: an option that cannot be.
    """
    from mechkin_cli.kernel.functions import force_threads, force_width

    tell_as(command.messages)
    force_width(command.lanes)
    force_threads(command.threads)
    settings, files = parameters(command.set_), command.files
    _ = command.formats, command.decimal_comma  # refused before any file is run
    code = ExitCode.OK
    records: list[Record] = []
    folders = _folders(files, command.out)
    with working("", command.quiet) as tell:
        for number, (path, folder) in enumerate(folders.items(), 1):
            count = f" ({number} of {len(files)})" if len(files) > 1 else ""
            words = f"{shown(path)}{count}"

            def at(what: str, words: str = words) -> None:
                tell(f"{words}: {what}")

            outcome, record = _one(path, folder, command, settings, at)
            code = max(code, outcome)
            records.append(record)
    if command.json:
        put_json(records[0] if len(files) == 1 else {"files": records})
    return code


def _one(
    path: Path, folder: Path, command: AnalyzeCommand, settings: dict[str, str], tell: Tell
) -> tuple[ExitCode, Record]:
    """Runs one file; what is wrong with it does not stop the others."""
    try:
        tell("reading")
        model = model_of(path, settings)
        command = with_labels(command, model)
        if command.errors:
            _refuse_own_errors(model, command.table)
        done = _run(model, folder, command, tell)
    except (InvalidFile, UsageError) as error:
        return refusal(path, error)
    analyses, streamed = done.analyses, done.streamed
    runs: list[Analysis | StreamedRun] = [*analyses, *streamed]
    diagnostics = dict.fromkeys(one for run in runs for one in run.diagnostics)
    say_diagnostics((*diagnostics, *done.notes), shown(path))
    record: Record = {}
    if command.json:
        results = [_results(analysis, command) for analysis in analyses]
        record = {"file": shown(path)} | table_room.runs_record(results)
        if command.explain:
            from mechkin_cli.cli.show import explanation

            texts = [explanation(analysis) for analysis in analyses]
            record["explanation"] = "\n".join(texts).split("\n")
    else:
        _report(shown(path), done, folder, command)
    enough = all(_is_enough(analysis, command) for analysis in analyses)
    enough &= all(run.is_enough(strict=command.strict) for run in streamed)
    return ExitCode.OK if enough else ExitCode.ROWS_MISSING, record


class _Done(NamedTuple):
    """The runs of a file, those whose rows are not held, notes on what is not proven or not
    removed, the files written and the names of those removed."""

    analyses: list[Analysis]
    streamed: list[StreamedRun]
    notes: tuple[Diagnostic, ...] = ()
    written: Sequence[Path] = ()
    removed: Sequence[str] = ()


def _run(model: Model, folder: Path, command: AnalyzeCommand, tell: Tell) -> _Done:
    """Runs a file and writes its tables: alone in their folder from before the work on, so that
    nothing is computed that cannot be written."""
    with table_room.OutputFolder(folder) if command.writes else nullcontext() as output:
        streamed: list[StreamedRun] = []
        _refuse_unknown(model, command.table or ())
        done: list[str] = []
        if command.summary_only or _is_long(model):
            from mechkin_cli.cli.long_runs import stream_to, streamed_runs

            if output is not None:
                done = streamed_runs(model, command)
                streamed += [stream_to(model, run, command, output, tell) for run in done]
        analyses = run_all(model, command.table, command.mode, tell, done)
        tell("proving rows" if command.certify else "evaluating tables")
        notes = certify_sweeps(analyses) if command.certify else ()
        if output is None:
            return _Done(analyses, streamed, notes)
        tell("measuring true errors" if command.errors else "writing tables")
        results = [_results(analysis, command) for analysis in analyses]
        write_results(results, command.formats, output.begin)
        if command.view:
            page, left_out = view.view_page(analyses)
            output.add(view.PAGE_NAME, page)
            notes = (*notes, *left_out)
        written, removed, changed = output.write_run()
        notes = (*notes, *_changed_notes(folder, changed))
        return _Done(analyses, streamed, notes, written, removed)


def _is_long(model: Model) -> bool:
    """Whether some run has many rows."""
    return any(
        (model.problem.motion.rows if run == SWEEP else model.design.response(run).rows) > LONG_RUN
        for run in model.runs
    )


def _changed_notes(folder: Path, names: Sequence[str]) -> list[Diagnostic]:
    """Names the files of an earlier run that stay, since they are not as it wrote them."""
    if not names:
        return []
    verb = "is" if len(names) == 1 else "are"
    text = (
        f"in {folder} {listed(names)} {verb} of an earlier run, but not as it was written, and "
        f"therefore {verb} left beside the files of this one"
    )
    return [Diagnostic("earlier-files", "warning", text, hint="move or remove what is old there")]


def _refuse_own_errors(model: Model, wanted: list[str] | None) -> None:
    """Refuses a table of the file whose files `--errors` writes."""
    built = model.built
    named = [table.name for table in table_room.chosen(built.tables, wanted)]
    others = (*built.coefficients, *built.balances)
    named += [table.name for table in table_room.chosen(others, wanted)]
    name = table_room.clashing(named, model.runs)
    if name is not None:
        raise UsageError(
            f"--errors writes a table {name.casefold()}, and so does the file; rename the file's, "
            "choose others with --table, or leave --errors out"
        )


def _is_enough(analysis: Analysis, command: AnalyzeCommand) -> bool:
    proofs = command.strict and command.certify and analysis.run == SWEEP
    if proofs and not analysis.certificate.is_one_branch:
        return False
    return analysis.complete and (analysis.result.sound or not command.strict)


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


def _chosen(table: Columns, labels: Sequence[str] | None) -> Columns:
    return table if labels is None else table.chosen(labels)


def _results(analysis: Analysis, command: AnalyzeCommand) -> Results:
    labels = command.columns
    errors = analysis.errors.columns if command.errors else None
    if errors is not None and labels is not None:
        errors = tuple(column for column in errors if column.label in labels)
    return Results(
        analysis.model.name,
        (
            *(_chosen(table, labels) for table in analysis.tables),
            *analysis.coefficients,
            *analysis.balance_tables,
        ),
        analysis.result,
        analysis.diagnostics,
        command.threads,
        analysis.run,
        errors,
        command.units,
        command.decimal_comma,
        analysis.impacts,
    )


def _report(file: str, done: _Done, folder: Path, command: AnalyzeCommand) -> None:
    analyses = done.analyses
    if command.explain:
        from mechkin_cli.cli.show import explanation
    if not command.quiet:
        from mechkin_cli.cli.show import files_line, shown_tables, summary
    for run in () if command.quiet else done.streamed:
        run.report(file, folder)
    for analysis in analyses:
        if command.explain:
            put(f"{explanation(analysis)}\n")
        tables = () if command.quiet else [_chosen(t, command.columns) for t in analysis.tables]
        for part in shown_tables(tables, analysis.rows, folder) if tables else ():
            put(part)
    if command.quiet:
        return
    for analysis in analyses:
        for line in summary(file, analysis, errors=command.errors):
            say(line)
    say(files_line(folder, done.written, done.removed))
