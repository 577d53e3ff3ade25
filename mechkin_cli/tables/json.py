"""JSON record of an analysis: tables, rows with their verdicts, diagnostics; and its responses.

Every list of cells has one entry per row; null is an empty cell. The order of keys is fixed, and
each list stands on a line of its own.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from math import isfinite
from typing import TYPE_CHECKING

from mechkin_cli.diagnostics import SURROGATES, Diagnostic, escape
from mechkin_cli.kernel import _kernel
from mechkin_cli.record import dataclass
from mechkin_cli.tables.columns import FloatArray, TableSource, Words, number_column
from mechkin_cli.tables.csv import threads_for, word_column
from mechkin_cli.tables.errors import ColumnErrors, least_digits
from mechkin_cli.tables.markup import rows_table
from mechkin_cli.tables.table import Columns
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.tables.results import Results
    from mechkin_cli.tables.summary import Extreme, Summary


Plain = dict[str, object]

_NOT_ASCII = re.compile(r"[^\x00-\x7f]")


@dataclass(frozen=True, slots=True, eq=False)
class JsonCells:
    """A list of cells as it stands in a record: numbers as in CSV (no `-0`, whole numbers without a
    point, null for nan) or words."""

    values: FloatArray | Words
    threads: int = 1

    def json_bytes(self) -> bytes:
        """The list as JSON."""
        text: bytes = _kernel.json_list(
            word_column(self.values, one_line_json)
            if isinstance(self.values, Words)
            else number_column(self.values),
            self.threads,
        )
        return text


def analysis_record(
    name: str,
    tables: Iterable[Columns],
    source: TableSource,
    diagnostics: Iterable[Diagnostic] = (),
    threads: int = 0,
    run: str = SWEEP,
    errors: Sequence[ColumnErrors] | None = None,
) -> Plain:
    """One run as plain data and `Cells`; values are in file units, each column names its own;
    `errors` of all columns, where they were asked for."""
    measured = {} if errors is None else {"errors": _errors_record(errors)}
    proven: Plain = {}
    if run == SWEEP and source.is_certified:
        is_one_branch, tubes = source.proven_way
        centres = [dict(centre) for centre in source.proven_dead_centres]
        proven["proof"] = {"one_branch": is_one_branch, "tubes": tubes, "dead_centres": centres}
    return {
        "name": name,
        "row_count": source.rows,
        "tables": [table_record(table, threads) for table in tables],
        "rows": _column_records(rows_table(source, run), threads),
        **proven,
        **measured,
        "diagnostics": [diagnostic.record() for diagnostic in diagnostics],
    }


def runs_record(runs: Sequence[Results]) -> Plain:
    """All runs of a mechanism: the record of its sweep and, under `responses`, those of its
    responses with names of their own."""
    records = {
        results.run: analysis_record(
            results.name if results.run == SWEEP else results.run,
            results.tables,
            results.source,
            results.diagnostics,
            results.threads,
            results.run,
            results.errors,
        )
        for results in runs
    }
    sweep = records.pop(SWEEP, None)
    top = {"name": runs[0].name} if sweep is None else sweep
    return top | ({"responses": list(records.values())} if records else {})


def table_record(columns: Columns, threads: int = 0) -> Plain:
    """One table as plain data and `Cells`."""
    return {
        "name": columns.name,
        "title": columns.title,
        "columns": _column_records(columns, threads),
        **({} if columns.summary is None else {"summary": _summary_record(columns.summary)}),
    }


def json_bytes(record: object) -> bytes:
    """Valid JSON in UTF-8 with a newline at its end.

    Raises:
        ValueError: the record holds a number that is not finite, outside of cells.
    """
    return b"".join((*_parts(record, ""), b"\n"))


def json_text(record: object, *, ascii: bool = False) -> str:
    """As `json_bytes`, decoded; in ASCII all other characters are escapes of JSON."""
    text = json_bytes(record).decode()
    return _NOT_ASCII.sub(lambda found: json.dumps(found[0])[1:-1], text) if ascii else text


def _column_records(columns: Columns, threads: int) -> list[Plain]:
    return [
        {
            "label": column.label,
            "unit": column.unit,
            "values": JsonCells(column.values, threads_for([column], threads)),
        }
        for column in columns.columns
    ]


def _summary_record(summary: Summary) -> Plain:
    """What stands below a table, by column: null where no row has a cell, and for what is infinite,
    as in the cells; how many of the rows are is said beside."""
    return {
        "at": summary.parameter,
        "at_unit": summary.unit,
        "columns": [
            {
                "label": each.label,
                "unit": each.unit,
                **{word: _number(getattr(each.statistics, word)) for word in summary.words},
                "rows": each.statistics.rows,
                "infinite": each.statistics.infinite,
            }
            for each in summary.columns
        ],
    }


def _number(found: float | Extreme) -> object:
    if isinstance(found, tuple):
        return {"value": _number(found.value), "at": _number(found.place)}
    return found if isfinite(found) else None


def _errors_record(errors: Sequence[ColumnErrors]) -> Plain:
    """The digits that every cell has, and of each column its errors; null where none is known."""
    return {
        "digits": least_digits(errors),
        "columns": [
            {
                "table": column.table,
                "label": column.label,
                "unit": column.unit,
                "why": column.why,
                "error": JsonCells(column.error),
                "relative": JsonCells(column.relative),
            }
            for column in errors
        ],
    }


def one_line_json(value: object) -> str:
    """A value as JSON in one line."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False)
    # a reader of JSON need not take half characters, which file names may hold
    return SURROGATES.sub(lambda found: escape(found[0]).replace("\\", "\\\\"), text)


def _parts(value: object, indent: str) -> Iterator[bytes]:
    inner = indent + "  "
    if isinstance(value, JsonCells):
        yield value.json_bytes()
    elif isinstance(value, dict) and value:
        for number, (key, item) in enumerate(value.items()):
            yield f"{',' if number else '{'}\n{inner}{one_line_json(key)}: ".encode()
            yield from _parts(item, inner)
        yield f"\n{indent}}}".encode()
    elif isinstance(value, list) and any(
        isinstance(item, dict | list | JsonCells) for item in value
    ):
        for number, item in enumerate(value):
            yield f"{',' if number else '['}\n{inner}".encode()
            yield from _parts(item, inner)
        yield f"\n{indent}]".encode()
    else:
        yield one_line_json(value).encode()
