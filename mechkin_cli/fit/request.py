"""The request of a fit: parameters with bounds, targets, constraints; all checked first.

Its dicts are read key by key (runs, quantities, values, points, inputs, moments), then as wholes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis import input_values, run_name
from mechkin_cli.arguments import a_setting, shown
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.expressions import Vector
from mechkin_cli.mechanism import response_problem
from mechkin_cli.record import NamedTuple
from mechkin_cli.tolerances import LAST_ROW
from mechkin_cli.units import TIME
from mechkin_cli.variants import expressions_of, one_value, parameter_values, sample_of
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem
    from mechkin_cli.show import Floats


def run_of(problem: Problem, place: str, given: Any) -> tuple[str, Problem]:
    """The run that a dict names, else the file's first, and its problem."""
    swept = (SWEEP,) if problem.motion.inputs or not problem.responses else ()
    name = given.get("run") if isinstance(given, Mapping) else None
    try:
        run = run_name((*swept, *problem.responses), name)
    except UsageError as error:
        raise UsageError(f"{place}: run: {error}") from None
    if run == SWEEP:
        return run, problem
    response = problem.responses[run]
    if response.search is not None and response.search.window:
        raise UsageError(
            f"{place}: {run} finds any number of equilibria in a window; write near: instead"
        )
    return run, response_problem(problem, response)


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
    quantity = expression.evaluate(sample_of(problem), problem.units)
    width = len(quantity.value.components) if isinstance(quantity.value, Vector) else 1
    return of, problem.units.label(quantity.dimension), width


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
    component = of if width == 1 else f"dot({of}, {of})/norm({of})"
    for point in given:
        parts = [point] if width == 1 else point
        if isinstance(parts, str) or not isinstance(parts, Iterable):
            raise wrong
        parts = list(parts)
        if len(parts) != width:
            raise wrong
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
    """A moment of the rows of a response, or of a sweep in time, in the file's units."""
    moments, name = problem.motion.time, SWEEP
    if problem.response is not None:
        moments, name = problem.response.moments, problem.response.name
    assert moments is not None
    in_si = one_value(place, a_setting(place, value), TIME, problem.units)
    written = moments.written
    wanted = float(problem.units.from_si(in_si, TIME))
    near = float(written[np.abs(written - wanted).argmin()])
    if abs(near - wanted) > LAST_ROW * float(np.ptp(written)):
        unit = problem.units.label(TIME)
        raise UsageError(
            f"{place}: no row of {name} stands at {wanted:.12g} {unit}, the nearest at "
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


TARGET_KEYS = ("of", "run", "is", "at", "least", "within", "label")
CONSTRAINT_KEYS = ("of", "run", "min", "max", "label")
LEAST = ("peak", "rms")
"""Reductions of a quantity that can be made small."""

EXAMPLE = '{"of": "C.theta", "at": [0, 40], "is": [50, 62]}, or {"of": "O.effort", "least": "peak"}'


class Bounds(NamedTuple):
    """A parameter that is sought: bounds and its own value, in the file's units."""

    name: str
    lower: float
    upper: float
    own: float
    unit: str


class Target(NamedTuple):
    """What a quantity should be.

    Attributes:
        of: a quantity or an expression.
        wanted: (points, width) in the file's units; none where it is to be `least`.
        at: inputs of the points, or moments of a response, in the file's units; None: where the
            curve comes nearest.
        least: "peak" or "rms"; "" where values are wanted.
        within: what counts as one, in the file's units.
        unit: of the quantity.
        width: 1, or the components of a vector.
        run: the sweep, or a response.
    """

    of: str
    wanted: Floats
    at: tuple[float, ...] | None
    least: str
    within: float
    label: str
    unit: str
    width: int
    run: str


class FitConstraint(NamedTuple):
    """Bounds of an expression in every row of a run, in the file's units."""

    of: str
    lower: float
    upper: float
    label: str
    unit: str
    run: str

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Each bound there is, with 1 for the lower and -1 for the upper one."""
        ends = ((self.lower, 1.0), (self.upper, -1.0))
        return [(bound, sign) for bound, sign in ends if np.isfinite(bound)]


def request(
    problem: Problem, targets: Any, parameters: Any, constraints: Any
) -> tuple[tuple[Bounds, ...], tuple[Target, ...], tuple[FitConstraint, ...]]:
    """The checked parameters, targets and constraints, in the file's units.

    Raises:
        UsageError: the first thing that is wrong, and what to write.
    """
    checked = [
        _target(problem, f"targets[{k}]", one)
        for k, one in enumerate(several("targets", targets, EXAMPLE))
    ]
    if not checked:
        raise UsageError(f"targets: there is none; give one such as {EXAMPLE}")
    example = '{"of": "C.theta", "min": "40 deg"}'
    limits = tuple(
        _constraint(problem, f"constraints[{k}]", one)
        for k, one in enumerate(several("constraints", constraints, example))
    )
    units = {target.unit for target, _ in checked}
    for number, (target, has_scale) in enumerate(checked):
        if len(units) > 1 and not has_scale:
            raise UsageError(
                f"targets[{number}]: targets have different units ({', '.join(sorted(units))}), so "
                f'each needs within:, the deviation that counts as one, such as "1 {target.unit}"'
            )
    return _bounds(problem, parameters), tuple(t for t, _ in checked), limits


def _bounds(problem: Problem, parameters: Any) -> tuple[Bounds, ...]:
    example = '{"a": ("20 mm", "60 mm")}'
    if not isinstance(parameters, Mapping) or not parameters:
        raise UsageError(f"parameters: expected bounds by name such as {example}")
    pairs: dict[str, tuple[Any, Any]] = {}
    for name, pair in parameters.items():
        if isinstance(pair, str) or not isinstance(pair, Sequence) or len(pair) != 2:
            raise UsageError(
                f"parameters: {str(name)[:LONGEST_NAME]} has {shown(pair)}; write the least and "
                f"the largest value, as {example}"
            )
        pairs[name] = (pair[0], pair[1])
    lower = parameter_values(problem, {name: pair[0] for name, pair in pairs.items()})
    upper = parameter_values(problem, {name: pair[1] for name, pair in pairs.items()})
    bounds = []
    for name, low in lower.items():
        known = problem.parameters[name]
        own = float(known.value)  # type: ignore[arg-type]
        ends = [float(problem.units.from_si(v, known.dimension)) for v in (low, upper[name], own)]
        unit = problem.units.label(known.dimension)
        if not ends[0] < ends[1]:
            raise UsageError(
                f"parameters: the bounds of {name} are {ends[0]:g} and {ends[1]:g} {unit}".rstrip()
                + "; write the smaller one first"
            )
        bounds.append(Bounds(name, ends[0], ends[1], ends[2], unit))
    return tuple(bounds)


def _target(problem: Problem, place: str, given: Any) -> tuple[Target, bool]:
    """A target, and whether it says what counts as one."""
    run, problem = run_of(problem, place, given)
    of, unit, width = quantity_of(problem, place, given, TARGET_KEYS, EXAMPLE)
    if ("is" in given) == ("least" in given):
        raise UsageError(
            f"{place}: say either what {of[:LONGEST_NAME]} should be (is:) or that it should be "
            "small (least:)"
        )
    least, at = given.get("least", ""), None
    if "least" in given:
        if least not in LEAST:
            raise UsageError(f"{place}: least is {shown(least)}; it is one of {', '.join(LEAST)}")
        if "at" in given:
            raise UsageError(f"{place}: what should be least counts in all rows; leave out at:")
        if width > 1 and least == "peak":
            raise UsageError(f"{place}: {of} is a vector; write norm({of})")
        wanted = np.zeros((0, width))
    else:
        wanted = points_of(problem, place, of, given["is"], width)
        if "at" in given:
            items = given["at"]
            items = items if isinstance(items, Iterable) and not isinstance(items, str) else [items]
            read = input_of if problem.motion.time is None else moment_of
            at = tuple(read(problem, f"{place}: at", item) for item in items)
            if len(at) != len(wanted):
                raise UsageError(
                    f"{place}: {len(wanted)} values and {len(at)} inputs; each needs one"
                )
        elif run != SWEEP:
            raise UsageError(f"{place}: say at which moments of {run}, at: [...]")
        elif width == 1:
            raise UsageError(
                f"{place}: a number is met somewhere by most curves; say at which inputs, at: [...]"
            )
    within = 1.0
    if "within" in given:
        within = value_of(problem, f"{place}: within", of, given["within"])
        if not within > 0.0:
            raise UsageError(f"{place}: within is {within:g}; write a deviation above zero")
    label = str(given.get("label", of if not least else f"{least}({of})"))
    return Target(of, wanted, at, least, within, label, unit, width, run), "within" in given


def _constraint(problem: Problem, place: str, given: Any) -> FitConstraint:
    example = '{"of": "norm(A.force)", "max": "50 N"}'
    run, problem = run_of(problem, place, given)
    of, unit, width = quantity_of(problem, place, given, CONSTRAINT_KEYS, example)
    if width > 1:
        raise UsageError(f"{place}: {of} is a vector; bound a component or norm({of})")
    if "min" not in given and "max" not in given:
        raise UsageError(f"{place}: add min: or max:, as {example}")
    ends = {"min": -np.inf, "max": np.inf}
    for key in ends.keys() & given.keys():
        ends[key] = value_of(problem, f"{place}: {key}", of, given[key])
    if ends["min"] > ends["max"]:
        raise UsageError(f"{place}: min is above max; exchange them")
    return FitConstraint(of, ends["min"], ends["max"], str(given.get("label", of)), unit, run)
