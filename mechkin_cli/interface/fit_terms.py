"""What a fit's dicts say, key by key: runs, quantities, values, points, inputs and moments."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.expressions import Vector
from mechkin_cli.interface.arguments import a_setting, shown
from mechkin_cli.interface.asking import run_name
from mechkin_cli.interface.given import one_value
from mechkin_cli.interface.settings import input_values
from mechkin_cli.interface.variant_runs import sample_of
from mechkin_cli.interface.variants import expressions_of
from mechkin_cli.mechanism.response import response_problem
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.runs import SWEEP
from mechkin_cli.tolerances import LAST_ROW
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem


def run_of(problem: Problem, place: str, given: Any) -> tuple[str, Problem]:
    """The run that is meant, the file's first without a word of it, and its problem."""
    swept = (SWEEP,) if problem.motion.inputs or not problem.responses else ()
    name = given.get("run") if isinstance(given, Mapping) else None
    try:
        run = run_name((*swept, *problem.responses), name)
    except UsageError as error:
        raise UsageError(f"{place}: run: {error}") from None
    if run == SWEEP:
        return run, problem
    return run, response_problem(problem, problem.responses[run])


def quantity_of(
    problem: Problem, place: str, given: Any, keys: Sequence[str], example: str
) -> tuple[str, str, int]:
    """Text, unit and width of what a target or a constraint is of."""
    if not isinstance(given, Mapping) or not isinstance(given.get("of"), str):
        raise UsageError(f"{place}: expected a dict such as {example}, not {shown(given)}")
    for key in given:
        if key not in keys:
            hint = nearest_hint(str(key), list(keys)) or f"keys are {', '.join(keys)}"
            raise UsageError(f"{place}: there is no key {str(key)[:LONGEST_NAME]}; {hint}")
    of = given["of"]
    try:
        expression = expressions_of([of], problem)[of]
    except UsageError as error:
        raise UsageError(f"{place}: {error}") from None
    found = expression.evaluate(sample_of(problem), problem.units)
    width = len(found.value.components) if isinstance(found.value, Vector) else 1
    return of, problem.units.label(found.dimension), width


def value_of(problem: Problem, place: str, of: str, value: Any) -> float:
    """A value with the dimension of an expression, in the file's units."""
    expression = expressions_of([of], problem)[of]
    dimension = expression.evaluate(sample_of(problem), problem.units).dimension
    in_si = one_value(place, a_setting(place, value), dimension, problem.units)
    return float(problem.units.from_si(in_si, dimension))


def points_of(problem: Problem, place: str, of: str, given: Any, width: int) -> Floats:
    """(points, width) in the file's units."""
    wrong = UsageError(
        f"{place}: is should be a list of "
        + ("values" if width == 1 else f"points of {width} numbers")
        + f", not {shown(given)}"
    )
    if isinstance(given, str) or not isinstance(given, Iterable):
        given = [given]
    rows = []
    for point in given:
        parts = [point] if width == 1 else point
        if isinstance(parts, str) or not isinstance(parts, Iterable):
            raise wrong
        parts = list(parts)
        if len(parts) != width:
            raise wrong
        component = of if width == 1 else f"dot({of}, {of})/norm({of})"
        rows.append([value_of(problem, f"{place}: is", component, part) for part in parts])
    if not rows:
        raise wrong
    return np.array(rows)


def input_of(problem: Problem, place: str, value: Any) -> float:
    """A value of the input that moves, in the file's units."""
    try:
        return next(iter(input_values(problem, a_setting(place, value)).values()))
    except UsageError as error:
        raise UsageError(f"{place}: {error}") from None


def moment_of(problem: Problem, place: str, value: Any) -> float:
    """A moment of a response's rows, in the file's units."""
    response = problem.response
    assert response is not None
    in_si = one_value(place, a_setting(place, value), TIME, problem.units)
    written = response.moments.written
    wanted = float(problem.units.from_si(in_si, TIME))
    near = float(written[np.abs(written - wanted).argmin()])
    if abs(near - wanted) > LAST_ROW * float(np.ptp(written)):
        unit = problem.units.label(TIME)
        raise UsageError(
            f"{place}: no row of {response.name} stands at {wanted:.12g} {unit}, the nearest at "
            f"{near:.12g} {unit}; write that, or other moments into its time:"
        )
    return near


def several(name: str, given: Any, example: str) -> list[Any]:
    """One dict or a list of them as a list.

    Raises:
        UsageError: something else.
    """
    if isinstance(given, Mapping):
        return [given]
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise UsageError(f"{name}: expected a list of dicts such as {example}, not {shown(given)}")
    return list(given)
