"""`mechkin bench`: run time against error on this machine."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli import bench as room, model
from mechkin_cli.cli.messages import ExitCode, Record, put, put_json, refusal, refuse_stdin
from mechkin_cli.cli.progress import working
from mechkin_cli.diagnostics import InvalidFile, UsageError

if TYPE_CHECKING:
    from mechkin_cli.bench import Bench, BenchScene, ReportTable, Rounds, Suite


def bench(
    files: list[Path] | None = None,
    quick: bool = False,
    out: Path | None = None,
    json: bool = False,
    stress: bool = False,
) -> int:
    """Measures run time against error, or runs hard mechanisms."""
    if stress:
        refuse_options({"files": files, "quick": quick, "out": out}, STRESS_IS_ALONE)
        return _stress(json=json)
    return measure(room.SUITE, files or [], quick=quick, out=out, json=json)


STRESS_IS_ALONE = "--stress judges mechanisms of its own and times nothing; leave {} out"


def refuse_options(given: Mapping[str, object], message: str) -> None:
    """Refuses options that mean nothing beside others.

    Args:
        given: the parameters that must not be set, and whether they are.
        message: why, and what to do, with {} for those that are.

    Raises:
        UsageError: one of them is set.
    """
    present = [name for name, value in given.items() if value]
    if present:
        words = ", ".join("FILE" if name == "files" else f"--{name}" for name in present)
        raise UsageError(message.format(words))


def measure(
    suite: Suite, files: Sequence[Path], *, quick: bool, out: Path | None, json: bool
) -> int:
    """Measures the files, or a suite's own mechanisms, and shows and writes what was found.

    Returns:
        The exit code: that of the first file that cannot be measured.

    Raises:
        UsageError: a file is given twice, or the folder takes no file.
    """

    rounds = room.QUICK if quick else room.FULL
    if out is not None:
        _make_folder(out)
    code, scenes, refused = _read(files) if files else (int(ExitCode.OK), suite.scenes(), [])
    machine, shown = room.machine(), not json
    if shown and scenes:
        put(", ".join(f"{name} {value}" for name, value in machine.items()) + "\n")
    benches = list(_benches(suite, scenes, rounds, shown=shown))
    tables = list(_tables(suite, scenes, rounds, shown=shown))
    if out is not None and scenes:
        command = " ".join([suite.command, *map(str, files)])
        try:
            written = room.write(out, machine, benches, tables, command)
        except OSError as error:
            raise _not_written(out, error) from None
        if shown:
            put("\n" + "".join(f"{path}\n" for path in written))
    if json:
        put_json(room.record(machine, benches, tables) | ({"refused": refused} if refused else {}))
    return code


def _stress(*, json: bool) -> int:
    """Runs the small set of hard mechanisms.

    Returns:
        The exit code: 1 where a row is wrong and says ok, or a file is refused.
    """
    with working("hard mechanisms", json) as progress:
        outcomes = room.judge_hard_mechanisms(progress)
    if json:
        put_json({"mechanisms": [outcome.record() for outcome in outcomes]})
    else:
        show(room.stress_table(outcomes))
    return ExitCode.DIFFERENCES if any(outcome.is_wrong for outcome in outcomes) else ExitCode.OK


def _make_folder(folder: Path) -> None:
    """Makes the folder, and makes sure that its files can be written, before any measurement."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path in filter(Path.exists, (folder / name for name in room.NAMES.values())):
            path.open("r+b").close()
    except OSError as error:
        raise _not_written(folder, error) from None


def _not_written(folder: Path, error: OSError) -> UsageError:
    why, file = error.strerror or str(error), f" ({error.filename})" if error.filename else ""
    return UsageError(f"--out {folder}: {why}{file}; name a folder that can be written")


def _read(files: Sequence[Path]) -> tuple[int, list[BenchScene], list[Record]]:
    """The exit code, the files that can be measured, and the records of the others."""
    code, scenes = int(ExitCode.OK), []
    refused: list[Record] = []
    for file, name in _names(files).items():
        try:
            refuse_stdin(file, "bench reads a file several times, and - is none")
            scenes.append(room.BenchScene(name, model.load(file)))
        except (InvalidFile, UsageError) as error:
            own, record = refusal(file, error)
            code, refused = max(code, own), [*refused, record]
    return code, scenes, refused


def _names(files: Sequence[Path]) -> dict[Path, str]:
    """What tables call the files: their stems, with a number where table names would be the same.

    Raises:
        UsageError: a file is given twice.
    """
    names: dict[Path, str] = {}
    taken: set[str] = set()
    for file in files:
        if file in names:
            raise UsageError(f"{file} is given twice; name it once")
        name, number = file.stem, 1
        while room.key_of(name) in taken:
            number += 1
            name = f"{file.stem} {number}"
        names[file] = name
        taken.add(room.key_of(name))
    return names


def _benches(
    suite: Suite, scenes: Sequence[BenchScene], rounds: Rounds, *, shown: bool
) -> Iterator[Bench]:
    """Each scene's measurements, shown as soon as they are there."""
    for number, scene in enumerate(scenes, 1):
        with working(f"measuring {scene.name}: {number} of {len(scenes)}"):
            measured = room.bench(scene, rounds, suite.families)
        if shown:
            show(room.bench_table(measured))
        yield measured


def _tables(
    suite: Suite, scenes: Sequence[BenchScene], rounds: Rounds, *, shown: bool
) -> Iterator[ReportTable]:
    """What else a suite measures, each table shown as soon as it is there."""
    tables = suite.tables(scenes, rounds) if scenes else iter(())
    while True:
        with working(f"measuring {suite.words}"):
            table = next(tables, None)
        if table is None:
            return
        if shown:
            show(table)
        yield table


def show(table: ReportTable) -> None:
    """Aligned text on stdout."""
    put("\n" + room.plain_text(table))
