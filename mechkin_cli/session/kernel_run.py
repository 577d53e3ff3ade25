"""One call of the kernel over many rows, in doubles or in double-double (about 32 digits).

In double-double Newton starts from converged doubles and goes on to the rounding of double-double;
nothing is judged and no branch is followed. Its numbers have two parts, high and low, whose sum
they are: arrays are (numbers, 2, rows), or (2, rows) for one number a row.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.functions import threads_for, width
from mechkin_cli.plan import Demand, RowFlag
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from mechkin_cli.kernel._kernel import Outputs, Plan
    from mechkin_cli.plan import Readout
    from mechkin_cli.show import Floats


if TYPE_CHECKING:
    Numbered = TypeVar("Numbered", Plan, Outputs)
    _Charted = tuple[Floats | None, Floats | None, Floats | None, Floats | None]

RESIDUAL_TESTS = (
    tolerances.RESIDUAL_TIGHT,
    tolerances.STEP_COARSE,
    tolerances.RESIDUAL_ACCEPT,
)
PRECISE_TESTS = (
    tolerances.PRECISE_RESIDUAL_TIGHT,
    tolerances.PRECISE_STEP_COARSE,
    tolerances.PRECISE_RESIDUAL_ACCEPT,
)
_VELOCITY, _ACCELERATION, _JERK, _FORCES = (
    int(part) for part in (Demand.VELOCITY, Demand.ACCELERATION, Demand.JERK, Demand.FORCES)
)
_CONDITION, _POWER = int(Demand.CONDITION), int(Demand.POWER)
_GOOD = int(RowFlag.GOOD)


class Chart(NamedTuple):
    """Directions (charts * columns, rows) of a chart about each row's guess, the rates and
    accelerations (charts, rows) of its coordinates, and what the motion tells of friction (numbers,
    rows), as the kernel's `FrictionTold`: of what sticks, and of what just starts to slip."""

    direction: Floats
    rates: Floats
    accelerations: Floats
    friction: Floats

    def at(self, rows: NDArray[np.intp] | Sequence[int] | slice) -> Chart:
        """Some of the rows."""
        return Chart(*(array[..., rows] for array in self))


_NO_CHART = (None, None, None, None)


class RowInputs(NamedTuple):
    """What a run is given for its rows; the last axis of every array is over rows.

    In double-double each may have two parts, and time must. What is not demanded is not read.

    Attributes:
        inputs: (inputs, rows), rad and length units, without whole turns.
        guess: (states, rows); in double-double the states of a run in doubles.
        rates: (inputs, rows), needed for velocities.
        accelerations: (inputs, rows), needed for accelerations.
        jerks: (inputs, rows), needed for third derivatives.
        constraint_rates: rates of inputs by those that lead them (constraints, rows), needed for
            forces where there are any.
        turned: (turn slots, rows) as the kernel's `closing_turns` has them; springs on angles and
            laws of loads go by them.
        whole: (inputs, rows) whole turns that the inputs are without, likewise.
        full: (inputs, rows) the inputs with their whole turns, which laws of loads read.
        time: (rows,) s, likewise.
        chart: of a plan with one.
        origin: (states, rows) that the chart is about, where that is not the guess; in doubles.
        place: (charts, rows) its coordinates there; None: zero.
        limit: (rows,) the largest correction that a guess may need; `Batch.all_closed` goes by it.
    """

    inputs: Floats
    guess: Floats
    rates: Floats | None = None
    accelerations: Floats | None = None
    jerks: Floats | None = None
    constraint_rates: Floats | None = None
    turned: Floats | None = None
    whole: Floats | None = None
    full: Floats | None = None
    time: Floats | None = None
    chart: Chart | None = None
    origin: Floats | None = None
    place: Floats | None = None
    limit: Floats | None = None

    def at(self, rows: NDArray[np.intp] | Sequence[int]) -> RowInputs:
        """Some of the rows, in this order."""
        parts: Any = (
            part if part is None else part.at(rows) if isinstance(part, Chart) else part[..., rows]
            for part in self
        )
        return RowInputs(*parts)


