"""Footnotes of a table: which rows are not ok or lack a cell, and why."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.status import Status
from mechkin_cli.tables.columns import Columns, Words, solved_rows
from mechkin_cli.tables.run_parameter import RunParameter, run_parameter
from mechkin_cli.tables.source import Source

LISTED_RANGES = 6


def footnotes(columns: Columns, source: Source, written: Callable[[str], str] = str) -> list[str]:
    """One sentence per verdict other than ok, then one per column with unexplained empty cells.

    `written` makes of a label what is to stand in the file.
    """
    if not columns.of_rows:
        return []
    notes = [
        f"{_where(source.status == status, source)}: {status.label}: {status.sentence}"
        for status in Status
        if status is not Status.ok and bool((source.status == status).any())
    ]
    unclear = np.isin(source.status, (Status.rank_unclear, Status.dead_centre))
    explained = ~solved_rows(source) | unclear
    for column in columns.columns:
        if isinstance(column.values, Words):
            continue
        empty = ~np.isfinite(column.values) & ~explained
        if bool(empty.any()):
            reason = "the value is not finite or not unique there."
            notes.append(f"{_where(empty, source)}: no {written(column.label)}: {reason}")
    return notes


def _where(chosen: NDArray[np.bool_], source: Source) -> str:
    """Rows in words, counted from 1: `Rows 3, 27-30 (O1.theta 202 to 208 deg)`."""
    rows = np.flatnonzero(chosen)
    starts = np.flatnonzero(np.diff(rows, prepend=-2) != 1)
    ends = np.append(starts[1:], rows.size)
    swept = run_parameter(source)
    texts = [
        _range_text(int(rows[start]) + 1, int(rows[end - 1]) + 1, swept)
        for start, end in zip(starts[:LISTED_RANGES], ends[:LISTED_RANGES], strict=True)
    ]
    if starts.size > LISTED_RANGES:
        texts.append(f"and {rows.size - ends[LISTED_RANGES - 1]} more")
    return f"{'Row' if rows.size == 1 else 'Rows'} {', '.join(texts)}"


def _range_text(first: int, last: int, swept: RunParameter | None) -> str:
    rows = str(first) if first == last else f"{first}-{last}"
    if swept is None:
        return rows
    name, values, unit = swept
    start, end = float(values[first - 1]), float(values[last - 1])
    place = f"{name} {start:.12g}" if first == last else f"{name} {start:.12g} to {end:.12g}"
    return f"{rows} ({f'{place} {unit}'.rstrip()})"
