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
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import DrivenLaws
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.response import Response, Stop
    from mechkin_cli.solver.free_motion import MotionRows
    from mechkin_cli.solver.session import Session
    from mechkin_cli.units import Dimension

_WAYS = {"up": 1, "down": -1, "any": 0}


def watched_stop(stop: Stop) -> WatchedStop:
    """A stop as the kernel takes it."""
    if isinstance(stop, Crossing):
        return WatchedStop(0, _WAYS[stop.direction], 1, stop.at, *_powers(stop.dimension))
    if isinstance(stop, DeadCentre):
        rate = dimension_of(stop.coordinate) / TIME
        return WatchedStop(1, 0, stop.count, 0.0, *_powers(rate))
    return WatchedStop(2, 0, stop.count, 0.0)


def _powers(dimension: Dimension) -> tuple[int, int]:
    """`lengths` and `rates` of a `WatchedStop`."""
    length, mass, time, _ = dimension.exponents
    if mass or time > 0 or length != int(length) or time != int(time):
        return 0, -1
    return int(length), -int(time)


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
    if laws is not None and response.course is not None:
        edges = response.course.edges[1:] * float(free.problem.units.to_si(1.0, TIME))
        driven = _before_jumps(free, edges, laws, driven, moments)
    return free.problem.moved(Motion(driven, count, moments, response.course))


def _before_jumps(
    free: Session,
    edges: Floats,
    laws: DrivenLaws,
    driven: tuple[DrivenInput, ...],
    moments: Moments,
) -> tuple[DrivenInput, ...]:
    """Accelerations of laws where a piece of one ends at a row, at an edge (s): those that the
    motion came with, as the free coordinates have them there."""
    rows = [k for k in range(1, moments.values.size) if moments.values[k] in edges]
    if not rows:
        return driven
    accelerations = [item.accelerations.copy() for item in driven]
    written = [item.written_orders.copy() for item in driven]
    for row in rows:
        at = laws.at(float(np.nextafter(moments.values[row], moments.values[0])))
        for number, item in enumerate(driven):
            second = at[number][2] * input_unit(free.layout, item)
            dimension = dimension_of(item.coordinate) / TIME**2
            accelerations[number][row] = second
            written[number][2, row] = float(free.problem.units.from_si(second, dimension))
    return tuple(
        item._replace(accelerations=a, written_orders=w)
        for item, a, w in zip(driven, accelerations, written, strict=True)
    )


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