class Ask(NamedTuple):
    """What a run is asked for.

    Attributes:
        demand: what to compute beyond positions; the condition in doubles alone.
        readout: quantities to write, of a plan of the same structure.
        derivatives: return the columns' first and second derivatives, as far as they are demanded.
        shift: 1 or 2 adds a fixed part of the null space to reactions that are not unique.
        iterations: Newton steps at most.
        tests: residual tests (tight, coarse, accept); None: those of the numbers.
        only: the one block that is closed; the unknowns of the others stay as guessed and their
            loops are not looked at. For positions and the condition alone, in doubles.
        balance: return what would have to act along a chart, with forces, and the turns of cut
            joints, with accelerations; in double-double the former is always returned.
    """

    demand: Demand = Demand.POSITION
    readout: Readout | None = None
    derivatives: bool = False
    shift: int = 0
    iterations: int = tolerances.NEWTON_ITERATIONS
    tests: tuple[float, float, float] | None = None
    only: int | None = None
    balance: bool = False


POSITIONS = Ask()


class PreciseConstants(NamedTuple):
    """The constants (constants, 2) of a run in double-double, of its `plan` and of its `outputs`,
    as `session.Precise` gives them; None: the doubles that they have."""

    plan: Floats | None = None
    outputs: Floats | None = None


class Batch(NamedTuple):
    """What the kernel found, row by row; arrays over rows, or (columns, rows); in double-double
    with two parts each.

    `states` and `outputs` as planned; `first` and `second` are the derivatives of the columns
    (lengths in the kernel's unit); `correction` is the largest change of an unknown against its
    guess; `side` (blocks, rows) are the signs of the square blocks' determinants where more than
    positions was demanded; `flags` (rows,) are `RowFlag`s; `loads` (values, rows) are those of
    loads that vary, in the kernel's units, and `undefined` (rows,) tells rows in which one has
    none; `chart_forces` (charts, rows), in kernel units, are what would have to act along a chart's
    coordinates for its accelerations: M u'' + r in docs/numerics.md, zero along a free motion;
    `turns` (turn slots, rows) are angles within a turn and orientations of cut joints, of either
    sign; what was not asked for is None. `all_closed` tells, where rows have limits and more than
    positions was demanded, that each closed within its own, on one side of every fold and with a
    condition that leaves digits enough: nothing is to be judged row by row.

    In double-double there is no `condition`, no `side` and no `turns`; a row that Newton could not
    bring to the rounding of double-double is not converged, and its numbers are as good as its
    residual.
    """

    states: Floats
    outputs: Floats | None
    first: Floats | None
    second: Floats | None
    residual: Floats
    correction: Floats
    side: Floats | None
    condition: Floats | None
    power_error: Floats | None
    flags: NDArray[np.uint8]
    loads: Floats | None = None
    undefined: NDArray[np.uint8] | None = None
    chart_forces: Floats | None = None
    turns: Floats | None = None
    all_closed: bool = False

    @property
    def good(self) -> NDArray[np.bool_]:
        """Rows that are closed."""
        return np.equal(self.flags, _GOOD)


