"""Named expressions: where a name of one stands in a text, its nodes stand in the expression.

So whoever reads an expression knows only quantities of the mechanism and parameters, whatever a
file calls them; what grows beyond `MAX_EXPANDED` is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from mechkin_cli.expressions.errors import ExpressionError
from mechkin_cli.expressions.expression import Expression, parse
from mechkin_cli.expressions.limits import MAX_QUOTED
from mechkin_cli.expressions.nodes import Name, Node, Operation

Differentiate = Callable[[tuple[Node, ...], Name, int], tuple[Node, ...]]
"""The derivative of nodes by the coordinate of a name; the place is that of the whole."""

_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Definitions:
    """What is named, each with all names of others replaced, and how derivatives are taken where
    there are some."""

    named: Mapping[str, Expression] = field(default_factory=dict)
    differentiate: Differentiate | None = field(default=None, compare=False)

    def adding(self, name: str, expression: Expression) -> Definitions:
        """These and one more, in which what is named is replaced."""
        return replace(self, named={**self.named, name: expression})

    def parse(self, text: str) -> Expression:
        """The expression that a text says, in quantities of the mechanism.

        Raises:
            ExpressionError: as `parse`; or a derivative that is not known.
        """
        return self.expanded(parse(text))

    def expanded(self, expression: Expression) -> Expression:
        """The expression with what is named in the places of names.

        Raises:
            ExpressionError: it grows too large, or a derivative is not known.
        """
        if not any(self._is_replaced(node) for node in expression.nodes):
            return expression
        from mechkin_cli.expressions.differentiation import refuse_large

        stack: list[list[Node]] = []
        for node in expression.nodes:
            if isinstance(node, Name):
                stack.append(self._meant(node))
            elif isinstance(node, Operation):
                operands = stack[-node.arity :]
                del stack[-node.arity :]
                stack.append(self._operated(node, operands))
            else:
                stack.append([node])
            refuse_large(sum(map(len, stack)), node.offset)
        return Expression(expression.text, tuple(stack[-1]))

    def _is_replaced(self, node: Node) -> bool:
        if isinstance(node, Operation):
            return node.symbol == "derivative" and self.differentiate is not None
        return isinstance(node, Name) and node.text.partition(".")[0] in self.named

    def _meant(self, name: Name) -> list[Node]:
        whole = self.named.get(name.text)
        if whole is not None:
            return _at(name.offset, whole.nodes)
        prefix, _, axis = name.text.rpartition(".")
        vector = self.named.get(prefix)
        if vector is None:
            if name.text.partition(".")[0] in self.named:
                text = f"{name.text[:MAX_QUOTED]} is no component of a quantity"
                raise ExpressionError(text, name.offset, "components are .x, .y and .z")
            return [name]
        if axis not in _AXES:
            text = f"there is no component .{axis[:MAX_QUOTED]}"
            raise ExpressionError(text, name.offset, "components are .x, .y and .z")
        return [*_at(name.offset, vector.nodes), Operation(f".{axis}", 1, name.offset)]

    def _operated(self, node: Operation, operands: list[list[Node]]) -> list[Node]:
        if node.symbol != "derivative" or self.differentiate is None:
            return [*(part for operand in operands for part in operand), node]
        (coordinate, *others) = operands[1]
        if others or not isinstance(coordinate, Name):
            hint = "write derivative(expression, A.theta)"
            raise ExpressionError("a derivative is taken by an input", node.offset, hint)
        return list(self.differentiate(tuple(operands[0]), coordinate, node.offset))


def _at(offset: int, nodes: Sequence[Node]) -> list[Node]:
    """The nodes with one place; those that have it are shared, as most are in a chain of names."""
    return [node if node.offset == offset else node._replace(offset=offset) for node in nodes]
