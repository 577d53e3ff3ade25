"""Values of parameters as a caller gives them, to SI: one of each, or arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.expressions import ExpressionError, Quantity, constant
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.tolerances import LARGEST_NUMBER

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.units import Dimension, UnitSystem


def parameter_values(problem: Problem, given: Mapping[str, Any]) -> dict[str, float]:
    """One value of each parameter, in SI and in the file's order.

    Raises:
        UsageError: no mapping, an unknown parameter, or a value that is none.
    """
    return {
        name: _one(name, value, known.dimension, problem.units)
        for name, value, known in _known(problem, given)
    }


def parameter_arrays(problem: Problem, given: Mapping[str, Any]) -> tuple[tuple[str, ...], Floats]:
    """Names in the file's order, and values (parameters, variants) in SI; one value stands for all
    variants.

    Raises:
        UsageError: as `parameter_values`; arrays of more than one dimension or different lengths.
    """
    columns: dict[str, Floats] = {}
    lengths: dict[str, int] = {}
    for name, value, known in _known(problem, given):
        columns[name] = _column(name, value, known.dimension, problem.units)
        if columns[name].ndim:
            lengths[name] = columns[name].size
    if not columns:
        raise UsageError('vary takes values of at least one parameter, such as {"P1": [1, 2]}')
    if len(set(lengths.values())) > 1:
        words = ", ".join(f"{name} {n}" for name, n in lengths.items())
        raise UsageError(f"values of parameters need equally many variants, found {words}")
    count = next(iter(lengths.values()), 1)
    rows = [np.broadcast_to(column, (count,)) for column in columns.values()]
    return tuple(columns), np.stack(rows)


def _known(problem: Problem, given: Mapping[str, Any]) -> list[tuple[str, Any, Quantity]]:
    """Name, value and quantity, in the file's order."""
    if not isinstance(given, Mapping):
        raise UsageError(
            f'parameters are a mapping such as {{"P1": 0.5}}, not {type(given).__name__}'
        )
    known = problem.parameters
    for name in given:
        if name not in known:
            hint = nearest_hint(str(name), list(known)) or (
                f"parameters are {', '.join(known)}" if known else "the file has none"
            )
            raise UsageError(f"there is no parameter {name}; {hint}")
    return [(name, given[name], known[name]) for name in known if name in given]


def _one(name: str, value: Any, dimension: Dimension, units: UnitSystem) -> float:
    if isinstance(value, str):
        try:
            return _bounded(name, constant(value, dimension, units), value)
        except ExpressionError as error:
            hint = error.hint or f"write a number with its unit, such as 1 {units.label(dimension)}"
            raise UsageError(f"{name} = {value!r}: {error.message}; {hint.rstrip()}") from None
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.number):
        raise UsageError(
            f"{name} takes a number in {_unit(units, dimension)} or a text with its unit, "
            f"not {type(value).__name__}"
        )
    return _bounded(name, units.to_si(float(value), dimension), value)


def _column(name: str, value: Any, dimension: Dimension, units: UnitSystem) -> Floats:
    if isinstance(value, str | int | float | np.number):
        return np.array(_one(name, value, dimension, units))
    try:
        array = np.asarray(value)
    except (ValueError, TypeError):
        array = np.empty((0, 0))
    if array.ndim == 0:
        return np.array(_one(name, value, dimension, units))
    if array.ndim > 1:
        raise UsageError(f"{name} takes one value a variant, an array of one dimension")
    if array.dtype.kind not in "fiu":
        return np.array([_one(name, item, dimension, units) for item in value], dtype=np.float64)
    in_si = units.to_si(array.astype(np.float64), dimension)
    wrong = np.flatnonzero(~(np.abs(in_si) <= LARGEST_NUMBER))
    if wrong.size:
        _bounded(f"{name}[{wrong[0]}]", float(in_si[wrong[0]]), array[wrong[0]])
    return in_si


def _bounded(name: str, in_si: float, value: object) -> float:
    if not abs(in_si) <= LARGEST_NUMBER:
        raise UsageError(
            f"{name} = {value} is no finite number below {LARGEST_NUMBER:g} in SI units; "
            "check the value and its unit"
        )
    return in_si


def _unit(units: UnitSystem, dimension: Dimension) -> str:
    return units.label(dimension) or "no unit"
