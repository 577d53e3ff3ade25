"""How fast tables are written: a million rows of ten numbers, in each format, in blocks.

    python -P tests/benchmark/table_files.py [--rows 1000000] [--block 65536] [--rounds 5]

Beside them in the same run: std::to_chars on the same numbers and threads, `write_csv` and
`write_ndjson` of polars, and pyarrow on the same arrays (as it writes them by default, and as
mechkin asks it to). Text is made in memory; files are written to the folder of temporary files.
Ratios are of the processor's time, which holds where the machine is busy, and of the clock on the
wall in brackets.
"""

from __future__ import annotations

import argparse
import io
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

sys.path[:0] = [str(Path(__file__).resolve().parents[1])]

import numpy as np
from kernel.compiler import compile_with

from mechkin_cli.tables import (
    Columns,
    CsvStyle,
    OutputFolder,
    TableColumn,
    TableStream,
    TextRoom,
    heading_of,
    write_table,
)
from mechkin_cli.tables.csv import csv_lines
from mechkin_cli.tables.writers import STREAM_FORMATS

COLUMNS = 10
TURNS = 20.0


class Nowhere(io.RawIOBase):
    """A file that forgets what is written to it."""

    def write(self, data: object) -> int:
        """Counts it."""
        return len(data)  # type: ignore[arg-type]


def table_of(rows: int) -> Columns:
    """A table of smooth numbers with all their digits, of sizes from 1 to 1000."""
    way = np.linspace(0.0, TURNS, rows)
    return Columns(
        "table",
        "",
        tuple(
            TableColumn(f"c{k}", "mm", np.sin(way * (k + 1)) * 10.0 ** (k % 4))
            for k in range(COLUMNS)
        ),
    )


def blocks(table: Columns, size: int) -> Iterator[tuple[TableColumn, ...]]:
    """Its rows, so many at a time."""
    for start in range(0, table.columns[0].rows, size):
        stop = min(start + size, table.columns[0].rows)
        yield tuple(column.part(np.arange(start, stop)) for column in table.columns)


Took = tuple[float, float]
"""Seconds of processor time, of all threads together, and of the clock on the wall."""


def median_of(rounds: Sequence[Took]) -> Took:
    """The median of both."""
    processor, wall = zip(*rounds, strict=True)
    return median(processor), median(wall)


def in_turns(works: dict[str, Callable[[], object]], rounds: int) -> dict[str, Took]:
    """What each takes, the median of its turns."""
    took: dict[str, list[Took]] = {name: [] for name in works}
    for _ in range(rounds):
        for name, work in works.items():
            start = process_time(), perf_counter()
            work()
            took[name].append((process_time() - start[0], perf_counter() - start[1]))
    return {name: median_of(times) for name, times in took.items()}


def to_chars(folder: Path, table: Columns, threads: int, rounds: int) -> Took:
    """What the loop in C++ takes."""
    numbers = np.stack([column.numbers for column in table.columns], axis=1)
    (folder / "numbers").write_bytes(numbers.tobytes())
    source = Path(__file__).with_name("to_chars.cpp")
    program = compile_with(source, folder / "to_chars", "-O3", "-pthread")
    words = [str(program), str(folder / "numbers"), str(numbers.size), str(threads), str(rounds)]
    lines = subprocess.run(words, capture_output=True, check=True, text=True).stdout.splitlines()
    return median_of([tuple(map(float, line.split())) for line in lines])  # type: ignore[misc]


def measure(rows: int, block: int, rounds: int, threads: int) -> None:
    """Prints what was measured on some threads."""
    import polars
    import pyarrow
    from pyarrow import parquet

    pyarrow.set_cpu_count(threads)
    table = table_of(rows)
    parts = list(blocks(table, block))
    heading, style = heading_of(table), CsvStyle(threads=threads)
    room = TextRoom()
    arrays = {column.label: column.numbers for column in table.columns}
    frame, arrow = polars.DataFrame(arrays), pyarrow.table(arrays)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def text() -> None:
            for part in parts:
                for _ in csv_lines(part, room, style):
                    pass

        def written(format: str) -> None:
            with OutputFolder(folder / "out") as output:
                with output.begin(f"table.{format}") as file:
                    write_table(TableStream(heading, parts), format, file, style, room)
                output.write_run()

        def by_pyarrow(**options: object) -> None:
            path = folder / "peer.parquet"
            parquet.write_table(arrow, path, row_group_size=65536, **options)

        asked = {"compression": "zstd", "use_dictionary": False}
        asked["column_encoding"] = dict.fromkeys(arrays, "BYTE_STREAM_SPLIT")
        works: dict[str, Callable[[], object]] = {
            "csv, text alone": text,
            **{format: lambda format=format: written(format) for format in STREAM_FORMATS},
            "polars write_csv": lambda: frame.write_csv(folder / "peer.csv"),
            "polars write_ndjson": lambda: frame.write_ndjson(folder / "peer.jsonl"),
            "pyarrow": by_pyarrow,
            "pyarrow, as asked": lambda: by_pyarrow(**asked),
        }
        took = {"to_chars": to_chars(folder, table, threads, rounds), **in_turns(works, rounds)}
        peers = {
            "csv, text alone": ("to_chars",),
            "csv": ("to_chars", "polars write_csv"),
            "jsonl": ("polars write_ndjson",),
            "parquet": ("pyarrow", "pyarrow, as asked"),
        }
        print(f"\n{rows} rows x {COLUMNS}, blocks of {block}, {threads} thread(s)")
        print(f"{'':22} processor      wall")
        for name, both in took.items():
            ratios = [
                f"{both[0] / took[peer][0]:.2f} ({both[1] / took[peer][1]:.2f}) of {peer}"
                for peer in peers.get(name, ())
            ]
            print(f"{name:22} {both[0]:7.3f} s {both[1]:7.3f} s  {', '.join(ratios)}")
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"memory at most {most:.0f} MB, of which the numbers are {rows * COLUMNS * 8 >> 20} MB")


def main() -> None:
    """A process for each number of threads, as polars reads it when it is loaded."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rows", type=int, default=1_000_000)
    parser.add_argument("--block", type=int, default=65536)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=0)
    given = parser.parse_args()
    if given.threads:
        measure(given.rows, given.block, given.rounds, given.threads)
        return
    for threads in sorted({1, len(os.sched_getaffinity(0))}):
        words = [*sys.argv, "--threads", str(threads)]
        environment = {**os.environ, "POLARS_MAX_THREADS": str(threads)}
        subprocess.run([sys.executable, "-P", *words], env=environment, check=True)


if __name__ == "__main__":
    main()
