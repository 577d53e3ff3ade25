"""Values with dimensions, always in SI (m, kg, s, rad).

A scalar is a float, or a float64 array of shape (rows,) with one value per row. A vector is three
scalars in one frame, in a plane two. The same operations serve all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.diagnostics import MechkinError, nearest_hint
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.units import ANGLE, DIMENSIONLESS, CompoundUnit, Dimension, UnitSystem

Rows = NDArray[np.float64]
Scalar = float | Rows


@dataclass(frozen=True, slots=True, eq=False)
class Vector:
    """Components along the axes of ground; a vector in a plane has no z."""

    x: Scalar
    y: Scalar
    z: Scalar | None = None

    @property
    def components(self) -> tuple[Scalar, ...]:
        """The components in order."""
        return (self.x, self.y) if self.z is None else (self.x, self.y, self.z)

    def components_of(self, text: str) -> str:
        """What to write for one of the components of the vector that a text is.

        Example:
            >>> Vector(1.0, 2.0).components_of("A.force")
            'A.force.x, A.force.y or norm(A.force)'
            >>> Vector(1.0, 2.0, 3.0).components_of("a+b")
            '(a+b).x, (a+b).y, (a+b).z or norm(a+b)'
        """
        return f"{', '.join(self.component_texts(text))} or norm({text.strip()})"

    def component_texts(self, text: str) -> tuple[str, ...]:
        """The texts of the components, in order, of the vector that a text is.

        Example:
            >>> Vector(1.0, 2.0).component_texts("A.force")
            ('A.force.x', 'A.force.y')
            >>> Vector(1.0, 2.0, 3.0).component_texts("a+b")
            ('(a+b).x', '(a+b).y', '(a+b).z')
        """
        name = text.strip()
        whole = name if name.replace(".", "").isidentifier() else f"({name})"
        return tuple(f"{whole}.{axis}" for axis in "xyz"[: len(self.components)])


Value = Scalar | Vector


def components(value: Value) -> tuple[Scalar, ...]:
    """The components of a vector, or the one scalar."""
    return value.components if isinstance(value, Vector) else (value,)


@dataclass(frozen=True, slots=True, eq=False)
class Quantity:
    """A value in SI and its dimension; of an angle that has turned, `rest` is the same without
    whole turns, known more closely. A `truth` is 1 where something holds, 0 where it does not."""

    value: Value
    dimension: Dimension = DIMENSIONLESS
    rest: Scalar | None = None
    truth: bool = False

    @property
    def phrase(self) -> str:
        """What the quantity is, in words: `a length`, `a vector (a length)`."""
        if self.truth:
            return "a condition"
        phrase = self.dimension.phrase
        return f"a vector ({phrase})" if isinstance(self.value, Vector) else phrase


class ExpressionError(MechkinError):
    """An expression that cannot be read or evaluated.

    `offset` counts characters from the start of the expression's text; `hint` says what to do;
    `name` is the parameter whose text it is, if it is that of a parameter.
    """

    def __init__(
        self, message: str, offset: int = 0, hint: str | None = None, name: str | None = None
    ) -> None:
        self.message = message
        self.offset = offset
        self.hint = hint
        self.name = name
        super().__init__(message)

    def __str__(self) -> str:
        return f"{self.message}; {self.hint}" if self.hint else self.message


class UnknownName(KeyError):
    """Raised by a resolver for a name that it does not have; `known` are the names that it has,
    `reason` says why it has none of this kind, or tells that where it is asked: resolvers are asked
    for names of components, too, which they need not have."""

    def __init__(
        self,
        name: str,
        known: Iterable[str] = (),
        reason: str | Callable[[], str | None] | None = None,
    ) -> None:
        self.name = name
        self.known = known
        self.reason = reason
        super().__init__(name)

    @cached_property
    def hint(self) -> str | None:
        """The reason, or else the nearest known names, or all of them when they are few."""
        reason = self.reason() if callable(self.reason) else self.reason
        return reason or nearest_hint(self.name, self.known)


# Limits on expressions: far above what a drawing needs, far below what could stall a reader.

MAX_TEXT_LENGTH = 4000
"""Characters; the longest columns of published tables have about a hundred."""

MAX_NODES = 1000
"""Numbers, names and operations of one expression."""

MAX_EXPANDED = 20000
"""The same with quantities and derivatives in the places of their names: some 1e-4 s a row of
each."""

MAX_DEPTH = 50
"""Nested parentheses, calls, signs and powers; bounds the recursion of the parser."""

MAX_EXPONENT = 16
"""Size of a base dimension's exponent, and of a whole power of a value with a dimension."""

MAX_ERRORS = 50
"""Errors of a file's parameters; with more, the rest of them is not evaluated."""

MAX_CHAIN = 8
"""Names of a circle of parameters that a message shows."""

MAX_QUOTED = 40
"""Characters of the user's text repeated in a message."""


def refuse_large(size: int, offset: int) -> None:
    """Refuses an expression that has grown too large.

    Raises:
        ExpressionError: it has more nodes than the limit.
    """
    if size > MAX_EXPANDED:
        text = f"with the quantities in it the expression has more than {MAX_EXPANDED} parts"
        raise ExpressionError(text, offset, "use fewer of them in one another")


# Nodes of a parsed expression are in postfix order, operands before their operation: evaluation
# is a loop over a stack, so long sums need no recursion.


