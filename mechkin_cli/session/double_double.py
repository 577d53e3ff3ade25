"""A session's constants as the file's text says them, in double-double and enclosed.

The file is recorded once with all its numbers exact (`building.recording.record_exactly`); the
layout of the session is laid over that recording, and what reaches the kernel is replayed. Tree,
blocks, the choice of frames, length unit and origin are the session's own, in doubles; so is the
size in whose parts residuals are told. They are conventions, not measures.

Where a parameter is shifted by a little (`ShiftingPrecise`), what the constants are computed by is
recorded once; each shift is a replay of that tape in double-double, whose rounding, 1e-32, is far
below what a shift changes.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.exact import double_double, nearest
from mechkin_cli.mechanism import ORDERS, ExactMotion, dimension_of
from mechkin_cli.plan import Layout, OutputPlan, flatten, plan_records
from mechkin_cli.record import NamedTuple, fields, is_dataclass, replace
from mechkin_cli.session.inputs import held_values, turn_of
from mechkin_cli.structure import graph_of
from mechkin_cli.tape import (
    ExactRows,
    NotEnclosed,
    compiled,
    double_doubles,
    enclosures,
    register,
    replay_precise,
)
from mechkin_cli.units import ANGLE, TIME

if TYPE_CHECKING:
    from mechkin_cli.kernel import _kernel
    from mechkin_cli.mechanism import Assembly, Attached, DrivenInput, Problem, Wanted
    from mechkin_cli.session.inputs import KernelInputs
    from mechkin_cli.show import Floats
    from mechkin_cli.structure import SolverGraph
    from mechkin_cli.tape import ExactRecorder, ExactTape, ShiftingRecorder
    from mechkin_cli.units import UnitSystem


# The inputs of a session over its rows as the text says them, in double-double and enclosed.


class InDoubles(Protocol):
    """What is read of a session whose numbers are wanted in double-double."""

    @property
    def problem(self) -> Problem:
        """Mechanism, motion and assembly."""

    @property
    def graph(self) -> SolverGraph:
        """Tree, cut joints and blocks."""

    @property
    def layout(self) -> Layout:
        """How the mechanism lies in the kernel."""

    @property
    def driven(self) -> Sequence[tuple[str, str]]:
        """The inputs (joint, coordinate)."""

    @property
    def size(self) -> float | None:
        """Residual and condition are in parts of it (m)."""

    @property
    def inputs(self) -> KernelInputs:
        """The inputs of all rows."""


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
        constraint_rates: (constraints, 2, rows) as `Session.constraint_rates`; None without any.
        written: (2, rows) by the names of time, of inputs and of their rates, in the file's units.
    """

    values: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats
    reduced: Floats
    whole: Floats
    time: Floats | None
    constraint_rates: Floats | None
    written: Mapping[str, Floats]


def precise_inputs(precise: Precise, session: InDoubles) -> PreciseInputs:
    """The inputs of a session's rows in double-double."""
    return _inputs(precise, session, ExactRows.double_doubles)


def enclosed_inputs(precise: Precise, session: InDoubles) -> PreciseInputs:
    """The same enclosed: a third part is the radius about the two."""
    return _inputs(precise, session, ExactRows.enclosures)


def _inputs(
    precise: Precise, session: InDoubles, replayed: Callable[[ExactRows, list[Any]], Floats]
) -> PreciseInputs:
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
    reduced = [_reduced(session, motion, k, values) for k, values in enumerate(orders[0])]
    time = [motion.in_si["time"]] if "time" in motion.in_si else []
    transmitted = [
        rate * (units[c.leader] / units[c.input])
        for rate, c in zip(motion.constraint_rates, problem.motion.constraints, strict=False)
    ]
    written = {} if "time" not in motion.written else {"time": motion.written["time"]}
    for item in inputs:
        names = (item.name + suffix for suffix in ORDERS)
        written |= dict(zip(names, motion.written[item.name], strict=True))
    parts = [*orders, reduced, time, transmitted, list(written.values())]
    found = replayed(motion.rows, [number for part in parts for number in part])
    ends = np.cumsum([len(part) for part in parts[:-1]])
    *own, moments, leading, columns = np.split(found, ends)
    values, rates, accelerations, jerks, rest = own
    return PreciseInputs(
        values,
        rates,
        accelerations,
        jerks,
        rest,
        session.inputs.whole,
        moments[0] if len(moments) else None,
        leading if len(leading) else None,
        dict(zip(written, columns, strict=True)),
    )


