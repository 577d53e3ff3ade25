"""The rows of a motion with their verdicts, before anything is read: all of them, or a block."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.mechanism import (
    CrossingEnd,
    DrivenInput,
    Moments,
    MotionInputs,
    Span,
    dimension_of,
)
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.response.integration import ending, formula_ends
from mechkin_cli.response.report import MotionEnd
from mechkin_cli.response.result import ResponseResult
from mechkin_cli.session import Chart, input_unit
from mechkin_cli.sweep import SweepRows
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.kernel._kernel import DrivenLaws
    from mechkin_cli.mechanism import Limit, Problem, ResponseProblem
    from mechkin_cli.response.integration import Beginning
    from mechkin_cli.response.report import MotionReport, MotionRows
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


@dataclass(frozen=True)
class Prepared:
    """A response before it is integrated: the session that its assembly was `chosen` in, that of
    the `free` motion, and how it begins; None where it cannot."""

    response: ResponseProblem
    chosen: Session
    start: AssemblyStart
    free: Session
    begun: Beginning | None
    driven: DrivenLaws | None


def rows_problem(
    free: Session,
    response: ResponseProblem,
    laws: DrivenLaws | None,
    place: Span,
    stop: float | None,
) -> Problem:
    """The problem whose motion has some rows of the response, the last of them the moment (s) of a
    `stop`, if there is one."""
    every = response.moments
    end = place.first + place.rows - (stop is not None)
    moments = every.part(slice(place.first, end))
    driven = response.driven_in(place.first, end)
    if stop is not None:
        written = float(free.problem.units.from_si(stop, TIME))
        values = np.append(moments.values, stop)
        moments = Moments(values, np.append(moments.written, written))
        at = [] if laws is None else laws.at(stop)
        driven = tuple(_stopped(free, item, at[number]) for number, item in enumerate(driven))
    if laws is not None and response.course is not None:
        edges = formula_ends(response, free.problem.units)
        driven = _before_jumps(free, edges, laws, driven, moments, begins=place.first == 0)
    return free.problem.moved(MotionInputs(driven, place.rows, moments, response.course))


def _before_jumps(
    free: Session,
    edges: Floats,
    laws: DrivenLaws,
    driven: tuple[DrivenInput, ...],
    moments: Moments,
    *,
    begins: bool,
) -> tuple[DrivenInput, ...]:
    """Accelerations of laws where a piece of one ends at a row, at an edge (s): those that the
    motion came with, as the free coordinates have them there; to a row in which it `begins` it
    comes with none."""
    rows = [int(k) for k in np.flatnonzero(np.isin(moments.values, edges)) if k or not begins]
    if not rows:
        return driven
    accelerations = [item.accelerations.copy() for item in driven]
    written = [item.written_orders.copy() for item in driven]
    for row in rows:
        at = laws.at(float(np.nextafter(moments.values[row], -np.inf)))
        for number, item in enumerate(driven):
            second = at[number][2] * input_unit(free.layout, item)
            dimension = dimension_of(item.coordinate) / TIME**2
            accelerations[number][row] = second
            written[number][2, row] = float(free.problem.units.from_si(second, dimension))
    return tuple(
        item._replace(accelerations=a, written_orders=w)
        for item, a, w in zip(driven, accelerations, written, strict=True)
    )


def _stopped(free: Session, item: DrivenInput, at: tuple[float, float, float]) -> DrivenInput:
    """With one row more, where the motion was stopped; `at` in kernel units."""
    unit, units = input_unit(free.layout, item), free.problem.units
    last = [value * unit for value in at] + [nan]
    dimension = dimension_of(item.coordinate)
    written = [
        float(units.from_si(value, dimension / TIME**order)) for order, value in enumerate(last)
    ]
    return item._replace(
        values=np.append(item.values, last[0]),
        rates=np.append(item.rates, last[1]),
        accelerations=np.append(item.accelerations, last[2]),
        jerks=np.append(item.jerks, last[3]),
        written_orders=np.concatenate([item.written_orders, np.array(written)[:, None]], axis=1),
    )


def limits_of(response: ResponseProblem) -> list[Limit]:
    """The limits at which it may end."""
    stops = [stop for stop in response.stops if isinstance(stop, CrossingEnd)]
    return [stop.limit for stop in stops if stop.limit is not None]


def refuse_many_rows(one: Prepared, variants: int = 1) -> None:
    """Rows are held up to a limit.

    Raises:
        UsageError: these are too many.
    """
    plan, rows = one.free.plan, one.response.rows
    per_row = plan.states + plan.charts * (plan.columns + 2)
    if rows * per_row * variants > tolerances.MOST_NUMBERS:
        most = tolerances.MOST_NUMBERS // (per_row * variants)
        cure = (
            "take them block by block with stream(run=...), or write them with mechkin analyze "
            "--format csv or parquet"
        )
        raise UsageError(
            f"the response {one.response.name} has too many rows to be held at once, {rows} (limit "
            f"{most}); {cure}"
        )


class RunEnd(NamedTuple):
    """How a motion ended: its report, how many rows its table has and how many of them are reached,
    and whether the last one of these is a stop's own moment."""

    report: MotionReport
    rows: int
    reached: int
    has_stop: bool

    @property
    def is_stopped(self) -> bool:
        """Whether a stop has ended it, whose words the last row has."""
        return self.report.end is MotionEnd.STOPPED and self.rows > 0


