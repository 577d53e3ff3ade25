"""Columns as the kernel's writers of text take them, and how many threads write."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tolerances import CELLS_PER_THREAD, MOST_TEXT_THREADS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats

    WordColumn = tuple[NDArray[np.int32], list[str]]


def word_column(words: Words, written: Callable[[str], str] = str) -> WordColumn:
    """Codes and texts; `written` makes of each text what is to stand in the file."""
    return np.ascontiguousarray(words.codes, np.int32), [written(word) for word in words.words]


def number_column(values: Floats) -> Floats:
    """The numbers without gaps in memory, shape (rows,)."""
    return np.ascontiguousarray(values, np.float64)


def threads_for(columns: Columns | Iterable[Column], threads: int = 0) -> int:
    """Threads that write a table: those asked for, or with 0 as many as there are processors and
    as the number of cells is worth. The text does not depend on it."""
    if threads:
        return min(threads, MOST_TEXT_THREADS)
    listed = columns.columns if isinstance(columns, Columns) else tuple(columns)
    cells = sum(column.rows for column in listed)
    return max(1, min(_processors(), cells // CELLS_PER_THREAD, MOST_TEXT_THREADS))


def _processors() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
