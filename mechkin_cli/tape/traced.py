"""A scalar that writes down what is computed with it.

It is no float and does not become one: code that would lose the trace (float(), a format, a truth
value, an array of floats) raises `TraceLost`, so that nothing passes for a constant that is none.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn

from mechkin_cli.tape.operations import Operation
from mechkin_cli.tape.scalars import Recorded, Undecided

if TYPE_CHECKING:
    from mechkin_cli.tape.recorder import Recorder


class TraceLost(TypeError):
    """A number depends on a recorded one in a way that no tape holds; the message says which."""


class Condition(Undecided):
    """A comparison of which no code has taken note yet.

    As a truth value it becomes a guard; `choose` keeps both ways on the tape.
    """

    __slots__ = ("left", "negated", "operation", "recorder", "right")
    __hash__ = None  # type: ignore[assignment]

    def __init__(
        self, recorder: Recorder, operation: Operation, left: int, right: int, negated: bool = False
    ) -> None:
        self.recorder, self.operation = recorder, operation
        self.left, self.right, self.negated = left, right, negated

    def __bool__(self) -> bool:
        return self.recorder.guard(self.operation, self.left, self.right) is not self.negated

    def advised(self) -> bool:
        """The truth value, where no more than a warning hangs on it."""
        found = self.recorder.guard(self.operation, self.left, self.right, advice=True)
        return found is not self.negated

    def by_rounding(self) -> Undecided:
        """As `Undecided.by_rounding`."""
        return self.recorder.by_rounding(self)

    def choose(self, chosen: float | Traced, other: float | Traced) -> Traced:
        """`chosen` where the condition holds, else `other`."""
        for number in (chosen, other):
            if _is_made_of_others(number):
                made: Any = number
                return made.chosen_by(self, chosen, other)  # type: ignore[no-any-return]
        if self.negated:
            chosen, other = other, chosen
        holds = self.recorder.compute(self.operation, self.left, self.right)
        return _computed(Operation.CHOOSE, self.recorder.number(holds), chosen, other)


class Traced(Recorded):
    """A register of a recorder."""

    __slots__ = ("recorder", "register")
    __hash__ = None  # type: ignore[assignment]
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

    def __add__(self, other: float | Traced) -> Traced:
        return self._with(Operation.ADD, other)

    def __radd__(self, other: float) -> Traced:
        return self._after(Operation.ADD, other)

    def __sub__(self, other: float | Traced) -> Traced:
        return self._with(Operation.SUBTRACT, other)

    def __rsub__(self, other: float) -> Traced:
        return self._after(Operation.SUBTRACT, other)

    def __mul__(self, other: float | Traced) -> Traced:
        return self._with(Operation.MULTIPLY, other)

    def __rmul__(self, other: float) -> Traced:
        return self._after(Operation.MULTIPLY, other)

    def __truediv__(self, other: float | Traced) -> Traced:
        if isinstance(other, Traced):
            other._refuse_zero()
        elif not isinstance(other, Recorded) and other == 0.0:
            raise ZeroDivisionError("float division by zero")
        return self._with(Operation.DIVIDE, other)

    def __rtruediv__(self, other: float) -> Traced:
        self._refuse_zero()
        return self._after(Operation.DIVIDE, other)

    def __neg__(self) -> Traced:
        return self._with(Operation.NEGATE)

    def __abs__(self) -> Traced:
        return self._with(Operation.MAGNITUDE)

    def __lt__(self, other: float | Traced) -> Condition:
        return self._compared(Operation.LESS, other)

    def __le__(self, other: float | Traced) -> Condition:
        return self._compared(Operation.NOT_MORE, other)

    def __gt__(self, other: float | Traced) -> Condition:
        return self._compared(Operation.LESS, other, turned=True)

    def __ge__(self, other: float | Traced) -> Condition:
        return self._compared(Operation.NOT_MORE, other, turned=True)

    def __eq__(self, other: object) -> Condition:  # type: ignore[override]
        return self._compared(Operation.EQUAL, other)

    def __ne__(self, other: object) -> Condition:  # type: ignore[override]
        return self._compared(Operation.EQUAL, other, negated=True)

    def apply(self, operation: str, *others: float | Traced) -> Traced:
        """The operation of a name on this number first, then on others."""
        return self._with(Operation[operation], *others)

    def apply_after(self, operation: str, first: float) -> Traced:
        """The operation of a name on a float first, then on this number."""
        return self._after(Operation[operation], first)

    def _with(self, operation: Operation, *others: float | Traced) -> Traced:
        if others and _is_made_of_others(others[0]):
            made: Any = others[0]
            return made.apply_after(operation.name, self)  # type: ignore[no-any-return]
        return _computed(operation, self, *others)

    def _after(self, operation: Operation, other: float) -> Traced:
        return _computed(operation, other, self)

    def _compared(
        self, operation: Operation, other: object, *, turned: bool = False, negated: bool = False
    ) -> Condition:
        if _is_made_of_others(other):
            return NotImplemented  # type: ignore[no-any-return]
        recorder = _innermost(self, other)
        left, right = register(recorder, self), register(recorder, other)
        if turned:
            left, right = right, left
        return Condition(recorder, operation, left, right, negated)

    def _refuse_zero(self) -> None:
        """A division by zero ends the code with an error."""
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


def _is_made_of_others(number: object) -> bool:
    """Whether a recorded number is no register but consists of several, and knows what to do."""
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
        TraceLost: something else, or a number of another recording that is no constant of this one.
    """
    if isinstance(value, Traced):
        if value.recorder is recorder:
            return value.register
        if recorder.holds_others and not value.recorder.holds_others:
            return recorder.constant(value)  # type: ignore[arg-type]
        raise TraceLost("numbers of two recordings meet")
    if isinstance(value, float | int):
        # an `Exact` keeps what it knows
        return recorder.constant(value if isinstance(value, float) else float(value))
    raise TraceLost(f"a varied number meets {type(value).__name__}")
