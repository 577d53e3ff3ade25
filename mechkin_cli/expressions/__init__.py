"""Arithmetic with dimensions over parameters and quantities: from text to values.

Hides tokens, grammar, and how an expression is evaluated over rows, differentiated or expanded in
jets. An expression is parsed once; evaluating it never raises for a number, only for a dimension or
a name.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.expressions.differentiation import (
        Jet as Jet,
        constant_jet as constant_jet,
        derivatives as derivatives,
        differentiated as differentiated,
    )
    from mechkin_cli.expressions.expression import (
        Definitions as Definitions,
        Differentiate as Differentiate,
        Expression as Expression,
        Move as Move,
        constant as constant,
        constant_in_file_units as constant_in_file_units,
        evaluate_parameters as evaluate_parameters,
        exact_literal as exact_literal,
        in_order as in_order,
        literal as literal,
        number_of as number_of,
        parse as parse,
        scalar as scalar,
    )
    from mechkin_cli.expressions.grammar import parse_nodes as parse_nodes
    from mechkin_cli.expressions.quantity import (
        MAX_QUOTED as MAX_QUOTED,
        ExpressionError as ExpressionError,
        Name as Name,
        Node as Node,
        NumberNode as NumberNode,
        OperationNode as OperationNode,
        Quantity as Quantity,
        Resolve as Resolve,
        UnknownName as UnknownName,
        Value as Value,
        Vector as Vector,
        lookup as lookup,
        numbers_read_by as numbers_read_by,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "differentiation": "Jet constant_jet derivatives differentiated",
        "expression": "Definitions Differentiate Expression Move constant constant_in_file_units "
        "evaluate_parameters exact_literal in_order literal number_of parse scalar",
        "grammar": "parse_nodes",
        "quantity": "ExpressionError MAX_QUOTED Name Node NumberNode OperationNode Quantity "
        "Resolve UnknownName Value Vector lookup numbers_read_by",
    },
)
