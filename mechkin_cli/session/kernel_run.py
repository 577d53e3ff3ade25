"""One call of the kernel over many rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel.functions import threads_for, width
from mechkin_cli.plan import Demand, RowFlag

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Any

    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Outputs, Plan
    from mechkin_cli.session.inputs import KernelInputs
    from mechkin_cli.session.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep import SweepRows


RESIDUAL_TESTS = (
    tolerances.RESIDUAL_TIGHT,
    tolerances.STEP_COARSE,
    tolerances.RESIDUAL_ACCEPT,
)
_VELOCITY, _ACCELERATION, _FORCES = (
    int(part) for part in (Demand.VELOCITY, Demand.ACCELERATION, Demand.FORCES)
)
_CONDITION, _POWER = int(Demand.CONDITION), int(Demand.POWER)


class ChartArguments(NamedTuple):
    """What a run is told of a chart, as far as it is demanded."""

    directions: Floats | None = None
    friction_told: Floats | None = None
    rates: Floats | None = None
    accelerations: Floats | None = None


NO_CHART = ChartArguments()


class Chart(NamedTuple):
    """Directions (charts * columns, rows) of a chart about each row's guess, the rates and
    accelerations (charts, rows) of its coordinates, and what the motion tells of friction (numbers,
    rows), as the kernel's `FrictionTold`: of what sticks, and of what just starts to slip."""

    direction: Floats
    rates: Floats
    accelerations: Floats
    friction: Floats

    def at(self, rows: NDArray[np.intp] | slice) -> Chart:
        """Some of the rows."""
        return Chart(*(array[:, rows] for array in self))

    def arguments(self, demand: Demand) -> ChartArguments:
        """As `Plan.run` takes them."""
        told = self.friction.size and demand & Demand.FORCES
        return ChartArguments(
            _contiguous(self.direction),
            _contiguous(self.friction) if told else None,
            _contiguous(self.rates) if demand & Demand.VELOCITY else None,
            _contiguous(self.accelerations) if demand & Demand.ACCELERATION else None,
        )


class Batch(NamedTuple):
    """What the kernel found, row by row; arrays over rows, or (columns, rows).

    `states` and `outputs` as planned; `first` and `second` are the derivatives of the columns
    (lengths in the kernel's unit); `correction` is the largest change of an unknown against its
    guess; `side` (blocks, rows) are the signs of the square blocks' determinants where more than
    positions was demanded; `flags` are `RowFlag`s; `loads` (values, rows) are those of loads
    that vary, in the kernel's units, and `undefined` tells rows in which one has none; what was not
    asked for is None.
    """

    states: Floats
    outputs: Floats | None
    first: Floats | None
    second: Floats | None
    residual: Floats
    correction: Floats
    side: Floats
    condition: Floats | None
    power_error: Floats | None
    flags: NDArray[np.uint8]
    loads: Floats | None = None
    undefined: NDArray[np.uint8] | None = None

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
    ties: Floats | None = None,
    jerks: Floats | None = None,
    turned: Floats | None = None,
    whole: Floats | None = None,
    full: Floats | None = None,
    time: Floats | None = None,
    demand: Demand = Demand.POSITION,
    outputs: Outputs | None = None,
    derivatives: bool = False,
    chart: Chart | None = None,
    shift: int = 0,
    iterations: int = tolerances.NEWTON_ITERATIONS,
    tests: tuple[float, float, float] = RESIDUAL_TESTS,
    only: int | None = None,
    lanes: int = 0,
    threads: int = 0,
) -> Batch:
    """Closes all rows from their guesses and computes what is demanded.

    Args:
        plan: the kernel's plan.
        inputs: (inputs, rows), rad and length units; `rates`, `accelerations` likewise.
        guess: (states, rows).
        rates: needed for velocities.
        accelerations: needed for accelerations.
        jerks: needed for third derivatives.
        ties: rates of tied inputs by those of their leaders (ties, rows), needed for forces where
            there are any.
        turned: (turn slots, rows) as `solver.closing_turns` has them; springs on angles and laws of
            loads go by them.
        whole: (inputs, rows) whole turns that the inputs are without, likewise.
        chart: of a plan with one.
        full: (inputs, rows) the inputs with their whole turns, which laws of loads read.
        time: (rows,) s, likewise.
        demand: what to compute beyond positions.
        outputs: quantities to write, of a plan of the same structure.
        derivatives: return the columns' first and second derivatives, as far as they are demanded.
        shift: 1 or 2 adds a fixed part of the null space to reactions that are not unique.
        iterations: Newton steps at most.
        tests: residual tests (tight, coarse, accept).
        only: the one block that is closed; the unknowns of the others stay as guessed and their
            loops are not looked at. For positions and the condition alone.
        lanes: width of the packs, 0 for the widest; the results do not depend on it.
        threads: how many split the rows, 0 for as many as pay; the results do not depend on it.

    Raises:
        ValueError: shapes, codes or numbers that do not fit the plan or each other.
    """
    rows = inputs.shape[1]
    asked = int(demand)  # flags of an enumeration are slow, and short calls are many
    states = np.empty((plan.states, rows))
    values = None if outputs is None else np.empty((outputs.slots, rows))
    first = np.empty((plan.columns, rows)) if derivatives and asked & _VELOCITY else None
    second = np.empty((plan.columns, rows)) if derivatives and asked & _ACCELERATION else None
    residual, correction = np.empty(rows), np.empty(rows)
    # signs are told with a demand, of the blocks that are closed
    told = asked and only is None
    side = np.empty((plan.blocks, rows)) if told else np.ones((plan.blocks, rows))
    condition = np.empty(rows) if asked & _CONDITION else None
    power_error = np.empty(rows) if asked & _POWER else None
    flags = np.empty(rows, dtype=np.uint8)
    varying = plan.load_values if asked & _FORCES else 0
    loads = np.empty((plan.load_values, rows)) if varying else None
    undefined = np.empty(rows, dtype=np.uint8) if varying else None
    charted = NO_CHART if chart is None else chart.arguments(demand)
    # each by name: a mapping among the arguments would cost a short call a tenth
    plan.run(
        inputs=_contiguous(inputs),
        guess=_contiguous(guess),
        rates=None if rates is None else _contiguous(rates),
        accelerations=None if accelerations is None else _contiguous(accelerations),
        jerks=None if jerks is None else _contiguous(jerks),
        ties=None if ties is None else _contiguous(ties),
        turned=None if turned is None else _contiguous(turned),
        whole=None if whole is None else _contiguous(whole),
        chart=charted.directions,
        friction_told=charted.friction_told,
        chart_rates=charted.rates,
        chart_accelerations=charted.accelerations,
        full=None if full is None else _contiguous(full),
        time=None if time is None else _contiguous(time),
        outputs=outputs,
        states=states,
        values=values,
        first=first,
        second=second,
        residual=residual,
        correction=correction,
        side=side,
        condition=condition,
        power_error=power_error,
        loads=loads,
        undefined=undefined,
        flags=flags,
        demand=asked,
        shift=shift,
        iterations=iterations,
        tests=tests,
        only=only,
        lanes=width(lanes),
        threads=threads_for(rows, threads),
    )
    measured = (residual, correction, side, condition, power_error)
    return Batch(states, values, first, second, *measured, flags, loads, undefined)


