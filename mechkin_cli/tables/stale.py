"""Which files beside a mechanism were written by mechkin for a table that it has no more.

Nothing else may ever be removed, so a file must show where it comes from: a table has two files of
one name, CSV and Markdown, with the same labels and as many rows, and perhaps its summary beside
them; the errata page and the list of
disagreements have the words and the header that they always have.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from contextlib import suppress
from pathlib import Path

from mechkin_cli.regular_file import MOST_TABLE_BYTES, read_regular
from mechkin_cli.tables.disagreements import HEADER, NAME
from mechkin_cli.tables.errata import HEAD, PAGE
from mechkin_cli.tables.table_text import read_table_text


def stale_files(fresh: Collection[str], committed: Mapping[str, bytes]) -> tuple[str, ...]:
    """Names in `committed` that mechkin wrote and that are not among the `fresh` ones."""
    others = {name: committed[name] for name in sorted(committed) if name not in fresh}
    own = {name for name, content in others.items() if _is_page(name, content)}
    for name in others:
        twin = f"{name.removesuffix('.csv')}.md"
        if name.endswith(".csv") and twin in others and _is_pair(others[name], others[twin]):
            own |= {name, twin}
    for name, content in others.items():
        table = f"{name.removesuffix('.summary.csv')}.csv"
        if name.endswith(".summary.csv") and (table in own or table in fresh):
            own |= {name} if content.startswith(b"summary,") else set()
    return tuple(name for name in others if name in own)


def stale_in(folder: Path, fresh: Collection[str]) -> tuple[str, ...]:
    """The same for the files that stand in a folder; links and what cannot be read are not
    mechkin's."""
    found = {}
    for path in folder.iterdir() if folder.is_dir() else ():
        if path.name in fresh or path.suffix not in (".csv", ".md") or path.is_symlink():
            continue
        with suppress(OSError):
            found[path.name] = read_regular(path, MOST_TABLE_BYTES)
    return stale_files(fresh, found)


def _is_page(name: str, content: bytes) -> bool:
    """Whether it is the errata page, or the list of disagreements."""
    if name == NAME:
        return content.startswith(HEADER.encode())
    return name == PAGE and HEAD.encode() in content


def _is_pair(csv: bytes, markdown: bytes) -> bool:
    """Whether both are the same table: a title, labels with their units, and as many rows."""
    try:
        table = markdown.partition(b"\n\n| summary ")[0]
        cells, page = read_table_text("a.csv", csv), read_table_text("a.md", table)
    except ValueError:
        return False
    labels = tuple(label.partition(" [")[0] for label in page.labels)
    return (
        markdown.startswith(b"# ")
        and bool(labels)
        and labels == tuple(label.partition(" [")[0] for label in cells.labels)
        and len(page.rows) == len(cells.rows)
    )
