"""A run block by block: what `analyze` and `respond` give of all rows at once, in the memory of
some of them.

Rows are solved in parts of a size of their own (`sweep.parts`, `response.blocks`), so that no
answer depends on how many are taken at a time; what is said of the whole run is known when its rows
have been taken.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import balances, plots
from mechkin_cli.analysis.analysis import Analysis, by_label, drawing_of
from mechkin_cli.arguments import a_text
from mechkin_cli.assembly import rows_of_start
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.record import NamedTuple
from mechkin_cli.response import ResponseResult
from mechkin_cli.row_notes import Notes
from mechkin_cli.show import Named
from mechkin_cli.sweep import RunVerdicts, Sweep, has_parts
from mechkin_cli.tables import Columns, RunParameter, column_of, joined_column, moving_input
from mechkin_cli.units import TIME
from mechkin_cli.verdict import SWEEP, Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.analysis import Solvable
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import AnyBalance
    from mechkin_cli.plots import Drawing, Picture
    from mechkin_cli.response import ResponseBlocks
    from mechkin_cli.sweep import Part, Result
    from mechkin_cli.tables import CoefficientsLayout, TableColumn, TableLayout


class Stream:
    """The rows of a run in blocks, each of which may be forgotten when the next one is taken.

    It may be gone through several times; each time the run is made anew.

    Attributes:
        model: of the file.
        layouts: of the tables that were asked for.
        rows: how many a block has, but for the last one.
        run: `sweep`, or the name of the response.
        wanted: what else the file wants of a sweep: dense systems and balances.
        branch: the mode of the rows, and how the first assembly was found.
        ended: where a response has ended, as far as its rows have been taken; None before.
    """

    def __init__(
        self,
        model: Solvable,
        layouts: tuple[TableLayout, ...],
        source: Sweep | ResponseBlocks,
        rows: int,
        run: str = SWEEP,
        wanted: Beside | None = None,
    ) -> None:
        self.model, self.layouts, self.rows, self.run = model, layouts, rows, run
        self.wanted = wanted or Beside()
        self._beside: _FoundBeside | None = None
        self.source = source
        self._verdicts = RunVerdicts()
        self._notes = Notes(0)
        self.branch = "", ""
        self.ended: Ended | None = None

    @property
    def run_rows(self) -> int:
        """How many rows the run has; of a response that may be stopped, it is made to tell."""
        return self.source.run_rows

    def __iter__(self) -> Iterator[Block]:
        """The blocks, in the order of the rows.

        Raises:
            InvalidFile: what the file says of the motion does not hold in some row.
        """
        first, count = 0, 0
        pieces: list[_Piece] = []
        for rows, own in self.parts():
            begin, end, _ = own.indices(rows.rows)
            while begin < end:
                taken = min(self.rows - count, end - begin)
                pieces.append(_Piece(rows, slice(begin, begin + taken)))
                begin, count = begin + taken, count + taken
                if count == self.rows:
                    yield Block(first, pieces)
                    first, count, pieces = first + count, 0, []
        if pieces:
            yield Block(first, pieces)

    def parts(self) -> Iterator[tuple[PartRows, slice]]:
        """The rows as they are solved, and which of each part are in none before it."""
        verdicts, notes = self._verdicts, self._notes = RunVerdicts(), Notes(self.run_rows)
        self.ended, self._beside = None, None
        beside = _FoundBeside(self.wanted, self.run_rows)
        for part in self.source.parts():
            verdicts.add(part.result, part.own)
            beside.add(part)
            rows = part.result.row_states
            notes.add(rows.diagnostics, rows.span.first, part.own)
            if not any(self.branch):
                self.branch = part.result.mode, part.result.how
            if self.run != SWEEP:
                self.ended = ended(part.result, self.ended)
            solved, own = PartRows(self, part.result), part.own
            del part, rows
            yield solved, own
            del solved
        self._beside = beside
        if not isinstance(self.source, Sweep):
            verdicts.measure("energy error", np.array([self.source.energy_error]))

    @property
    def in_blocks(self) -> bool:
        """Whether memory does not go with the rows: the run has several parts."""
        if isinstance(self.source, Sweep):
            return has_parts(self.source.session)
        return self.source.in_blocks

    @property
    def verdicts(self) -> RunVerdicts:
        """The verdicts on the rows that have been solved so far."""
        return self._verdicts

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What the run has to say of the rows that have been solved so far."""
        own = self.source.session.problem.diagnostics
        faults = () if self._beside is None else self._beside.faults
        return (*own, *self.source.start.diagnostics, *self._notes.found(), *faults)

    @property
    def coefficients(self) -> tuple[Columns, ...]:
        """The tables of the dense system of reactions that the file asks for, two for each, when
        all rows have been taken; none before.

        Raises:
            UsageError: a row has no solution.
        """
        return () if self._beside is None else self._beside.systems

    @property
    def balance_tables(self) -> tuple[Columns, ...]:
        """The balances that were asked for, as those of an analysis, when all rows have been
        taken; none before."""
        return () if self._beside is None else self._beside.tables

    @property
    def balances(self) -> dict[str, dict[str, NDArray[Any]]]:
        """The same by name and label: `stream.balances["shaking"]["amplitude"]`; words as texts."""
        return by_label(self.balance_tables)

    @property
    def impacts(self) -> Columns | None:
        """The impacts of a response, as those of an analysis, when all rows have been taken; None
        before, and without any."""
        return None if isinstance(self.source, Sweep) else self.source.impact_table

    @property
    def complete(self) -> bool:
        """Whether every row that was taken has a solution, and every balance its cells."""
        faulty = self._beside is not None and bool(self._beside.faults)
        return self._verdicts.complete and not faulty

    @cached_property
    def inputs(self) -> tuple[str, ...]:
        """Time, where there is one, and the inputs, by name."""
        if not isinstance(self.source, Sweep):
            return ("time", *self.source.driven)
        motion = self.source.session.problem.motion
        names = tuple(item.name for item in motion.inputs)
        return names if motion.time is None else ("time", *names)

    @cached_property
    def along(self) -> RunParameter | None:
        """What the run goes along: with its values in some of the rows, if in any."""
        units, known = self.source.session.problem.units, self.source.session.problem.quantities()
        if not isinstance(self.source, Sweep):
            unit = units.label(known["time"].dimension)
            return RunParameter("time", np.empty(0), unit)
        motion = rows_of_start(self.source.session)[0].problem.motion
        time = {} if motion.time is None else {"time": motion.time.written}
        return moving_input(
            {**time, **{item.name: item.written for item in motion.inputs}},
            lambda name: units.label(known[name].dimension),
        )

    def picture(
        self, y: Sequence[str] = (), x: str | None = None, table: str | None = None
    ) -> Picture:
        """Curves of the run as plain data, as `Analysis.picture`, of no more rows than a picture
        shows: neighbouring ones stand for each other, but for the largest and the least."""
        along = self.along

        def drawings() -> Iterator[tuple[Drawing, slice]]:
            for part, own in self.parts():
                name, unit = ("row", "") if along is None else (along.name, along.unit)
                places = plots.PlotCurve(name, unit, self.places(part))
                yield drawing_of(part.analysis, y, x, table, places), own

        return plots.thinned_picture(drawings(), self.run_rows)

    def places(self, part: PartRows) -> NDArray[np.float64]:
        """Where the rows of a part stand along the run; their numbers from 1, if nothing moves."""
        result = part.analysis.result
        if self.along is not None:
            return result.inputs[self.along.name]
        return np.arange(1.0, result.rows + 1) + result.row_states.span.first

    def __len__(self) -> int:
        """Number of blocks."""
        return -(-self.run_rows // self.rows)

    def __repr__(self) -> str:
        return f"{self.model.name}: {self.run_rows} rows in {len(self)} blocks"


class Beside(NamedTuple):
    """What a file wants of a sweep beside the tables of its rows."""

    systems: tuple[CoefficientsLayout, ...] = ()
    balances: tuple[AnyBalance, ...] = ()


class _FoundBeside:
    """The same while the rows pass by."""

    def __init__(self, wanted: Beside, run_rows: int) -> None:
        self._wanted = wanted
        self._systems: dict[str, tuple[Columns, ...] | UsageError] = {}
        self._balances = [balances.running_balance(one, run_rows) for one in wanted.balances]

    def add(self, part: Part) -> None:
        """Takes the rows of a part that are in none before it."""
        result, (begin, end, _) = part.result, part.own.indices(part.result.rows)
        for one in self._balances:
            one.add(result, part.own)
        first = result.row_states.span.first
        for layout in self._wanted.systems:
            if begin <= layout.row - 1 - first < end:
                try:
                    found = balances.coefficient_tables(layout, result)
                    self._systems[layout.name] = found
                except UsageError as error:  # raised where it is read, as of rows that are held
                    self._systems[layout.name] = error

    @cached_property
    def _balanced(self) -> list[tuple[Columns, list[Diagnostic]]]:
        return [one.table() for one in self._balances]

    @property
    def tables(self) -> tuple[Columns, ...]:
        """The balances."""
        return tuple(table for table, _ in self._balanced)

    @property
    def faults(self) -> tuple[Diagnostic, ...]:
        """What is wrong with them, each once."""
        return tuple(dict.fromkeys(fault for _, own in self._balanced for fault in own))

    @property
    def systems(self) -> tuple[Columns, ...]:
        """The tables of dense systems.

        Raises:
            UsageError: a row has no solution.
        """
        tables: list[Columns] = []
        for layout in self._wanted.systems:
            found = self._systems[layout.name]
            if isinstance(found, UsageError):
                raise found
            tables += found
        return tuple(tables)


class Ended(NamedTuple):
    """Where a response has ended: its last row with a position by its number from 0, the moment and
    the event of it; the moment at which the motion was over; and the status of the row behind it,
    None where none is known."""

    row: int
    time: float
    event: str
    over: float
    behind: Status | None


def ended(result: Result, before: Ended | None = None) -> Ended | None:
    """Where some rows of a response have ended, behind those before them."""
    solved = np.flatnonzero(result.solved)
    if not solved.size:
        if before is None or before.behind is not None or not result.rows:
            return before
        return before._replace(behind=Status(int(result.status[0])))
    last = int(solved[-1])
    behind = Status(int(result.status[last + 1])) if last + 1 < result.rows else None
    row = last + result.row_states.span.first
    time = float(result.inputs["time"][last])
    report = result.report if isinstance(result, ResponseResult) else None
    over = time if report is None else float(result.units.from_si(report.time, TIME))
    return Ended(row, time, result.events[last], over, behind)


class PartRows:
    """The rows of a part, whose columns are evaluated once for all blocks."""

    def __init__(self, stream: Stream, result: Result) -> None:
        self.analysis = Analysis(stream.model, stream.layouts, result, stream.run)
        self.rows = result.rows
        self._columns: dict[tuple[int, int], TableColumn] = {}
        self._values: dict[str, NDArray[Any]] = {}

    def column(self, table: int, number: int) -> TableColumn:
        """A column of a table by both numbers."""
        if (table, number) not in self._columns:
            layout = self.analysis.layouts[table].columns[number]
            self._columns[table, number] = column_of(layout, self.analysis.result)
        return self._columns[table, number]

    def values(self, text: str) -> NDArray[Any]:
        """As `Analysis.__getitem__`."""
        if text not in self._values:
            self._values[text] = self.analysis[text]
        return self._values[text]


class _Piece:
    """Some neighbouring rows of a part."""

    def __init__(self, part: PartRows, rows: slice) -> None:
        self.part, self.rows = part, rows


class Block:
    """Some neighbouring rows of a run: `block["O4.theta"]` is an array over them, in the file's
    units, as that of an analysis; `first` is the number of the first row, from 0."""

    def __init__(self, first: int, pieces: Sequence[_Piece]) -> None:
        self.first = first
        self._pieces = tuple(pieces)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return sum(piece.rows.stop - piece.rows.start for piece in self._pieces)

    def __getitem__(self, text: str) -> NDArray[Any]:
        """A quantity or an expression of quantities in the file's units, (rows,), of a vector
        (rows, 3); arguments and errors are those of `Analysis`. Arrays are parts of larger ones,
        which are not to be written to."""
        a_text("a quantity or expression", text, '"O4.theta"')
        found = [piece.part.values(text)[piece.rows] for piece in self._pieces]
        values = found[0] if len(found) == 1 else np.concatenate(found)
        values.flags.writeable = False
        return values

    def unit(self, text: str) -> str:
        """The unit of a quantity or an expression, as `Analysis.unit`."""
        return self._pieces[0].part.analysis.unit(text)

    @property
    def tables(self) -> Named[Columns]:
        """These rows of the tables that were asked for, in order, and by name."""
        layouts = self._pieces[0].part.analysis.layouts
        return Named(
            Columns(
                layout.name,
                layout.title,
                tuple(self._column(table, number) for number in range(len(layout.columns))),
            )
            for table, layout in enumerate(layouts)
        )

    def _column(self, table: int, number: int) -> TableColumn:
        pieces = [piece.part.column(table, number).between(piece.rows) for piece in self._pieces]
        return joined_column(pieces)

    def __repr__(self) -> str:
        return f"rows {self.first + 1} to {self.first + self.rows}"
