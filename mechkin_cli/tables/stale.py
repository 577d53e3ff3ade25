"""Which files beside a mechanism were written by mechkin for a table that it has no more.

Nothing else may ever be removed, so a file must show where it comes from: a table has two files of
one name, CSV and Markdown, with the same labels and as many rows; the errata page and the list of
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
    others = sorted(name for name in committed if name not in fresh)
    return tuple(name for name in others if _is_own(name, others, committed))


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


def _is_own(name: str, others: Collection[str], committed: Mapping[str, bytes]) -> bool:
    if name == PAGE:
        return HEAD.encode() in committed[name]
    if name == NAME:
        return committed[name].startswith(HEADER.encode())
    stem = name.rpartition(".")[0]
    twins = f"{stem}.csv", f"{stem}.md"
    return all(twin in others for twin in twins) and _is_pair(*(committed[t] for t in twins))


def _is_pair(csv: bytes, markdown: bytes) -> bool:
    """Whether both are the same table: a title, labels with their units, and as many rows."""
    try:
        cells, page = read_table_text("a.csv", csv), read_table_text("a.md", markdown)
    except ValueError:
        return False
    labels = tuple(label.partition(" [")[0] for label in page.labels)
    return (
        markdown.startswith(b"# ")
        and bool(labels)
        and labels == tuple(label.partition(" [")[0] for label in cells.labels)
        and len(page.rows) == len(cells.rows)
    )
