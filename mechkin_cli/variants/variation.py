"""A session under varied parameters: its plan, outputs and inputs as tapes.

Constants of plan and outputs, and the inputs where they depend on a parameter, are replayed; graph,
structure and length unit stay the base's. A variant starts from the base's first assembly, along
the straight line in the parameters (kernel/core/stepping/variants.hpp).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.expressions import Quantity
from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel._kernel import VariantEnd
from mechkin_cli.kernel.functions import width
from mechkin_cli.kernel.plan_text import Record, plan_text
from mechkin_cli.mechanism import Problem
from mechkin_cli.plan import Demand, Layout, OutputPlan, Readout, flatten, plan_records
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.session import (
    Continued,
    KernelInputs,
    Session,
    Structure,
    angle_slots,
    kernel_inputs,
    step_limits,
    step_numbers,
)
from mechkin_cli.structure import graph_of, structure_of
from mechkin_cli.tape import (
    Filling,
    GivenRows,
    Recorder,
    Tape,
    Verdict,
    compiled,
    is_traced,
    register,
    replay,
    tape_values,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.show import Floats


class Runs(NamedTuple):
    """Variants by the kernel: outputs (variants, slots, rows) in SI, residual and condition
    (variants, rows), and how each ended, codes of the kernel's `VariantEnd`; nan where not
    complete."""

    outputs: Floats
    residual: Floats
    condition: Floats
    end: NDArray[np.int32]


class VariantReadout:
    """Some quantities of all variants: where they stand, and the kernel's runs of them."""

    def __init__(self, variation: SessionVariation, wanted: tuple[Wanted, ...]) -> None:
        base, layout = variation.base, variation.layout
        self.variation = variation
        self.readout = base.readout(wanted)
        plan = OutputPlan(layout, base.plan, base.driven)
        for quantity in wanted:
            plan.add(quantity)
        constants = [*variation.constants, *flatten(plan.records)]
        self.recorded = variation.recorded_tape([*constants, *variation.moving_inputs])
        self.tape = compiled(self.recorded)
        self.first = len(variation.constants)
        self.last = len(constants)

    @property
    def slots(self) -> Mapping[str, slice]:
        """Where each quantity stands among the outputs."""
        return self.readout.slots

    def outputs(self, values: Floats) -> _kernel.Outputs:
        """What a run of one variant writes."""
        constants = replay(self.tape, self.variation.inputs_of(values[:, None]))[0][0]
        return self.readout.outputs.with_constants(constants[self.first : self.last])

    def text(self, demand: Demand) -> str:
        """What a run of variants rests on, for the core without Python (kernel/plan_text.py)."""
        variation = self.variation
        first = variation.state, variation.row, variation.size
        return plan_text(*self.parts(), self.start_records(demand, first))

    def start_records(self, demand: Demand, first: tuple[Floats, int, float]) -> list[Record]:
        """What a run of variants has in common, with the assembly that they are continued from:
        states at a row, the row, and the mechanism's size there in m."""
        variation = self.variation
        state, row, size = first
        base, time = variation.base, variation.base.problem.motion.time
        inputs = base.inputs
        arrays = (inputs.reduced, inputs.rates, inputs.accelerations, inputs.jerks, inputs.whole)
        limits = (
            step_numbers(tolerances.LONGEST_DIMENSION_STEP),
            step_numbers(straight=base.problem.assembly.straight),
        )
        values = [
            variation.values.tolist(),
            *(array.ravel().tolist() for array in (*arrays, inputs.values)),
            [] if time is None else time.values.tolist(),
            state.tolist(),
            float(size),
            base.problem.motion.rows,
            row,
            int(demand),
            tolerances.NEWTON_ITERATIONS,
            *([float(number) for number in numbers.values()] for numbers in limits),
            [(slot, turn, int(of)) for slot, turn, of in angle_slots(base, self.slots)],
            float(tolerances.HALF_TURN_SIDE),
        ]
        records: list[Record] = [("variants", values)]
        for step in (1, -1) if base.route is not None else ():
            way = base.route.way(row, step)  # type: ignore[union-attr]
            records.append(("way", (step, way.rows.tolist(), way.values.ravel().tolist())))
            if way.course is not None:
                records.append(("course", way.course_values))
        return records

    def parts(self) -> tuple[Sequence[Record], Sequence[Sequence[Any]], Sequence[Any]]:
        """The plan, its outputs and the tape of their constants, as `plan_text` takes them."""
        base = self.variation.base
        calls: list[Record] = [
            ("plan" if call == "units" else call, arguments)
            for call, arguments in plan_records(base.layout, self.variation.size)
        ]
        plan = OutputPlan(base.layout, None, base.driven)
        for quantity in self.readout.wanted:
            plan.add(quantity)
        return calls, plan.records, tape_values(self.recorded)

    @property
    def base(self) -> Session:
        """The session with the file's own parameters."""
        return self.variation.base

    def runs(self, demand: Demand) -> _kernel.Variants:
        """The kernel's variants of this reading."""
        variation = self.variation
        base = variation.base
        moments = base.problem.motion.time
        return _kernel.Variants(
            tape=self.tape,
            plan=base.plan,
            outputs=self.readout.outputs,
            parameters=variation.values,
            inputs=base.inputs.reduced,
            whole=base.inputs.whole,
            full=base.inputs.values,
            time=np.empty(0) if moments is None else moments.values,
            rates=base.inputs.rates,
            accelerations=base.inputs.accelerations,
            jerks=base.inputs.jerks,
            state=np.ascontiguousarray(variation.state),
            size=variation.size,
            start_row=variation.row,
            demand=int(demand),
            iterations=tolerances.NEWTON_ITERATIONS,
            continuation=step_limits(tolerances.LONGEST_DIMENSION_STEP),
            following=step_limits(straight=base.problem.assembly.straight),
            angles=angle_slots(base, self.slots),
            half_turn_side=tolerances.HALF_TURN_SIDE,
            ways=_ways(base, variation.row),
        )


