"""`mechkin bench`: run time against error on this machine."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from mechkin_cli.cli.messages import ExitCode, Record, put, put_json, refusal, refuse_stdin, say
from mechkin_cli.cli.options import Json, folder
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import LONGEST_NAME, InvalidFile, UsageError, nearest_hint

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from mechkin_cli.benchmark.report import Table
    from mechkin_cli.benchmark.runs import Bench, Rounds
    from mechkin_cli.benchmark.scene import Scene
    from mechkin_cli.benchmark.stress.tally import Tally
    from mechkin_cli.benchmark.subject import Subject


# Options of `mechkin bench --stress`.

MOST_ROWS = 10**9
MOST_SEED = 2**63 - 1
MOST_NUMBER = 10**9
MOST_PROCESSES = 256

Stress = Annotated[
    bool, typer.Option("--stress", help="Hard mechanisms by the thousand instead of run times.")
]
Rows = Annotated[
    float,
    typer.Option("--rows", min=1, max=MOST_ROWS, help="--stress: rows in all, as 1e6."),
]
Seed = Annotated[
    int,
    typer.Option("--seed", min=0, max=MOST_SEED, help="--stress: seed of the random mechanisms."),
]
Family = Annotated[
    str | None, typer.Option("--family", metavar="NAME", help="--stress: one family alone.")
]
Only = Annotated[
    int | None,
    typer.Option(
        "--only",
        min=0,
        max=MOST_NUMBER,
        metavar="K",
        help="--stress: print mechanism K of the family as a file, and run nothing.",
    ),
]
Page = Annotated[
    Path | None, typer.Option("--page", metavar="FILE", help="--stress: also write a page.")
]
Check = Annotated[
    bool,
    typer.Option("--check", help="--stress: run the small set anew and compare it with the page."),
]
Processes = Annotated[
    int,
    typer.Option(
        "--processes", min=0, max=MOST_PROCESSES, help="--stress: processes at once; 0: all cores."
    ),
]


_OF_STRESS = ("rows", "seed", "family", "only", "page", "check", "processes")
_OF_TIMES = ("files", "quick", "out")


def bench(
    context: typer.Context,
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Mechanism files to measure instead of the eight of its own.", metavar="FILE"
        ),
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Few rounds: takes seconds, and measures less well.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            parser=folder,
            help="Also write bench.json, bench.csv, bench.md, bench.svg.",
        ),
    ] = None,
    json: Json = False,
    stress: Stress = False,
    rows: Rows = 2_000,
    seed: Seed = 1,
    family: Family = None,
    only: Only = None,
    page: Page = None,
    check: Check = False,
    processes: Processes = 0,
) -> None:
    """Measure run time against error, mechkin's and others'.

    Without files it measures eight mechanisms, variants and responses. Other libraries are measured
    if they are installed (pip install 'mechkin[bench]'). With --stress it runs hard mechanisms by
    the thousand instead, and decides every row in double-double.
    """
    _refuse_options_of_the_other(context, stress=stress)
    if stress:
        asked = BenchStressStress(round(rows), seed, family, only, page, check, processes, json)
        code = stress_command(asked, _show)
        if code:
            raise typer.Exit(code)
        return
    from mechkin_cli.benchmark.machine import machine
    from mechkin_cli.benchmark.outputs import record, write
    from mechkin_cli.benchmark.runs import FULL, QUICK

    rounds = QUICK if quick else FULL
    if out is not None:
        _made(out)
    code, subjects, scenes, refused = _read(files or [])
    described, shown = machine(), not json
    if shown and scenes:
        put(", ".join(f"{name} {value}" for name, value in described.items()) + "\n")
    benches = list(_benches(scenes, rounds, shown=shown))
    tables = list(_tables(subjects, scenes, rounds, whole=not files, shown=shown))
    if out is not None and scenes:
        command = " ".join(["mechkin bench", *map(str, files or [])])
        try:
            written = write(out, described, benches, tables, command)
        except OSError as error:
            raise _not_written(out, error) from None
        if shown:
            put("\n" + "".join(f"{path}\n" for path in written))
    if json:
        put_json(record(described, benches, tables) | ({"refused": refused} if refused else {}))
    if code:
        raise typer.Exit(code)


def _refuse_options_of_the_other(context: typer.Context, *, stress: bool) -> None:
    """
    Raises:
        UsageError: an option is given that means nothing with, or without, --stress.
    """
    others = _OF_TIMES if stress else _OF_STRESS
    given = [name for name in others if _is_given(context, name)]
    if not given:
        return
    words = ", ".join("FILE" if name == "files" else f"--{name}" for name in given)
    if stress:
        raise UsageError(
            f"--stress judges mechanisms of its own and times nothing; leave {words} out"
        )
    raise UsageError(
        f"without --stress there is nothing for {words}; add --stress, or leave it out"
    )


def _is_given(context: typer.Context, name: str) -> bool:
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def _made(folder: Path) -> None:
    """Makes the folder of the files before anything is measured."""
    from mechkin_cli.benchmark.outputs import NAMES

    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path in filter(Path.exists, (folder / name for name in NAMES.values())):
            # to be written to; what is there stays as it is
            path.open("r+b").close()
    except OSError as error:
        raise _not_written(folder, error) from None


def _not_written(folder: Path, error: OSError) -> UsageError:
    why, file = error.strerror or str(error), f" ({error.filename})" if error.filename else ""
    return UsageError(f"--out {folder}: {why}{file}; name a folder that can be written")


def _read(files: Sequence[Path]) -> tuple[int, list[Subject], list[Scene], list[Record]]:
    """The scenes of the files, or the known ones; files that cannot be measured are told."""
    from mechkin_cli.benchmark.scene import Scene
    from mechkin_cli.benchmark.scenes import subjects
    from mechkin_cli.benchmark.subject import Subject
    from mechkin_cli.model import load

    if not files:
        known = subjects()
        return ExitCode.OK, known, [Scene(each.name, each.model) for each in known], []
    code, found, scenes = int(ExitCode.OK), [], []
    refused: list[Record] = []
    for file, name in _names(files).items():
        try:
            refuse_stdin(file, "bench reads a file several times, and - is none")
            subject = Subject(name, load(file), file)
            scenes.append(Scene(subject.name, subject.model))
            found.append(subject)
        except (InvalidFile, UsageError) as error:
            own, record = refusal(file, error)
            code, refused = max(code, own), [*refused, record]
    return code, found, scenes, refused


def _names(files: Sequence[Path]) -> dict[Path, str]:
    """What tables call the files: their stems, with a number where tables could not tell them
    apart.

    Raises:
        UsageError: a file is given twice.
    """
    from mechkin_cli.benchmark.report import key_of

    names: dict[Path, str] = {}
    taken: set[str] = set()
    for file in files:
        if file in names:
            raise UsageError(f"{file} is given twice; name it once")
        name, number = file.stem, 1
        while key_of(name) in taken:
            number += 1
            name = f"{file.stem} {number}"
        names[file] = name
        taken.add(key_of(name))
    return names


def _benches(scenes: Sequence[Scene], rounds: Rounds, *, shown: bool) -> Iterator[Bench]:
    """Each scene's measurements, shown as soon as they are there."""
    from mechkin_cli.benchmark.runs import bench as measure
    from mechkin_cli.benchmark.tables import bench_table

    for number, scene in enumerate(scenes, 1):
        with working(f"measuring {scene.name}: {number} of {len(scenes)}"):
            found = measure(scene, rounds)
        if shown:
            _show(bench_table(found))
        yield found


