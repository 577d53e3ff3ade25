"""Where a response ends since the slope of a function of a coordinate jumps (`sweep/slopes.py`).

There the rates of what the function moves would jump. What they are behind it depends on how the
jump is rounded off: with all energy kept if it is smooth, with some of it lost if bodies strike.

A motion is integrated as if there were no jumps; if they lie in what it has passed, once more with
an end at each. So a file without them pays nothing, and places need not be known before.
"""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import SlopeEnd
from mechkin_cli.record import replace
from mechkin_cli.response.report import MotionEnd, MotionRows
from mechkin_cli.sweep import bends, jumps_between, place_text, size_text, value_at

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem, ResponseProblem
    from mechkin_cli.response.report import MotionReport
    from mechkin_cli.response.result import ResponseResult
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import Bend


class BendsPassed:
    """What a motion passes of the functions whose slopes may jump: the least and the largest value
    of each coordinate in its rows, the last one, and the longest way from row to row."""

    def __init__(self, problem: Problem) -> None:
        self._passed: dict[Bend, tuple[float, float, float, float]] = {}
        self.bends = bends(problem)

    def add(self, result: ResponseResult) -> None:
        """Adds rows."""
        reached = result.row_states.reached
        for bend in self.bends if reached.any() else ():
            every = np.broadcast_to(np.asarray(result.quantity(bend.name).value), reached.shape)
            self._add(bend, every[reached])

    def _add(self, bend: Bend, values: Floats) -> None:
        first = float(values[0])
        least, most, last, way = self._passed.get(bend, (first, first, first, 0.0))
        way = max(way, float(np.abs(np.diff(values, prepend=last)).max()))
        least, most = min(least, float(values.min())), max(most, float(values.max()))
        self._passed[bend] = least, most, float(values[-1]), way

    def ends(
        self, report: MotionReport | None, chosen: Session, response: ResponseProblem
    ) -> list[SlopeEnd]:
        """The places at which slopes jump, in what the motion has passed, and somewhat beyond."""
        ends: list[SlopeEnd] = []
        if report is None:
            return ends
        for bend in [*self._passed]:
            self._add(bend, np.array([value_at(chosen, bend.name, np.array(report.last))]))
            least, most, _, way = self._passed[bend]
            slack = tolerances.SLOPE_RANGE + way
            joint, _, coordinate = bend.name.rpartition(".")
            for jump in jumps_between(bend, least - slack, most + slack):
                words = place_text(chosen.problem, bend, jump.at)
                by = size_text(chosen.problem, bend, jump.size)
                ends.append(
                    SlopeEnd(words, response.place, joint, coordinate, jump.at, bend.owner, by)
                )
        return ends


def at_jump(chosen: Session, response: ResponseProblem, moved: MotionRows) -> MotionRows:
    """A motion that ends at a jump of a slope, as one that this has ended, whatever refused its
    steps there; else the motion itself."""
    report = moved.report
    if report.end in (MotionEnd.DONE, MotionEnd.STOPPED):
        return moved
    last = np.array(report.last)
    for number, stop in enumerate(response.stops):
        if isinstance(stop, SlopeEnd):
            off = abs(value_at(chosen, f"{stop.joint}.{stop.coordinate}", last) - stop.at)
            if off <= tolerances.AT_LIMIT * max(1.0, abs(stop.at)):
                report = report._replace(end=MotionEnd.STOPPED, stop=number)
                return replace(moved, report=report)
    return moved


def before_jump(response: ResponseProblem, moved: MotionRows) -> MotionRows:
    """A motion that has come to a jump of a slope as one that cannot go on, without a row there, as
    the rates of no side are its own; else the motion itself."""
    report = moved.report
    if report.end is not MotionEnd.STOPPED or not isinstance(response.stops[report.stop], SlopeEnd):
        return moved
    rows = report.rows
    if rows:
        row = float(response.moments.part(slice(rows - 1, rows)).values[0])
        rows -= abs(report.time - row) <= tolerances.SAME_MOMENT * abs(row)
    states = moved.states.copy()
    states[:, max(rows - report.first, 0) :] = nan
    report = report._replace(end=MotionEnd.STUCK, rows=rows)
    return replace(moved, report=report, states=states)