def _reduced(session: InDoubles, motion: ExactMotion, number: int, value: Any) -> Any:
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
        exact = precise.motion
        # coordinates at rest under the loads stand in no text
        unsaid = [item for item in motion.inputs if item.name not in exact.in_si]
        if not unsaid:
            return exact
        given = {item.name: list(map(exact.rows.given, item.written_orders)) for item in unsaid}
        si = {item.name: _in_si(units, item, given[item.name]) for item in unsaid}
        return exact._replace(in_si={**exact.in_si, **si}, written={**exact.written, **given})
    rows = ExactRows(precise.recorder, motion.rows)
    written: dict[str, Any] = {}
    in_si: dict[str, Any] = {}
    if motion.time is not None:
        written["time"] = rows.given(motion.time.written)
        in_si["time"] = units.to_si(written["time"], TIME)
    for item in motion.inputs:
        written[item.name] = [rows.given(order) for order in item.written_orders]
        in_si[item.name] = _in_si(units, item, written[item.name])
    rates = () if motion.constraint_rates is None else motion.constraint_rates
    return ExactMotion(rows, in_si, written, tuple(rows.given(rate) for rate in rates))


def _in_si(units: UnitSystem, item: DrivenInput, written: list[Any]) -> list[Any]:
    """The orders of an input in SI."""
    return [
        units.to_si(number, dimension_of(item.coordinate) / TIME**order)
        for order, number in enumerate(written)
    ]


