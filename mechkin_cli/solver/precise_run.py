"""One call of the kernel over many rows in double-double: about 32 digits.

Newton starts from converged doubles and goes on to the rounding of double-double; nothing is judged
and no branch is followed. Numbers have two parts, high and low, whose sum they are: arrays are
(numbers, 2, rows), or (2, rows) for one number a row. Wherever such an array is given, doubles
(numbers, rows) stand for themselves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.width import threads_for, width
from mechkin_cli.solver.batch import NO_CHART
from mechkin_cli.solver.codes import Demand, RowFlag

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Outputs, Plan
    from mechkin_cli.solver.batch import Chart

PRECISE_TESTS = (
    tolerances.PRECISE_RESIDUAL_TIGHT,
    tolerances.PRECISE_STEP_COARSE,
    tolerances.PRECISE_RESIDUAL_ACCEPT,
)


class PreciseBatch(NamedTuple):
    """What the kernel found, row by row, as `solver.batch.Batch`, in double-double.

    `flags` (rows,) are `RowFlag`s: a row that Newton could not bring to the rounding of
    double-double is not converged, and its numbers are as good as its residual. `chart_forces`
    (charts, 2, rows), in kernel units, are what would have to act along a chart's coordinates for
    its accelerations: M u'' + r in docs/numerics.md, zero along a free motion.
    """

    states: Floats
    outputs: Floats | None
    first: Floats | None
    second: Floats | None
    residual: Floats
    correction: Floats
    power_error: Floats | None
    flags: NDArray[np.uint8]
    loads: Floats | None = None
    undefined: NDArray[np.uint8] | None = None
    chart_forces: Floats | None = None

    @property
    def good(self) -> NDArray[np.bool_]:
        """Rows that are closed."""
        return np.equal(self.flags, RowFlag.GOOD)


def run_precise(
    plan: Plan,
    inputs: Floats,
    guess: Floats,
    *,
    rates: Floats | None = None,
    accelerations: Floats | None = None,
    ties: Floats | None = None,
    jerks: Floats | None = None,
    turned: Floats | None = None,
    whole: Floats | None = None,
    full: Floats | None = None,
    time: Floats | None = None,
    demand: Demand = Demand.POSITION,
    outputs: Outputs | None = None,
    constants: Floats | None = None,
    output_constants: Floats | None = None,
    derivatives: bool = False,
    chart: Chart | None = None,
    shift: int = 0,
    iterations: int = tolerances.NEWTON_ITERATIONS,
    tests: tuple[float, float, float] = PRECISE_TESTS,
    lanes: int = 0,
    threads: int = 0,
) -> PreciseBatch:
    """Closes all rows from their guesses and computes what is demanded.

    Args as those of `solver.batch.run`, numbers in two parts, and besides:
        guess: states (states, rows) of a run in doubles.
        demand: without the condition, which that run tells.
        constants: (constants, 2) of the plan, as `solver.precise.Precise.constants`; None for the
            plan's own, which are doubles.
        output_constants: (constants, 2) of the outputs, likewise.

    Raises:
        ValueError: shapes, codes or numbers that do not fit the plan or each other.
    """
    rows = inputs.shape[-1]
    low = low_outputs = None
    if constants is not None:
        plan, low = plan.with_constants(constants[:, 0].copy()), constants[:, 1].copy()
    if outputs is not None and output_constants is not None:
        outputs = outputs.with_constants(output_constants[:, 0].copy())
        low_outputs = output_constants[:, 1].copy()

    def empty(*shape: int) -> Floats:
        return np.empty((*shape, 2, rows))

    states = empty(plan.states)
    values = None if outputs is None else empty(outputs.slots)
    moving, second_order = demand & Demand.VELOCITY, demand & Demand.ACCELERATION
    first = empty(plan.columns) if derivatives and moving else None
    second = empty(plan.columns) if derivatives and second_order else None
    residual, correction = empty(), empty()
    power_error = empty() if demand & Demand.POWER else None
    flags = np.empty(rows, dtype=np.uint8)
    varying = plan.load_values and demand & Demand.FORCES
    loads = empty(plan.load_values) if varying else None
    undefined = np.empty(rows, dtype=np.uint8) if varying else None
    charted = NO_CHART if chart is None else chart.arguments(demand)
    chart_forces = empty(plan.charts) if chart is not None and demand & Demand.FORCES else None
    plan.run_precise(
        inputs=in_parts(inputs, 1),
        guess=in_parts(guess, 1),
        rates=in_parts(rates, 1),
        accelerations=in_parts(accelerations, 1),
        jerks=in_parts(jerks, 1),
        ties=in_parts(ties, 1),
        turned=in_parts(turned, 1),
        whole=in_parts(whole, 1),
        chart=in_parts(charted.directions, 1),
        friction_told=in_parts(charted.friction_told, 1),
        chart_rates=in_parts(charted.rates, 1),
        chart_accelerations=in_parts(charted.accelerations, 1),
        full=in_parts(full, 1),
        time=in_parts(time, 0),
        outputs=outputs,
        low=low,
        low_outputs=low_outputs,
        states=states,
        values=values,
        first=first,
        second=second,
        residual=residual,
        correction=correction,
        power_error=power_error,
        loads=loads,
        undefined=undefined,
        chart_forces=chart_forces,
        flags=flags,
        demand=int(demand),
        shift=shift,
        iterations=iterations,
        tests=tests,
        lanes=width(lanes),
        threads=threads_for(rows, threads),
    )
    measured = (residual, correction, power_error)
    acting = (loads, undefined, chart_forces)
    return PreciseBatch(states, values, first, second, *measured, flags, *acting)


def in_parts(array: Floats | None, dimensions: int) -> Floats | None:
    """Numbers in two parts: those that are given so, or doubles, of `dimensions` beside their rows,
    with zero for their low parts."""
    if array is None:
        return None
    given: Floats = np.ascontiguousarray(array, np.float64)
    if given.ndim == dimensions + 2:
        return given
    return np.ascontiguousarray(np.stack([given, np.zeros_like(given)], axis=-2))
