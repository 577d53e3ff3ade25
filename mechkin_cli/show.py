"""Things with names in their order: a tuple that also gives them by name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Generic, NamedTuple, SupportsIndex, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, legible, nearest_hint

Item = TypeVar("Item")


class Named(tuple[Item, ...], Generic[Item]):
    """A tuple of things with a `name`: `tables[0]`, `tables["drive"]`, `"drive" in tables`."""

    __slots__ = ()

    def __repr__(self) -> str:
        return f"({', '.join(map(repr, self.keys()))}), by number or name"

    def keys(self) -> list[str]:
        """The names, in order."""
        return [item.name for item in self]  # type: ignore[attr-defined]

    def __contains__(self, key: object) -> bool:
        return key in self.keys() if isinstance(key, str) else tuple.__contains__(self, key)

    @overload
    def __getitem__(self, key: SupportsIndex | str) -> Item: ...

    @overload
    def __getitem__(self, key: slice) -> tuple[Item, ...]: ...

    def __getitem__(self, key: Any) -> Any:
        """By number, slice or name.

        Raises:
            UsageError: nothing has this name, or neither number nor name.
            IndexError: there are not so many.
        """
        names = self.keys()
        if not isinstance(key, str):
            try:
                return tuple.__getitem__(self, key)
            except TypeError:
                text = f"a {type(key).__name__} is neither number nor name; see keys()"
                raise UsageError(text) from None
        if key in names:
            return tuple.__getitem__(self, names.index(key))
        hint = nearest_hint(key, names) or f"there are {len(names)}, see keys()"
        raise UsageError(f"there is no {key[:LONGEST_NAME]!r} here; {hint}")


# How an object shows itself: as aligned text to Python's prompt, as HTML to a notebook.

MOST_COLUMNS = 8
"""Columns of a text; more stand in HTML alone."""

MOST_ROWS = 20
"""Lines of a text or a page; longer lists are shortened in their middle."""

WIDEST = 28
"""Characters of a cell of a text."""


class Listing(NamedTuple):
    """A head line, labels above rows of cells (both may be empty), and lines below."""

    head: str
    labels: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    notes: tuple[str, ...] = ()

    def text(self) -> str:
        """Aligned text, at most `MOST_COLUMNS` and `MOST_ROWS` of it; nothing else is left out
        without a word."""
        lines = [_line(self.head)]
        table = [self.labels, *shortened(self.rows)] if self.labels else []
        cut = [[_cell(cell) for cell in row[:MOST_COLUMNS]] for row in table]
        widths = [max(map(len, column)) for column in zip(*cut, strict=True)]
        for row in cut:
            cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
            lines.append(f"  {'  '.join(cells)}".rstrip())
        if len(self.labels) > MOST_COLUMNS:
            lines.append(f"  and {len(self.labels) - MOST_COLUMNS} more columns")
        return "\n".join([*lines, *(f"  {_line(note)}" for note in self.notes)])

    def html(self) -> str:
        """The same as a fragment of a page, with all columns; every text of a file is escaped."""
        parts = [f"<div><p><strong>{_marked(self.head)}</strong></p>"]
        if self.labels:
            parts.append(html_table(self.labels, shortened(self.rows)))
        notes = "".join(f"<li>{_marked(note)}</li>" for note in self.notes)
        return "".join([*parts, f"<ul>{notes}</ul>" if notes else "", "</div>"])


class Listed:
    """An object that shows itself as its `listing`."""

    __slots__ = ()

    @property
    def listing(self) -> Listing:
        """What is shown of it."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.listing.text()

    def _repr_html_(self) -> str:
        return self.listing.html()


def html_table(labels: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table of a page."""

    def line(tag: str, cells: Sequence[str]) -> str:
        return f"<tr>{''.join(f'<{tag}>{_marked(cell)}</{tag}>' for cell in cells)}</tr>"

    body = "".join(line("td", row) for row in rows)
    return f"<table><thead>{line('th', labels)}</thead><tbody>{body}</tbody></table>"


def shortened(rows: Sequence[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """The rows, or the first and the last with a row of dots between them."""
    if len(rows) <= MOST_ROWS:
        return list(rows)
    half = MOST_ROWS // 2
    return [*rows[:half], ("...",) * len(rows[0]), *rows[-half:]]


def _cell(text: str) -> str:
    line = _line(text)
    return line if len(line) <= WIDEST else f"{line[: WIDEST - 3]}..."


def _line(text: str) -> str:
    return legible(" ".join(text.split()), also="")


def _marked(text: str) -> str:
    from html import escape  # its tables of characters are of no use to a run

    return escape(_line(text))


# The types of arrays, so that each has one name; only type checkers read them.

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
