"""A parsed expression and its evaluation; the fields, parameters and definitions of a file.

Example:
    >>> from mechkin_cli.expressions import Quantity, parse
    >>> from mechkin_cli.units import LENGTH
    >>> parse("2*P1 + 1 m").evaluate({"P1": Quantity(0.5, LENGTH)}.__getitem__).value
    2.0
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType
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
from mechkin_cli.expressions.grammar import VANISHES, WRITE_ZERO, parse_nodes, vanishes
from mechkin_cli.expressions.quantity import (
    MAX_CHAIN,
    MAX_ERRORS,
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
    Scalar,
    Site,
    UnknownName,
    Vector,
    components,
    lookup,
    read,
    refuse_large,
)
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.tape import DoubleDoubles, Recorded, as_recorded, is_finite, is_number, plain
from mechkin_cli.units import UNITS, Dimension, UnitError, UnitSystem, conversion

_NAMES_ARE = "names are those of parameters and directions, and of quantities such as J.theta"

_IN_PI = frozenset({"+", "-", "*", "negate"})
"""Operations whose result is in parts of pi if an operand is."""

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
        first = self.nodes[0]
        if len(self.nodes) == 1 and isinstance(first, Name):
            return _look_up(first, resolve)
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
                    stack.append(Operand(literal(node), node.offset, node, node.in_pi))
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
    start = min(node.offset, *(operand.offset for operand in operands))
    in_pi = stays_in_pi(node.symbol, [operand.in_pi for operand in operands])
    return Operand(quantity, start, in_pi=in_pi)


def stays_in_pi(symbol: str, in_pi: Sequence[bool]) -> bool:
    """Whether the result of an operation is in parts of pi, of operands that are or not; divided by
    pi it may be in degrees."""
    if symbol == "/":
        return in_pi[0] and not in_pi[1]
    return symbol in _IN_PI and any(in_pi)


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
        if hint and axis in _AXES:
            # a component was asked for, not the size
            hint = re.sub(r"norm\(([\w.]+)\)", rf"\1.{axis}", hint)
        if node.text in UNITS:
            hint = f"a unit stands right behind a number: 1 {node.text}, 10 N*m"
            if node.text == "t" and _exists("time", resolve):
                hint = f"write time, if that is meant; {hint}"
        message = f"there is nothing named {node.text[:MAX_QUOTED]}"
        raise ExpressionError(message, node.offset, hint or _NAMES_ARE) from None
    except ExpressionError as error:
        raise ExpressionError(error.message, node.offset, error.hint) from error
    site = Site("." + axis, node.offset + len(prefix), _DEFAULT_UNITS)
    return operations.component(site, Operand(vector, node.offset))


def _resolved(name: str, resolve: Resolve) -> Quantity:
    """The quantity of a name, its constants as plain floats."""
    quantity = resolve(name)
    value = quantity.value
    parts = [p if isinstance(p, np.ndarray) else plain(p) for p in components(value)]
    if isinstance(value, Vector):
        return replace(quantity, value=Vector(*parts))
    return quantity if parts[0] is value else replace(quantity, value=parts[0])


def _exists(name: str, resolve: Resolve) -> bool:
    try:
        resolve(name)
    except (KeyError, ExpressionError):
        return False
    return True


def exact_literal(number: NumberNode) -> Quantity:
    """The number of a text in double-double, so that functions of it have all their digits, too."""
    pi = -PI if number.text.startswith("-") else PI
    exact = pi if number.in_pi else Fraction(number.text)
    if number.unit is None:
        return Quantity(DoubleDoubles.of_fraction(exact))  # type: ignore[arg-type]
    value: Any = DoubleDoubles.of_fraction(exact * number.unit.factor)
    return Quantity(value, number.unit.dimension)


# Scalar fields and parameters of a file. A text that is only a number takes the field's unit;
# anything else must have the field's dimension. Parameters may use one another in any order.

_LITERAL = re.compile(
    r"[ \t]*([-+]?)[ \t]*((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)[ \t]*"
)
_LONGEST_LITERAL = 400

_NO_VALUES: Mapping[str, Quantity] = MappingProxyType({})
_NO_NAMES = lookup(_NO_VALUES)


def literal(text: str) -> float | None:
    """The value of a text that is only a finite number with an optional sign; otherwise None.

    Example:
        >>> literal("010"), literal("-1e-3"), literal("0.5 in")
        (10.0, -0.001, None)
    """
    match = _LITERAL.fullmatch(text) if len(text) <= _LONGEST_LITERAL else None
    if match is None:
        return None
    value = float(match[1] + match[2])
    return value if math.isfinite(value) and not vanishes(match[2], value) else None


def number_of(text: str) -> float | None:
    """As `literal`, for a number to compute with: it may be a recorded one (`written`)."""
    value = literal(text)
    return value if value is None else read(value, "".join(text.split()))


def constant(
    text: str, dimension: Dimension, units: UnitSystem, resolve: Resolve = _NO_NAMES
) -> float:
    """The SI value of a field.

    Raises:
        ExpressionError: the text is no expression, or its value is not one finite number of the
            field's dimension.
    """
    bare = number_of(text)
    if bare is None:
        return _evaluated(parse(text), dimension, units, resolve)
    value = units.to_si(bare, dimension)
    if not is_finite(value):
        raise ExpressionError(f"{text.strip()} {units.label(dimension)} is too large", 0)
    if value == 0.0 and bare != 0.0:
        raise ExpressionError(f"{text.strip()} {units.label(dimension)} {VANISHES}", 0, WRITE_ZERO)
    return value


def constant_in_file_units(
    text: str, dimension: Dimension, units: UnitSystem, resolve: Resolve = _NO_NAMES
) -> float:
    """The value of a field in the file's units; a number is returned exactly as written.

    A literal with a unit is converted by the exact ratio of the units, so `192 deg` in a file in
    degrees is 192 and `5 cm` in a file in mm is 50.

    Raises:
        ExpressionError: as `constant`.
    """
    bare = number_of(text)
    if bare is not None:
        return bare
    expression = parse(text)
    value = _evaluated(expression, dimension, units, resolve)
    number = expression.number
    if number is None or number.unit is None:
        return units.from_si(value, dimension)
    try:
        return conversion(number.unit.factor / units.unit(dimension).factor).apply(number.value)
    except UnitError as error:
        raise ExpressionError(error.message, number.offset, error.hint) from None


def _evaluated(
    expression: Expression, dimension: Dimension, units: UnitSystem, resolve: Resolve
) -> float:
    value = scalar(expression, dimension, units, resolve)
    if not is_number(value):
        raise ExpressionError(
            "expected a constant, found a value per row", _start(expression), "use parameters only"
        )
    return value


def scalar(
    expression: Expression, dimension: Dimension, units: UnitSystem, resolve: Resolve
) -> Scalar:
    """The SI value of an expression that must be one number (per row) of a dimension.

    Raises:
        ExpressionError: a vector, another dimension, or as `Expression.evaluate`.
    """
    quantity = expression.evaluate(resolve, units)
    value = quantity.value
    start = _start(expression)
    if isinstance(value, Vector):
        raise ExpressionError(
            f"expected {dimension.phrase}, found {quantity.phrase}",
            start,
            "take a component with .x, .y or .z, or norm(...)",
        )
    if not quantity.dimension.compatible(dimension):
        operand = Operand(quantity, start, expression.number)
        hint = Site("", start, units).unit_hint(operand, dimension)
        raise ExpressionError(f"expected {dimension.phrase}, found {quantity.phrase}", start, hint)
    return value


def _start(expression: Expression) -> int:
    return len(expression.text) - len(expression.text.lstrip())


Move = Callable[[str, Quantity], Quantity]
"""Changes the value of a parameter, of which it takes name and value."""


def evaluate_parameters(
    texts: Mapping[str, str],
    units: UnitSystem,
    errors: list[ExpressionError] | None = None,
    given: Mapping[str, Quantity] = _NO_VALUES,
    moved: Move | None = None,
) -> dict[str, Quantity]:
    """The values of all parameters in SI, in the order of `texts`.

    A number without unit is dimensionless. With a list `errors`, every independent error (up to
    a little over `MAX_ERRORS`) is appended to it and the parameters that cannot be evaluated are
    left out; without one the first is raised. `given` are values instead of some texts. `moved`
    changes each value, and so those that depend on it.

    Raises:
        ExpressionError: a text that is no constant, or parameters that depend on themselves; `name`
            is the parameter, `offset` counts within its text.
    """
    all_errors: list[ExpressionError] = [] if errors is None else errors
    before = len(all_errors)
    expressions = {}
    for name, text in texts.items():
        if name not in given:
            try:
                expressions[name] = parse(text)
            except ExpressionError as error:
                error.name = name
                all_errors.append(error)
    needs = {
        name: sorted({used.partition(".")[0] for used in expression.names})
        for name, expression in expressions.items()
    }
    move = moved or (lambda _, value: value)
    values = {name: move(name, value) for name, value in given.items()}
    resolve = lookup(values, texts)
    for name in in_order(expressions, needs, all_errors):
        if len(all_errors) - before > MAX_ERRORS:
            break
        if any(need in texts and need not in values for need in needs[name]):
            continue
        try:
            expressions[name].reject_ambiguous_units(texts.__contains__)
            quantity = expressions[name].evaluate(resolve, units)
            if isinstance(quantity.value, Vector):
                hint = "take a component with .x, .y or .z"
                raise ExpressionError("a parameter is one number, not a vector", 0, hint)
            values[name] = move(name, quantity)
        except ExpressionError as error:
            error.name = name
            all_errors.append(error)
    if errors is None and len(all_errors) > before:
        raise all_errors[before]
    return {name: values[name] for name in texts if name in values}


def in_order(
    expressions: Mapping[str, Expression],
    needs: Mapping[str, list[str]],
    errors: list[ExpressionError],
    kind: str = "parameters",
) -> list[str]:
    """Names with what they need before them; the members of a cycle are left out with one error,
    in which `kind` is the noun for them."""
    order: list[str] = []
    finished: set[str] = set()
    for root in expressions:
        path: dict[str, Iterator[str]] = {} if root in finished else {root: iter(needs[root])}
        while path:
            name = next(reversed(path))
            need = next(path[name], None)
            if need is None:
                del path[name]
                if name not in finished:
                    finished.add(name)
                    order.append(name)
            elif need in path:
                chain = list(path)[list(path).index(need) :]
                errors.append(_cycle(expressions[name], chain, kind))
                finished.update(chain)
            elif need in expressions and need not in finished:
                path[need] = iter(needs[need])
    return order


def _cycle(expression: Expression, chain: list[str], kind: str) -> ExpressionError:
    shown = chain
    if len(chain) > MAX_CHAIN:
        shown = [*chain[: MAX_CHAIN - 1], f"... ({len(chain)} names)"]
    return ExpressionError(
        f"{kind} depend on themselves: {' -> '.join([*shown, chain[0]])}",
        expression.offset_of(chain[0]),
        "give one of them a value" if kind == "parameters" else "write one without the others",
        chain[-1],
    )


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
        if not isinstance(node, Name):
            return False
        parts = (node.text, node.text.partition(".")[0], node.text.rpartition(".")[0])
        return any(part in self.named for part in parts)

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
