"""`mechkin bench`: run time against error on this machine."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mechkin_cli.cli import stress_options as options
from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.given_file import refuse_stdin
from mechkin_cli.cli.messages import Record, put, put_json, refusal
from mechkin_cli.cli.options import Json, folder
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from rich.table import Table as RichTable

    from mechkin_cli.benchmark.report import Table
    from mechkin_cli.benchmark.runs import Bench, Rounds
    from mechkin_cli.benchmark.scene import Scene
    from mechkin_cli.benchmark.subject import Subject

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
    stress: options.Stress = False,
    rows: options.Rows = 2_000,
    seed: options.Seed = 1,
    family: options.Family = None,
    only: options.Only = None,
    page: options.Page = None,
    check: options.Check = False,
    processes: options.Processes = 0,
) -> None:
    """Measure run time against error, mechkin's and others'.

    Without files it measures eight mechanisms, variants and responses. Other libraries are measured
    if they are installed (pip install 'mechkin[bench]'). With --stress it runs hard mechanisms by
    the thousand instead, and decides every row in double-double.
    """
    _refuse_options_of_the_other(context, stress=stress)
    if stress:
        from mechkin_cli.cli.bench_stress import Stress, stress_command

        asked = Stress(round(rows), seed, family, only, page, check, processes, json)
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
    from mechkin_cli.interface import load

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