def _ways(base: Session, row: int) -> list[tuple[int, list[int], Floats, _kernel.Course | None]]:
    """The course of the inputs on and back from a row, where they have one."""
    if base.route is None:
        return []
    ways = [(step, base.route.way(row, step)) for step in (1, -1)]
    return [(step, way.rows.tolist(), way.values, way.course) for step, way in ways]


class Recording:
    """How a file's problem, and the constants of its plan, depend on some parameters.

    Values of parameters are (parameters, variants) or of one variant (parameters,), in SI.

    Args:
        base: the session with the values that it was recorded with.
        recorder: that holds the parameters as inputs.
        problem: the session's problem with recorded numbers.
        moves: whether its motion is recorded, too: else it has the plan alone.

    Raises:
        TraceLost: the plan depends on a parameter in a way that no tape holds.
    """

    def __init__(
        self, base: Session, recorder: Recorder, problem: Problem, *, moves: bool = True
    ) -> None:
        self.moves = moves
        self.base = base
        self.recorder = recorder
        self.recorded = problem
        self.values = np.array(recorder.values_given)
        self.count = len(self.values) - sum(given.rows for given in recorder.given_rows)
        self.layout = Layout(
            problem.laid_mechanism,
            graph_of(problem.solved_mechanism, base.graph),
            base.layout.length,
            problem.laws,
        )
        self.constants = flatten(plan_records(self.layout))
        inputs = kernel_inputs(problem, self.layout).orders
        moving = any(map(is_traced, inputs))
        self.moving_inputs = [x for table in inputs for x in table.flat] if moving else []
        self._parts: dict[tuple[object, ...], Recording] = {}

    def part(self, make: Callable[[Session], Problem], length: float) -> Recording:
        """The recording of the problem that follows from this session's, as `Session.derived`, in
        a length unit (m).

        Raises:
            TraceLost: as above.
        """
        with self.recorder.lock:
            problem = make(replace(self.base, problem=self.recorded))
            mechanism = problem.mechanism
            key = tuple(mechanism.joints), tuple(mechanism.links), length
            if key not in self._parts:
                base = self.base.derived(make).measured_in(length)
                self._parts[key] = Recording(base, self.recorder, problem, moves=self.moves)
            return self._parts[key]

    def tape(self, numbers: Iterable[Any]) -> _kernel.Tape:
        """The tape from the inputs to some numbers of the recording."""
        return compiled(self.recorded_tape(numbers))

    def recorded_tape(self, numbers: Iterable[Any]) -> Tape:
        """The same as plain data."""
        with self.recorder.lock:
            return self.recorder.tape(register(self.recorder, n) for n in numbers)

    def inputs_of(self, values: Floats) -> Floats:
        """The tape's inputs (inputs, variants) with some parameters; nan, which no guard passes,
        where there are not as many rows as were recorded."""
        if not self.recorder.given_rows:
            return values
        found = self._with_recorded_rows(values)
        for given, tape in self._row_tapes:
            numbers = replay(tape, found)[0]
            rows = found[given.first : given.first + given.rows]
            known: dict[bytes, Floats] = {}
            for column, own in enumerate(numbers):
                key = own.tobytes()
                if key not in known:
                    known[key] = given.compute(*own.tolist())
                fits = known[key].size == given.rows
                rows[:, column] = known[key] if fits else np.nan
        return found

    def other_rows(self, values: Floats) -> int | None:
        """How many rows one variant has, where its inputs have others than were recorded and all
        else is as recorded; None where it has as many, or this does not tell."""
        own = self.base.problem.motion
        moving = [one for one in own.inputs if np.ptp(one.written) > 0.0]
        if len(moving) != len(self.recorder.given_rows) or self.plan_constants(values) is None:
            return None
        found = self._with_recorded_rows(values[:, None])
        counts = {
            given.compute(*replay(tape, found)[0][0].tolist()).size
            for given, tape in self._row_tapes
        }
        count = counts.pop() if len(counts) == 1 else 0
        return count if count not in (0, own.rows) else None

    def _with_recorded_rows(self, values: Floats) -> Floats:
        rows = np.repeat(self.values[self.count :, None], values.shape[1], axis=1)
        return np.vstack([values, rows])

    @cached_property
    def _row_tapes(self) -> list[tuple[GivenRows, _kernel.Tape]]:
        found = []
        with self.recorder.lock:
            for given in self.recorder.given_rows:
                numbers = [register(self.recorder, number) for number in given.numbers]
                found.append((given, compiled(self.recorder.tape(numbers, guarded=False))))
        return found

    def verdicts(self, values: Floats) -> NDArray[np.uint8]:
        """The guards' verdicts on parameters (parameters, variants)."""
        return replay(self._plan_tape, self.inputs_of(values))[1]

    @cached_property
    def _plan_tape(self) -> _kernel.Tape:
        return self.tape([*self.constants, *self.moving_inputs])

    def plan_constants(self, values: Floats) -> Floats | None:
        """The plan's constants with the parameters of one variant, however many rows it has; None
        where a guard fails."""
        inputs = values[:, None]
        if self.recorder.given_rows:
            inputs = self._with_recorded_rows(inputs)
        numbers, verdicts = replay(self._plan_tape, inputs)
        holds = verdicts[0] != Verdict.OTHER_WAY
        return numbers[0][: len(self.constants)] if holds else None

    def orders(self, values: Floats) -> dict[str, tuple[Floats, Floats]]:
        """As `DrivenInput.orders` of all inputs: (variants, rows) where they depend on parameters,
        else (rows,)."""
        found = {}
        tape, numbers = self._orders_tape, self._orders
        moved = iter(()) if tape is None else iter(replay(tape, self.inputs_of(values))[0].T)
        for name, both in numbers.items():
            found[name] = tuple(
                np.array([next(moved) for _ in range(one.size)]).T if is_traced(one) else one
                for one in both
            )
        return found  # type: ignore[return-value]

    @cached_property
    def _orders(self) -> dict[str, tuple[Floats, Floats]]:
        inputs = self.recorded.motion.inputs
        return {name: both for driven in inputs for name, both in driven.orders.items()}

    @cached_property
    def _orders_tape(self) -> _kernel.Tape | None:
        numbers = [
            x for both in self._orders.values() for one in both if is_traced(one) for x in one.flat
        ]
        # one that is not recorded stands among others that are
        return self.tape(numbers) if numbers else None

    @property
    def moves_limits(self) -> bool:
        """Whether the limits of coordinates depend on the parameters."""
        return any(is_traced(end) for one in self.recorded.limits for end in (one.low, one.high))

    @cached_property
    def _parameter_tape(self) -> _kernel.Tape:
        return self.tape(q.value for q in self.recorded.parameters.values())

    @cached_property
    def _mechanism_tape(self) -> _kernel.Tape:
        return self.tape(self._mechanism.numbers)

    @cached_property
    def _mechanism(self) -> Filling:
        problem = self.recorded
        return Filling((problem.mechanism, problem.assembly, problem.motion, problem.limits))

    def parameters(self, values: Floats) -> Floats:
        """All parameters of the file (parameters, variants), in the file's order."""
        return np.asarray(replay(self._parameter_tape, self.inputs_of(values))[0].T)

    def problem(self, values: Floats) -> Problem:
        """The problem of one variant, as building it would give it."""
        inputs = self.inputs_of(values[:, None])
        numbers = replay(self._parameter_tape, inputs)[0][0].tolist()
        parameters = {
            name: Quantity(number, quantity.dimension)
            for (name, quantity), number in zip(
                self.recorded.parameters.items(), numbers, strict=True
            )
        }
        leaves = replay(self._mechanism_tape, inputs)[0][0].tolist()
        mechanism, assembly, motion, limits = self._mechanism.fill(leaves)
        problem = replace(
            self.base.problem,
            mechanism=mechanism,
            assembly=assembly,
            motion=motion,
            limits=limits,
            parameters=parameters,
        )
        return problem.with_quantities_of(self.base.problem)

    def plan(self, values: Floats, size: float) -> _kernel.Plan:
        """The plan of one variant; residual and condition in parts of `size` (m)."""
        constants = replay(self._plan_tape, self.inputs_of(values[:, None]))[0][0]
        count = len(self.constants)
        return self.base.plan.with_constants(constants[:count]).with_size(size)

    def inputs(self, values: Floats) -> KernelInputs:
        """The inputs of one variant."""
        base = self.base.inputs
        if not self.moving_inputs:
            return base
        numbers = replay(self._plan_tape, self.inputs_of(values[:, None]))[0][0]
        orders = numbers[len(self.constants) :].reshape((4, *base.values.shape))
        return KernelInputs.of(self.problem(values), *orders)


