"""A response in blocks of rows, each of which may be forgotten when the next one is taken.

The kernel marches on in a thread of its own and hands on the rows of a block as it has reached them
(core/response), so it takes the very steps that it takes where all rows are held. How many rows a
motion with stops has, and the energies by which `row.energy_error` is measured, are known behind
its last row alone: where they are wanted before, the motion is gone through twice.
"""

from __future__ import annotations

import atexit
from collections.abc import Callable, Iterable, Iterator
from functools import cached_property
from queue import SimpleQueue
from threading import Semaphore, Thread
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import Span, read_for
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.impacts import stopped_at_start
from mechkin_cli.response.jumps import BendsPassed, at_jump, before_jump
from mechkin_cli.response.report import motion_of, under_way
from mechkin_cli.response.rows import Prepared, RunEnd, block_of, limits_of, run_end, why_held
from mechkin_cli.response.runs import (
    ended_at_jumps,
    integrated,
    integrated_rows,
    prepare,
    read,
)
from mechkin_cli.sweep import Part

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.mechanism import Problem, ResponseProblem, Wanted
    from mechkin_cli.response.report import MotionRows
    from mechkin_cli.response.result import Energies, ResponseResult
    from mechkin_cli.session import Packing, Session


_ENERGY_ERROR = "row.energy_error"


class _Whole(NamedTuple):
    """What is known of a motion behind its last row."""

    end: RunEnd
    energies: Energies | None


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
        """Whether the rows are not held: there are many, and the motion goes on in one way."""
        one = self._given
        is_long = one.response.rows > self.block_rows
        return is_long and one.begun is not None and not why_held(one)

    def parts(self) -> Iterator[Part]:
        """The rows in order, block by block; one block, where they are held."""
        if not self.in_blocks:
            (result,) = integrated([self._given], self._packing)
            read(result, self.names)
            self._take(result)
            yield Part(result, slice(0, result.rows))
            return
        rows, done, self._taken = self.run_rows, 0, None
        if _ENERGY_ERROR in self.names:
            _ = self._whole  # before another motion is under way
        for motion in self._marched(self._one):
            end = self._end_at(motion)
            count = min(motion.states.shape[1], rows - done)
            if count > 0:
                yield self._part(motion, end, Span(done, count, rows))
            done += count
        # rows that the motion did not come to
        nothing = replace(motion, states=np.zeros_like(motion.states))
        while done < rows:
            count = min(self.block_rows, rows - done)
            yield self._part(nothing, end, Span(done, count, rows))
            done += count

    @cached_property
    def _one(self) -> Prepared:
        """The response with an end at each jump of a slope; whether its motion comes to one is told
        by the motion without."""
        one = self._given
        passed = BendsPassed(one.free.problem)
        if not passed.bends or not self.in_blocks:
            return one
        end = self._go_through(one, passed.add)
        return ended_at_jumps(one, passed, end.report)

    def _end_at(self, motion: MotionRows) -> RunEnd:
        """How the motion ends, as some of its rows tell: that they are reached, and the last of
        them all."""
        if self._one.response.stops:
            return self._whole.end
        every = self._one.response.rows
        return run_end(self._one, motion.report, motion.count if motion.report.is_over else every)

    def _part(self, motion: MotionRows, end: RunEnd, place: Span) -> Part:
        result = block_of(self._one, motion, end, place)
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

        end = self._go_through(self._one, add)
        return _Whole(end, energies and energies.between(end.report, self._one.free.layout.length))

    def _go_through(self, one: Prepared, add: Callable[[ResponseResult], None]) -> RunEnd:
        """The end of a motion; `add` takes its rows block by block, before anything is read."""
        every, done = one.response.rows, 0
        for motion in self._marched(one):
            report = motion.report
            end = run_end(one, report, motion.count if report.is_over else every)
            count = min(motion.states.shape[1], end.rows - done)
            if count > 0:
                add(block_of(one, motion, end, Span(done, count, every)))
            done += count
        return end

    @property
    def energy_error(self) -> float:
        """The largest of the rows, when all have been taken; nan where nothing moves or works."""
        found = self._taken
        error = None if found is None else found.error(np.array([found.missing]))
        return float("nan") if error is None else float(error[0])

    def _marched(self, one: Prepared) -> Iterator[MotionRows]:
        """A motion in blocks of rows, as they are reached; the report of the last one is that of
        the motion, and the others are under way."""
        march = _March(one, self._packing, self.block_rows)
        try:
            for motion in march:
                if not motion.report.first and limits_of(one.response):
                    motion = self._from_limit(one, motion)
                ended = at_jump(one.chosen, one.response, motion)
                yield before_jump(one.response, ended)
                if motion.report.is_over:
                    return
        finally:
            march.leave()

    def _from_limit(self, one: Prepared, motion: MotionRows) -> MotionRows:
        """The first rows of a motion, which is over where it begins at a limit and goes beyond."""
        place = Span(0, 1, one.response.rows)
        end = run_end(one, motion.report, motion.report.rows)
        return stopped_at_start(block_of(one, motion, end, place), motion)


class _March:
    """A motion that is integrated in a thread, a block ahead of whoever takes its rows."""

    def __init__(self, one: Prepared, packing: Packing, rows: int) -> None:
        self._one, self._packing, self._rows = one, packing, rows
        self._found: SimpleQueue[MotionRows | BaseException] = SimpleQueue()
        self._free, self._is_left = Semaphore(1), False
        # an interrupt ends the process without it
        self._thread = Thread(target=self._run, name="response", daemon=True)
        atexit.register(self.leave)  # it must not come back to an interpreter that has ended
        self._thread.start()

    def __iter__(self) -> Iterator[MotionRows]:
        """The blocks of rows."""
        while True:
            found = self._found.get()
            if isinstance(found, BaseException):
                raise found
            is_last = found.report.is_over
            yield found
            if is_last:
                return
            del found
            self._free.release()

    def leave(self) -> None:
        """Ends the thread, whether or not all rows have been taken."""
        atexit.unregister(self.leave)
        self._is_left = True
        self._free.release()
        self._thread.join()

    def _run(self) -> None:
        try:
            (last,) = integrated_rows([self._one], self._packing, self._rows, self._take)
        except BaseException as error:  # raised where rows are taken
            self._found.put(error)
        else:
            self._found.put(last)

    def _take(self, first: int, rows: int, arrays: list[NDArray[Any]]) -> bool:
        own = [np.array(array[0, ..., :rows], order="C") for array in arrays]
        for array in arrays:
            # where no row is written there is none
            array.fill(np.nan if array.dtype == np.float64 else 0)
        self._found.put(motion_of(under_way(first, rows, len(own[0])), own))
        self._free.acquire()
        return not self._is_left
