"""The files of a run: records as JSON, measurements as CSV, the page as Markdown, the figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mechkin_cli.benchmark.figure import Panel, svg
from mechkin_cli.benchmark.page import best_table, page
from mechkin_cli.benchmark.tables import csv_text
from mechkin_cli.tables import json_text
from mechkin_cli.verdict import versions

if TYPE_CHECKING:
    from mechkin_cli.benchmark.report import Table
    from mechkin_cli.benchmark.runs import Bench


NAMES = {"json": "bench.json", "csv": "bench.csv", "page": "bench.md", "figure": "bench.svg"}


def record(
    machine: Mapping[str, str], benches: Sequence[Bench], tables: Sequence[Table]
) -> dict[str, Any]:
    """The run as plain data: `mechanisms` with their measurements, then the tables by name."""
    return versions() | {
        "machine": dict(machine),
        "mechanisms": [bench.record() for bench in benches],
        "tables": {table.name: table.record() for table in (best_table(benches), *tables)},
    }


def figure(benches: Sequence[Bench]) -> str:
    """The figure of a run."""
    return svg([Panel(bench.scene.name, bench.measurements) for bench in benches])


def write(
    folder: Path,
    machine: Mapping[str, str],
    benches: Sequence[Bench],
    tables: Sequence[Table],
    command: str,
) -> list[Path]:
    """Writes all four files into a folder that is there and says where they are.

    Raises:
        OSError: the folder takes no file.
    """
    texts = {
        "json": json_text(record(machine, benches, tables)),
        "csv": csv_text(benches),
        "page": page(machine, benches, tables, NAMES["figure"], command),
        "figure": figure(benches),
    }
    found = []
    for kind, text in texts.items():
        path = folder / NAMES[kind]
        path.write_text(text, encoding="utf-8", newline="\n")
        found.append(path)
    return found
