"""Programs of quantities: expressions and tables as data of the kernel, evaluated row by row.

An expression is evaluated once on numbers that record all arithmetic on them, so that the program's
operations are those of `Expression.evaluate` in their order, and its bits are the same
(`kernel/core/forces/quantity_program.hpp`). The values of loads that vary are such a program of the
plan, and so are the values that end a motion.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli.expressions import Quantity, UnknownName
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import Amount, JointLoad, LinkLoad, Load, Varying, dot, is_angle
from mechkin_cli.plan.outputs import OutputPlan
from mechkin_cli.plan.records import Output, OutputCode, PlanRecord, Program, ReadCode, record
from mechkin_cli.tape import (
    JetNumber,
    Operation,
    RowRecorder,
    as_recorded,
    orders_of,
    register,
)
from mechkin_cli.tolerances import LARGEST_NUMBER, TABLE_END

if TYPE_CHECKING:
    from mechkin_cli.mechanism import CoordinateLaw, Curve, Laws, LoadLaw, Track, Vector, Wanted
    from mechkin_cli.plan.layout import Layout


KINKS = (Operation.MAGNITUDE, Operation.SIGN, Operation.LARGER, Operation.SMALLER, Operation.WHOLE)
"""Operations at which a value bends or jumps."""

ORDERS = range(4)
"""Of a function: its value and its derivatives."""

_NOTHING = Output(OutputCode.STATE, 0, 0, 0, (0.0, 0.0, 0.0), 0.0)
"""Where no quantity of the mechanism is read."""


def load_program(layout: Layout) -> list[Program]:
    """The program of the values of the loads that vary, then of the values that end a motion; none
    where there is neither."""
    assert layout.laws is not None
    recording = _Recording(layout, layout.laws)
    return [recording.program()] if recording.laws else []


def kink_laws(layout: Layout) -> list[LoadLaw]:
    """The law of each kink of `load_program`, of several the first."""
    assert layout.laws is not None
    recording = _Recording(layout, layout.laws)
    instructions = recording.recorder.instructions
    owner: dict[int, LoadLaw] = {}
    ends = recording.ends
    for law, begin, end in zip(recording.laws, [0, *ends], ends, strict=False):
        marked = [kink for kink in instructions[begin:end] if kink in recording.kinks]
        for number in recording.recorder.listed(recording.outputs, marked)[-1]:
            owner.setdefault(number, law)
    return [owner[number] for number in sorted(owner)]


class _Recording:
    """The arithmetic of the laws of a layout, recorded.

    Attributes:
        laws: of the loads that vary, then of the values that end a motion.
        outputs: registers of the kernel's columns, then of the values.
        kinks: instructions of the laws at which a value bends or jumps.
        ends: numbers of instructions after each law.
    """

    def __init__(self, layout: Layout, laws: Laws) -> None:
        loads = layout.mechanism.loads
        used = sorted({amount.number for load in loads for amount in load.varying})
        self.laws: list[LoadLaw] = [*(laws.laws[number] for number in used), *laws.watched]
        self.parameters: Mapping[str, Quantity] = laws.parameters
        self._reads: list[tuple[int, Output]] = []
        self._first: dict[str, tuple[Wanted, int]] = {}
        width = 0
        for name in dict.fromkeys(name for law in self.laws for name in law.reads):
            wanted = laws.quantities[name]
            self._first[name] = (wanted, width)
            read = _read(layout, wanted)
            self._reads.append(read)
            width += _width(*read)
        tables = [(law.curve, law.reads[0]) for law in self.laws if law.curve is not None]
        self._curves = [_ranged(curve, self._first[name][1]) for curve, name in tables]
        self._knots = [number for curve, _ in tables for number in _knots(curve)]
        recorder = self.recorder = RowRecorder(width + len(self._curves))
        self.ends: list[int] = []
        values = self._values(width)
        self.kinks = [each for each in recorder.instructions if each[0] in KINKS]
        varied = dict(zip(used, map(self._defined, values[: len(used)]), strict=True))
        columns = [*kernel_columns(layout, varied), *values[len(used) :]]
        self.outputs = [register(recorder, value) for value in columns]

    def program(self) -> Program:
        """The program of the outputs."""
        program = self.recorder.listed(self.outputs, self.kinks)
        reads = [(int(kind), o.type, o.number, o.freedom, o.order) for kind, o in self._reads]
        numbers = [n for _, o in self._reads for n in (*o.data, o.factor)]
        return Program(reads, numbers, self._curves, self._knots, *program)

    def _values(self, first_curve: int) -> list[Any]:
        """The laws' values in SI."""
        curves = itertools.count(first_curve)
        values: list[Any] = []
        for law in self.laws:
            if law.expression is not None and law.curve is None:
                values.append(law.expression.evaluate(self._resolve).value)
            else:
                values.append(self.recorder.number(next(curves)))
            self.ends.append(len(self.recorder.instructions))
        return values

    def _defined(self, value: Any) -> Any:
        """The value, or nan where it is absurdly large."""
        recorder = self.recorder
        number = recorder.number(register(recorder, value))
        nothing = recorder.number(recorder.constant(0.0)) / 0.0
        condition: Any = abs(number) <= LARGEST_NUMBER
        return condition.choose(number, nothing)

    def _resolve(self, name: str) -> Quantity:
        if name in self.parameters:
            return self.parameters[name]
        if name not in self._first:
            raise UnknownName(name, self._first)
        wanted, first = self._first[name]
        number = self.recorder.number
        if wanted.vector:
            return Quantity(wanted.value([number(first + k) for k in range(3)]), wanted.dimension)
        rest: Any = number(first + 1) if _turns(wanted) else None
        return Quantity(number(first), wanted.dimension, rest)  # type: ignore[arg-type]


