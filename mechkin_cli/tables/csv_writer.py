"""CSV of a table: RFC 4180 with LF line ends, labels as header, numbers as the kernel writes them.

Numbers have the shortest digits that read back as the same double, or, for tables kept under
version control, the shortest of the value rounded to a number of significant digits; an empty cell
is a missing value.
"""

from __future__ import annotations

import numpy as np

from mechkin_cli.tables.columns import Columns, Words

COMMITTED_DIGITS = 12
"""Significant digits of committed tables: above any rounding, below what a last bit can change."""

SHORTEST = 0


def csv_bytes(columns: Columns, significant_digits: int = SHORTEST) -> bytes:
    """The whole file as UTF-8; `SHORTEST` or 1 to 15 significant digits."""
    from mechkin_cli.kernel import _kernel

    labels = [column.label for column in columns.columns]
    cells = [
        (np.ascontiguousarray(column.values.codes, np.int32), list(column.values.words))
        if isinstance(column.values, Words)
        else np.ascontiguousarray(column.values, np.float64)
        for column in columns.columns
    ]
    text: bytes = _kernel.csv_text(labels, cells, None, significant_digits)
    return text if len(labels) > 1 else _with_quoted_empty_lines(text)


def _with_quoted_empty_lines(text: bytes) -> bytes:
    """Empty cells of a single column in quotes, as many readers skip blank lines."""
    lines = text.removesuffix(b"\n").split(b"\n")
    return b"\n".join(line or b'""' for line in lines) + b"\n"
