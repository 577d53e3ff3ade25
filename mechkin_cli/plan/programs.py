"""Programs of quantities: expressions and tables as data of the kernel, evaluated row by row.

An expression is evaluated once on numbers that write down what is computed with them, so that the
program's operations are those of `Expression.evaluate` in their order, and its bits are the same
(`kernel/core/forces/quantity_program.hpp`). The values of loads that vary are such a program of the
plan; others serve numbers that are asked for while a motion is integrated.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli.expressions import Expression, Quantity, UnknownName
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import is_angle, varying
from mechkin_cli.plan.codes import OutputCode, ReadCode
from mechkin_cli.plan.loads import kernel_columns
from mechkin_cli.plan.outputs import OutputPlan
from mechkin_cli.plan.records import Output, Program, ProgramCurve
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape import Operation, RowRecorder, register
from mechkin_cli.tolerances import LARGEST_NUMBER, TABLE_END

if TYPE_CHECKING:
    from mechkin_cli.mechanism import LoadLaw, Problem, Wanted, curve
    from mechkin_cli.plan.layout import Layout
    from mechkin_cli.tape import Instruction


KINKS = (
    Operation.MAGNITUDE,
    Operation.SIGN,
    Operation.LARGER,
    Operation.SMALLER,
    Operation.WHOLE,
)
"""Operations at which a value bends or jumps."""

_NOTHING = Output(OutputCode.STATE, 0, 0, 0, (0.0, 0.0, 0.0), 1.0)
"""Stands where no quantity of the mechanism is read."""


class Law(NamedTuple):
    """A scalar: an expression, or a curve over the one quantity that is read.

    `reads` are the names of the quantities that it depends on, parameters left out.
    """

    reads: Sequence[str]
    expression: Expression | None = None
    curve: curve.Curve | None = None


def load_program(layout: Layout) -> list[Program]:
    """The record of the values of the loads that vary, then of what a motion is watched for; none
    where there is neither."""
    laws = layout.laws
    used = sorted({one.number for load in layout.mechanism.loads for one in varying(load)})
    if laws is None or not (used or laws.watched):
        return []
    acting = [laws.laws[number] for number in used]
    recording = _Recording(layout, laws.quantities, laws.parameters, [*acting, *laws.watched])
    found = recording.values()
    kinks = recording.kinks
    outputs = _outputs_of_loads(layout, recording, used, found)
    return [recording.program(outputs, kinks)]


def _outputs_of_loads(
    layout: Layout, recording: _Recording, used: Sequence[int], found: Sequence[Any]
) -> list[Any]:
    values = dict(zip(used, map(recording.defined, found[: len(used)]), strict=True))
    return [*kernel_columns(layout, values), *found[len(used) :]]


def kink_laws(layout: Layout) -> list[LoadLaw]:
    """The law in which each kink of `load_program` stands, of several the first."""
    laws = layout.laws
    assert laws is not None
    used = sorted({one.number for load in layout.mechanism.loads for one in varying(load)})
    own = [*(laws.laws[number] for number in used), *laws.watched]
    recording = _Recording(layout, laws.quantities, laws.parameters, own)
    found = recording.values()
    kinks, ends = recording.kinks, recording.ends
    outputs = _outputs_of_loads(layout, recording, used, found)
    registers = [register(recording.recorder, value) for value in outputs]
    written = recording.recorder.instructions
    owner: dict[int, LoadLaw] = {}
    for law, begin, end in zip(own, [0, *ends], ends, strict=False):
        marked = [one for one in written[begin:end] if one in kinks]
        for number in recording.recorder.listed(registers, marked)[-1]:
            owner.setdefault(number, law)
    return [owner[number] for number in sorted(owner)]


def compile_quantity_expressions(
    layout: Layout, problem: Problem, expressions: Iterable[Expression]
) -> Program:
    """The record of some scalars of quantities that are known without forces, in SI, in order.

    Args:
        layout: of the session that serves them.
        problem: what names stand for; parameters may be recorded numbers.
        expressions: scalars of positions, rates, directions, energies, parameters and time, known
            to be right.
    """
    known = problem.quantities()
    laws = [Law(read_names(expression, problem), expression) for expression in expressions]
    recording = _Recording(layout, known, problem.parameters, laws)
    return recording.program(recording.values(), recording.kinks)


def read_names(expression: Expression, problem: Problem) -> list[str]:
    """The quantities behind the names of an expression, parameters left out."""
    known = problem.quantities()
    names = sorted(expression.names - problem.parameters.keys())
    whole = (name if name in known else name.rpartition(".")[0] for name in names)
    return list(dict.fromkeys(whole))


class _Recording:
    """Registers of what some laws read, and what is computed with them.

    Args:
        layout: the mechanism in the kernel.
        quantities: by name.
        parameters: by name, floats or recorded numbers.
        laws: each with an expression or a curve.
    """

    def __init__(
        self,
        layout: Layout,
        quantities: Mapping[str, Wanted],
        parameters: Mapping[str, Quantity],
        laws: Sequence[Any],
    ) -> None:
        self.parameters = parameters
        self._reads: list[tuple[int, Output]] = []
        self._first: dict[str, tuple[Wanted, int]] = {}
        width = 0
        for name in dict.fromkeys(name for law in laws for name in law.reads):
            wanted = quantities[name]
            self._first[name] = (wanted, width)
            read = _read(layout, wanted)
            self._reads.append(read)
            width += _width(*read)
        self._laws = laws
        self._curves = [
            _curve(law.curve, self._first[law.reads[0]][1]) for law in laws if law.curve is not None
        ]
        self._first_curve = width
        self.recorder = RowRecorder(width + len(self._curves))
        self.ends: list[int] = []
        """How many instructions there are after each law."""

    def values(self) -> list[Any]:
        """The laws' values in SI."""
        curves = iter(range(self._first_curve, self._first_curve + len(self._curves)))
        found = []
        for law in self._laws:
            found.append(
                law.expression.evaluate(self._resolve).value
                if law.curve is None
                else self.recorder.number(next(curves))
            )
            self.ends.append(len(self.recorder.instructions))
        return found

    def defined(self, value: Any) -> Any:
        """The value where it is no slip of the pen, else nan."""
        recorder = self.recorder
        number = recorder.number(register(recorder, value))
        nothing = recorder.number(recorder.constant(0.0)) / 0.0
        condition: Any = abs(number) <= LARGEST_NUMBER
        return condition.choose(number, nothing)

    @property
    def kinks(self) -> list[Instruction]:
        """Where what was written down so far bends or jumps."""
        return [one for one in self.recorder.instructions if one[0] in KINKS]

    def program(self, values: Sequence[Any], kinks: Sequence[Instruction]) -> Program:
        """The record that computes some values."""
        recorder = self.recorder
        outputs = [register(recorder, value) for value in values]
        constants, operations, operands, results, marked = recorder.listed(outputs, kinks)
        reads = [(int(kind), o.type, o.number, o.freedom, o.order) for kind, o in self._reads]
        numbers = [n for _, o in self._reads for n in (*o.data, o.factor)]
        return Program(
            reads, numbers, self._curves, constants, operations, operands, results, marked
        )

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


def _read(layout: Layout, wanted: Wanted) -> tuple[int, Output]:
    """How a quantity is read into a program's registers."""
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


def _curve(given: curve.Curve, over: int) -> ProgramCurve:
    slack = TABLE_END * (given.last - given.first)
    knots = zip(given.x.tolist(), *given.coefficients.tolist(), strict=True)
    return ProgramCurve(over, given.first - slack, given.last + slack, list(knots))
