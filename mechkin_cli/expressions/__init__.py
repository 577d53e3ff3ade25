"""Arithmetic with dimensions over parameters and quantities: from text to values.

Hides tokens, grammar, and how an expression is evaluated over rows, differentiated or expanded in
jets. An expression is parsed once; evaluating it never raises for a number, only for a dimension or
a name.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.expressions.differentiation import *
    from mechkin_cli.expressions.expression import *
    from mechkin_cli.expressions.grammar import *
    from mechkin_cli.expressions.quantity import *

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