class NumberNode(NamedTuple):
    """A number as written, with the unit behind it if there is one."""

    value: float
    unit: CompoundUnit | None
    text: str
    offset: int
    joined_units: tuple[tuple[str, int], ...] = ()
    """Unit words that follow `*` or `/`, with offsets: they could be meant as parameters."""

    @property
    def in_pi(self) -> bool:
        """Whether it is pi or -pi, which are angles in radians where one is taken."""
        return self.text in ("pi", "-pi")


class Name(NamedTuple):
    """A name with dots; a last part `x`, `y` or `z` may be a component of what comes before it,
    unless it is `whole`."""

    text: str
    offset: int
    whole: bool = False


class OperationNode(NamedTuple):
    """An operation or function on the `arity` values before it; `symbol` is its table key."""

    symbol: str
    arity: int
    offset: int


Node = NumberNode | Name | OperationNode


Resolve = Callable[[str], Quantity]
"""A quantity by its dotted name; raises `UnknownName` for a name that it does not have."""


def lookup(quantities: Mapping[str, Quantity], known: Iterable[str] | None = None) -> Resolve:
    """A resolver for the names of a mapping; its hints for others are names of `known` (None: of
    the mapping)."""

    def resolve(name: str) -> Quantity:
        try:
            return quantities[name]
        except KeyError:
            raise UnknownName(name, quantities if known is None else known) from None

    return resolve


@dataclass(frozen=True, slots=True, eq=False)
class Operand:
    """A value with the place of its text, and the number literal it comes from if it is one.

    A number in parts of pi, such as 2*pi*time/(1 s), is an angle in radians where one is taken.
    """

    quantity: Quantity
    offset: int
    number: NumberNode | None = None
    in_pi: bool = False

    @property
    def value(self) -> Value:
        """The value in SI."""
        return self.quantity.value

    @property
    def dimension(self) -> Dimension:
        """The dimension of the value."""
        return self.quantity.dimension

    @property
    def phrase(self) -> str:
        """What the operand is, in words."""
        return self.quantity.phrase


class Site(NamedTuple):
    """An operation in its text: its name, where it stands, and the units of its hints."""

    symbol: str
    offset: int
    units: UnitSystem

    def error(
        self, message: str, hint: str | None = None, at: Operand | None = None
    ) -> ExpressionError:
        """An error at an operand, or at the operation itself."""
        return ExpressionError(message, at.offset if at else self.offset, hint)

    def scalar(self, operand: Operand) -> Scalar:
        """The value of an operand that must not be a vector.

        Raises:
            ExpressionError: it is a vector.
        """
        if isinstance(operand.value, Vector):
            raise self.error(
                f"{self.symbol} takes a number, not {operand.phrase}",
                "take a component with .x, .y or .z, or norm(...)",
                operand,
            )
        return operand.value

    def periodic(self, operand: Operand) -> Scalar:
        """The value of an operand of which whole turns do not matter.

        Raises:
            ExpressionError: it is a vector.
        """
        value = self.scalar(operand)
        return value if operand.quantity.rest is None else operand.quantity.rest

    def vector(self, operand: Operand) -> Vector:
        """The value of an operand that must be a vector.

        Raises:
            ExpressionError: it is a scalar.
        """
        if not isinstance(operand.value, Vector):
            raise self.error(
                f"{self.symbol} takes a vector, not {operand.phrase}",
                "write a vector as [x, y, z]",
                operand,
            )
        return operand.value

    def require(self, operand: Operand, dimension: Dimension) -> None:
        """Check the dimension of an operand.

        Raises:
            ExpressionError: it has another one.
        """
        if not operand.dimension.compatible(dimension):
            raise self.error(
                f"{self.symbol} takes {dimension.phrase}, not {operand.phrase}",
                self.unit_hint(operand, dimension),
                operand,
            )

    def unit_hint(self, operand: Operand, dimension: Dimension) -> str:
        """How to give an operand a dimension."""
        label = self.units.label(dimension)
        number = operand.number
        bare = number is not None and number.unit is None and not number.in_pi
        if number is not None and bare and label and len(number.text) <= MAX_QUOTED:
            return f"write the number with a unit: {number.text} {label}"
        if operand.dimension.dimensionless and dimension == ANGLE:
            return "multiply it by 1 deg if it is in degrees, by 1 rad if it is in radians"
        if operand.dimension.dimensionless:
            return f"multiply it by 1 {label}"
        if (operand.dimension / ANGLE).compatible(dimension):
            return f"it is per angle: write its unit as {label}"
        if dimension.dimensionless:
            return f"divide it by 1 {self.units.label(operand.dimension)}"
        return f"give a value such as 1 {label}"


# While a file is recorded with all its numbers, each digit string becomes a recorded number that
# knows its decimal; otherwise it becomes a double.

Reader = Callable[[str], Any]
"""From digits (or the word `pi`) to a number to compute with."""

_READER: ContextVar[Reader | None] = ContextVar("reader of written numbers", default=None)


@contextmanager
def numbers_read_by(reader: Reader) -> Iterator[None]:
    """Numbers in this context are read by `reader`."""
    token = _READER.set(reader)
    try:
        yield
    finally:
        _READER.reset(token)


def read(value: float, digits: str) -> Any:
    """The number of these digits, whose double is `value`."""
    reader = _READER.get()
    return value if reader is None else reader(digits)