def run(
    plan: Plan,
    rows: RowInputs,
    ask: Ask = POSITIONS,
    constants: PreciseConstants | None = None,
    *,
    lanes: int = 0,
    threads: int = 0,
) -> Batch:
    """Closes all rows from their guesses and computes what is asked for.

    Args:
        plan: the kernel's plan.
        rows: what is given for each row.
        ask: what is asked for.
        constants: run in double-double with these; None: in doubles.
        lanes: width of the packs, 0 for the widest; the results do not depend on it.
        threads: how many split the rows, 0 for as many as pay; the results do not depend on it.

    Raises:
        ValueError: shapes, codes or numbers that do not fit the plan or each other.
    """
    inputs, guess, rates, accelerations, jerks, transmitted = rows[:6]
    turned, whole, full, time, chart, origin, place, limit = rows[6:]
    count = inputs.shape[-1]
    demand = int(ask.demand)  # flags of an enumeration are slow, and short calls are many
    outputs = None if ask.readout is None else ask.readout.outputs
    call: Callable[..., object] = plan.run
    turns: Floats | None = None
    if constants is None:
        given, tests = _contiguous, RESIDUAL_TESTS
        shape: tuple[int, ...] = (count,)
        # signs are told with a demand, of the blocks that are closed
        told = demand and ask.only is None
        blocks = (plan.blocks, count)
        side: Floats | None = np.empty(blocks) if told else np.ones(blocks)
        condition = np.empty(count) if demand & _CONDITION else None
        chart_forces: Floats | None = None
        if ask.only is not None:
            call = partial(call, only=ask.only)
        elif ask.balance or origin is not None:
            chart_forces = np.empty((plan.charts, count)) if ask.balance else None
            if ask.balance:
                turns = np.empty((turn_count(plan), count))
            call = partial(
                call,
                chart_origin=given(origin),
                chart_place=given(place),
                chart_forces=chart_forces,
                turn=turns,
            )
        if limit is not None and told:
            most = (tolerances.CONDITION_FEW_DIGITS,)
            call = partial(call, limit=given(limit), most_condition=most)
    else:
        given, tests = _in_parts, PRECISE_TESTS
        shape = (2, count)
        side = condition = None
        forces = chart is not None and demand & _FORCES
        chart_forces = np.empty((plan.charts, *shape)) if forces else None
        low = low_outputs = None
        if constants.plan is not None:
            plan, low = _split(plan, constants.plan)
        if outputs is not None and constants.outputs is not None:
            outputs, low_outputs = _split(outputs, constants.outputs)
        call = partial(
            plan.run_precise, low=low, low_outputs=low_outputs, chart_forces=chart_forces
        )
    moving, accelerating = demand & _VELOCITY, demand & _ACCELERATION
    forced = demand & _FORCES
    charted: _Charted = _NO_CHART if chart is None else chart
    directions, chart_rates, chart_accelerations, friction = charted
    rubbing = forced and friction is not None and friction.size
    varying = plan.load_values if forced else 0
    states = np.empty((plan.states, *shape))
    values = None if outputs is None else np.empty((outputs.slots, *shape))
    first = np.empty((plan.columns, *shape)) if ask.derivatives and moving else None
    second = np.empty((plan.columns, *shape)) if ask.derivatives and accelerating else None
    residual, correction = np.empty(shape), np.empty(shape)
    power_error = np.empty(shape) if demand & _POWER else None
    flags = np.empty(count, dtype=np.uint8)
    loads = np.empty((varying, *shape)) if varying else None
    undefined = np.empty(count, dtype=np.uint8) if varying else None
    # each by name, in the order in which the kernel looks for them: a mapping among the arguments
    # would cost a short call a tenth
    all_closed = call(
        inputs=given(inputs),
        guess=given(guess),
        rates=given(rates) if moving else None,
        accelerations=given(accelerations) if accelerating else None,
        jerks=given(jerks) if demand & _JERK else None,
        constraint_rates=given(transmitted) if forced else None,
        turned=None if turned is None else given(turned),
        whole=None if whole is None else given(whole),
        chart=None if directions is None else given(directions),
        chart_rates=given(chart_rates) if moving else None,
        chart_accelerations=given(chart_accelerations) if accelerating else None,
        friction_told=given(friction) if rubbing else None,
        full=None if full is None else given(full),
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
        flags=flags,
        loads=loads,
        undefined=undefined,
        demand=demand,
        shift=ask.shift,
        iterations=ask.iterations,
        tests=ask.tests or tests,
        lanes=width(lanes),
        threads=threads_for(count, threads),
    )
    measured = (residual, correction, side, condition, power_error)
    acting = (loads, undefined, chart_forces, turns)
    return Batch(states, values, first, second, *measured, flags, *acting, bool(all_closed))


