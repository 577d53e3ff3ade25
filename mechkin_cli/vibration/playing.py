"""Modes of vibration as rows that can be shown: the mechanism at moments of one period, swung as
far as is seen well, its loops closed.
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel.functions import cos, sin
from mechkin_cli.mechanism import Moments, MotionInputs
from mechkin_cli.plan import Demand
from mechkin_cli.session import Ask, Chart
from mechkin_cli.statics import combined
from mechkin_cli.sweep import Result, SweepRows
from mechkin_cli.units import TIME
from mechkin_cli.vibration.arithmetic import times

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.mechanism import DrivenInput, Problem
    from mechkin_cli.session import KernelInputs, RowInputs, Session
    from mechkin_cli.show import Floats
    from mechkin_cli.statics import ForcesAt
    from mechkin_cli.vibration.place import Freed

MOMENTS = 49
"""Moments of a period that are shown, its end among them."""

SWING = 0.25
"""Largest displacement of a joint coordinate that is shown, rad or the mechanism's length unit."""

SHOWN_STEP = 1e-3
"""Displacement whose direction an arrow shows: so short that nothing bends."""

LEAST_SWING = SWING / 64.0
"""Where the loops do not close that far, half as far is tried, down to this."""


class PlayedMode(Result):
    """The rows of a mode of vibration, at rest in each.

    Args:
        session: of the free mechanism, over the moments of a period.
        start: how its run was assembled.
        rows: places.
        chart: about each row.
    """

    def __init__(
        self, session: Session, start: AssemblyStart, rows: SweepRows, chart: Chart
    ) -> None:
        super().__init__(session, start, rows)
        self.chart = chart
        self.events = ("",) * self.rows

    @property
    def mode(self) -> str:
        """None: the rows belong to that of their run."""
        return ""

    @property
    def letter(self) -> str:
        """As `mode`."""
        return ""

    def _row_inputs(self, session: Session, inputs: KernelInputs) -> RowInputs:
        return super()._row_inputs(session, inputs)._replace(chart=self.chart)


def played(
    freed: Freed, run: Result, row: int, shape: tuple[Floats, Floats], frequency: float
) -> PlayedMode:
    """A mode about a row of a run.

    Args:
        freed: the row that is left to move.
        run: the rows that it is one of.
        row: its number.
        shape: real and imaginary parts of the named coordinates (freedoms,), SI.
        frequency: Hz; zero counts as one.

    Raises:
        UsageError: the loops do not close beside the row.
    """
    small = freed.motions
    angles: Floats = np.arange(float(MOMENTS)) * (2.0 * pi / (MOMENTS - 1))
    along = [times(small.inverse, part[:, None])[:, 0] for part in shape]
    way = along[0][:, None] * cos(angles) - along[1][:, None] * sin(angles)
    largest = float(np.abs(combined(small.place.tangents, way)).max())
    swing = SWING
    while True:
        found = small.forces.at(small.place, way * (swing / largest))
        if found.good.all():
            break
        swing *= 0.5
        if swing < LEAST_SWING:
            raise UsageError("this mode cannot be shown: the loops do not close beside its place")
    return _shown(freed, run, row, found, angles / (2.0 * pi * (frequency or 1.0)))


def swung(freed: Freed, run: Result, row: int, shape: Floats) -> PlayedMode:
    """Two rows: a row of a run, and a place a little beside it along a mode.

    Args:
        freed: the row that is left to move.
        run: the rows that it is one of.
        row: its number.
        shape: the named coordinates (freedoms,), SI.
    """
    small = freed.motions
    way = times(small.inverse, shape[:, None])
    largest = float(np.abs(combined(small.place.tangents, way)).max())
    found = small.forces.at(small.place, way * np.array([0.0, SHOWN_STEP / largest]))
    return _shown(freed, run, row, found, np.array([0.0, 1.0]))


def _shown(freed: Freed, run: Result, row: int, found: ForcesAt, seconds: Floats) -> PlayedMode:
    """Places beside a row as rows at some moments."""
    small, count = freed.motions, seconds.size
    session = small.session
    problem = _over_moments(session.problem, row, seconds)
    rows = SweepRows.without_guesses(session.layout.states, 0, count)
    rows.states, rows.turns = found.states, found.turns
    rows.reached[:] = True
    still = np.zeros((small.forces.freedoms, count))
    direction = np.repeat(small.place.tangents.ravel()[:, None], count, axis=1)
    chart = Chart(direction, still, still, np.zeros((0, count)))
    shown = PlayedMode(session.moved(problem), run.start, rows, chart)
    ask = Ask(Demand.CONDITION)
    shown.keep(shown.run(ask), ask)
    return shown


def _over_moments(problem: Problem, row: int, seconds: Floats) -> Problem:
    """The problem over some moments, where what is driven stays as in a row."""
    written = np.asarray(problem.units.from_si(seconds.copy(), TIME), dtype=np.float64)
    inputs = tuple(_held(item, row, seconds.size) for item in problem.motion.inputs)
    return problem.moved(MotionInputs(inputs, seconds.size, Moments(seconds, written)))


def _held(item: DrivenInput, row: int, count: int) -> DrivenInput:
    still = np.zeros(count)
    written = np.zeros((4, count))
    written[0] = item.written_orders[0, row]
    return item._replace(
        values=np.full(count, item.values[row]),
        rates=still,
        accelerations=still,
        jerks=still,
        written_orders=written,
    )
