"""The page `docs/errors.md`: right digits of every table kept here."""

from __future__ import annotations

from pathlib import Path

from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.tables.errors import ZERO, ColumnErrors, least_digits, worst_column

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "errors.md"

HEAD = """# Right digits

How many digits of the tables kept here are right? For every cell of every table of [the
mechanisms](../mechanisms/README.md) the true value is computed: rows are repeated in
double-double arithmetic from the converged ones, and responses are integrated once more from
their start, with all numbers exactly as written in the files. This is what `mechkin analyze
--errors` does; [numerics](numerics.md#true-errors) explains how.

*Digits* is the number of digits to which every cell of a table is right, relative to the largest
value of its column. *Worst* is the largest such error, with its column and row. *Not repeated*
names what cannot be measured in this way. The page is made by `python -P
tests/mechanisms/right_digits`, and a test compares it.

| mechanism | table | cells | digits | worst | column | row | not repeated |
|---|---|---|---|---|---|---|---|
"""


def page(mechanisms: list[Path] | None = None) -> str:
    """The whole page, or the lines of some mechanisms."""
    files = list(FILE_OF.values()) if mechanisms is None else mechanisms
    lines = [line for file in files for line in _lines(file)]
    return HEAD + "".join(f"{line}\n" for line in lines)


def _lines(file: Path) -> list[str]:
    model = mk.load(file)
    found: list[str] = []
    for run in model.runs:
        analysis = model.analyze() if run == "sweep" else model.run_free(run)
        columns = analysis.errors.columns
        tables = dict.fromkeys(column.table for column in columns)
        for table in tables:
            found.append(_line(file.stem, table, [c for c in columns if c.table == table]))
    return found


def _line(mechanism: str, table: str, columns: list[ColumnErrors]) -> str:
    repeated = [column for column in columns if (column.digits >= 0).any()]
    cells = sum(int((column.digits >= 0).sum()) for column in repeated)
    why = dict.fromkeys(column.why for column in columns if column.why and column.why != ZERO)
    lost = sum(column.lost for column in columns)
    words = [*why, *([f"{lost} cells"] if lost else [])]
    worst = worst_column(repeated)
    if worst is None:
        parts = ["0", "", "", "", ""]
    else:
        row = int(worst.worst)
        relative = f"{worst.relative[row]:.0e}"
        parts = [str(cells), str(least_digits(repeated)), relative, worst.label, str(row + 1)]
    return f"| {' | '.join([mechanism, table, *parts, ', '.join(words)])} |"