def _turns(wanted: Wanted) -> bool:
    return wanted.kind == "coordinate" and wanted.order == 0 and is_angle(wanted.coordinate)


def function_record(law: CoordinateLaw) -> PlanRecord:
    """The record of a function of a coordinate, with its derivatives (`plan/functions.hpp`)."""
    curves = [] if law.curve is None else [law.curve]
    recorder = RowRecorder(1 + len(ORDERS) * len(curves))
    number = recorder.number
    if law.curve is not None:
        orders: Sequence[Any] = [number(1 + order) for order in ORDERS]
    else:
        assert law.value is not None
        orders = orders_of(law.value(JetNumber([number(0), 1.0, 0.0, 0.0])))
    return _of_orders(1, curves, recorder, [[order] for order in orders], repeats=law.period != 0.0)


def track_record(track: Track, origin: Vector) -> PlanRecord:
    """The record of a curve or surface: places from an origin of the drawing (m), with their
    derivatives."""
    count = len(track.names)
    if track.knots:
        return _knots_record(track, origin)
    recorder = RowRecorder(count)
    numbers = [recorder.number(register(recorder, number)) for number in track.numbers]
    orders = track.orders([recorder.number(k) for k in range(count)], numbers)
    values = [[a - b for a, b in zip(orders[0], origin, strict=True)], *orders[1:]]
    return _of_orders(count, [], recorder, values)


def _knots_record(track: Track, origin: Vector) -> PlanRecord:
    recorder = RowRecorder(1 + len(ORDERS) * len(track.knots))
    values = [
        [recorder.number(1 + len(ORDERS) * k + order) for k in range(len(track.knots))]
        for order in ORDERS
    ]
    moved: list[Any] = [a - b for a, b in zip(values[0], origin, strict=True)]
    return _of_orders(1, track.knots, recorder, [moved, *values[1:]], repeats=track.closed[0])


def _of_orders(
    arguments: int,
    curves: Sequence[Curve],
    recorder: RowRecorder,
    orders: Sequence[Sequence[Any]],
    *,
    repeats: bool = False,
) -> PlanRecord:
    """The record of a function by the outputs of each order; its curves go over its first argument,
    with their spans as periods or without any."""
    outputs: list[int] = []
    parts: list[list[int]] = []
    for order in orders:
        outputs = [*outputs, *(register(recorder, value) for value in order)]
        parts.append(outputs)
    constants, operations, operands, instructions, registers = recorder.listed_in_turn(parts)
    ends = [len(part) for part in parts]
    return record(
        "add_function",
        arguments,
        [(0, repeats, curve.x.size) for curve in curves],
        [number for curve in curves for number in _knots(curve)],
        constants,
        operations,
        operands,
        instructions,
        registers,
        ends,
    )


def _read(layout: Layout, wanted: Wanted) -> tuple[int, Output]:
    """The kind of read of a quantity, and the output that is read."""
    if wanted.kind == "time":
        return ReadCode.TIME, _NOTHING
    outputs = OutputPlan(layout, None, [])
    outputs.add(wanted)
    kind = ReadCode.ANGLE if _turns(wanted) else ReadCode.OUTPUT
    return kind, outputs.records[0]


def _width(kind: int, output: Output) -> int:
    if kind == ReadCode.OUTPUT:
        return _kernel.output_width(output.type)
    return 2 if kind == ReadCode.ANGLE else 1


def _ranged(curve: Curve, over: int) -> tuple[int, float, float, int]:
    """A curve over a register; where it ends is decided in doubles."""
    first, last = as_recorded(curve.first), as_recorded(curve.last)
    slack = TABLE_END * (last - first)
    return over, first - slack, last + slack, curve.x.size


def _knots(curve: Curve) -> list[Any]:
    """x, y, b, c, d of each piece."""
    rows = zip(curve.x.tolist(), *curve.coefficients.tolist(), strict=True)
    return [number for row in rows for number in row]


def kernel_columns(layout: Layout, values: Mapping[int, Any]) -> list[Any]:
    """The columns of the loads that vary, in the order of the loads: one of a load along
    a coordinate, three of one on a link, components in the axes of the load; in the kernel's units.

    Args:
        layout: of the mechanism with the loads.
        values: of the laws in SI by their numbers, rows or recorded numbers.
    """
    return [
        column
        for load in layout.mechanism.loads
        if load.varying
        for column in _columns(layout, load, values)
    ]


def _columns(layout: Layout, load: Load, values: Mapping[int, Any]) -> list[Any]:
    length = layout.length
    if isinstance(load, JointLoad):
        per = length * length if is_angle(load.coordinate) else length
        return [_amount(load.amount, values) / per]
    assert isinstance(load, LinkLoad)
    per = 1.0 / length if load.kind == "force" else 1.0 / (length * length)
    components: Any = [_amount(amount, values) for amount in load.value]
    if load.axes == "link":
        frame = layout.link_frame[load.link]
        components = [dot(axis, components) for axis in (frame.x, frame.y, frame.z)]
    return [per * component for component in components]


def _amount(amount: Amount, values: Mapping[int, Any]) -> Any:
    return values[amount.number] if isinstance(amount, Varying) else amount