class SessionVariation(Recording):
    """How a session depends on some parameters.

    Args:
        base: the session with the file's own parameters.
        first: its first assembly: states at a row, the row, and the mechanism's size there in m.
        recorder: that holds the parameters as inputs.
        problem: the session's problem with recorded numbers.

    Raises:
        TraceLost: as for a `Recording`.
    """

    def __init__(
        self,
        base: Session,
        first: tuple[Floats, int, float],
        recorder: Recorder,
        problem: Problem,
    ) -> None:
        super().__init__(base, recorder, problem)
        self.state, self.row, self.size = first
        self._readings: dict[tuple[str, ...], VariantReadout] = {}

    def reading(self, wanted: Iterable[Wanted]) -> VariantReadout:
        """The reading of some quantities."""
        wanted = tuple(wanted)
        key = tuple(quantity.name for quantity in wanted)
        with self.recorder.lock:
            if key not in self._readings:
                self._readings[key] = VariantReadout(self, wanted)
            return self._readings[key]


def run_variants(
    variants: _kernel.Variants, inputs: Floats, lanes: int = 0, threads: int = 1
) -> Runs:
    """Runs inputs of the tape (inputs, variants), `Recording.inputs_of` parameters."""
    values = np.ascontiguousarray(inputs, dtype=np.float64)
    return Runs(*variants.run(values, width(lanes), threads))


