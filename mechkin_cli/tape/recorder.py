"""Recording: instructions as they are computed, each only once; guards; the tape of some outputs.

A tape leaves out what no output and no guard needs, and the registers of equal instructions: the
code may compute a frame ten times over. Code runs on `Traced` numbers, which record all arithmetic
on them, and stand inside nested data that a `Filling` builds again with other numbers.
"""

from __future__ import annotations

import math
import operator
from _thread import RLock  # a process that has loaded no threading is ended at once
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any, NoReturn

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple, fields, is_dataclass, replace
from mechkin_cli.show import Floats
from mechkin_cli.tape.scalars import Recorded, Undecided, as_recorded
from mechkin_cli.tape.tape import ARITY, Operation, Tape, meaning

Instruction = tuple[Operation, int, int, int]


class GivenRows(NamedTuple):
    """Inputs of a tape that no operation gives: a function of floats computes them from recorded
    `numbers`, and is to give as many `rows` again; `first` is the place of the first among the
    inputs."""

    compute: Callable[..., Floats]
    numbers: tuple[Any, ...]
    first: int
    rows: int


class Recorder:
    """Grows by `constant`, `compute` and `guard`; register numbers are its own.

    Attributes:
        values: of every register, when it was recorded.
        given_rows: inputs that follow from others in a way that no operation has.
        is_settled: whether no other values will replace its inputs.
        lock: of threads that share what is recorded, and go on recording.
        holds_others: whether numbers of other recordings are constants of this one.
    """

    holds_others = False
    is_settled = False

    def __init__(self, inputs: Sequence[str], values: Sequence[float]) -> None:
        self.inputs = tuple(inputs)
        self.values: list[float] = list(values)
        self.lock = RLock()
        self.given_rows: list[GivenRows] = []
        self._inputs_at = list(range(len(self.inputs)))
        self._constants: dict[tuple[float, float], int] = {}
        self._instructions: dict[Instruction, int] = {}
        self._written: dict[int, Instruction] = {}
        self._guards: dict[Instruction, bool] = {}
        self._serious: set[Instruction] = set()

    def constant(self, value: float) -> int:
        """The register of a constant; zeros of either sign are two constants."""
        key = (value, math.copysign(1.0, value))
        if key not in self._constants:
            self._constants[key] = self._register(value)
        return self._constants[key]

    def compute(self, operation: Operation, *operands: int) -> int:
        """The register of an operation's result."""
        a, b, c = (*operands, 0, 0)[:3]
        instruction = (operation, a, b, c)
        if instruction not in self._instructions:
            value = meaning(operation)(*(self.values[register] for register in operands))
            number = self._instructions[instruction] = self._register(value)
            self._written[number] = instruction
        return self._instructions[instruction]

    def take(self, name: str, compute: Callable[..., Floats], *numbers: Any) -> Floats:
        """What a function of floats gives of recorded numbers, each a further input `name`."""
        found = compute(*map(as_recorded, numbers))
        self.given_rows.append(GivenRows(compute, numbers, len(self.inputs), found.size))
        self.inputs += tuple(f"{name}[{row}]" for row in range(found.size))
        registers = [self._register(value) for value in found.tolist()]
        self._inputs_at += registers
        return of_numbers(map(self.number, registers))

    @property
    def values_given(self) -> list[float]:
        """The values of the inputs when they were recorded."""
        return [self.values[register] for register in self._inputs_at]

    def number(self, register: int) -> Traced:
        """The number in a register."""
        return Traced(self, register)

    def guard(self, condition: Operation, a: int, b: int, *, advice: bool = False) -> bool:
        """The truth of a condition now, of which a replay reports if it is another one: with
        `advice` as `Verdict.OTHER_ADVICE` only."""
        instruction = (condition, a, b, 0)
        if not advice:
            self._serious.add(instruction)
        if instruction not in self._guards:
            holds = meaning(condition)(self.values[a], self.values[b]) != 0.0
            self._guards[instruction] = holds
        return self._guards[instruction]

    def by_rounding(self, condition: Undecided) -> Undecided:
        """A condition of this recording whose branches differ by rounding only."""
        return condition

    def tape(self, outputs: Iterable[int], *, guarded: bool = True) -> Tape:
        """The tape of some registers, with all guards so far or with none."""
        outputs = list(outputs)
        guards = self._guards if guarded else {}
        needed = self._needed([*outputs, *(r for g in guards for r in g[1:3])])
        given = set(self._inputs_at)
        constants = [r for r in needed if r not in given and r not in self._written]
        values = [self.values[r] for r in constants]
        leaves = [*self._inputs_at, *constants]
        return self._tape(self.inputs, leaves, values, needed, outputs, guards)

    def _tape(
        self,
        inputs: tuple[str, ...],
        leaves: Sequence[int],
        constants: Sequence[float],
        needed: Sequence[int],
        outputs: Sequence[int],
        guards: Mapping[Instruction, bool] = MappingProxyType({}),
    ) -> Tape:
        """A tape of the `needed` registers, whose `leaves` are the inputs and the constants."""
        operations, operands, number = self._renumbered(leaves, needed)
        conditions = [(g[0], number[g[1]], number[g[2]]) for g in guards]
        return Tape(
            inputs,
            np.array(constants, dtype=np.float64),
            np.array(operations, dtype=np.uint8),
            np.array(operands, dtype=np.int32).reshape(-1, 3),
            np.array([number[r] for r in outputs], dtype=np.int32),
            np.array(conditions, dtype=np.int32).reshape(-1, 3),
            np.array(list(guards.values()), dtype=np.bool_),
            np.array([g not in self._serious for g in guards], dtype=np.bool_),
        )

    def _renumbered(
        self, leaves: Sequence[int], needed: Sequence[int]
    ) -> tuple[list[int], list[tuple[int, int, int]], dict[int, int]]:
        """Operations and operands of the registers among `needed` that are computed, and the
        numbers that all registers have when the leaves come first."""
        computed = [r for r in needed if r in self._written]
        number = {r: k for k, r in enumerate((*leaves, *computed))}
        operations, operands = [], []
        for register in computed:
            operation, *registers = self._written[register]
            a, b, c = ([number[r] for r in registers[: ARITY[operation]]] + [0, 0])[:3]
            operations.append(int(operation))
            operands.append((a, b, c))
        return operations, operands, number

    def _register(self, value: float) -> int:
        self.values.append(value)
        return len(self.values) - 1

    def without_zero(self, number: Traced) -> float | Traced:
        """A number; of one that is zero for good its double."""
        return number

    def _needed(self, outputs: Iterable[int]) -> list[int]:
        """The registers that some depend on, themselves included, in order."""
        needed: set[int] = set()
        pending = list(outputs)
        while pending:
            register = pending.pop()
            if register not in needed:
                needed.add(register)
                if register in self._written:
                    operation, *operands = self._written[register]
                    pending += operands[: ARITY[operation]]
        return sorted(needed)


