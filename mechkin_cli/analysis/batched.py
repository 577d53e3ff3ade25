"""The batched run of all rows of a sweep from their guesses, and which of them it lost."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.rows import RowStates
from mechkin_cli.analysis.setup import Setup
from mechkin_cli.solver.batch import Batch, run
from mechkin_cli.solver.codes import Demand

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


def run_reached(
    setup: Setup, rows: RowStates, *, shift: int = 0, loads: Floats | None = None
) -> Batch:
    """Runs all rows; those without a guess repeat a neighbour's and are emptied later.

    `shift` and `loads` as in `solver.batch.run`.
    """
    plan, inputs, demand = setup.outputs.plan, setup.inputs, setup.demand
    values, guess = inputs.values, rows.guess
    if not rows.reached.all():
        if not rows.reached.any():
            return _no_rows(setup, rows.reached.size)
        stand_in = np.where(
            rows.reached, np.arange(rows.reached.size), int(np.argmax(rows.reached))
        )
        values, guess = values[:, stand_in], guess[:, stand_in]
    return run(
        plan,
        np.ascontiguousarray(values),
        np.ascontiguousarray(guess),
        rates=inputs.rates,
        accelerations=inputs.accelerations,
        jerks=inputs.jerks if demand & Demand.JERK else None,
        loads=loads,
        demand=demand,
        outputs=setup.outputs.outputs,
        shift=shift,
        lanes=setup.lanes,
    )


def failed_rows(batch: Batch, rows: RowStates) -> NDArray[np.bool_]:
    """Rows with a guess that did not close near it, on its side of every fold.

    Orientations are there where the run demanded more than positions.
    """
    if not rows.reached.any():
        return np.zeros(rows.reached.size, dtype=bool)
    turned = batch.orientation != batch.orientation[int(np.argmax(rows.reached))]
    failed: NDArray[np.bool_] = ~batch.good | turned | ~(batch.correction <= rows.limit)
    return rows.reached & failed


def _no_rows(setup: Setup, count: int) -> Batch:
    plan, slots = setup.outputs.plan, setup.outputs.outputs.slots
    nothing = np.full(count, np.nan)
    return Batch(
        states=np.empty((plan.states, count)),
        outputs=np.full((slots, count), np.nan),
        first=None,
        second=None,
        residual=nothing,
        correction=nothing.copy(),
        orientation=nothing.copy(),
        condition=nothing.copy(),
        power_error=nothing.copy(),
        flags=np.zeros(count, dtype=np.uint8),
    )