def varied_session(variation: SessionVariation, values: Floats, problem: Problem) -> Session:
    """The session of a variant whose first assembly is continued from the base's.

    Args:
        variation: how the base depends on the parameters.
        values: (parameters,) of the variant, in SI.
        problem: its problem.
    """
    base = variation.base
    graph = graph_of(problem.solved_mechanism, base.graph)
    inputs = variation.inputs_of(values[:, None])[:, 0]
    end, size, state = variation.reading(()).runs(Demand.POSITION).start(inputs)
    lost = end != VariantEnd.COMPLETE
    structure = Structure(
        Layout(problem.laid_mechanism, graph, base.layout.length, problem.laws),
        base.driven,
        base.closed_at,
        built=variation.plan(values, variation.size if lost else size),
        varied=partial(_varied_readout, variation, values),
    )
    return Session(
        problem,
        structure,
        first=Continued(None if lost else np.asarray(state), variation.row),
        size=variation.size if lost else size,
        packing=base.packing,
        own_inputs=variation.inputs(values),
    )


def varied_response(variation: SessionVariation, values: Floats, built: Session) -> Session | None:
    """The session at the first moment of a response with other parameters, its first assembly
    continued from the base's; None where the branch ends on the way, or the loops are solved in
    another way.

    Args:
        variation: how the base depends on the parameters.
        values: (parameters,) of the variant, in SI.
        built: the session of the file with these parameters.
    """
    base, problem = variation.base, built.problem
    if structure_of(built.graph) != structure_of(base.graph):
        return None
    if variation.verdicts(values[:, None])[0] == Verdict.OTHER_WAY:
        return None
    inputs = variation.inputs_of(values[:, None])[:, 0]
    end, size, state = variation.reading(()).runs(Demand.POSITION).start(inputs)
    if end != VariantEnd.COMPLETE:
        return None
    graph = graph_of(problem.solved_mechanism, base.graph)
    layout = Layout(problem.laid_mechanism, graph, base.layout.length, problem.laws)
    structure = Structure(layout, base.driven, base.closed_at)
    first = Continued(np.asarray(state), variation.row)
    return replace(built, structure=structure, first=first, size=size)


def _varied_readout(
    variation: SessionVariation, values: Floats, wanted: tuple[Wanted, ...]
) -> Readout:
    """Outputs whose constants are replayed."""
    reading = variation.reading(wanted)
    return reading.readout._replace(outputs=reading.outputs(values))