_RELATIONS: dict[Any, tuple[Operation, bool, bool]] = {
    operator.lt: (Operation.LESS, False, False),
    operator.le: (Operation.NOT_MORE, False, False),
    operator.gt: (Operation.LESS, True, False),
    operator.ge: (Operation.NOT_MORE, True, False),
    operator.eq: (Operation.EQUAL, False, False),
    operator.ne: (Operation.EQUAL, False, True),
}
"""Each comparison as a condition: whether its operands change places, and whether it is denied."""


class TraceLost(TypeError):
    """A number depends on a recorded one in a way that no tape holds; the message says which."""


class RecordedComparison(Undecided):
    """A comparison that has not decided anything yet.

    As a truth value it becomes a guard; `choose` records both branches.
    """

    __slots__ = ("left", "negated", "operation", "recorder", "right")
    __hash__ = None

    def __init__(
        self, recorder: Recorder, operation: Operation, left: int, right: int, negated: bool = False
    ) -> None:
        self.recorder, self.operation = recorder, operation
        self.left, self.right, self.negated = left, right, negated

    def __bool__(self) -> bool:
        return self.recorder.guard(self.operation, self.left, self.right) is not self.negated

    def advised(self) -> bool:
        """The truth value, where it decides on a warning only."""
        holds = self.recorder.guard(self.operation, self.left, self.right, advice=True)
        return holds is not self.negated

    def by_rounding(self) -> Undecided:
        """As `Undecided.by_rounding`."""
        return self.recorder.by_rounding(self)

    def choose(self, chosen: float | Traced, other: float | Traced) -> Traced:
        """`chosen` where the condition holds, else `other`."""
        number: Any
        for number in (chosen, other):
            if _is_composite(number):
                return number.chosen_by(self, chosen, other)  # type: ignore[no-any-return]
        if self.negated:
            chosen, other = other, chosen
        holds = self.recorder.compute(self.operation, self.left, self.right)
        return _computed(Operation.CHOOSE, self.recorder.number(holds), chosen, other)


