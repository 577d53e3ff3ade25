"""`mechkin bench`: run time against error on this machine."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mechkin_cli.cli.messages import ExitCode, Record, put, put_json, refusal, refuse_stdin
from mechkin_cli.cli.options import Json, folder
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from mechkin_cli.bench.measurement import Bench
    from mechkin_cli.bench.report import ReportTable
    from mechkin_cli.bench.runs import Rounds, Suite
    from mechkin_cli.bench.scene import BenchScene, Subject


Quick = Annotated[
    bool, typer.Option("--quick", help="Fewer rounds: takes seconds, with less accurate times.")
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        parser=folder,
        help="Also write bench.json, bench.csv, bench.md, bench.svg.",
    ),
]


def bench(
    context: typer.Context,
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Mechanism files to measure instead of some templates.", metavar="FILE"
        ),
    ] = None,
    quick: Quick = False,
    out: Out = None,
    json: Json = False,
    stress: Annotated[
        bool, typer.Option("--stress", help="Run hard mechanisms with known rows instead.")
    ] = False,
) -> None:
    """Measure run time against error.

    Beside mechkin's own settings it measures scipy (pip install 'mechkin[bench]'), the dense
    systems of the sources, and explicit stepping. Without files it measures some of the templates.
    With --stress it runs a small set of hard mechanisms instead, whose rows are known, and judges
    every row.
    """
    if stress:
        refuse_options(context, ("files", "quick", "out"), STRESS_IS_ALONE)
        code = _stress(json=json)
    else:
        from mechkin_cli.bench.runs import SUITE

        code = measure(SUITE, files or [], quick=quick, out=out, json=json)
    if code:
        raise typer.Exit(code)


STRESS_IS_ALONE = "--stress judges mechanisms of its own and times nothing; leave {} out"


def refuse_options(context: typer.Context, names: Sequence[str], message: str) -> None:
    """Refuses options that mean nothing beside others.

    Args:
        names: the parameters that must not be given.
        message: why, and what to do, with {} for those that are.

    Raises:
        UsageError: one of them is given.
    """
    given = [name for name in names if _is_given(context, name)]
    if given:
        words = ", ".join("FILE" if name == "files" else f"--{name}" for name in given)
        raise UsageError(message.format(words))


def _is_given(context: typer.Context, name: str) -> bool:
    source = context.get_parameter_source(name)
    return source is not None and source.name == "COMMANDLINE"


def measure(
    suite: Suite, files: Sequence[Path], *, quick: bool, out: Path | None, json: bool
) -> int:
    """Measures the files, or a suite's own mechanisms, and shows and writes what was found.

    Returns:
        The exit code: that of the first file that cannot be measured.

    Raises:
        UsageError: a file is given twice, or the folder takes no file.
    """
    from mechkin_cli.bench.outputs import record, write
    from mechkin_cli.bench.report import machine
    from mechkin_cli.bench.runs import FULL, QUICK

    rounds = QUICK if quick else FULL
    if out is not None:
        _made(out)
    code, subjects, refused = _read(files) if files else (int(ExitCode.OK), suite.subjects(), [])
    scenes = [subject.scene for subject in subjects]
    described, shown = machine(), not json
    if shown and scenes:
        put(", ".join(f"{name} {value}" for name, value in described.items()) + "\n")
    benches = list(_benches(suite, scenes, rounds, shown=shown))
    tables = list(_tables(suite, subjects, rounds, shown=shown))
    if out is not None and scenes:
        command = " ".join([suite.command, *map(str, files)])
        try:
            written = write(out, described, benches, tables, command)
        except OSError as error:
            raise _not_written(out, error) from None
        if shown:
            put("\n" + "".join(f"{path}\n" for path in written))
    if json:
        put_json(record(described, benches, tables) | ({"refused": refused} if refused else {}))
    return code


def _stress(*, json: bool) -> int:
    """Runs the small set of hard mechanisms.

    Returns:
        The exit code: 1 where a row is wrong and says ok, or a file is refused.
    """
    from mechkin_cli.bench.stress import stress, stress_table

    with working("hard mechanisms", json) as tell:
        found = stress(tell)
    if json:
        put_json({"mechanisms": [outcome.record() for outcome in found]})
    else:
        show(stress_table(found))
    return ExitCode.DIFFERENCES if any(outcome.is_wrong for outcome in found) else ExitCode.OK


def _made(folder: Path) -> None:
    """Makes the folder of the files before anything is measured."""
    from mechkin_cli.bench.outputs import NAMES

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


def _read(files: Sequence[Path]) -> tuple[int, list[Subject], list[Record]]:
    """The files that can be measured; others are told."""
    from mechkin_cli.bench.scene import BenchScene, Subject
    from mechkin_cli.model import load

    code, found = int(ExitCode.OK), []
    refused: list[Record] = []
    for file, name in _names(files).items():
        try:
            refuse_stdin(file, "bench reads a file several times, and - is none")
            found.append(Subject(BenchScene(name, load(file)), file))
        except (InvalidFile, UsageError) as error:
            own, record = refusal(file, error)
            code, refused = max(code, own), [*refused, record]
    return code, found, refused


def _names(files: Sequence[Path]) -> dict[Path, str]:
    """What tables call the files: their stems, with a number where tables could not tell them
    apart.

    Raises:
        UsageError: a file is given twice.
    """
    from mechkin_cli.bench.report import key_of

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


def _benches(
    suite: Suite, scenes: Sequence[BenchScene], rounds: Rounds, *, shown: bool
) -> Iterator[Bench]:
    """Each scene's measurements, shown as soon as they are there."""
    from mechkin_cli.bench.report import bench_table
    from mechkin_cli.bench.runs import bench as measured

    for number, scene in enumerate(scenes, 1):
        with working(f"measuring {scene.name}: {number} of {len(scenes)}"):
            found = measured(scene, rounds, suite.families)
        if shown:
            show(bench_table(found))
        yield found


def _tables(
    suite: Suite, subjects: Sequence[Subject], rounds: Rounds, *, shown: bool
) -> Iterator[ReportTable]:
    """What else a suite measures, each table shown as soon as it is there."""
    found = suite.tables(subjects, rounds) if subjects else iter(())
    while True:
        with working(f"measuring {suite.words}"):
            table = next(found, None)
        if table is None:
            return
        if shown:
            show(table)
        yield table


def show(table: ReportTable) -> None:
    """Styled on a terminal wide enough, else aligned text."""
    from mechkin_cli.bench.report import plain_text, width

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


def _styled(table: ReportTable) -> RichTable:
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