def _tables(
    subjects: Sequence[Subject],
    scenes: Sequence[Scene],
    rounds: Rounds,
    *,
    whole: bool,
    shown: bool,
) -> Iterator[Table]:
    """What settings cost, variants and responses, each shown as soon as it is there."""
    from mechkin_cli.benchmark.runs import tables

    found = tables(subjects, scenes, rounds, whole=whole) if scenes else iter(())
    while True:
        with working("measuring demand plan, threads, variants, responses"):
            table = next(found, None)
        if table is None:
            return
        if shown:
            _show(table)
        yield table


def _show(table: Table) -> None:
    """Styled on a terminal wide enough, else aligned text."""
    from mechkin_cli.benchmark.report import plain_text, width

    if not sys.stdout.isatty():
        put("\n" + plain_text(table))
        return
    from rich.console import Console

    console = Console()
    console.print()
    # a table that does not fit would lose digits
    if width(table) > console.width:
        console.out(plain_text(table), end="", highlight=False)
        return
    console.print(_styled(table))
    for note in table.notes:
        console.print(note, style="dim", highlight=False, markup=False)


def _styled(table: Table) -> RichTable:
    from rich import box
    from rich.table import Table as RichTable

    styled = RichTable(
        title=table.title,
        title_justify="left",
        title_style="bold",
        header_style="",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, 1, 0, 0),
    )
    for column in table.columns:
        justify = "left" if column.kind == "text" else "right"
        styled.add_column(column.label, justify=justify, vertical="bottom", no_wrap=True)  # type: ignore[arg-type]
    for row in table.texts():
        styled.add_row(*row)
    return styled


