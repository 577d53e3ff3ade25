"""How many rows and poses of a branch a page shows: the own branch most, other modes a part."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli.view.limits import (
    LEAST_ROWS,
    MOST_CELLS,
    MOST_MODE_POSES,
    MOST_POSES,
    MOST_ROWS,
)

if TYPE_CHECKING:
    from mechkin_cli.view.readable import ShownRun


class Share(NamedTuple):
    """The most rows, and the most poses."""

    rows: int
    poses: int


def shares(run: ShownRun) -> list[Share]:
    """What each branch of a run is given, in their order."""
    own, *others = run.branches
    columns = sum(len(table.columns) for table in own.analysis.tables)
    found = [Share(_rows(columns), MOST_POSES)]
    if others:
        poses = min(MOST_POSES, MOST_MODE_POSES // len(others))
        found += [Share(_rows(columns * len(others)), poses)] * len(others)
    return found


def _rows(columns: int) -> int:
    """The rows that so many columns share, of one branch or several."""
    return max(LEAST_ROWS, min(MOST_ROWS, MOST_CELLS // max(columns, 1)))