class Precise:
    """The numbers of a file's sessions as its text says them.

    Args:
        recorder: that holds the exact numbers.
        problem: the file's problem on that recorder.
        motion: the file's motion over its rows.
        base: the same problem in doubles, of which the sessions are.
        moments: gives those of the rows of a response, whose first moment `problem` is, in
            double-double (2, 2, rows): in s, and in the file's unit.
    """

    def __init__(
        self,
        recorder: ExactRecorder,
        problem: Problem,
        motion: ExactMotion,
        base: Problem,
        moments: Callable[[], Floats] | None = None,
    ) -> None:
        self.recorder = recorder
        self.problem = problem
        self.motion = motion
        self.base = base
        self._moments = moments
        self._layouts: dict[int, tuple[InDoubles, Layout]] = {}
        self._inputs: dict[int, tuple[Problem, PreciseInputs]] = {}
        self._numbers: dict[int, tuple[InDoubles, Floats]] = {}

    @cached_property
    def moments(self) -> Floats:
        """Those of the rows of a response (2, 2, rows); a start alone needs none."""
        assert self._moments is not None
        return self._moments()

    def constants(self, session: InDoubles) -> Floats:
        """The constants of the session's plan in double-double (constants, 2), in the order in
        which the kernel numbers them: high and low, |low| <= ulp(high)/2; kept.

        The session may be any of the file's: of the whole mechanism, of the loops that are
        followed, with other loads left out, sized or packed otherwise.
        """
        if id(session) not in self._numbers:
            numbers = double_doubles(self.tape(self._constants(session)))
            self._numbers[id(session)] = (session, numbers)
        return self._numbers[id(session)][1]

    def enclosed_constants(self, session: InDoubles) -> Floats:
        """The same enclosed (constants, 3): high and low parts, and radii about their sums.

        Raises:
            NotEnclosed: a constant is not defined.
        """
        return enclosures(self.tape(self._constants(session)))

    def outputs(
        self, session: InDoubles, wanted: Iterable[Wanted], points: Iterable[Attached] = ()
    ) -> Floats:
        """The constants of `session.readout(wanted, points)` in double-double (constants, 2)."""
        return double_doubles(self.tape(self._outputs(session, wanted, points)))

    def enclosed_outputs(self, session: InDoubles, wanted: Iterable[Wanted]) -> Floats:
        """The same without points, enclosed (constants, 3)."""
        return enclosures(self.tape(self._outputs(session, wanted, ())))

    def inputs(self, session: InDoubles) -> PreciseInputs:
        """The inputs of all rows in double-double, as `session.inputs` has them in doubles; kept.

        Rows that a call asked for in place of the file's are the doubles that it gave, in the
        file's units.
        """
        problem = session.problem
        if id(problem) not in self._inputs:
            self._inputs[id(problem)] = (problem, precise_inputs(self, session))
        return self._inputs[id(problem)][1]

    def enclosed_inputs(self, session: InDoubles) -> PreciseInputs:
        """The same enclosed: a third part is the radius about the two."""
        return enclosed_inputs(self, session)

    @cached_property
    def parameters(self) -> Mapping[str, Floats]:
        """The file's parameters in SI and double-double (2,), by name; nan where the text says no
        number, as where it divides by zero."""
        return self._parameters()

    def _parameters(self) -> dict[str, Floats]:
        known = self.problem.parameters
        try:
            values = double_doubles(self.tape([quantity.value for quantity in known.values()]))
        except NotEnclosed:
            return {name: self._parameter(quantity.value) for name, quantity in known.items()}
        return dict(zip(known, values, strict=True))

    def _parameter(self, value: Any) -> Floats:
        try:
            found: Floats = double_doubles(self.tape([value]))[0]
        except NotEnclosed:
            return np.full(2, np.nan)
        return found

    def tape(self, numbers: Iterable[Any]) -> ExactTape:
        """The tape to some numbers of the recording."""
        return self.recorder.exact_tape([register(self.recorder, n) for n in numbers])

    def layout(self, session: InDoubles) -> Layout:
        """The session's layout over the recording; kept."""
        if id(session) not in self._layouts:
            problem = self.problem_of(session)
            own = session.layout
            graph = graph_of(problem.solved_mechanism, session.graph)
            # unit of length and origin are choices of the drawing
            layout = Layout(
                problem.laid_mechanism, graph, own.length, problem.laws, drawn_about=own.origin
            )
            self._layouts[id(session)] = (session, layout)
        return self._layouts[id(session)][1]

    def _constants(self, session: InDoubles) -> list[Any]:
        size = session.size or session.layout.mechanism.box_diagonal()
        return flatten(plan_records(self.layout(session), size))

    def _outputs(
        self, session: InDoubles, wanted: Iterable[Wanted], points: Iterable[Attached]
    ) -> list[Any]:
        plan = OutputPlan(self.layout(session), None, session.driven)
        for quantity in wanted:
            plan.add(quantity)
        for at in points:
            plan.add_point(at, 0)
        return flatten(plan.records)

    def problem_of(self, session: InDoubles) -> Problem:
        """The recorded problem of what the session's problem is made of."""
        own = session.problem
        mechanism = own.mechanism
        parts: dict[str, Any] = {
            name: {key: self._recorded(part) for key, part in getattr(mechanism, name).items()}
            for name in ("links", "joints", "points", "directions", "couplings")
        }
        for name in ("loads", "frictions"):
            parts[name] = tuple(map(self._recorded, getattr(mechanism, name)))
        parts["gravity"] = self._recorded(mechanism.gravity)
        return replace(
            own,
            mechanism=replace(mechanism, **parts),
            assembly=self._assembly(own.assembly),
            parameters=self.problem.parameters,
            load_laws=tuple(map(self._recorded, own.load_laws)),
            held=tuple(map(self._recorded, own.held)),
        )

    def _assembly(self, own: Assembly) -> Assembly:
        """The recorded assembly; what a session names of the file's coordinates."""
        near = self.problem.assembly.near
        return replace(own, near={name: near.get(name, own.near[name]) for name in own.near})

    def _recorded(self, part: Any) -> Any:
        """A part of the file's problem as it is recorded; another one must be of whole numbers, as
        what is left out and what has the size 1."""
        found = self._counterparts.get(id(part))
        if found is not None:
            return found[1]
        if any(number != int(number) for number in _numbers(part)):
            raise ValueError(f"{part} stands in no text")
        return part

    @cached_property
    def _counterparts(self) -> dict[int, tuple[Any, Any]]:
        """Each part of the problem with the recorded one, by its identity."""
        own, recorded = self.base, self.problem
        pairs: list[tuple[Any, Any]] = [
            (own.mechanism.gravity, recorded.mechanism.gravity),
            *zip(own.mechanism.loads, recorded.mechanism.loads, strict=True),
            *zip(own.mechanism.frictions, recorded.mechanism.frictions, strict=True),
            *zip(own.load_laws, recorded.load_laws, strict=True),
            *zip(own.held, recorded.held, strict=True),
        ]
        for name in ("links", "joints", "points", "directions", "couplings"):
            parts = getattr(recorded.mechanism, name)
            pairs += [(part, parts[key]) for key, part in getattr(own.mechanism, name).items()]
        return {id(one): (one, other) for one, other in pairs}


