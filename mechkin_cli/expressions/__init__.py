"""Expressions: arithmetic with dimensions over parameters and quantities of a mechanism."""

from mechkin_cli.expressions.errors import ExpressionError, UnknownName
from mechkin_cli.expressions.expression import Expression, parse
from mechkin_cli.expressions.fields import constant, constant_in_file_units, literal, number_of
from mechkin_cli.expressions.functions import FUNCTIONS
from mechkin_cli.expressions.operand import Resolve
from mechkin_cli.expressions.parameters import evaluate_parameters, lookup
from mechkin_cli.expressions.quantity import Quantity, Rows, Scalar, Value, Vector

__all__ = [
    "FUNCTIONS",
    "Expression",
    "ExpressionError",
    "Quantity",
    "Resolve",
    "Rows",
    "Scalar",
    "UnknownName",
    "Value",
    "Vector",
    "constant",
    "constant_in_file_units",
    "evaluate_parameters",
    "literal",
    "lookup",
    "number_of",
    "parse",
]
