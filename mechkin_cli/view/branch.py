"""One branch of a run for the page: marks, axis, poses, verdicts, curves, arrows and tables.

Marked on the axis of a run are dead centres, branch points, and what ended or stopped a response.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism import is_angle
from mechkin_cli.record import replace
from mechkin_cli.session import input_text
from mechkin_cli.tables import Columns, RunParameter, Words, rows_table
from mechkin_cli.units import ANGLE
from mechkin_cli.verdict import Status
from mechkin_cli.view.arrows import arrow_records
from mechkin_cli.view.joints import continuous, link_poses
from mechkin_cli.view.page import packed, thinned, turning_points

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.diagnostics import Diagnostic, Number
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Readable
    from mechkin_cli.view.page import Lengths, Plain, Share


KINDS = {
    "dead-centre": "dead-centre",
    "branch-point": "branch-point",
    "branch-point-passed": "branch-point",
    "branch-point-touched": "branch-point",
}
"""Kind of mark by the code of the message with the place."""


def run_marks(analysis: Readable, label: str, x: Floats, *, whole: bool = True) -> list[Plain]:
    """The marks of a branch, in the order of its messages, over its axis `label` with values `x`
    (rows,); not the `whole` of a run has those places alone that lie among its rows."""
    found: list[Plain] = []
    for diagnostic in analysis.diagnostics:
        kind = KINDS.get(diagnostic.code)
        if kind is not None:
            for text, place in _places(analysis, diagnostic, label, x, whole=whole):
                found.append({"x": place, "kind": kind, "text": text})
    for row in np.flatnonzero(analysis.result.status == Status.dead_centre).tolist():
        found.append({"x": float(x[row]), "kind": "dead-centre", "text": "row at a dead centre"})
    for row, event in enumerate(analysis.result.events):
        if event:
            found.append({"x": float(x[row]), "kind": "event", "text": event})
    return [mark for at, mark in enumerate(found) if mark not in found[:at]]


def _places(
    analysis: Readable, diagnostic: Diagnostic, label: str, x: Floats, *, whole: bool
) -> Iterator[tuple[str, float]]:
    """What a message measured, place by place, with where on the axis that is."""
    for numbers in _by_place(diagnostic.numbers):
        places = {number.name: number.value for number in numbers}
        words = f"{diagnostic.code.replace('-', ' ')}: {', '.join(map(input_text, numbers))}"
        if label in places:
            yield words, places[label]
        else:
            for place in _crossed(analysis, places, x, whole=whole):
                yield words, place


def _by_place(numbers: tuple[Number, ...]) -> Iterator[tuple[Number, ...]]:
    """Numbers in a row, where those of one place have different names."""
    first = 0
    for at, number in enumerate(numbers):
        if any(number.name == other.name for other in numbers[first:at]):
            yield numbers[first:at]
            first = at
    if numbers:
        yield numbers[first:]


def _crossed(
    analysis: Readable, places: dict[str, float], x: Floats, *, whole: bool
) -> Iterator[float]:
    """Where the first of some coordinates passes its place between two rows, read straight between
    them; at the last row with a solution where it never does in the `whole` run."""
    name, value = next(iter(places.items()))
    solved = np.flatnonzero(analysis.result.solved)
    if not solved.size:
        return
    off = np.asarray(analysis[name], dtype=np.float64)[solved] - value
    near = np.ones(max(off.size - 1, 0), dtype=bool)
    if is_angle(name.rpartition(".")[2]):
        turn = float(analysis.result.units.from_si(2.0 * np.pi, ANGLE))
        off -= turn * np.round(off / turn)
        near = np.abs(np.diff(off)) < 0.5 * turn
    at = np.flatnonzero((off[:-1] * off[1:] <= 0.0) & near)
    for k in at:
        share = 0.0 if off[k] == off[k + 1] else off[k] / (off[k] - off[k + 1])
        yield float(x[solved[k]] + share * (x[solved[k + 1]] - x[solved[k]]))
    if whole and not at.size:
        yield float(x[solved[-1]])


VERDICTS = ("residual", "condition", "power_error")
"""Columns of the rows' own table that are shown as curves."""


