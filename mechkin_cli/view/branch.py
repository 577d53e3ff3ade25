"""One branch of a run for the page: its axis, poses, verdicts, marks, curves and arrows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.status import Status
from mechkin_cli.tables.columns import Words
from mechkin_cli.tables.rows_table import rows_table
from mechkin_cli.view.arrows import arrow_records
from mechkin_cli.view.encoding import packed
from mechkin_cli.view.marks import run_marks
from mechkin_cli.view.poses import continuous, link_poses
from mechkin_cli.view.thinning import thinned, turning_points

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.tables.columns import Columns
    from mechkin_cli.view.encoding import Plain
    from mechkin_cli.view.lengths import Lengths
    from mechkin_cli.view.readable import Readable, ShownBranch
    from mechkin_cli.view.shares import Share

VERDICTS = ("residual", "condition", "power_error")
"""Columns of the rows' own table that are shown as curves."""


@dataclass(frozen=True)
class Axis:
    """What the rows of a run are plotted over: a quantity's name, its unit and values (rows,)."""

    label: str
    unit: str
    values: Floats


def axis_of(analysis: Readable) -> Axis:
    """Time where the rows have it, else the first input that moves, else the number of the row."""
    result = analysis.result
    leading = result.problem.motion.leading
    name = "time" if "time" in result.inputs else leading.name if leading else ""
    if name not in result.inputs:
        return Axis("row", "", np.arange(1.0, analysis.rows + 1.0))
    unit = result.units.label(result.quantity(name).dimension)
    return Axis(name, unit, np.asarray(result.inputs[name], dtype=np.float64))


class BranchScene:
    """A branch of a run, and what the page has of it.

    Attributes:
        shown: the branch.
        links: names of all links, ground first.
        share: the most rows and poses that are shown.
    """

    def __init__(self, shown: ShownBranch, links: Sequence[str], share: Share) -> None:
        self.shown = shown
        self.links = links
        self.share = share

    @property
    def analysis(self) -> Readable:
        """The analysis of the branch."""
        return self.shown.analysis

    @cached_property
    def axis(self) -> Axis:
        """What its rows are plotted over."""
        return axis_of(self.analysis)

    @cached_property
    def _notable(self) -> NDArray[np.intp]:
        """Rows beside which the verdict changes, and rows with an event."""
        result = self.analysis.result
        events = [row for row, event in enumerate(result.events) if event]
        return np.union1d(turning_points(result.status), np.array(events, dtype=np.intp))

    @cached_property
    def rows(self) -> NDArray[np.intp]:
        """The rows that curves and tables show, counted from 0."""
        return thinned(np.arange(self.analysis.rows), self.share.rows, self._notable)

    @cached_property
    def posed(self) -> NDArray[np.intp]:
        """Which of the shown rows have a pose, by their place among these."""
        solved = np.flatnonzero(self.analysis.result.solved[self.rows])
        notable = np.flatnonzero(np.isin(self.rows, self._notable))
        return thinned(solved, self.share.poses, notable)

    @cached_property
    def poses(self) -> Floats:
        """Poses of all links (poses, links, 7), shifts in m."""
        every = link_poses(self.analysis.result, self.links)
        return continuous(every[self.rows[self.posed]])

    def record(self, own: bool, lengths: Lengths) -> Plain:
        """The branch as the page reads it."""
        poses = self.poses.copy()
        poses[:, :, :3] = lengths.array(poses[:, :, :3])
        codes = self.analysis.result.status[self.rows]
        forces = self.shown.forces
        posed = self.rows[self.posed]
        return {
            "name": self.shown.name,
            "own": own,
            "rows": int(self.rows.size),
            "x": packed("f64", self.axis.values[self.rows]),
            "poses": {"rows": packed("i32", self.posed), "values": packed("f32", poses)},
            "status": {"words": [one.label for one in Status], "codes": packed("u8", codes)},
            "marks": run_marks(self.analysis, self.axis.label, self.axis.values),
            "columns": list(self._columns()),
            "arrows": arrow_records(self.analysis, posed, self.links, lengths) if forces else [],
        }

    @cached_property
    def verdicts(self) -> Columns:
        """The table of its rows and their verdicts."""
        return rows_table(self.analysis.result, self.analysis.run)

    def _columns(self) -> Iterator[Plain]:
        for table in self.analysis.tables:
            yield from self._curves(table, None)
        yield from self._curves(self.verdicts, VERDICTS)

    def _curves(self, table: Columns, labels: Sequence[str] | None) -> Iterator[Plain]:
        for column in table.columns:
            wanted = labels is None or column.label in labels
            if not wanted or isinstance(column.values, Words) or np.isnan(column.values).all():
                continue
            values = packed("f64", column.values[self.rows])
            yield {
                "label": column.label,
                "unit": column.unit,
                "table": table.name,
                "values": values,
            }
