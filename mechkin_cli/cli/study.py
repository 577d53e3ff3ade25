"""`mechkin study`: a hundred thousand variants of a mechanism, a few numbers of each."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from mechkin_cli import studies, tables
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
from mechkin_cli.cli.progress import counting, working
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.model import load

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.studies import Spread, Study, StudyFiles, Workers
    from mechkin_cli.tables import Columns, TableColumn


SHOWN_VARIANTS = 6
"""Variants that `--dry-run` shows: half of them the first, half the last."""


def study(
    file: Path,
    *,
    out: Path | None = None,
    set_: list[str] | None = None,
    format_: str = "csv",
    again: bool = False,
    threads: int = 0,
    processes: int = 0,
    scheduler: str | None = None,
    part: str | None = None,
    merge: bool = False,
    explain: bool = False,
    dry_run: bool = False,
    json: bool = False,
    messages: str | None = None,
    quiet: bool = False,
) -> ExitCode:
    """Runs many variants of a mechanism and keeps a few numbers of each."""

    tell_as(messages)
    record: Record = {}
    code = ExitCode.OK
    try:
        share = None if part is None else studies.share_of(part)
        if merge and (part is not None or explain or dry_run):
            other = "--part" if part is not None else "--explain" if explain else "--dry-run"
            raise UsageError(f"--merge computes nothing; leave {other} out")
        source = studies.open_study(file)
        planned = studies.Study(source.load_model(parameters(set_), load), source, share)
        say_diagnostics(planned.notes, str(file))
        workers = studies.Workers(threads, processes, None, scheduler)
        if dry_run:
            record = _shown_variants(planned, json)
        elif explain:
            record = _estimate(planned, workers, format_, json)
        else:
            target = Path("out", file.stem) if out is None else out
            found = _written(planned, target, workers, format_, again, merge, quiet or json)
            record = _record(found, planned)
            if not json:
                _print(found, planned, quiet)
            if set(found.overview.verdicts) - {"ok"}:
                code = ExitCode.ROWS_MISSING
    except (InvalidFile, UsageError) as error:
        code, record = refusal(file, error)
    if json:
        put_json({"file": str(file), **record})
    return code


def _written(
    planned: Study,
    target: Path,
    workers: Workers,
    format_: str,
    again: bool,
    merge: bool,
    quiet: bool,
) -> StudyFiles:
    """The files of the study or of its share, computed or merged."""
    name = planned.source.name
    then(", and the same command goes on with them")
    if merge:
        with working(f"{name}: putting all parts together", quiet):
            return planned.merged(target, format_, again)
    if workers.processes:
        studies.end_without_warnings()
    with counting(name, "variants", quiet) as progress:
        return planned.in_folder(target, workers, format_, again, progress)


def _shown_variants(planned: Study, json: bool) -> Record:
    """Counts and the values of some variants."""
    variation = planned.variation
    lists, lines, samples = variation.counts
    half = SHOWN_VARIANTS // 2
    own = planned.numbers
    stretches = [own[:half], own[half:][-half:]]
    shown = {
        number: {name: float(values[place]) for name, values in found.items()}
        for numbers in stretches
        if numbers
        for found in [variation.values(numbers.start, numbers.stop)]
        for place, number in enumerate(numbers)
    }
    if not json:
        say(_counts(planned))
        put(_values_table(planned, shown))
    return _share_record(planned) | {
        "variants": planned.variants,
        "lists": lists,
        "lines": lines,
        "samples": samples,
        "shown": [{"variant": number, **values} for number, values in shown.items()],
    }


def _counts(planned: Study) -> str:
    """How many variants there are, and of what."""
    lists, lines, samples = planned.variation.counts
    parts = [(lists, "of lists"), (lines, "lines of the table"), (samples, "samples")]
    words = " x ".join(f"{count} {what}" for count, what in parts if count > 1)
    of_what = f" ({words})" if words.count("x") else ""
    text = f"{planned.source.name}: {planned.variants} variants{of_what} of {planned.model.name}"
    if planned.share is None:
        return text
    numbers = planned.numbers
    which = f"variants {numbers[0]} to {numbers[-1]}" if numbers else "no variants"
    return f"{text}; part {planned.share} has {which}"


def _share_record(planned: Study) -> Record:
    """Which variants a share has, where one is named."""
    if planned.share is None:
        return {}
    numbers = planned.numbers
    return {"part": str(planned.share), "begin": numbers.start, "end": numbers.stop}


def _values_table(planned: Study, shown: dict[int, dict[str, float]]) -> str:
    from mechkin_cli.cli.show import shown_table

    columns = [tables.column_of_numbers("variant", "", list(shown), 0)]
    for heading in planned.question.parameters:
        values = [values[heading.label] for values in shown.values()]
        columns.append(tables.column_of_numbers(heading.label, heading.unit, values, 6))
    table = tables.Columns("variants", "some of the variants", tuple(columns))
    return shown_table(table, len(shown))


def _estimate(planned: Study, workers: Workers, format_: str, json: bool) -> Record:
    """Time and size, from a trial."""
    with working(f"{planned.source.name}: a trial of some variants", json):
        tried, seconds, whole_seconds, whole_bytes = planned.trial(workers, format_)
    whole = "all of them take" if planned.share is None else f"part {planned.share} takes"
    if not json:
        say(_counts(planned))
        say(
            f"  a trial of {tried} took {_time(seconds)}; {whole} about "
            f"{_time(whole_seconds)} and {_size(whole_bytes)}, in pieces of "
            f"{planned.piece}"
        )
        run = planned.question.run
        count = len(planned.question.tables["variants"])
        say(f"  each variant has {count} columns, of the run {run}")
    return _share_record(planned) | {
        "variants": planned.variants,
        "piece": planned.piece,
        "trial": {"variants": tried, "seconds": seconds},
        "estimate": {"seconds": whole_seconds, "bytes": whole_bytes},
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


def _record(found: StudyFiles, planned: Study) -> Record:
    return {
        "name": found.name,
        **_share_record(planned),
        "files": [str(path) for path in found.files],
        "variants": found.overview.variants,
        "verdicts": found.overview.verdicts,
        "columns": [_spread_record(spread) for spread in found.overview.spreads],
        "diagnostics": [diagnostic.record() for diagnostic in found.diagnostics],
    }


def _spread_record(spread: Spread) -> dict[str, Any]:
    if spread.found:
        return spread._asdict()
    return {"label": spread.label, "unit": spread.unit, "found": spread.found}


def _print(found: StudyFiles, planned: Study, quiet: bool) -> None:
    for path in found.files:
        put(f"{path}\n")
    if quiet:
        return
    spreads = found.overview.spreads
    if spreads:
        from mechkin_cli.cli.show import shown_table

        put(shown_table(_overview(spreads), len(spreads)))
    verdicts = ", ".join(f"{count} {word}" for word, count in found.overview.verdicts.items())
    which = "" if planned.share is None else f", part {planned.share}"
    say(f"{found.name}{which}: {found.overview.variants} variants{verdicts and f': {verdicts}'}")


def _overview(spreads: Sequence[Spread]) -> Columns:
    def numbers(label: str, decimals: int | None, values: list[float]) -> TableColumn:
        return tables.column_of_numbers(label, "", values, decimals)

    def place(number: int) -> float:
        return float("nan") if number < 0 else float(number)

    columns = (
        tables.TableColumn("column", "", tables.words_of([spread.label for spread in spreads])),
        tables.TableColumn("unit", "", tables.words_of([spread.unit for spread in spreads])),
        numbers("least", 6, [spread.least for spread in spreads]),
        numbers("in variant", 0, [place(spread.least_at) for spread in spreads]),
        numbers("mean", 6, [spread.mean for spread in spreads]),
        numbers("largest", 6, [spread.largest for spread in spreads]),
        numbers("in variant", 0, [place(spread.largest_at) for spread in spreads]),
    )
    return tables.Columns("overview", "overview", columns)
