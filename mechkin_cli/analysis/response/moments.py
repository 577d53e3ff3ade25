"""The moments of a response's rows, with what is driven at them, and its stops as the kernel has
them."""

from __future__ import annotations

from math import nan
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.joint_table import dimension_of
from mechkin_cli.mechanism.motion import DrivenInput, Moments, Motion
from mechkin_cli.mechanism.response import Crossing, DeadCentre
from mechkin_cli.solver.free_motion import WatchedStop
from mechkin_cli.solver.inputs import input_unit
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import DrivenLaws
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.response import Response, Stop
    from mechkin_cli.solver.free_motion import MotionRows
    from mechkin_cli.solver.session import Session

_WAYS = {"up": 1, "down": -1, "any": 0}


def watched_stop(stop: Stop) -> WatchedStop:
    """A stop as the kernel takes it."""
    if isinstance(stop, Crossing):
        return WatchedStop(0, _WAYS[stop.direction], 1, stop.at)
    return WatchedStop(1 if isinstance(stop, DeadCentre) else 2, 0, stop.count, 0.0)


def rows_problem(
    free: Session, response: Response, laws: DrivenLaws | None, found: MotionRows, count: int
) -> Problem:
    """The problem whose motion has the first `count` rows, a stop's moment among them."""
    asked = response.moments
    if count <= found.report.rows or found.count <= found.report.rows:
        moments = Moments(asked.values[:count], asked.written[:count])
        driven = tuple(_part(item, count) for item in response.driven)
    else:
        end = found.report.time
        written = float(free.problem.units.from_si(end, TIME))
        moments = Moments(
            np.append(asked.values[: count - 1], end),
            np.append(asked.written[: count - 1], written),
        )
        at = [] if laws is None else laws.at(end)
        driven = tuple(
            _stopped(free, _part(item, count - 1), at[number])
            for number, item in enumerate(response.driven)
        )
    return free.problem.moved(Motion(driven, count, moments, response.course))


def _part(item: DrivenInput, count: int) -> DrivenInput:
    return item._replace(
        values=item.values[:count],
        rates=item.rates[:count],
        accelerations=item.accelerations[:count],
        jerks=item.jerks[:count],
        written_orders=item.written_orders[:, :count],
    )


def _stopped(free: Session, item: DrivenInput, at: tuple[float, float, float]) -> DrivenInput:
    """With one row more, where the motion was stopped; `at` in kernel units."""
    unit, units = input_unit(free.layout, item), free.problem.units
    found = [value * unit for value in at] + [nan]
    dimension = dimension_of(item.coordinate)
    written = [
        float(units.from_si(value, dimension / TIME**order)) for order, value in enumerate(found)
    ]
    arrays = (item.values, item.rates, item.accelerations, item.jerks)
    values, rates, accelerations, jerks = (
        np.append(array, value) for array, value in zip(arrays, found, strict=True)
    )
    orders = np.concatenate([item.written_orders, np.array(written)[:, None]], axis=1)
    return DrivenInput(
        item.joint, item.coordinate, values, rates, accelerations, jerks, orders, item.follows
    )
