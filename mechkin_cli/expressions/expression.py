"""A parsed expression and its evaluation.

Example:
    >>> from mechkin_cli.expressions import Quantity, parse
    >>> from mechkin_cli.units import LENGTH
    >>> parse("2*P1 + 1 m").evaluate({"P1": Quantity(0.5, LENGTH)}.__getitem__).value
    2.0
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from mechkin_cli.exact import PI
from mechkin_cli.expressions import operations
from mechkin_cli.expressions.functions import (
    FORMS,
    FUNCTIONS,
    is_infinite,
    of_infinite,
    without_new,
)
from mechkin_cli.expressions.grammar import VANISHES, WRITE_ZERO, parse_nodes
from mechkin_cli.expressions.quantity import (
    MAX_EXPANDED,
    MAX_EXPONENT,
    MAX_QUOTED,
    ExpressionError,
    Name,
    Node,
    NumberNode,
    Operand,
    OperationNode,
    Quantity,
    Resolve,
    Site,
    UnknownName,
    Vector,
    components,
)
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.tape import DoubleDoubles, Recorded, as_recorded, is_finite, is_number, plain
from mechkin_cli.units import UNITS, UnitError, UnitSystem, conversion

_NAMES_ARE = "names are those of parameters and directions, and of quantities such as J.theta"

_OPERATIONS: dict[str, Callable[..., Quantity]] = {
    "+": operations.add_or_subtract,
    "-": operations.add_or_subtract,
    "*": operations.multiply,
    "/": operations.divide,
    "^": operations.raise_to_power,
    "negate": operations.negate,
    "[]": operations.vector,
    ".x": operations.component,
    ".y": operations.component,
    ".z": operations.component,
    **dict.fromkeys(operations.COMPARED, operations.compare),
    "and": operations.join,
    "or": operations.join,
    "not": operations.deny,
    **{name: function.apply for name, function in (FUNCTIONS | FORMS).items()},
}
_AXES = ("x", "y", "z")
_DEFAULT_UNITS = UnitSystem()


class Expression(NamedTuple):
    """An expression; `nodes` are in postfix order."""

    text: str
    nodes: tuple[Node, ...]

    @property
    def names(self) -> frozenset[str]:
        """The dotted names that a resolver has to look up.

        A component of a name with a dot is left out: `pm1.position.x` counts as `pm1.position`.
        `B.x` stays: it is a coordinate x of a joint B, or else the component of a direction B.
        """
        return frozenset(_looked_up(node) for node in self.nodes if isinstance(node, Name))

    @property
    def number(self) -> NumberNode | None:
        """The number literal, with or without unit, that the whole expression consists of."""
        only = self.nodes[0]
        return only if len(self.nodes) == 1 and isinstance(only, NumberNode) else None

    @property
    def in_doubles(self) -> Expression:
        """The same with its numbers as doubles, where they are recorded: to check it on rows."""
        if not any(isinstance(n, NumberNode) and isinstance(n.value, Recorded) for n in self.nodes):
            return self
        nodes = (
            n._replace(value=as_recorded(n.value)) if isinstance(n, NumberNode) else n
            for n in self.nodes
        )
        return Expression(self.text, tuple(nodes))

    def taking_whole(self, names: Collection[str]) -> Expression:
        """The same where some names are no components of others."""
        nodes = (
            node._replace(whole=True) if isinstance(node, Name) and node.text in names else node
            for node in self.nodes
        )
        return Expression(self.text, tuple(nodes))

    def offset_of(self, name: str) -> int:
        """Where a name, or a dotted name that begins with it, first stands in the text."""
        offsets = [
            node.offset
            for node in self.nodes
            if isinstance(node, Name) and (node.text == name or node.text.startswith(name + "."))
        ]
        return min(offsets, default=0)

    def reject_ambiguous_units(self, known: Callable[[str], bool]) -> None:
        """Refuse unit words behind `*` or `/` that are known names too.

        Raises:
            ExpressionError: `10 N*m` where there is a parameter m.
        """
        for node in self.nodes:
            if isinstance(node, NumberNode):
                for word, offset in node.joined_units:
                    if known(word):
                        unit = f"1 {word}"
                        raise ExpressionError(
                            f"ambiguous: {word} is a unit and a name of this file",
                            offset,
                            f"write spaces around the sign to mean the name, {unit} for the unit",
                        )

    def evaluate(
        self,
        resolve: Resolve,
        units: UnitSystem = _DEFAULT_UNITS,
        literal: Callable[[NumberNode], Quantity] | None = None,
        *,
        through_infinity: bool = False,
    ) -> Quantity:
        """The value in SI, with names looked up by `resolve`.

        Values of names may be floats, rows of shape (rows,), or vectors of these. A row in which an
        operation has no finite value is nan from there on, one in which a name is infinite is
        infinite or nan; a constant without a finite value is an error. To check dimensions alone,
        resolve every name to rows of length one. `units` are only used to write hints; `literal`
        gives numbers of the text (None: as doubles). `through_infinity` lets functions take
        infinite rows, as the kernel's programs do: atan(1/x) is a quarter turn at 0.

        Raises:
            ExpressionError: unknown name, dimensions that do not fit, a value outside a function's
                domain; the offset is that of the offending part.
        """
        self.reject_ambiguous_units(lambda word: _exists(word, resolve))
        literal = literal or _literal
        stack: list[Operand] = []
        some_infinite = through_infinity
        with np.errstate(all="ignore"):
            for node in self.nodes:
                if isinstance(node, OperationNode):
                    operands = stack[-node.arity :]
                    del stack[-node.arity :]
                    operand = _operate(node, operands, units)
                    if not some_infinite:
                        operand = without_new(operand)
                    elif not through_infinity:
                        operand = of_infinite(node.symbol, operand, operands)
                    stack.append(operand)
                elif isinstance(node, NumberNode):
                    stack.append(Operand(literal(node), node.offset, node))
                else:
                    quantity = _look_up(node, resolve)
                    some_infinite = some_infinite or is_infinite(quantity)
                    stack.append(Operand(quantity, node.offset))
        return stack[-1].quantity


def parse(text: str) -> Expression:
    """The expression of a text.

    Raises:
        ExpressionError: the text is not an expression, or exceeds a limit (`MAX_NODES`, ...).
    """
    return Expression(text, parse_nodes(text))


def _looked_up(node: Name) -> str:
    prefix, _, axis = node.text.rpartition(".")
    if node.whole:
        return node.text
    return prefix if axis in _AXES and "." in prefix else node.text


def _operate(node: OperationNode, operands: list[Operand], units: UnitSystem) -> Operand:
    site = Site(node.symbol, node.offset, units)
    quantity = _OPERATIONS[node.symbol](site, *operands)
    if any(exponent**2 > MAX_EXPONENT**2 for exponent in quantity.dimension.exponents):
        raise site.error(
            f"the dimension {quantity.dimension} has an exponent above the limit {MAX_EXPONENT}"
        )
    if any(is_number(item) and not is_finite(item) for item in components(quantity.value)):
        # an overflow, or a value outside a function's domain
        numbers = [f"{item.value:.6g}" for item in operands if isinstance(item.value, float)]
        of_numbers = f" for {', '.join(numbers)} (in SI units)" if numbers else ""
        raise site.error(
            f"{site.symbol} has no finite value{of_numbers}", "check the values of the parameters"
        )
    return Operand(quantity, min(node.offset, *(operand.offset for operand in operands)))


def _literal(number: NumberNode) -> Quantity:
    if number.unit is None:
        return Quantity(number.value)
    try:
        value = conversion(number.unit.factor).apply(number.value)
    except UnitError as error:
        raise ExpressionError(error.message, number.offset, error.hint) from None
    finite = is_finite(value)
    if not finite or (value == 0.0 and number.value != 0.0):
        text = f"{number.text[:MAX_QUOTED]} {number.unit}"
        if finite:
            raise ExpressionError(f"{text} {VANISHES}", number.offset, WRITE_ZERO)
        raise ExpressionError(f"{text} is too large", number.offset)
    return Quantity(value, number.unit.dimension)


def _look_up(node: Name, resolve: Resolve) -> Quantity:
    """The quantity of a name, or else the component of the quantity before its last dot."""
    prefix, _, axis = node.text.rpartition(".")
    try:
        if _looked_up(node) == node.text:
            try:
                return _resolved(node.text, resolve)
            except KeyError:
                if axis not in _AXES or not _exists(prefix, resolve):
                    raise
        vector = _resolved(prefix, resolve)
    except KeyError as error:
        hint = error.hint if isinstance(error, UnknownName) else None
        if node.text in UNITS:
            hint = f"a unit stands right behind a number: 1 {node.text}, 10 N*m"
        message = f"there is nothing named {node.text[:MAX_QUOTED]}"
        raise ExpressionError(message, node.offset, hint or _NAMES_ARE) from None
    except ExpressionError as error:
        raise ExpressionError(error.message, node.offset, error.hint) from error
    site = Site("." + axis, node.offset + len(prefix), _DEFAULT_UNITS)
    return operations.component(site, Operand(vector, node.offset))


def _resolved(name: str, resolve: Resolve) -> Quantity:
    """The quantity of a name, its constants as plain floats."""
    quantity = resolve(name)
    if not isinstance(quantity.value, Vector):
        number = quantity.value if isinstance(quantity.value, np.ndarray) else plain(quantity.value)
        return quantity if number is quantity.value else replace(quantity, value=number)
    parts = [p if isinstance(p, np.ndarray) else plain(p) for p in quantity.value.components]
    return replace(quantity, value=Vector(*parts))


def _exists(name: str, resolve: Resolve) -> bool:
    try:
        resolve(name)
    except (KeyError, ExpressionError):
        return False
    return True


Differentiate = Callable[[tuple[Node, ...], Name, int], tuple[Node, ...]]
"""The derivative of nodes by the coordinate of a name, with the offset of the whole."""


@dataclass(frozen=True)
class Definitions:
    """Named expressions, whose nodes replace their names in other expressions, and how derivatives
    are taken (None: not at all).

    So whoever evaluates an expression knows only quantities of the mechanism and parameters,
    whatever a file calls them. What grows beyond `MAX_EXPANDED` is refused.
    """

    named: Mapping[str, Expression] = field(default_factory=dict)
    differentiate: Differentiate | None = field(default=None, compare=False)

    def adding(self, name: str, expression: Expression) -> Definitions:
        """These and one more, which has no names of others."""
        return replace(self, named={**self.named, name: expression})

    def parse(self, text: str) -> Expression:
        """The expression of a text, in quantities of the mechanism.

        Raises:
            ExpressionError: as `parse`; or a derivative that is not known.
        """
        return self.expanded(parse(text))

    def expanded(self, expression: Expression) -> Expression:
        """The expression with the named expressions in the places of their names.

        Raises:
            ExpressionError: it grows too large, or a derivative is not known.
        """
        if not any(self._is_replaced(node) for node in expression.nodes):
            return expression

        stack: list[list[Node]] = []
        for node in expression.nodes:
            if isinstance(node, Name):
                stack.append(self._replacement(node))
            elif isinstance(node, OperationNode):
                operands = stack[-node.arity :]
                del stack[-node.arity :]
                stack.append(self._operated(node, operands))
            else:
                stack.append([node])
            refuse_large(sum(map(len, stack)), node.offset)
        return Expression(expression.text, tuple(stack[-1]))

    def _is_replaced(self, node: Node) -> bool:
        if isinstance(node, OperationNode):
            return node.symbol == "derivative" and self.differentiate is not None
        return isinstance(node, Name) and node.text.partition(".")[0] in self.named

    def _replacement(self, name: Name) -> list[Node]:
        whole = self.named.get(name.text)
        if whole is not None:
            return _at(name.offset, whole.nodes)
        prefix, _, axis = name.text.rpartition(".")
        vector = self.named.get(prefix)
        if vector is None:
            if name.text.partition(".")[0] in self.named:
                text = f"{name.text[:MAX_QUOTED]} is not a component of a quantity"
                raise ExpressionError(text, name.offset, "components are .x, .y and .z")
            return [name]
        if axis not in _AXES:
            text = f"there is no component .{axis[:MAX_QUOTED]}"
            raise ExpressionError(text, name.offset, "components are .x, .y and .z")
        return [*_at(name.offset, vector.nodes), OperationNode(f".{axis}", 1, name.offset)]

    def _operated(self, node: OperationNode, operands: list[list[Node]]) -> list[Node]:
        if node.symbol != "derivative" or self.differentiate is None:
            return [*(part for operand in operands for part in operand), node]
        (coordinate, *others) = operands[1]
        if others or not isinstance(coordinate, Name):
            hint = "write derivative(expression, A.theta)"
            raise ExpressionError("a derivative is taken by an input", node.offset, hint)
        return list(self.differentiate(tuple(operands[0]), coordinate, node.offset))


def _at(offset: int, nodes: Sequence[Node]) -> list[Node]:
    """The nodes with one offset; those that have it are shared, as most are in a chain of names."""
    return [node if node.offset == offset else node._replace(offset=offset) for node in nodes]


def exact_literal(number: NumberNode) -> Quantity:
    """The number of a text in double-double, so that functions of it have all their digits, too."""
    exact = PI if number.text == "pi" else Fraction(number.text)
    if number.unit is None:
        return Quantity(DoubleDoubles.of_fraction(exact))  # type: ignore[arg-type]
    value: Any = DoubleDoubles.of_fraction(exact * number.unit.factor)
    return Quantity(value, number.unit.dimension)


def refuse_large(size: int, offset: int) -> None:
    """Refuses an expression that has grown too large.

    Raises:
        ExpressionError: it has more nodes than the limit.
    """
    if size > MAX_EXPANDED:
        text = f"with the quantities in it the expression has more than {MAX_EXPANDED} parts"
        raise ExpressionError(text, offset, "use fewer of them in one another")