def run_end(one: Prepared, report: MotionReport, reached: int) -> RunEnd:
    """The end of a motion of which so many rows were `reached`, a stop's own moment among them."""
    count = one.response.rows
    if report.end is MotionEnd.STOPPED:
        count = reached
        if report.rows:
            # a stop at the moment of the last row before it has that row
            last = slice(report.rows - 1, report.rows)
            row = float(one.response.moments.part(last).values[0])
            count -= abs(report.time - row) <= tolerances.SAME_MOMENT * abs(row)
    return RunEnd(report, count, reached, report.rows < reached and report.rows < count)


def block_of(one: Prepared, moved: MotionRows, end: RunEnd, place: Span) -> ResponseResult:
    """Some rows of a motion, with which the arrays of `moved` begin, and their verdicts. What is
    said of the whole motion comes with the first ones where its end is known before, as of one with
    stops, else with the last ones."""
    response, chosen, free, report = one.response, one.chosen, one.free, end.report
    count, is_last = place.rows, place.first + place.rows == end.rows
    part = slice(0, count)
    reached = np.arange(place.first, place.first + count) < end.reached
    rows = SweepRows.without_guesses(free.layout.states, 0, count, place)
    rows.states = np.where(reached, moved.states[:, part], 0.0)
    rows.reached, rows.nodes = reached, report.steps
    # no whole turns of the tree's angles, whose states have them
    tree = np.zeros((len(free.structure.tree_slots), count))
    rows.turns = np.concatenate([moved.turns[:, part], tree])
    status, notes = ending(chosen, free, response, report, np.array(report.last))
    rows.status[~reached] = status
    tells = not place.first if response.stops else is_last
    rows.diagnostics += notes if tells else []
    energy = free.layout.length * free.layout.length
    events = [""] * count
    if is_last and end.is_stopped and count:
        events[-1] = response.stops[report.stop].words
    # the rows that a motion did not reach are those of the file
    stop = report.time if is_last and end.has_stop and end.rows == end.reached else None
    return ResponseResult(
        free.moved(rows_problem(free, response, one.driven, place, stop)),
        one.start,
        rows,
        chosen=chosen,
        chart=Chart(*(np.where(reached, array, 0.0) for array in moved.chart.at(part))),
        work=np.where(reached, energy * moved.work[:, part], np.nan),
        events=events,
        response=response,
        report=report,
    )
