"""`mechkin study`: a hundred thousand variants of a mechanism, and what is kept of each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mechkin_cli.cli.interrupts import then
from mechkin_cli.cli.messages import (
    ExitCode,
    Record,
    parameters,
    put,
    put_json,
    refusal,
    say,
    say_diagnostics,
    tell_as,
)
from mechkin_cli.cli.options import (
    Json,
    Messages,
    Quiet,
    Set,
    folder,
    study_files,
    study_format_names,
)
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.model import load

if TYPE_CHECKING:
    from mechkin_cli.studies import Study, StudyFiles, Workers


SHOWN_VARIANTS = 6
"""Variants that `--dry-run` shows: half of them the first, half the last."""


def study(
    file: Annotated[
        Path,
        typer.Argument(help="Study file (YAML).", metavar="STUDY", autocompletion=study_files),
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--out",
            metavar="FOLDER",
            parser=folder,
            help="Folder to write to (default: out/STUDY).",
        ),
    ] = None,
    set_: Set = None,
    format_: Annotated[
        str,
        typer.Option(
            "--format",
            metavar="FORMAT",
            help="csv or parquet.",
            autocompletion=study_format_names,
        ),
    ] = "csv",
    again: Annotated[
        bool, typer.Option("--again", help="Discard the results in the folder and start over.")
    ] = False,
    threads: Annotated[
        int, typer.Option("--threads", help="Threads of each process (0: as many as pay).")
    ] = 0,
    processes: Annotated[
        int, typer.Option("--processes", help="Number of new processes (0: compute in this one).")
    ] = 0,
    scheduler: Annotated[
        str | None,
        typer.Option(
            "--scheduler",
            metavar="ADDRESS",
            help="Compute on a Dask cluster at this address, as tcp://host:8786.",
        ),
    ] = None,
    explain: Annotated[
        bool, typer.Option("--explain", help="Estimate time and size from a trial; write nothing.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Check the study and show variants; compute nothing.")
    ] = False,
    json: Json = False,
    messages: Messages = None,
    quiet: Quiet = False,
) -> None:
    """Run many variants of a mechanism and keep a few numbers of each.

    Writes variants.csv, with a line for each variant, into a folder. A study that was stopped is
    continued by the same command.
    """
    from mechkin_cli.studies import Study, Workers, end_without_warnings, open_study

    tell_as(messages)
    record: Record = {}
    code = ExitCode.OK
    try:
        source = open_study(file)
        planned = Study(source.model(parameters(set_), load), source)
        say_diagnostics(planned.plan.notes, str(file))
        workers = Workers(threads, processes, None, scheduler)
        if dry_run:
            record = _shown_variants(planned, json)
        elif explain:
            record = _estimate(planned, workers, format_, json)
        else:
            target = Path("out", file.stem) if out is None else out
            then(", and the same command goes on with them")
            if processes:
                end_without_warnings()
            with _progress(planned, quiet or json) as progress:
                found = planned.in_folder(target, workers, format_, again, progress)
            record = _record(found)
            if not json:
                _print(found, quiet)
            if set(found.overview.verdicts) - {"ok"}:
                code = ExitCode.ROWS_MISSING
    except (InvalidFile, UsageError) as error:
        code, record = refusal(file, error)
    if json:
        put_json({"file": str(file), **record})
    if code:
        raise typer.Exit(code)


def _shown_variants(planned: Study, json: bool) -> Record:
    """Counts and the values of some variants."""
    variation = planned.plan.variation
    lists, lines, samples = variation.counts
    half = SHOWN_VARIANTS // 2
    last = max(planned.variants - half, half)
    stretches = [(0, min(half, planned.variants))]
    if last < planned.variants:
        stretches.append((last, planned.variants))
    shown = {
        number: {name: float(values[place]) for name, values in found.items()}
        for begin, end in stretches
        for found in [variation.values(begin, end)]
        for place, number in enumerate(range(begin, end))
    }
    if not json:
        say(_counts(planned))
        put(_values_table(planned, shown))
    return {
        "variants": planned.variants,
        "lists": lists,
        "lines": lines,
        "samples": samples,
        "shown": [{"variant": number, **values} for number, values in shown.items()],
    }


def _counts(planned: Study) -> str:
    """How many variants there are, and of what."""
    lists, lines, samples = planned.plan.variation.counts
    parts = [(lists, "of lists"), (lines, "lines of the table"), (samples, "samples")]
    words = " x ".join(f"{count} {what}" for count, what in parts if count > 1)
    of_what = f" ({words})" if words.count("x") else ""
    return f"{planned.source.name}: {planned.variants} variants{of_what} of {planned.model.name}"


def _values_table(planned: Study, shown: dict[int, dict[str, float]]) -> str:
    import numpy as np

    from mechkin_cli.cli.show import shown_table
    from mechkin_cli.tables import Columns, TableColumn

    columns = [TableColumn("variant", "", np.array(list(shown), dtype=np.float64), 0)]
    for heading in planned.plan.question.parameters:
        values = np.array([values[heading.label] for values in shown.values()])
        columns.append(TableColumn(heading.label, heading.unit, values, 6))
    return shown_table(Columns("variants", "some of the variants", tuple(columns)), len(shown))


def _estimate(planned: Study, workers: Workers, format_: str, json: bool) -> Record:
    """Time and size, from a trial."""
    from mechkin_cli.cli.progress import working

    with working(f"{planned.source.name}: a trial of some variants", json):
        found = planned.trial(workers, format_)
    if not json:
        say(_counts(planned))
        say(
            f"  a trial of {found.variants} took {_time(found.seconds)}; all of them take about "
            f"{_time(found.whole_seconds)} and {_size(found.whole_bytes)}, in pieces of "
            f"{planned.piece}"
        )
        run = planned.plan.question.run
        kept = len(planned.plan.question.tables["variants"])
        say(f"  of the run {run} {kept} columns are kept of every variant")
    return {
        "variants": planned.variants,
        "piece": planned.piece,
        "trial": {"variants": found.variants, "seconds": found.seconds},
        "estimate": {"seconds": found.whole_seconds, "bytes": found.whole_bytes},
    }


def _time(seconds: float) -> str:
    for unit, size in (("days", 86400.0), ("h", 3600.0), ("min", 60.0), ("s", 1.0)):
        if seconds >= size:
            return f"{_two_digits(seconds / size)} {unit}"
    return f"{_two_digits(seconds * 1e3)} ms"


def _two_digits(value: float) -> str:
    """Two digits that count, without a power of ten: 240, 2.4."""
    return f"{float(f'{value:.1e}'):.15g}"


def _size(count: float) -> str:
    for unit in ("B", "kB", "MB", "GB"):
        if count < 1000.0:
            return f"{count:.3g} {unit}"
        count /= 1000.0
    return f"{count:.3g} TB"


@contextmanager
def _progress(planned: Study, quiet: bool) -> Iterator[Callable[[int, int], None] | None]:
    """A line with how many are done, the rate and the remaining time, on a terminal."""
    from mechkin_cli.cli.progress import counting

    with counting(f"{planned.source.name}", "variants", quiet) as tell:
        yield tell


def _record(found: StudyFiles) -> Record:
    return {
        "name": found.name,
        "files": [str(path) for path in found.files],
        "variants": found.overview.variants,
        "verdicts": found.overview.verdicts,
        "columns": [_finite(spread._asdict()) for spread in found.overview.spreads],
        "diagnostics": [diagnostic.record() for diagnostic in found.diagnostics],
    }


def _finite(fields: dict[str, Any]) -> dict[str, Any]:
    """Without what a column without numbers does not have."""
    return {k: v for k, v in fields.items() if fields["found"] or k in ("label", "unit", "found")}


def _print(found: StudyFiles, quiet: bool) -> None:
    import numpy as np

    from mechkin_cli.cli.show import shown_table
    from mechkin_cli.tables import Columns, TableColumn, column_of_numbers, words_of

    seen = found.overview
    for path in found.files:
        put(f"{path}\n")
    if quiet:
        return
    spreads = seen.spreads

    def numbers(label: str, decimals: int | None, values: list[float]) -> TableColumn:
        return column_of_numbers(label, "", np.array(values, dtype=np.float64), decimals)

    def place(number: int) -> float:
        return float("nan") if number < 0 else float(number)

    columns = (
        TableColumn("column", "", words_of([spread.label for spread in spreads])),
        TableColumn("unit", "", words_of([spread.unit for spread in spreads])),
        numbers("least", 6, [spread.least for spread in spreads]),
        numbers("in variant", 0, [place(spread.least_at) for spread in spreads]),
        numbers("mean", 6, [spread.mean for spread in spreads]),
        numbers("largest", 6, [spread.largest for spread in spreads]),
        numbers("in variant", 0, [place(spread.largest_at) for spread in spreads]),
    )
    if spreads:
        put(shown_table(Columns("overview", "overview", columns), len(spreads)))
    verdicts = ", ".join(f"{count} {word}" for word, count in seen.verdicts.items())
    say(f"{found.name}: {seen.variants} variants: {verdicts}")
