"""JSON record of an analysis: tables, rows with their verdicts, diagnostics.

Every list of cells has one entry per row; null is an empty cell. The order of keys is fixed, and
each list stands on a line of its own.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tables.rows_table import rows_table
from mechkin_cli.tables.source import Source

Plain = dict[str, object]


def analysis_record(
    name: str,
    tables: Iterable[Columns],
    source: Source,
    diagnostics: Iterable[Diagnostic] = (),
) -> Plain:
    """The analysis as plain data; values are in file units, each column names its own."""
    return {
        "name": name,
        "row_count": source.rows,
        "tables": [table_record(table) for table in tables],
        "rows": _column_records(rows_table(source)),
        "diagnostics": [diagnostic.record() for diagnostic in diagnostics],
    }


def table_record(columns: Columns) -> Plain:
    """One table as plain data."""
    return {
        "name": columns.name,
        "title": columns.title,
        "columns": _column_records(columns),
    }


def json_text(record: object) -> str:
    """Valid JSON with a newline at its end.

    Raises:
        ValueError: the record holds a number that is not finite.
    """
    return _text(record, "") + "\n"


def _column_records(columns: Columns) -> list[Plain]:
    return [
        {"label": column.label, "unit": column.unit, "values": _values(column)}
        for column in columns.columns
    ]


def _values(column: Column) -> list[object]:
    if isinstance(column.values, Words):
        return list(column.values.texts())
    return [_number(value) for value in column.values.tolist()]


def _number(value: float) -> int | float | None:
    """The value as CSV cells hold it: no `-0`, whole numbers without a point, null for nan."""
    if not math.isfinite(value):
        return None
    return int(value) if value.is_integer() and abs(value) < 1e16 else value


def _text(value: object, indent: str) -> str:
    inner = indent + "  "
    if isinstance(value, dict) and value:
        items = [f"{inner}{json.dumps(key)}: {_text(item, inner)}" for key, item in value.items()]
        return "{\n" + ",\n".join(items) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(item, dict | list) for item in value):
        items = [inner + _text(item, inner) for item in value]
        return "[\n" + ",\n".join(items) + f"\n{indent}]"
    return json.dumps(value, ensure_ascii=False, allow_nan=False)