def assembly_size(plan: Plan, inputs: Floats, state: Floats) -> float:
    """Diagonal (m) of the box of all joint points in the assembly at `inputs` (inputs,) near
    `state` (states,); 1 where they coincide."""
    return plan.assembly_size(
        inputs=np.ascontiguousarray(inputs[:, None]),
        guess=np.ascontiguousarray(state[:, None]),
        iterations=tolerances.NEWTON_ITERATIONS,
        tests=RESIDUAL_TESTS,
    )


def _contiguous(array: Floats) -> Floats:
    return np.ascontiguousarray(array, np.float64)


# Places of a motion as the kernel takes them: all that a run is told beside what it is to find.


class RowPlaces(NamedTuple):
    """Arguments of `Session.run` by their names there, the last axis of each over places."""

    inputs: Floats
    guess: Floats
    rates: Floats | None
    accelerations: Floats | None
    jerks: Floats | None
    turned: Floats
    whole: Floats
    full: Floats
    time: Floats | None
    ties: Floats | None

    @classmethod
    def of(
        cls,
        own: Session,
        rows: SweepRows,
        inputs: KernelInputs,
        demand: Demand,
        ties: Floats | None,
    ) -> RowPlaces:
        """The rows of a run of the session `own` on their states, with rates of `inputs` as far as
        they are demanded."""
        moments = own.problem.motion.time
        return cls(
            inputs=inputs.reduced,
            guess=rows.states,
            rates=inputs.rates if demand & Demand.VELOCITY else None,
            accelerations=inputs.accelerations if demand & Demand.ACCELERATION else None,
            jerks=inputs.jerks if demand & Demand.JERK else None,
            turned=rows.turns,
            whole=own.inputs.whole,
            full=own.inputs.values,
            time=None if moments is None else moments.values,
            ties=ties if demand & Demand.FORCES else None,
        )

    def at(self, numbers: NDArray[np.intp] | Sequence[int]) -> RowPlaces:
        """Some of the places, in this order."""
        parts: Any = (None if part is None else part[..., numbers] for part in self)
        return RowPlaces(*parts)

    @property
    def arguments(self) -> dict[str, Any]:
        """As `Session.run` takes them."""
        return self._asdict()
