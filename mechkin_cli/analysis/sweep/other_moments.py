"""A sweep in time at other moments: the same branch, followed by the same laws."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.mechanism.joint_table import dimension_of
from mechkin_cli.mechanism.motion import Moments
from mechkin_cli.solver.places import places_at
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.motion import DrivenInput


class Between(NamedTuple):
    """The motion of a result between its rows: `bends` are moments, in the file's unit, at which
    the laws of its inputs bend or jump."""

    result: Result
    bends: Floats

    @classmethod
    def of(cls, result: Result) -> Between | None:
        """None where the motion is not known there: without time, and where several inputs move by
        one motor, whose ties are those of the rows."""
        motion = result.problem.motion
        if motion.time is None or motion.course is None or motion.tied:
            return None
        return cls(result, np.unique(motion.course.at[motion.course.rows < 0]))

    def at(self, written: Floats) -> Result:
        """The sweep at rising moments within its own, in the file's unit, and at that of its first
        assembly, which may be none of them: rows (moments,) or one more."""
        from mechkin_cli.analysis.sweep.sweep import closed_rows

        session, problem, start = self.result.session, self.result.problem, self.result.start
        time, course = problem.motion.time, problem.motion.course
        assert time is not None
        assert course is not None
        first = time.written[start.row]
        moments = np.unique(np.concatenate([written, [first]]))
        motion = problem.motion._replace(
            inputs=tuple(_inputs(self.result, moments)),
            rows=moments.size,
            time=Moments(problem.units.to_si(moments.copy(), TIME), moments),
        )
        values = np.stack([item.values for item in motion.inputs])
        motion = motion._replace(course=places_at(course, moments, values))
        row = int(np.searchsorted(moments, first))
        return closed_rows(session.moved(replace(problem, motion=motion)), replace(start, row=row))


def _inputs(result: Result, moments: Floats) -> list[DrivenInput]:
    """The inputs at some moments, with no jerk."""
    session, units = result.session, result.problem.units
    inputs, route = result.problem.motion.inputs, session.route
    assert route is not None
    edges = route.course.edges
    cells = np.clip(np.searchsorted(edges, moments) - 1, 0, edges.size - 2)
    jets = np.zeros((moments.size, len(inputs), 4))
    for cell in np.unique(cells):
        here = cells == cell
        jets[here, :, :3] = route.jets(int(cell), moments[here]) * route.units[:, None]
    second, found = float(units.to_si(1.0, TIME)), []
    for k, item in enumerate(inputs):
        written, orders = [], []
        dimension, unit = dimension_of(item.coordinate), 1.0
        for order in range(jets.shape[2]):
            orders.append(jets[:, k, order] / unit)
            written.append(units.from_si(orders[-1].copy(), dimension))
            dimension, unit = dimension / TIME, unit * second
        values, rates, accelerations, jerks = orders
        found.append(
            item._replace(
                values=values,
                rates=rates,
                accelerations=accelerations,
                jerks=jerks,
                written_orders=np.array(written),
            )
        )
    return found
