"""One call of the kernel over many rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.width import width
from mechkin_cli.solver.codes import Demand, RowFlag

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan

RESIDUAL_TESTS = (
    tolerances.RESIDUAL_TIGHT,
    tolerances.STEP_COARSE,
    tolerances.RESIDUAL_ACCEPT,
)


class Batch(NamedTuple):
    """What the kernel found, row by row; arrays over rows, or (columns, rows).

    `states` and `outputs` as planned; `first` and `second` are the derivatives of the columns
    (lengths in the kernel's unit); `correction` is the largest change of an unknown against its
    guess; `flags` are `RowFlag`s; what was not asked for is None.
    """

    states: Floats
    outputs: Floats | None
    first: Floats | None
    second: Floats | None
    residual: Floats
    correction: Floats
    orientation: Floats
    condition: Floats | None
    power_error: Floats | None
    flags: NDArray[np.uint8]

    @property
    def good(self) -> NDArray[np.bool_]:
        """Rows that are closed."""
        return np.equal(self.flags, RowFlag.GOOD)


def run(
    plan: Plan,
    inputs: Floats,
    guess: Floats,
    *,
    rates: Floats | None = None,
    accelerations: Floats | None = None,
    loads: Floats | None = None,
    jerks: Floats | None = None,
    demand: Demand = Demand.POSITION,
    outputs: bool = False,
    derivatives: bool = False,
    shift: int = 0,
    iterations: int = tolerances.NEWTON_ITERATIONS,
    tests: tuple[float, float, float] = RESIDUAL_TESTS,
    lanes: int = 0,
) -> Batch:
    """Closes all rows from their guesses and computes what is demanded.

    Args:
        plan: the kernel's plan.
        inputs: (inputs, rows), rad and length units; `rates`, `accelerations` likewise.
        guess: (states, rows).
        rates: needed for velocities.
        accelerations: needed for accelerations.
        jerks: needed for third derivatives.
        loads: values of varying loads (columns, rows) as `varying_loads.kernel_loads` gives them,
            needed for forces where there are any.
        demand: what to compute beyond positions.
        outputs: fill the plan's outputs.
        derivatives: return the columns' first and second derivatives.
        shift: 1 or 2 adds a fixed part of the null space to reactions that are not unique.
        iterations: Newton steps at most.
        tests: residual tests (tight, coarse, accept).
        lanes: width of the packs, 0 for the widest; the results do not depend on it.
    """
    rows = inputs.shape[1]
    states = np.empty((plan.states, rows))
    values = np.empty((plan.slots, rows)) if outputs else None
    first = np.empty((plan.columns, rows)) if derivatives else None
    second = np.empty((plan.columns, rows)) if derivatives else None
    residual, correction, orientation = np.empty(rows), np.empty(rows), np.ones(rows)
    condition = np.empty(rows) if demand & Demand.CONDITION else None
    power_error = np.empty(rows) if demand & Demand.POWER else None
    flags = np.empty(rows, dtype=np.uint8)
    plan.run(
        inputs,
        rates,
        accelerations,
        guess,
        states,
        values,
        first,
        second,
        residual,
        correction,
        orientation,
        condition,
        power_error,
        flags,
        int(demand),
        shift,
        iterations,
        tests,
        width(lanes),
        loads,
        jerks,
    )
    measured = (residual, correction, orientation, condition, power_error)
    return Batch(states, values, first, second, *measured, flags)