class BranchScene:
    """A branch of a run, and what the page has of it.

    Attributes:
        name: of its assembly mode.
        analysis: the run in that mode.
        links: names of all links, ground first.
        share: the most rows and poses that are shown.
        forces: whether arrows of forces may be read.
    """

    def __init__(
        self, name: str, analysis: Readable, links: Sequence[str], share: Share, *, forces: bool
    ) -> None:
        self.name = name
        self.analysis = analysis
        self.links = links
        self.share = share
        self.forces = forces

    @cached_property
    def axis(self) -> RunParameter:
        """Time where the rows have it, else the first input that moves, else the row's number."""
        result = self.analysis.result
        leading = result.problem.motion.leading
        name = "time" if "time" in result.inputs else leading.name if leading else ""
        if name not in result.inputs:
            return RunParameter("row", np.arange(1.0, self.analysis.rows + 1.0), "")
        unit = result.units.label(result.quantity(name).dimension)
        return RunParameter(name, np.asarray(result.inputs[name], dtype=np.float64), unit)

    @cached_property
    def _notable(self) -> NDArray[np.intp]:
        """Rows beside which the verdict changes, and rows with an event."""
        result = self.analysis.result
        events = [row for row, event in enumerate(result.events) if event]
        return np.union1d(turning_points(result.status), np.array(events, dtype=np.intp))

    @cached_property
    def rows(self) -> NDArray[np.intp]:
        """The rows that curves and tables show, counted from 0."""
        return thinned(np.arange(self.analysis.rows), self.share[0], self._notable)

    @cached_property
    def posed(self) -> NDArray[np.intp]:
        """Which of the shown rows have a pose, by their place among these."""
        solved = np.flatnonzero(self.analysis.result.solved[self.rows])
        notable = np.flatnonzero(np.isin(self.rows, self._notable))
        return thinned(solved, self.share[1], notable)

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
        posed = self.rows[self.posed]
        columns = list(self.curves)  # before arrows read forces
        arrows = arrow_records(self.analysis, posed, self.links, lengths) if self.forces else []
        # 0: ok, 1: a position with a reservation, 2: no position
        doubts = [0 if one is Status.ok else 1 if one.has_solution else 2 for one in Status]
        words = [one.label for one in Status]
        return {
            "name": self.name,
            "own": own,
            "rows": int(self.rows.size),
            "x": packed("f64", self.axis.values[self.rows]),
            "poses": {"rows": packed("i32", self.posed), "values": packed("f32", poses)},
            "status": {"words": words, "doubts": doubts, "codes": packed("u8", codes)},
            "marks": run_marks(self.analysis, self.axis.name, self.axis.values),
            "columns": columns,
            "arrows": arrows,
        }

    @cached_property
    def verdicts(self) -> Columns:
        """The table of its rows and their verdicts, as they are now: arrows may read forces, and
        then there is a power error that the command does not write."""
        table = rows_table(self.analysis.result, self.analysis.run)
        rows = np.arange(self.analysis.rows)
        return replace(table, columns=tuple(column.part(rows) for column in table.columns))

    @cached_property
    def curves(self) -> tuple[Plain, ...]:
        """The columns that curves are drawn of, as the page reads them."""
        return tuple(self._columns())

    def _columns(self) -> Iterator[Plain]:
        columns = [(table.name, c) for table in self.analysis.tables for c in table.columns]
        columns += [(self.verdicts.name, c) for c in self.verdicts.columns if c.label in VERDICTS]
        for table, column in columns:
            if not (isinstance(column.values, Words) or np.isnan(column.values).all()):
                yield {
                    "label": column.label,
                    "unit": column.unit,
                    "table": table,
                    "rounding": float(column.rounding),
                    "values": packed("f64", column.values[self.rows]),
                }


def table_record(table: Columns, run: str, own: BranchScene) -> Plain:
    """A table for the page: of one that has the rows of its run those that the `own` branch shows,
    with their verdicts, of others all. Numbers that the branch's columns have are not repeated."""
    codes = [int(code) for code in own.analysis.result.status[own.rows]]
    curves = {(curve["table"], curve["label"]) for curve in own.curves}
    if table.of_rows:
        table = replace(table, columns=tuple(column.part(own.rows) for column in table.columns))
    return {
        "name": table.name,
        "title": table.title,
        "run": run,
        "columns": [
            {
                "label": one.label,
                "unit": one.unit,
                "exact": None
                if isinstance(one.values, Words) or (table.name, one.label) in curves
                else packed("f64", one.numbers),
            }
            for one in table.columns
        ],
        "rows": [list(row) for row in table.listing.rows],
        "status": codes if table.of_rows else [],
    }
