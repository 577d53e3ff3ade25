"""What was measured of a mechanism as a table for a person, as CSV, and as Markdown."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from io import StringIO
from typing import TYPE_CHECKING

from mechkin_cli.benchmark.measurement import Measurement
from mechkin_cli.benchmark.report import Cell, Column, Table, key_of

if TYPE_CHECKING:
    from mechkin_cli.benchmark.runs import Bench


COLUMNS = (
    Column("family", "by"),
    Column("curve", "method"),
    Column("setting", "setting"),
    Column("microseconds", "us per\nrow", "time"),
    Column("spread", "+-\n%", "percent"),
    Column("ratio", "times\nkernel", "time"),
    Column("position", "error:\nposi-\ntion", "error"),
    Column("velocity", "velo-\ncity", "error"),
    Column("acceleration", "acceler-\nation", "error"),
    Column("loads", "\nloads", "error"),
)
NOTES = (
    "times kernel: against one call of the kernel for the same quantities, in the same rounds.",
    "errors: largest, in parts of the quantity's largest value.",
)


def bench_table(bench: Bench) -> Table:
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
    return Table(name, title, COLUMNS, rows, (*NOTES, exact, *skipped))


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


def markdown(table: Table) -> str:
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


def rows_of(values: Iterable[Mapping[str, Cell]]) -> list[dict[str, Cell]]:
    """Rows of a table as plain dictionaries."""
    return [dict(row) for row in values]