def _numbers(part: Any) -> Iterator[float]:
    if isinstance(part, float):
        yield part
    elif isinstance(part, tuple):
        for item in part:
            yield from _numbers(item)
    elif is_dataclass(part):
        for field in fields(part):
            yield from _numbers(getattr(part, field.name))
    elif isinstance(part, Mapping):
        for item in part.values():
            yield from _numbers(item)


Shifts = Mapping[int, Fraction]


class ShiftingPrecise(Precise):
    """As `Precise`; each parameter is its text's value and a shift, zero unless it is `shifted`.

    Args:
        leaves: of the recorder, by the names of the parameters that they shift.
        others: as those of `Precise`.
    """

    recorder: ShiftingRecorder

    def __init__(
        self,
        recorder: ShiftingRecorder,
        problem: Problem,
        motion: ExactMotion,
        base: Problem,
        leaves: Mapping[str, int],
    ) -> None:
        super().__init__(recorder, problem, motion, base)
        self.leaves = leaves
        self._turned: dict[tuple[str, Fraction], bool] = {}
        self._tapes: dict[Hashable, tuple[InDoubles, ExactTape, _kernel.Tape | None]] = {}

    def is_turned(self, name: str, amount: Fraction) -> bool:
        """Whether anything that the building decides is decided otherwise for this shift of a
        parameter in SI, or its negative; then no shift tells what the file says there.

        Raises:
            NotEnclosed: something is not defined there.
        """
        if (name, amount) not in self._turned:
            self._turned[name, amount] = self.recorder.turns(self.leaves[name], amount)
        return self._turned[name, amount]

    def shifted(self, name: str | None, amount: Fraction) -> Shifted:
        """The same numbers with a parameter larger by an amount in SI; None: with none."""
        return Shifted(self, {} if name is None else {self.leaves[name]: amount})

    def replayed(
        self,
        key: Hashable,
        session: InDoubles,
        numbers: Callable[[], Iterable[Any]],
        shifts: Shifts,
    ) -> Floats:
        """Some numbers of a session, told apart by a key, with shifts: (numbers, 2)."""
        if (key, id(session)) not in self._tapes:
            registers = [register(self.recorder, number) for number in numbers()]
            tape = self.recorder.exact_tape(registers)
            native = compiled(tape.tape) if tape.given else None
            self._tapes[key, id(session)] = (session, tape, native)
        _, tape, native = self._tapes[key, id(session)]
        if native is None:
            return double_doubles(tape)  # no number that is rounded, so none that is shifted
        values = tape.values.copy()
        for leaf, amount in shifts.items():
            if leaf in tape.given:
                values[tape.given.index(leaf)] = double_double(amount)
        return np.ascontiguousarray(replay_precise(native, values[:, :, None])[0][0])


class Shifted(Precise):
    """The numbers of a `ShiftingPrecise` with some leaves shifted; layouts and tapes are its own
    no more than once."""

    recorder: ShiftingRecorder

    def __init__(self, own: ShiftingPrecise, shifts: Shifts) -> None:
        super().__init__(own.recorder, own.problem, own.motion, own.base)
        self._layouts = own._layouts
        self.own, self.shifts = own, shifts

    def constants(self, session: InDoubles) -> Floats:
        """As `Precise.constants`."""
        return self.own.replayed("plan", session, lambda: self._constants(session), self.shifts)

    def outputs(
        self, session: InDoubles, wanted: Iterable[Wanted], points: Iterable[Attached] = ()
    ) -> Floats:
        """As `Precise.outputs`."""
        wanted, points = tuple(wanted), tuple(points)
        key = (tuple(quantity.name for quantity in wanted), points)
        return self.own.replayed(
            key, session, lambda: self._outputs(session, wanted, points), self.shifts
        )

    def inputs(self, session: InDoubles) -> PreciseInputs:
        """As `Precise.inputs`."""
        with self.recorder.shifted(self.shifts):
            return super().inputs(session)

    @cached_property
    def parameters(self) -> Mapping[str, Floats]:
        """As `Precise.parameters`."""
        with self.recorder.shifted(self.shifts):
            return self._parameters()
