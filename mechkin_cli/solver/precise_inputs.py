"""The inputs of a session over its rows as the text says them, in double-double and enclosed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli.exact import nearest
from mechkin_cli.mechanism.exact_motion import ExactMotion
from mechkin_cli.mechanism.joint_table import dimension_of
from mechkin_cli.mechanism.motion import ORDERS
from mechkin_cli.solver.inputs import held_values, turn_of
from mechkin_cli.tape.exact_rows import ExactRows
from mechkin_cli.units import ANGLE, TIME

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.solver.precise import Precise
    from mechkin_cli.solver.session import Session


class PreciseInputs(NamedTuple):
    """Inputs over the rows, high and low parts, in the order of `Session.inputs`; enclosed they
    have a third part, a radius.

    Attributes:
        values: (inputs, 2, rows) in kernel units; what holds idle freedoms stands behind.
        rates: (inputs, 2, rows) their first derivatives over time.
        accelerations: (inputs, 2, rows) their second derivatives.
        jerks: (inputs, 2, rows) their third derivatives.
        reduced: (inputs, 2, rows) values without the whole turns of angles.
        whole: (inputs, rows) those turns, as `Session.inputs` has them.
        time: (2, rows) in s; None without any.
        tie_rates: (ties, 2, rows) as `Session.tie_rates`; None without any.
        written: (2, rows) by the names of time, of inputs and of their rates, in the file's units.
    """

    values: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats
    reduced: Floats
    whole: Floats
    time: Floats | None
    tie_rates: Floats | None
    written: Mapping[str, Floats]


class _Numbers(NamedTuple):
    """What `PreciseInputs` are made of, recorded: by order, then by input."""

    rows: ExactRows
    orders: Sequence[Sequence[Any]]
    reduced: Sequence[Any]
    time: Sequence[Any]
    tie_rates: Sequence[Any]
    written: Mapping[str, Any]

    @property
    def listed(self) -> list[Any]:
        """All of them."""
        orders = [number for order in self.orders for number in order]
        return [*orders, *self.reduced, *self.time, *self.tie_rates, *self.written.values()]


def precise_inputs(precise: Precise, session: Session) -> PreciseInputs:
    """The inputs of a session's rows in double-double."""
    recorded = _recorded(precise, session)
    return _put_together(session, recorded, recorded.rows.double_doubles(recorded.listed))


def enclosed_inputs(precise: Precise, session: Session) -> PreciseInputs:
    """The same enclosed: a third part is the radius about the two."""
    recorded = _recorded(precise, session)
    return _put_together(session, recorded, recorded.rows.enclosures(recorded.listed))


def _put_together(session: Session, recorded: _Numbers, found: Floats) -> PreciseInputs:
    count = len(session.inputs.values)
    ends = np.cumsum([count] * 5 + [len(recorded.time), len(recorded.tie_rates)])
    *parts, time, ties, written = np.split(found, ends)
    values, rates, accelerations, jerks, reduced = parts
    names = dict(zip(recorded.written, written, strict=True))
    return PreciseInputs(
        values,
        rates,
        accelerations,
        jerks,
        reduced,
        session.inputs.whole,
        time[0] if len(time) else None,
        ties if len(ties) else None,
        names,
    )


def _recorded(precise: Precise, session: Session) -> _Numbers:
    problem = precise.problem_of(session)
    layout, inputs = precise.layout(session), problem.motion.inputs
    motion = _motion_of(precise, problem)
    units = [layout.mechanism.joints[i.joint].unit_of(i.coordinate, layout.length) for i in inputs]
    held = held_values(problem, layout)
    orders = [
        [
            *(motion.in_si[i.name][k] / unit for i, unit in zip(inputs, units, strict=True)),
            *(held if k == 0 else [0.0] * len(held)),
        ]
        for k in range(len(ORDERS))
    ]
    ties = [
        rate * (units[leader] / units[tied])
        for rate, (tied, leader) in zip(motion.tie_rates, problem.motion.tied, strict=False)
    ]
    written = {} if "time" not in motion.written else {"time": motion.written["time"]}
    for item in inputs:
        names = (item.name + suffix for suffix in ORDERS)
        written |= dict(zip(names, motion.written[item.name], strict=True))
    return _Numbers(
        motion.rows,
        orders,
        [_reduced(session, motion, k, values) for k, values in enumerate(orders[0])],
        [motion.in_si["time"]] if "time" in motion.in_si else [],
        ties,
        written,
    )


def _reduced(session: Session, motion: ExactMotion, number: int, value: Any) -> Any:
    """An input without its whole turns, taken off in the file's unit."""
    whole = session.inputs.whole[number]
    if not whole.any():
        return value
    problem = session.problem
    item = problem.motion.inputs[number]
    turn = turn_of(problem, item)
    assert turn is not None
    rest = motion.written[item.name][0] - motion.rows.given(whole) * nearest(turn)
    return problem.units.to_si(rest, ANGLE)


def _motion_of(precise: Precise, problem: Problem) -> ExactMotion:
    """The file's motion, or another one as the doubles of its rows in the file's units."""
    motion, units = problem.motion, problem.units
    if motion is precise.base.motion:
        return precise.motion
    rows = ExactRows(precise.recorder, motion.rows)
    written: dict[str, Any] = {}
    in_si: dict[str, Any] = {}
    if motion.time is not None:
        written["time"] = rows.given(motion.time.written)
        in_si["time"] = units.to_si(written["time"], TIME)
    for item in motion.inputs:
        written[item.name] = [rows.given(order) for order in item.written_orders]
        in_si[item.name] = [
            units.to_si(number, dimension_of(item.coordinate) / TIME**order)
            for order, number in enumerate(written[item.name])
        ]
    ties = () if motion.tie_rates is None else tuple(rows.given(rate) for rate in motion.tie_rates)
    return ExactMotion(rows, in_si, written, ties)
