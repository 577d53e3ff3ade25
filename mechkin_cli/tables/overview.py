"""The overview page of a folder of mechanisms: one line per file, in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from mechkin_cli.legible import whole
from mechkin_cli.tables.neutral import link_target, markdown_text

PAGE = "README.md"
MARK = "<!-- written by `mechkin tables` -->"
"""First line of the page; a page without it is somebody else's."""


class OverviewRow(NamedTuple):
    """What the page says of one file; `stem` names the file, `picture` that of its drawing in the
    folder of its tables, other cells are words."""

    stem: str
    name: str
    joints: str
    mobility: str
    modes: str
    rows: str
    verdict: str
    source: str
    picture: str


def overview_page(rows: Sequence[OverviewRow]) -> str:
    """The whole page, with a newline at its end."""
    labels = (
        "picture",
        "mechanism",
        "joints",
        "mobility",
        "modes",
        "rows",
        "against print",
        "source",
    )
    lines = [_line(labels), _line(["---"] * len(labels)), *(_line(_cells(row)) for row in rows)]
    return "\n".join([MARK, "", "# Mechanisms", "", _HEAD, "", *lines]) + "\n"


_HEAD = """\
Each file has its tables in the folder of its name, and a page `errata.md` where they are compared
with print. The picture shows its first position, seen from a corner: links in colours, joints by
symbols of their types, the ways of its points. Joints stand in the order of the file. Mobility is
the true one; Kutzbach's count and idle freedoms stand beside it where they make a difference. Modes
are the ways of assembling it that were found at the first row. Rows are those solved, of all where
they differ."""


def _cells(row: OverviewRow) -> list[str]:
    stem = link_target(row.stem)
    link = f"[{_text(row.name)}]({stem}.yaml)"
    verdict = f"[{row.verdict}]({stem}/errata.md)" if row.verdict else ""
    return [
        f"![{_text(row.name)}]({stem}/{link_target(row.picture)})",
        link,
        *map(_text, (row.joints, row.mobility, row.modes, row.rows)),
        verdict,
        _text(row.source),
    ]


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _text(text: str) -> str:
    return markdown_text(whole(text))
