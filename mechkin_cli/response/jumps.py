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
    from mechkin_cli.mechanism import ResponseProblem
    from mechkin_cli.response.result import ResponseResult
    from mechkin_cli.session import Session


def slope_ends(result: ResponseResult, chosen: Session) -> list[SlopeEnd]:
    """The places at which slopes jump, in what a motion has passed, and somewhat beyond."""
    rows, report, ends = result.row_states, result.report, []
    if report is None or not rows.reached.any():
        return []
    for bend in bends(result.problem):
        every = np.broadcast_to(np.asarray(result.quantity(bend.name).value), rows.reached.shape)
        last = value_at(chosen, bend.name, np.array(report.last))
        values = np.append(every[rows.reached], last)
        slack = tolerances.SLOPE_RANGE + float(np.abs(np.diff(values)).max())
        jumps = jumps_between(bend, float(values.min()) - slack, float(values.max()) + slack)
        joint, _, coordinate = bend.name.rpartition(".")
        for jump in jumps:
            words = place_text(result.problem, bend, jump.at)
            by, place = size_text(result.problem, bend, jump.size), result.response.place
            ends.append(SlopeEnd(words, place, joint, coordinate, jump.at, bend.owner, by))
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
    """A motion that has come to a jump of a slope as one that cannot go on, without a row there;
    else the motion itself."""
    report = moved.report
    if report.end is not MotionEnd.STOPPED or not isinstance(response.stops[report.stop], SlopeEnd):
        return moved
    states = moved.states.copy()
    states[:, report.rows :] = nan
    return replace(moved, report=report._replace(end=MotionEnd.STUCK), states=states)