# `mechkin bench --stress`: families of hard mechanisms, every row decided in double-double.

LONG = 60.0
"""Seconds of work that are told beforehand."""


class BenchStressStress(NamedTuple):
    """What the command line asks for."""

    rows: int
    seed: int
    family: str | None
    only: int | None
    page: Path | None
    check: bool
    processes: int
    json: bool


def stress_command(asked: BenchStressStress, show: Callable[[Table], None]) -> int:
    """Runs what is asked for; `show` prints a table for a person.

    Returns:
        The exit code: 1 where a row is wrong and says ok, a file is refused, or the page is old.

    Raises:
        UsageError: an unknown family, or options that do not go together.
    """
    from mechkin_cli.benchmark.stress.families.table import FAMILIES

    names = list(FAMILIES)
    if asked.family is not None:
        if asked.family not in FAMILIES:
            hint = nearest_hint(asked.family, names) or f"known are {', '.join(names)}"
            raise UsageError(f"there is no family {asked.family[:LONGEST_NAME]}; {hint}")
        names = [asked.family]
    if asked.only is not None:
        return _one(asked)
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
        from mechkin_cli.benchmark.stress.tables import tables

        for table in tables(tallies):
            show(table)
    wrong = any(tally.verdicts["false_ok"] or tally.verdicts["refused"] for tally in tallies)
    return ExitCode.DIFFERENCES if wrong else ExitCode.OK


def _run(asked: BenchStressStress, rows: int, seed: int, names: Sequence[str]) -> list[Tally]:
    """All blocks, with progress on a terminal, and a word beforehand where it takes long."""
    from mechkin_cli.benchmark.stress.run import stress

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


def _one(asked: BenchStressStress) -> int:
    """One mechanism as a file on stdout."""
    from mechkin_cli.benchmark.stress.block import text_of

    if asked.family is None or asked.only is None:
        raise UsageError("--only K is a mechanism of one family; name it with --family")
    put(text_of(asked.family, asked.seed, asked.only))
    return ExitCode.OK


def _write(asked: BenchStressStress, tallies: list[Tally]) -> None:
    """The page, which takes its place whole."""
    from mechkin_cli.benchmark.stress.families.table import FAMILIES
    from mechkin_cli.benchmark.stress.page import SMALL_ROWS, page

    assert asked.page is not None
    small = _run(asked, SMALL_ROWS, asked.seed, list(FAMILIES))
    text = page(tallies, small, asked.rows, asked.seed)
    beside = asked.page.with_name(f".{asked.page.name}.{os.getpid()}")
    try:
        beside.write_text(text, encoding="utf-8")
        beside.replace(asked.page)
    except OSError as error:
        with contextlib.suppress(OSError):
            beside.unlink()
        raise UsageError(f"{asked.page} cannot be written: {error.strerror}") from None


def _checked(asked: BenchStressStress) -> int:
    """Whether the page has today's form, and its small set's numbers."""
    from mechkin_cli.benchmark.stress.families.table import FAMILIES
    from mechkin_cli.benchmark.stress.page import SMALL_ROWS, is_current, of_page

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
        f"{asked.page} is not what would be written now; write it by: mechkin bench --stress "
        f"--rows {rows} --seed {seed} --page {asked.page}"
    )
    return ExitCode.DIFFERENCES
