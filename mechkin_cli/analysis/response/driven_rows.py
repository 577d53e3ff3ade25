"""The rows of a response as if the start's coordinates were driven through them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.sweep.result import Result
from mechkin_cli.analysis.sweep.rows import Rows
from mechkin_cli.mechanism.joint_table import dimension_of
from mechkin_cli.mechanism.motion import ORDERS, DrivenInput, Motion
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.analysis.response.result import ResponseResult
    from mechkin_cli.arrays import Floats


def driven_rows(response: ResponseResult) -> Result:
    """A sweep with the states, rates and accelerations of a response, on the same tree."""
    own, moving = response.row_states, response.problem.motion
    free = [_driven(response, *at) for at in response.response.independent]
    motion = Motion((*free, *moving.inputs), moving.rows, moving.time, moving.course)
    session = response.chosen.moved(replace(response.chosen.problem, motion=motion))
    rows = Rows.without_guesses(own.states.shape[0], 0, moving.rows)
    rows.states, rows.reached, rows.status = own.states, own.reached, own.status
    # closing joints have the same turns; the tree's angles have theirs in the states
    closing = own.turns[: own.turns.shape[0] - len(response.session.turn_slots.tree)]
    still = np.zeros((len(session.turn_slots.tree), moving.rows))
    rows.turns = np.concatenate([closing, still])
    return Result(session, response.start, rows)


def _driven(response: ResponseResult, joint: str, coordinate: str) -> DrivenInput:
    name, units, rows = f"{joint}.{coordinate}", response.units, response.rows
    orders = [_numbers(response, name + ORDERS[order]) for order in range(3)] + [np.zeros(rows)]
    dimension = dimension_of(coordinate)
    written = np.array(
        [units.from_si(found.copy(), dimension / TIME**order) for order, found in enumerate(orders)]
    )
    values, rates, accelerations, jerks = orders
    return DrivenInput(joint, coordinate, values, rates, accelerations, jerks, written)


def _numbers(response: ResponseResult, name: str) -> Floats:
    """A quantity over the rows in SI, zero where there is none."""
    value = np.asarray(response.quantity(name).value, dtype=np.float64)
    return np.where(response.solved, np.broadcast_to(value, (response.rows,)), 0.0)
