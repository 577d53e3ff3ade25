"""`--stress`: families of hard mechanisms, every row decided in double-double."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.cli.messages import ExitCode, put, put_json, say
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint

if TYPE_CHECKING:
    from benchmarks.stress.tally import Tally
    from mechkin_cli.bench.report import ReportTable


LONG = 60.0
"""Seconds of work that are told beforehand."""


class Stress(NamedTuple):
    """What the command line asks for."""

    rows: int
    seed: int
    family: str | None
    only: int | None
    page: Path | None
    check: bool
    processes: int
    small: Path | None
    json: bool


def stress_command(asked: Stress, show: Callable[[ReportTable], None]) -> int:
    """Runs what is asked for; `show` prints a table for a person.

    Returns:
        The exit code: 1 where a row is wrong and says ok, a file is refused, or the page is old.

    Raises:
        UsageError: an unknown family, or options that do not go together.
    """
    from benchmarks.stress.families.table import FAMILIES

    names = list(FAMILIES)
    if asked.family is not None:
        if asked.family not in FAMILIES:
            hint = nearest_hint(asked.family, names) or f"known are {', '.join(names)}"
            raise UsageError(f"there is no family {asked.family[:LONGEST_NAME]}; {hint}")
        names = [asked.family]
    if asked.only is not None:
        return _one(asked)
    if asked.small is not None:
        return _small(asked.small)
    if asked.check:
        return _checked(asked)
    if asked.page is not None and asked.family is not None:
        raise UsageError("--page tells of all families; leave --family out")
    tallies = _run(asked, asked.rows, asked.seed, names)
    if asked.page is not None:
        _write(asked, tallies)
    if asked.json:
        families = {tally.family: tally.record() for tally in tallies}
        put_json({"rows": asked.rows, "seed": asked.seed, "families": families})
    else:
        from benchmarks.stress.tables import tables

        for table in tables(tallies):
            show(table)
    wrong = any(tally.verdicts["false_ok"] or tally.verdicts["refused"] for tally in tallies)
    return ExitCode.DIFFERENCES if wrong else ExitCode.OK


def _run(asked: Stress, rows: int, seed: int, names: Sequence[str]) -> list[Tally]:
    """All blocks, with progress on a terminal, and a word beforehand where it takes long."""
    from benchmarks.stress.run import stress

    processes = asked.processes or os.cpu_count() or 1
    told = asked.json

    def step(done: int, count: int, left: float | None) -> None:
        nonlocal told
        more = "" if left is None else f", about {_span(left)} left"
        tell(f"{done} of {count} blocks{more}")
        if left is not None and not told:
            told = True
            if left > LONG:
                say(f"{rows} rows: about {_span(left)} more with {processes} at once")

    with working(f"{rows} rows", asked.json) as tell:
        return stress(rows, seed, names, processes, step)


def _span(seconds: float) -> str:
    """In words of one or two digits."""
    return f"{seconds:.0f} s" if seconds < 100.0 else f"{seconds / 60.0:.0f} min"


def _one(asked: Stress) -> int:
    """One mechanism as a file on stdout."""
    from benchmarks.stress.block import text_of

    if asked.family is None or asked.only is None:
        raise UsageError("--only K is a mechanism of one family; name it with --family")
    put(text_of(asked.family, asked.seed, asked.only))
    return ExitCode.OK


def _write(asked: Stress, tallies: list[Tally]) -> None:
    """The page."""
    from benchmarks.stress.families.table import FAMILIES
    from benchmarks.stress.page import SMALL_ROWS, page

    assert asked.page is not None
    small = _run(asked, SMALL_ROWS, asked.seed, list(FAMILIES))
    _written(asked.page, page(tallies, small, asked.rows, asked.seed))


def _small(file: Path) -> int:
    """The set that the package carries."""
    from benchmarks.stress.small import small_set

    _written(file, small_set())
    return ExitCode.OK


def _written(file: Path, text: str) -> None:
    """A file that takes its place whole."""
    beside = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        beside.write_text(text, encoding="utf-8", newline="\n")
        beside.replace(file)
    except OSError as error:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise UsageError(f"{file} cannot be written: {error.strerror}") from None


def _checked(asked: Stress) -> int:
    """Whether the page has today's form, and its small set's numbers."""
    from benchmarks.stress.families.table import FAMILIES
    from benchmarks.stress.page import SMALL_ROWS, is_current, of_page

    if asked.page is None:
        raise UsageError("--check compares a page; name it with --page")
    try:
        text = asked.page.read_text(encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{asked.page} cannot be read: {error.strerror}") from None
    known = of_page(text)
    seed = known[1] if known else asked.seed
    if is_current(text, _run(asked, SMALL_ROWS, seed, list(FAMILIES))):
        return ExitCode.OK
    rows = known[0] if known else asked.rows
    say(
        f"{asked.page} is not what would be written now; write it by: python -m benchmarks "
        f"--stress --rows {rows} --seed {seed} --page {asked.page}"
    )
    return ExitCode.DIFFERENCES
