"""What was found: the machine, and tables of cells, as data for programs, as text for a person, as
CSV and as Markdown.
"""

from __future__ import annotations

import csv
import platform
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from io import StringIO
from pathlib import Path
from typing import Literal

import numpy as np

from mechkin_cli.bench.measurement import Bench, Measurement
from mechkin_cli.kernel.functions import widths


def machine() -> dict[str, str]:
    """Processor, lane widths, and the versions that matter, by name."""
    return {
        "processor": _processor(),
        "lanes": "/".join(map(str, widths())),
        "Python": platform.python_version(),
        "numpy": np.__version__,
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


Cell = str | float | int | bool | None
Kind = Literal["text", "time", "error", "ratio", "percent", "number", "verdict"]


@dataclass(frozen=True)
class ReportColumn:
    """`key` names the column for programs, `label` (which may have two lines) for a person."""

    key: str
    label: str
    kind: Kind = "text"


@dataclass(frozen=True)
class ReportTable:
    """One part of the report; each row maps column keys to values."""

    name: str
    title: str
    columns: Sequence[ReportColumn]
    rows: Sequence[Mapping[str, Cell]]
    notes: Sequence[str] = field(default_factory=tuple)

    def record(self) -> dict[str, object]:
        """As plain data."""
        return {
            "title": self.title,
            "rows": [{c.key: row.get(c.key) for c in self.columns} for row in self.rows],
            "notes": list(self.notes),
        }

    def texts(self) -> list[list[str]]:
        """The cells as text, row by row."""
        return [[cell_text(row.get(c.key), c.kind) for c in self.columns] for row in self.rows]


def key_of(name: str) -> str:
    """A mechanism's name as part of a table's name: letters and digits, the rest as underscores."""
    return "".join(c if c.isalnum() else "_" for c in name.lower())


def cell_text(value: Cell, kind: Kind) -> str:
    """A cell for a person; nothing is an empty text."""
    if value is None:
        return ""
    if kind == "verdict":
        return "yes" if value else "no"
    if isinstance(value, str) or kind == "text":
        return str(value)
    if kind == "time":
        return _significant(value)
    if kind == "error":
        return f"{value:.1e}"
    if kind == "percent":
        return f"{100.0 * value:.0f}"
    return f"{value:.2f}" if kind == "ratio" else f"{value:.10g}"


def _significant(value: float) -> str:
    """Three significant digits without an exponent."""
    if value >= 100.0:
        return f"{value:.0f}"
    return f"{value:.1f}" if value >= 10.0 else f"{value:.2f}" if value >= 1.0 else f"{value:.3f}"


def plain_text(table: ReportTable) -> str:
    """Aligned columns, numbers to the right."""
    labels = [column.label.split("\n") for column in table.columns]
    depth = max(map(len, labels))
    head = [[""] * (depth - len(label)) + label for label in labels]
    lines = [list(line) for line in zip(*head, strict=True)] + table.texts()
    widths = [max(len(line[i]) for line in lines) for i in range(len(table.columns))]
    text = [table.title, ""]
    for line in lines:
        cells = [
            cell.ljust(width) if column.kind == "text" else cell.rjust(width)
            for cell, width, column in zip(line, widths, table.columns, strict=True)
        ]
        text.append("  ".join(cells).rstrip())
    return "\n".join([*text, *([""] if table.notes else []), *table.notes]) + "\n"


COLUMNS = (
    ReportColumn("family", "by"),
    ReportColumn("curve", "method"),
    ReportColumn("setting", "setting"),
    ReportColumn("microseconds", "us per\nrow", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times\nkernel", "time"),
    ReportColumn("position", "error:\nposi-\ntion", "error"),
    ReportColumn("velocity", "velo-\ncity", "error"),
    ReportColumn("acceleration", "acceler-\nation", "error"),
    ReportColumn("loads", "\nloads", "error"),
)
NOTES = (
    "times kernel: against one call of the kernel for the same quantities, in the same rounds.",
    "errors: largest, in parts of the quantity's largest value.",
)


def bench_table(bench: Bench) -> ReportTable:
    """Every method at every setting, and what could not run."""
    rows = [m.record() for m in bench.measurements]
    scene, chain = bench.scene, bench.scene.chain
    skipped = [f"{s.family} is left out: {s.reason}" for s in bench.skipped]
    title = (
        f"{scene.name}: {scene.result.rows} rows, {chain.equations} equations in "
        f"{len(chain.unknowns)} unknowns"
    )
    exact = f"exact: {bench.exact}."
    name = "bench_" + key_of(scene.name)
    return ReportTable(name, title, COLUMNS, rows, (*NOTES, exact, *skipped))


def csv_text(benches: Iterable[Bench]) -> str:
    """All measurements, one line each."""
    stream = StringIO()
    names = list(Measurement.__dataclass_fields__)
    writer = csv.DictWriter(stream, names, lineterminator="\n")
    writer.writeheader()
    for bench in benches:
        for m in bench.measurements:
            cells = {k: "" if v is None else v for k, v in m.record().items()}
            writer.writerow({k: repr(v) if isinstance(v, float) else v for k, v in cells.items()})
    return stream.getvalue()


def markdown(table: ReportTable) -> str:
    """A table as Markdown, notes below."""
    # a word that a line end divides is whole again
    whole = [re.sub(r"(?<=[a-z])-\n", "", column.label) for column in table.columns]
    labels = [" ".join(label.split()) for label in whole]
    sides = ["---" if c.kind == "text" else "---:" for c in table.columns]
    lines = [f"### {table.title}", "", _line(labels), _line(sides)]
    lines += [_line(cells) for cells in table.texts()]
    notes = " ".join(table.notes)
    return "\n".join([*lines, "", *([notes, ""] if notes else [])])


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