def balance(
    plan: Plan,
    rows: RowInputs,
    free: Sequence[tuple[int, int, float]],
    cyclic: Sequence[int],
    readout: Readout,
    stiffness: Floats | None = None,
    *,
    known: bool = False,
    lanes: int = 0,
    threads: int = 0,
) -> tuple[int, Floats, Floats, Floats]:
    """Places at which the loads balance, each by Newton's steps from a guess of its own: how many,
    from the first one on, come there before one does not, inputs (inputs, places) and states
    (states, places) of all, and slopes (free, free, places) of the efforts before their last step.

    Args:
        plan: the kernel's plan.
        rows: inputs with their whole turns, states, rates by leaders, turns and time of the
            guesses.
        free: inputs that nothing drives: number, slot of the effort along it among the outputs,
            and the effort's unit by that of the input.
        cyclic: inputs that come again after a whole turn.
        readout: with these efforts, N*m or N.
        stiffness: (free, free, places) slopes to go by, nearly those of the places; None: the
            places' own by differences, and places end before their determinant changes its sign.
        known: whether the first place is an equilibrium, which stays.
        lanes: as for `run`.
        threads: as for `run`.

    Raises:
        ValueError: shapes, codes or numbers that do not fit the plan or each other.
    """
    assert rows.turned is not None
    assert rows.time is not None
    count, places = len(free), rows.inputs.shape[-1]
    inputs, states = (np.array(array, np.float64, order="C") for array in rows[:2])
    if stiffness is None:
        slopes, enough = np.empty((count, count, places)), tolerances.EQUILIBRIUM_STEP
    else:
        slopes, enough = np.array(stiffness, order="C"), tolerances.REST_CHORD
    found = plan.balance(
        free=free,
        cyclic=cyclic,
        inputs=inputs,
        states=states,
        stiffness=slopes.reshape(count * count, places),
        turned=np.ascontiguousarray(rows.turned),
        time=np.ascontiguousarray(rows.time),
        constraint_rates=_contiguous(rows.constraint_rates),
        given=int(stiffness is not None),
        known=int(known),
        limits=(
            tolerances.NEWTON_DIFFERENCE,
            tolerances.CHORD_GAIN,
            tolerances.REST_ROUNDING,
            enough,
        ),
        steps=tolerances.MOST_CHORDS,
        outputs=readout.outputs,
        iterations=tolerances.NEWTON_ITERATIONS,
        tests=RESIDUAL_TESTS,
        lanes=width(lanes),
        threads=threads_for(places, threads),
    )
    return found, inputs, states, slopes


def turn_count(plan: Plan) -> int:
    """Number of rows of `Followed.turns`."""
    return sum(width for *_, width in _kernel.closing_turns(plan)) + len(_kernel.tree_turns(plan))


def assembly_size(plan: Plan, inputs: Floats, state: Floats) -> float:
    """Diagonal (m) of the box of all joint points in the assembly at `inputs` (inputs,) near
    `state` (states,); 1 where they coincide."""
    return plan.assembly_size(
        inputs=np.ascontiguousarray(inputs[:, None]),
        guess=np.ascontiguousarray(state[:, None]),
        iterations=tolerances.NEWTON_ITERATIONS,
        tests=RESIDUAL_TESTS,
    )


def _contiguous(array: Floats | None) -> Floats | None:
    return None if array is None else np.ascontiguousarray(array, np.float64)


def _in_parts(array: Floats | None) -> Floats | None:
    """Numbers (numbers, 2, rows): those given so, or doubles with zero for their low parts."""
    if array is None or array.ndim == 3:
        return _contiguous(array)
    return np.ascontiguousarray(np.stack([array, np.zeros_like(array)], axis=-2), np.float64)


def _split(of: Numbered, constants: Floats) -> tuple[Numbered, Floats]:
    """A plan or outputs at the high parts of constants (constants, 2), and the low parts."""
    return of.with_constants(constants[:, 0].copy()), constants[:, 1].copy()
