"""A response in blocks of rows, each of which may be forgotten when the next one is taken.

How many rows a motion with stops has, the limits at which something rests, and the energies by
which `row.energy_error` is measured, are known behind its last row alone: where they are wanted
before, the motion is gone through twice.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import Span, read_for
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.impulses import impact_table
from mechkin_cli.response.jumps import BendsPassed
from mechkin_cli.response.rows import block_of, rows_problem, run_end
from mechkin_cli.response.runs import ended_at_jumps, integrated, prepare, read
from mechkin_cli.response.stretches import Block, Stretches, result_of
from mechkin_cli.sweep import Part

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.mechanism import Problem, ResponseProblem, Wanted
    from mechkin_cli.response.integration import Rebound
    from mechkin_cli.response.report import MotionRows
    from mechkin_cli.response.result import Energies, ResponseResult
    from mechkin_cli.response.rows import Prepared, RunEnd
    from mechkin_cli.session import Packing, Session
    from mechkin_cli.tables import Columns


_ENERGY_ERROR = "row.energy_error"


class _Whole(NamedTuple):
    """What is known of a motion behind its last row."""

    end: RunEnd
    energies: Energies | None
    stretches: Stretches


class ResponseBlocks:
    """A response that is to be run block by block; arguments and errors are those of `respond`."""

    def __init__(
        self,
        problem: Problem,
        response: ResponseProblem,
        quantities: Iterable[str],
        packing: Packing,
        session: Session | None = None,
    ) -> None:
        self._given: Prepared = prepare(problem, response, packing, session)
        self._packing = packing
        self.names = tuple(dict.fromkeys(quantities))
        self._taken: Energies | None = None  # of the rows that have been taken so far
        self._rebounds: Sequence[Rebound] = ()

    @property
    def session(self) -> Session:
        """Of the free motion; its motion is the first moment."""
        return self._given.free

    @property
    def start(self) -> AssemblyStart:
        """The first assembly."""
        return self._given.start

    @property
    def run_rows(self) -> int:
        """The rows of the table: those of the file, or up to a stop."""
        one = self._one
        return self._whole.end.rows if self.in_blocks and one.response.stops else one.response.rows

    @property
    def driven(self) -> tuple[str, ...]:
        """The coordinates that go by laws of time."""
        return tuple(item.name for item in self._given.response.driven)

    @property
    def asked(self) -> list[Wanted]:
        """The quantities asked for."""
        known = self._given.free.problem.quantities()
        return [known[name] for name in read_for(self.names, known)]

    @cached_property
    def block_rows(self) -> int:
        """Rows of a block: as many as take about the memory of a part of a sweep."""
        plan = self._given.free.plan
        numbers = plan.states + plan.charts * (plan.columns + 2)
        rows = tolerances.PART_ROWS
        while rows > tolerances.LEAST_PART_ROWS and rows * numbers > tolerances.PART_NUMBERS:
            rows //= 2
        return rows

    @property
    def in_blocks(self) -> bool:
        """Whether the rows are not held: there are many."""
        one = self._given
        is_long = one.response.rows > self.block_rows
        return is_long and one.begun is not None

    def parts(self) -> Iterator[Part]:
        """The rows in order, block by block; one block, where they are held."""
        if not self.in_blocks:
            (result,) = integrated([self._given], self._packing)
            read(result, self.names)
            self._take(result)
            self._rebounds = result.rebounds
            yield Part(result, slice(0, result.rows))
            return
        rows, done, self._taken = self.run_rows, 0, None
        if _ENERGY_ERROR in self.names:
            _ = self._whole  # before another motion is under way
        for block in self._stretches(self._one).blocks():
            motion = block.motion
            end = self._end_at(motion)
            count = min(motion.states.shape[1], rows - done)
            if count > 0:
                yield self._part(block, end, Span(done, count, rows))
            done += count
        # rows that the motion did not come to
        nothing = Block(replace(motion, states=np.zeros_like(motion.states)))
        while done < rows:
            count = min(self.block_rows, rows - done)
            yield self._part(nothing, end, Span(done, count, rows))
            done += count

    @property
    def impact_table(self) -> Columns | None:
        """The impacts with what joints transmit, when all rows have been taken; None before, and
        without any."""
        if not self._rebounds:
            return None
        one = self._given
        row = rows_problem(one.free, one.response, one.driven, Span(0, 1, one.response.rows), None)
        return impact_table(one.free.moved(row), one.response.name, self._rebounds)

    @cached_property
    def _one(self) -> Prepared:
        """The response with an end at each jump of a slope; whether its motion comes to one is told
        by the motion without."""
        one = self._given
        passed = BendsPassed(one.free.problem)
        if not passed.bends or not self.in_blocks:
            return one
        end, _ = self._go_through(one, passed.add)
        return ended_at_jumps(one, passed, end.report)

    def _end_at(self, motion: MotionRows) -> RunEnd:
        """How the motion ends, as some of its rows tell: that they are reached, and the last of
        them all."""
        if self._one.response.stops:
            return self._whole.end
        every = self._one.response.rows
        return run_end(self._one, motion.report, motion.count if motion.report.is_over else every)

    def _part(self, block: Block, end: RunEnd, place: Span) -> Part:
        is_known = bool(self._one.response.stops)
        resting = self._whole.stretches.resting if is_known else {}
        result = result_of(self._one, block, end, place, resting)
        if is_known and not place.first:
            whole = self._whole.stretches
            self._rebounds = result.rebounds = tuple(whole.rebounds)
            result.row_states.diagnostics += whole.notes(result.units)
        read(result, self.names)
        self._take(result)
        result.run_energies = lambda: self._whole.energies
        stops = [self._one.response.stops[end.report.stop].words] if end.is_stopped else []
        result.run_events = (*[""] * (end.rows > len(stops)), *stops)
        return Part(result, slice(0, place.rows))

    def _take(self, result: ResponseResult) -> None:
        found = result.energies_with(self._taken)
        if found is not None and result.report is not None:
            found = found.between(result.report, self._one.free.layout.length)
        self._taken = found

    @cached_property
    def _whole(self) -> _Whole:
        """How the motion ends, and its energies."""
        energies: Energies | None = None

        def add(result: ResponseResult) -> None:
            nonlocal energies
            read(result, ())
            energies = result.energies_with(energies)

        end, stretches = self._go_through(self._one, add)
        found = energies and energies.between(end.report, self._one.free.layout.length)
        return _Whole(end, found, stretches)

    def _stretches(self, one: Prepared) -> Stretches:
        return Stretches(one, self._packing, self.block_rows)

    def _go_through(
        self, one: Prepared, add: Callable[[ResponseResult], None]
    ) -> tuple[RunEnd, Stretches]:
        """The end of a motion, and what its stretches tell; `add` takes its rows block by block,
        before anything is read."""
        every, done, stretches = one.response.rows, 0, self._stretches(one)
        for motion, _ in stretches.blocks():
            report = motion.report
            end = run_end(one, report, motion.count if report.is_over else every)
            count = min(motion.states.shape[1], end.rows - done)
            if count > 0:
                add(block_of(one, motion, end, Span(done, count, every)))
            done += count
        return end, stretches

    @property
    def energy_error(self) -> float:
        """The largest of the rows, when all have been taken; nan where nothing moves or works."""
        found = self._taken
        error = None if found is None else found.error(np.array([found.missing]))
        return float("nan") if error is None else float(error[0])