class Traced(Recorded):
    """A register of a recorder, which records what is computed with it.

    It is not a float and does not become one: code that would lose the trace (float(), a format, a
    truth value, an array of floats) raises `TraceLost`, so that no number is taken for a constant.
    """

    __slots__ = ("recorder", "register")
    __array_ufunc__ = None

    def __init__(self, recorder: Recorder, register: int) -> None:
        self.recorder, self.register = recorder, register

    @property
    def is_settled(self) -> bool:
        """As `Recorded.is_settled`."""
        return self.recorder.is_settled

    @property
    def recorded(self) -> float:
        """The value when it was recorded."""
        return self.recorder.values[self.register]

    def __truediv__(self, other: float | Traced) -> Traced:
        if isinstance(other, Traced):
            other._refuse_zero()
        elif not isinstance(other, Recorded) and other == 0.0:
            raise ZeroDivisionError("float division by zero")
        return self.apply("DIVIDE", other)

    def __rtruediv__(self, other: float) -> Traced:
        self._refuse_zero()
        return self.apply_after("DIVIDE", other)

    def apply(self, operation: str, *others: float | Traced) -> Traced:
        """The operation of a name on this number first, then on others."""
        if others and _is_composite(others[0]):
            composite: Any = others[0]
            return composite.apply_after(operation, self)  # type: ignore[no-any-return]
        return _computed(Operation[operation], self, *others)

    def apply_after(self, operation: str, first: float) -> Traced:
        """The operation of a name on a float first, then on this number."""
        return _computed(Operation[operation], first, self)

    def compared(self, relation: Callable[[Any, Any], Any], other: object) -> RecordedComparison:
        """The comparison with a number, which is recorded once it decides something."""
        if _is_composite(other):
            return NotImplemented  # type: ignore[no-any-return]
        recorder = _innermost(self, other)
        left, right = register(recorder, self), register(recorder, other)
        operation, is_turned, is_negated = _RELATIONS[relation]
        if is_turned:
            left, right = right, left
        return RecordedComparison(recorder, operation, left, right, is_negated)

    def _refuse_zero(self) -> None:
        if self == 0.0:
            raise ZeroDivisionError("float division by zero")

    def _lost(self, *_: object) -> NoReturn:
        raise TraceLost("a number that depends on a varied parameter is used as a plain number")

    __float__ = __int__ = __index__ = __bool__ = __complex__ = _lost
    __round__ = __trunc__ = __floor__ = __ceil__ = _lost
    __format__ = __str__ = _lost
    __pow__ = __rpow__ = __mod__ = __rmod__ = __floordiv__ = __rfloordiv__ = _lost
    __copy__ = __deepcopy__ = __reduce__ = _lost

    def __repr__(self) -> str:
        return f"Traced({self.recorded!r})"


def _is_composite(number: object) -> bool:
    """Whether a recorded number is not one register but consists of several, as a jet does."""
    return isinstance(number, Recorded) and not isinstance(number, Traced)


def _innermost(*numbers: object) -> Recorder:
    """The recorder of some numbers, of which those of other recordings are constants."""
    recorders = [number.recorder for number in numbers if isinstance(number, Traced)]
    return next((r for r in recorders if r.holds_others), recorders[0])


def _computed(operation: Operation, *operands: float | Traced) -> Traced:
    recorder = _innermost(*operands)
    registers = [register(recorder, operand) for operand in operands]
    return recorder.number(recorder.compute(operation, *registers))


def register(recorder: Recorder, value: object) -> int:
    """The register of a traced number or of a constant.

    Raises:
        TraceLost: another type, or a number of another recording that cannot be a constant here.
    """
    if isinstance(value, Traced):
        if value.recorder is recorder:
            return value.register
        if recorder.holds_others and not value.recorder.holds_others:
            return recorder.constant(value)  # type: ignore[arg-type]
        raise TraceLost("numbers of two recordings meet")
    if isinstance(value, float | int):
        # an `Exact` stays one
        return recorder.constant(value if isinstance(value, float) else float(value))
    raise TraceLost(f"a varied number meets {type(value).__name__}")


