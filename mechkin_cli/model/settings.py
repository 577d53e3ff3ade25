"""What a caller gives beside the file: values of parameters and of inputs, as numbers or texts."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mechkin_cli.arguments import Setting, a_setting, settings, shown
from mechkin_cli.building import is_tiny_length
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.expressions import ExpressionError, constant_in_file_units, lookup
from mechkin_cli.mechanism import Problem, dimension_of


def parameter_texts(parameters: Mapping[str, Setting]) -> dict[str, str]:
    """Parameters as texts; a number stands for itself, without a unit.

    Raises:
        UsageError: no mapping of names to numbers or texts.
    """
    given = settings("parameters", parameters, '{"P1": "0.6 in"}')
    return {k: v if isinstance(v, str) else repr(v) for k, v in given.items()}


def input_values(problem: Problem, at: Setting | Mapping[str, Setting]) -> dict[str, float]:
    """Inputs by name in the file's units; a bare value is for the first input that is swept.

    Raises:
        UsageError: an unknown input, or an invalid value.
    """
    inputs = {item.name: item for item in problem.motion.inputs}
    if not isinstance(at, Mapping):
        swept = [name for name, item in inputs.items() if np.ptp(item.written) > 0.0]
        names = swept or list(inputs)
        if not names:
            raise UsageError(f"{problem.mechanism.name} has no input to be put at {shown(at)}")
        at = {names[0]: a_setting("at", at)}
    places = {}
    for name, value in settings("at", at, '{"O1.theta": 170}').items():
        if name not in inputs:
            raise UsageError(
                f"{name[:LONGEST_NAME]} is no input; inputs are {', '.join(inputs) or 'none'}"
            )
        places[name] = _input_value(problem, name, value)
    return places


def _input_value(problem: Problem, name: str, value: Setting) -> float:
    """A value of an input in the file's units."""
    text = value if isinstance(value, str) else repr(value)
    dimension = dimension_of(name.rpartition(".")[2])
    resolve = lookup(problem.parameters)
    try:
        found = constant_in_file_units(text, dimension, problem.units, resolve)
        if is_tiny_length(problem.units.to_si(found, dimension), dimension):
            raise ExpressionError("this length is too small", 0, "check its exponent and unit")
        return found
    except ExpressionError as error:
        hint = f"; {error.hint}" if error.hint else ""
        raise UsageError(f"{name} at {text[:LONGEST_NAME]}: {error.message}{hint}") from None
