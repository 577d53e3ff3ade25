"""Values of parameters as a caller gives them, to SI: one of each, or arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.building.fields import is_tiny_length
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.expressions import ExpressionError, Quantity, constant
from mechkin_cli.interface.arguments import Setting, a_setting, a_text, settings, shown
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.tolerances import LARGEST_NUMBER, SMALLEST_SIZE
from mechkin_cli.units import LENGTH

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.units import Dimension, UnitSystem


def parameter_values(problem: Problem, given: Mapping[str, Any]) -> dict[str, float]:
    """One value of each parameter, in SI and in the file's order.

    Raises:
        UsageError: no mapping, an unknown parameter, or an invalid value.
    """
    values = settings("parameters", given, '{"P1": "0.6 in"}')
    return {
        name: one_value(name, values[name], known.dimension, problem.units)
        for name, known in _known(problem, values)
    }


def parameter_arrays(problem: Problem, given: Mapping[str, Any]) -> tuple[tuple[str, ...], Floats]:
    """Names in the file's order, and values (parameters, variants) in SI; one value stands for all
    variants.

    Raises:
        UsageError: as `parameter_values`; arrays of more than one dimension or different lengths.
    """
    if not isinstance(given, Mapping):
        settings("parameters", given, '{"P1": [0.5, 0.6]}')
    for name in given:
        a_text("a key of parameters", name, '"P1"')
    columns = {
        name: _column(name, given[name], known.dimension, problem.units)
        for name, known in _known(problem, given)
    }
    if not columns:
        raise UsageError('vary takes values of at least one parameter, such as {"P1": [0.5, 0.6]}')
    lengths = {name: column.size for name, column in columns.items() if column.ndim}
    if len(set(lengths.values())) > 1:
        words = ", ".join(f"{name} {n}" for name, n in lengths.items())
        raise UsageError(f"values of parameters need equally many variants, found {words}")
    count = next(iter(lengths.values()), 1)
    rows = [np.broadcast_to(column, (count,)) for column in columns.values()]
    return tuple(columns), np.stack(rows)


def _known(problem: Problem, given: Mapping[str, Any]) -> list[tuple[str, Quantity]]:
    """Names and quantities, in the file's order."""
    known = problem.parameters
    for name in given:
        if name not in known:
            listed = ", ".join(list(known)[:10])
            hint = nearest_hint(name, list(known)) or (
                f"parameters are {listed}" if known else "write parameters: into the file"
            )
            raise UsageError(f"there is no parameter {name[:LONGEST_NAME]}; {hint}")
    return [(name, known[name]) for name in known if name in given]


def one_value(name: str, value: Setting, dimension: Dimension, units: UnitSystem) -> float:
    """A value in SI; a number is in the file's units, a text carries its own.

    Raises:
        UsageError: it is none, or no number that can be computed with.
    """
    if not isinstance(value, str):
        in_si = units.to_si(float(value), dimension)
        if in_si == 0.0 and value != 0.0:
            raise UsageError(
                f"{name} = {value} is too small: in SI units it would be zero; write 0 or another "
                "value or unit"
            )
        return _bounded(name, in_si, value, dimension)
    try:
        return _bounded(name, constant(value, dimension, units), value, dimension)
    except ExpressionError as error:
        unit = units.label(dimension)
        hint = error.hint or f"write a number with its unit, such as 1 {unit}".rstrip()
        raise UsageError(f"{name} = {value[:LONGEST_NAME]}: {error.message}; {hint}") from None


def _column(name: str, value: Any, dimension: Dimension, units: UnitSystem) -> Floats:
    try:
        array = np.asarray(value)
    except Exception:
        # whatever a foreign object's conversion raises
        array = np.empty((0, 0))
    if isinstance(value, str) or array.ndim == 0:
        return np.array(one_value(name, a_setting(name, value), dimension, units))
    if array.ndim > 1:
        raise UsageError(
            f"{name}: expected a value a variant, an array of one dimension, not {shown(value)}"
        )
    if array.dtype.kind not in "fiu":
        items = [a_setting(f"{name}[{k}]", item) for k, item in enumerate(value)]
        return np.array(
            [one_value(name, item, dimension, units) for item in items], dtype=np.float64
        )
    found = units.to_si(array.astype(np.float64), dimension)
    sizes = np.abs(found)
    least = SMALLEST_SIZE if dimension == LENGTH else 0.0
    kept = (sizes >= least) & (sizes > 0.0) | (array == 0)
    wrong = np.flatnonzero(~((sizes <= LARGEST_NUMBER) & kept))
    if wrong.size:
        one_value(f"{name}[{wrong[0]}]", array[wrong[0]].item(), dimension, units)
        _bounded(f"{name}[{wrong[0]}]", float(found[wrong[0]]), array[wrong[0]], dimension)
    return found


def _bounded(name: str, in_si: float, value: object, dimension: Dimension) -> float:
    if is_tiny_length(in_si, dimension):
        raise UsageError(
            f"{name} = {str(value)[:LONGEST_NAME]} is a length below {SMALLEST_SIZE:g} m; write "
            "another value or unit"
        )
    if not abs(in_si) <= LARGEST_NUMBER:
        raise UsageError(
            f"{name} = {str(value)[:LONGEST_NAME]} is no finite number below {LARGEST_NUMBER:g} in "
            "SI units; write another value or unit"
        )
    return in_si
