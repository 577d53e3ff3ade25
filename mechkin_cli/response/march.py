"""One motion over many rows, in blocks of which each may be forgotten when the next one is taken.

The kernel marches on in a thread of its own and hands on the rows of a block as it has reached them
(core/response), so it takes the very steps that it takes where all rows are held.
"""

from __future__ import annotations

import atexit
from collections.abc import Callable, Iterator, Sequence
from queue import SimpleQueue
from threading import Semaphore, Thread
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.report import MotionRows, motion_of, under_way
from mechkin_cli.session import Chart

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Moments, SpacedMoments
    from mechkin_cli.response.report import MotionReport
    from mechkin_cli.show import Floats

Taker = Callable[[int, int, list["NDArray[Any]"]], bool]
"""Takes a block of rows, the number of its first one and how many they are, out of the kernel's
arrays, which the next ones are then written into; False: no more are wanted."""

Run = Callable[[int, Taker | None], MotionRows]
"""Integrates a motion; a taker takes all rows but the last ones in blocks of so many."""


class RowTimes(NamedTuple):
    """The moments (s) of a motion's rows: so many `rows` of a response from the number `first` on,
    each after so many equal `parts` of the way from the one before; then one more, the `last`, if
    there is one."""

    moments: Moments | SpacedMoments
    first: int
    rows: int
    parts: int = 1
    last: float | None = None

    @property
    def size(self) -> int:
        """How many there are."""
        return self.rows * self.parts + (self.last is not None)

    def row(self, number: int) -> float:
        """The moment of a row of the response, by its number from `first` on."""
        at = self.first + number
        return float(self.moments.part(slice(at, at + 1)).values[0])

    def between(self, first: int, end: int, begin: float) -> Floats:
        """Those of some numbers, of a motion from `begin` (s) on, by the operations of the
        kernel."""
        numbers = np.arange(first, min(end, self.rows * self.parts))
        more = [] if self.last is None or end < self.size else [self.last]
        if not numbers.size:
            return np.array(more)
        whole, inner = numbers // self.parts, numbers % self.parts + 1
        low = max(int(whole[0]) - 1, 0)
        known = slice(self.first + low, self.first + int(whole[-1]) + 1)
        given = self.moments.part(known).values
        to = given[whole - low]
        start = np.where(whole > 0, given[np.maximum(whole - 1 - low, 0)], begin)
        between = np.where(inner == self.parts, to, start + (to - start) * (inner / self.parts))
        return np.concatenate([between, more])


def changed(moved: MotionRows, change: Callable[[NDArray[Any]], NDArray[Any]]) -> MotionRows:
    """A motion with each of its arrays changed."""
    chart = Chart(*(change(array) for array in moved.chart))
    states, turns, work = (change(array) for array in (moved.states, moved.turns, moved.work))
    return MotionRows(moved.report, states, chart, turns, work, change(moved.flags))


def with_columns(moved: MotionRows, columns: slice | Sequence[int]) -> MotionRows:
    """Some columns of a motion's arrays, without these, which may be far wider."""
    return changed(moved, lambda array: array[..., columns].copy())


def widened(moved: MotionRows, width: int) -> MotionRows:
    """With columns up to a width, those more without a row."""

    def wide(array: NDArray[Any]) -> NDArray[Any]:
        found = np.full((*array.shape[:-1], width), nothing(array), dtype=array.dtype)
        found[..., : array.shape[-1]] = array
        return found

    return changed(moved, wide) if moved.states.shape[-1] < width else moved


def nothing(array: NDArray[Any]) -> float:
    """What an array holds where there is no row."""
    return np.nan if array.dtype == np.float64 else 0


def joined(pieces: Sequence[MotionRows], report: MotionReport, width: int = 0) -> MotionRows:
    """Rows behind one another, with columns up to a width, as those of one motion."""
    if len(pieces) == 1:
        return widened(replace(pieces[0], report=report), width)
    arrays = zip(*(_arrays(one) for one in pieces), strict=True)
    made = [np.concatenate(each, axis=-1) for each in arrays]
    return widened(motion_of(report, made), width)


def _arrays(moved: MotionRows) -> list[NDArray[Any]]:
    direction, rates, seconds, friction = moved.chart
    ways = [moved.states, direction, rates, seconds, moved.turns, friction, moved.work, moved.flags]
    return [np.asarray(one) for one in ways]


def first_row(run: Run) -> MotionRows:
    """The first row of a motion, which is left behind it."""
    return with_columns(run(1, lambda *_: False), slice(1))


def beginning_of(begin: float, moments: Moments | SpacedMoments) -> Floats:
    """Moments (s) of a motion of which the first row is wanted: it has the length of the motion to
    the last row."""
    last = float(moments.part(slice(moments.rows - 1, moments.rows)).values[0])
    return np.unique([begin, begin + tolerances.FIRST_PART * (last - begin), last])


def taken(first: int, rows: int, arrays: Sequence[NDArray[Any]]) -> MotionRows:
    """A block of rows out of the kernel's arrays, as a taker has them."""
    own = [np.array(array[0, ..., :rows], order="C") for array in arrays]
    for array in arrays:
        array.fill(nothing(array))  # where no row is written there is none
    return motion_of(under_way(first, rows, len(own[0])), own)


def marched(run: Run, rows: int, block: int) -> Iterator[MotionRows]:
    """A motion of so many rows in blocks, as they are reached; the report of the last one is that
    of the motion, and the others are under way."""
    if rows <= block:
        yield run(0, None)
        return
    march = March(run, block)
    try:
        yield from march
    finally:
        march.leave()


class March:
    """A motion that is integrated in a thread, a block ahead of whoever takes its rows."""

    def __init__(self, run: Run, rows: int) -> None:
        self._integrate, self._rows = run, rows
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
            last = self._integrate(self._rows, self._take)
        except BaseException as error:  # raised where rows are taken
            self._found.put(error)
        else:
            self._found.put(last)

    def _take(self, first: int, rows: int, arrays: list[NDArray[Any]]) -> bool:
        self._found.put(taken(first, rows, arrays))
        self._free.acquire()
        return not self._is_left