_OBJECTS = np.dtype(object)


def is_traced(values: Any) -> bool:
    """Whether some of the numbers are recorded: they stand in an array of objects."""
    return isinstance(values, Recorded) or getattr(values, "dtype", None) is _OBJECTS


def of_numbers(values: Iterable[Any]) -> Floats:
    """A row of numbers."""
    return np.array(list(values))


def with_rates(values: Floats, rates: Iterable[Any]) -> Floats:
    """Values in a first row, constants in the rows below (1 + rates, values)."""
    return np.stack([values, *(np.full(values.size, rate) for rate in rates)])


def within(values: Floats, limit: float) -> bool:
    """Whether no number is larger than a limit, or nan."""
    if is_traced(values):
        return all(bool(abs(value) <= limit) for value in values.flat)
    if values.dtype != np.float64:
        return bool(np.abs(values).max() <= limit)
    cells, _, largest, smallest = _kernel.extremes(np.ascontiguousarray(values).reshape(-1))
    return cells == values.size and -limit <= smallest and largest <= limit


def differ(values: Floats) -> bool:
    """Whether the numbers are not all the same."""
    if is_traced(values):
        return any(bool(value != values[0]) for value in values.flat)
    return bool((values != values[0]).any())


Build = Callable[[list[Any]], Any]


class Filling:
    """How some data follows from its recorded numbers: mappings, tuples, data classes and arrays of
    objects, nested in one another.

    Each distinct part with a recorded number is built once, from parts built before it. Parts
    without any stay the objects that they are.

    Attributes:
        numbers: the recorded numbers, each once.
    """

    def __init__(self, data: Any) -> None:
        self.numbers: list[Traced] = []
        self._registers: dict[int, int] = {}
        self._parts: dict[int, int | None] = {}
        self._fixed: list[Any] = []
        self._steps: list[tuple[Build, list[int]]] = []
        self._whole = self._place(data)
        self._data = data

    def fill(self, numbers: Sequence[float]) -> Any:
        """The data with other numbers in the places of the recorded ones."""
        if self._whole is None:
            return self._data
        # a place: 3k for number k, 3k + 1 for a part without numbers, 3k + 2 for a step's result
        built: list[Any] = []
        sources = (numbers, self._fixed, built)
        for build, places in self._steps:
            built.append(build([sources[place % 3][place // 3] for place in places]))
        return sources[self._whole % 3][self._whole // 3]

    def _place(self, value: Any) -> int | None:
        """The place of a value with recorded numbers; None where it has none."""
        if isinstance(value, Traced):
            if value.register not in self._registers:
                self._registers[value.register] = len(self.numbers)
                self.numbers.append(value)
            return 3 * self._registers[value.register]
        if id(value) not in self._parts:
            self._parts[id(value)] = self._built(value)
        return self._parts[id(value)]

    def _built(self, value: Any) -> int | None:
        taken_apart = _taken_apart(value)
        if taken_apart is None:
            return None
        items, build = taken_apart
        places = [self._place(item) for item in items]
        if all(place is None for place in places):
            return None
        for k, item in enumerate(items):
            if places[k] is None:
                places[k] = 3 * len(self._fixed) + 1
                self._fixed.append(item)
        self._steps.append((build, places))  # type: ignore[arg-type]
        return 3 * (len(self._steps) - 1) + 2


def _taken_apart(value: Any) -> tuple[list[Any], Build] | None:
    """The parts of a value, and how to build it from them; None where it has none."""
    if isinstance(value, np.ndarray):
        if value.dtype != object:
            return None
        return list(value.flat), partial(_array, value.shape)
    if isinstance(value, tuple):
        return list(value), getattr(type(value), "_make", tuple)
    if isinstance(value, Mapping):
        return list(value.values()), partial(_mapping, list(value))
    if is_dataclass(value) and not isinstance(value, type):
        names = [field.name for field in fields(value)]
        return [getattr(value, name) for name in names], partial(_record, value, names)
    return None


def _array(shape: tuple[int, ...], items: list[Any]) -> Any:
    return np.array(items, dtype=np.float64).reshape(shape)


def _mapping(keys: list[Any], items: list[Any]) -> dict[Any, Any]:
    return dict(zip(keys, items, strict=True))


def _record(value: Any, names: list[str], items: list[Any]) -> Any:
    return replace(value, **dict(zip(names, items, strict=True)))
