"""What the kernel tells of a motion: how it ended, and its rows."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.session import Chart

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats


class MotionEnd(IntEnum):
    """How a motion ended, as the kernel's `LaneEnd`."""

    DONE = 0
    STOPPED = 1
    STUCK = 2
    STEP_LIMIT = 3
    HELD = 4

    UNDER_WAY = 5
    """It goes on: rows of a motion that are not its last ones."""


class Fault(IntEnum):
    """Why no step could be taken: bits of the kernel's `StageFlag`."""

    NOT_CLOSED = 1
    OFF_BRANCH = 2
    SINGULAR_INERTIA = 4
    UNDEFINED_LOAD = 8
    FRICTION = 16
    UNDEFINED_STOP = 32
    NOT_FINITE = 255


class MotionReport(NamedTuple):
    """How a motion ended.

    Attributes:
        first: the number of the first row that is held.
        stop: that ended it, or that had no value where it ended; -1: none.
        joints: numbers of the frictions that it ended by.
        energy: largest kinetic energy at the ends of its steps (kg, length units, s).
        lightest: least inertia at the last of them, in parts of that at the start.
        growth: accelerations there, in parts of the rates (1/s).
        met: how often the switch `which` was met.
        step: the last one, s.
        value: largest of that switch.
        end: the kernel's verdict.
        fault: of the last refused step.
        which: the switch that held it, or that was met most often when steps ran out.
        stiff, stiff_from: whether and from when (s) the implicit method took over.
        time: the last one, s.
        rows, evaluations, steps, rejections: their counts.
        last: the last states.
        crossings: the branch points that were passed (time in s, states).
        touches: stops (numbers) whose value came to `at` and went back, and when (s).
        branch_point: the states at the one that it has ended next to; empty: none.
        singular: whether short steps were refused there as off the branch.
    """

    first: int
    stop: int
    joints: list[int]
    energy: float
    lightest: float
    growth: float
    met: int
    step: float
    value: float
    end: MotionEnd
    fault: int
    which: int
    stiff: bool
    stiff_from: float
    time: float
    rows: int
    evaluations: int
    steps: int
    rejections: int
    last: list[float]
    crossings: list[tuple[float, list[float]]]
    touches: list[tuple[int, float]]
    branch_point: list[float]
    singular: bool

    @property
    def is_over(self) -> bool:
        """Whether it is the report of a whole motion."""
        return self.end is not MotionEnd.UNDER_WAY


def under_way(first: int, rows: int, states: int) -> MotionReport:
    """What is known of a motion behind some of its rows."""
    last = [0.0] * states
    nothing = (0.0, 0, 0.0, 0.0, MotionEnd.UNDER_WAY, 0, -1, False, 0.0, 0.0, first + rows, 0, 0, 0)
    return MotionReport(first, -1, [], 0.0, 1.0, *nothing, last, [], [], [], singular=False)


@dataclass(frozen=True)
class MotionRows:
    """Rows of one motion in kernel units: states (states, rows), the chart about each, turns of
    cut joints (slots, rows), work put in and lost (2, rows) in kg, length units and s, and the
    kernel's flags (rows,). Rows that were not reached hold nan."""

    report: MotionReport
    states: Floats
    chart: Chart
    turns: Floats
    work: Floats
    flags: NDArray[np.uint8]

    @property
    def count(self) -> int:
        """Rows that there are: those that were reached, and one where a stop lies between rows."""
        held = self.report.rows - self.report.first
        behind = self.states[:1, held : held + 1]
        return self.report.rows + bool(behind.size and np.isfinite(behind).all())


def motion_of(report: MotionReport, arrays: Sequence[NDArray[Any]]) -> MotionRows:
    """A motion of the kernel's arrays."""
    states, direction, rates, seconds, turns, friction, work, flags = arrays
    chart = Chart(direction, rates, seconds, friction)
    return MotionRows(report, states, chart, turns, work, flags)
