"""The motion of a long run, whose numbers are made part by part as they are wanted.

A run of 10^8 rows takes a gigabyte for each number of its inputs. So the file's motion is built in
a sample of its rows, which has all that is no number of a row, and in any part of them anew. Who
asks for a number in all rows gets it, as far as the memory allows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.mechanism.motion import Moments, MotionInputs, Span
from mechkin_cli.tolerances import PART_ROWS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism.motion import Course, DrivenInput
    from mechkin_cli.show import Floats

Build = Callable[["NDArray[np.int64]"], MotionInputs]
"""Builds the motion in some rows, by their numbers, which rise."""


def long_motion(
    sample: MotionInputs, rows: NDArray[np.int64], build: Build, most_rows: int
) -> MotionInputs:
    """The motion of a long run; to all others it is one like any other.

    Args:
        sample: the motion in some of its rows, first and last among them.
        rows: their numbers.
        build: builds it in others.
        most_rows: how many rows may be in memory at once.
    """
    return cast("MotionInputs", LongRun(sample, rows, build, most_rows))


def in_pieces(motion: MotionInputs) -> Iterator[MotionInputs]:
    """A motion in pieces, each of which begins with the last row of the one before; in one, where
    it is held."""
    if not isinstance(motion, LongRun):
        yield motion
        return
    for first in range(0, motion.rows - 1, PART_ROWS):
        yield motion.part(first, min(first + PART_ROWS, motion.rows - 1))


def with_ends(motion: MotionInputs) -> MotionInputs:
    """A motion with the first and the last row of another: that itself, or a sample."""
    return motion.sample if isinstance(motion, LongRun) else motion


class LongRun:
    """What `MotionInputs` has, and the motion in some rows; arguments are those of
    `long_motion`."""

    span = None

    def __init__(
        self, sample: MotionInputs, rows: NDArray[np.int64], build: Build, most_rows: int
    ) -> None:
        self.sample, self.sampled, self.most_rows = sample, rows, most_rows
        self._build = build
        self.rows = int(rows[-1]) + 1
        self.grid = sample.grid
        self.sample = sample._replace(grid=None)
        self.leader = sample.leading_number
        self.paths, self.constraints = sample.paths, sample.constraints
        self.unrated, self.driven = sample.unrated, sample.driven
        self.inputs = tuple(_Input(self, number) for number in range(len(sample.inputs)))
        self.time = None if sample.time is None else _Moments(self)

    @property
    def leading(self) -> object | None:
        """The first input that moves."""
        return self.inputs[self.leader] if self.inputs else None

    @property
    def leading_number(self) -> int:
        """The number of that input."""
        return self.leader

    def at(self, rows: NDArray[np.int64]) -> MotionInputs:
        """The motion in some rows, by their numbers, which rise."""
        # what moves in the run may rest in some of its rows
        found = self._build(rows)
        return found._replace(leader=self.leader, unrated=self.unrated, grid=self._lines_of(rows))

    def _lines_of(self, rows: NDArray[np.int64]) -> tuple[int, int] | None:
        """The grid of some rows that are whole lines of one; else None."""
        if self.grid is None:
            return None
        first, last, (_, width) = int(rows[0]), int(rows[-1]), self.grid
        is_whole = first % width == 0 and (last + 1) % width == 0
        are_all = last - first + 1 == rows.size
        return (rows.size // width, width) if is_whole and are_all else None

    def part(self, first: int, last: int) -> MotionInputs:
        """The rows from `first` to `last`, both included."""
        found = self.at(np.arange(first, last + 1))
        return found._replace(span=Span(first, last + 1 - first, self.rows))

    @cached_property
    def whole(self) -> MotionInputs:
        """The motion in all rows.

        Raises:
            UsageError: they do not fit in memory.
        """
        if self.rows > self.most_rows:
            raise UsageError(
                f"the run has too many rows to be held at once, {self.rows} (limit "
                f"{self.most_rows}); take them block by block with stream(), or write them with "
                "mechkin analyze --format csv or parquet"
            )
        return self._build(np.arange(self.rows))._replace(span=None, leader=self.leader)

    @property
    def rest(self) -> None:
        """No coordinate is at rest: where such stand is found for all rows at once."""
        return None

    @property
    def course(self) -> Course | None:
        """The course of the inputs along all rows."""
        return self.whole.course

    @property
    def constraint_rates(self) -> Floats | None:
        """Rates of constrained inputs in all rows (constraints, rows)."""
        return self.whole.constraint_rates

    def _replace(self, **changes: Any) -> MotionInputs:
        return self.whole._replace(**changes)


class _Input:
    """What `DrivenInput` has, of a long run."""

    def __init__(self, run: LongRun, number: int) -> None:
        item = run.sample.inputs[number]
        self._run, self._number = run, number
        self.joint, self.coordinate, self.follows = item.joint, item.coordinate, item.follows
        self.name = item.name

    def __getattr__(self, name: str) -> Any:
        """A number in all rows, or what depends on it."""
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._whole, name)

    @property
    def _whole(self) -> DrivenInput:
        return self._run.whole.inputs[self._number]


class _Moments:
    """What `Moments` has, of a long run."""

    def __init__(self, run: LongRun) -> None:
        self._run = run

    @property
    def values(self) -> Floats:
        """In s (rows,)."""
        return self._whole.values

    @property
    def written(self) -> Floats:
        """In the file's units (rows,)."""
        return self._whole.written

    @property
    def _whole(self) -> Moments:
        moments = self._run.whole.time
        assert moments is not None
        return moments
