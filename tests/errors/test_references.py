"""Rows in double-double against references at 60 digits: 1e-28 of the largest number of their kind,
where the condition is large 1e-31 times it, of rates and loads times its square."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from errors.test_errors import ROCKER
from mechanisms.runs import run
from mechanisms.test_oracle import NAMES, mechanism, reactions, solution
from oracle import mp
from oracle.numerics import mpmath_context
from properties.answers import kind, scales
from properties.cases import case
from properties.expected import expected

import mechkin_cli as mk
from mechkin_cli.errors.errors import true_values
from mechkin_cli.errors.rows import KernelRows, Repeated, wide_run
from mechkin_cli.expressions.expression import parse
from mechkin_cli.sweep.result import Result
from mechkin_cli.units.dimension import ANGLE

RANDOM = ["loop 0", "loop 4", "structure 1"]
CLOSE = 1e-28
BY_CONDITION = 1e-31
ROW = 1


def condition_of(result: Result, row: int) -> float:
    return float(np.asarray(result.quantity("row.condition").value)[row])


def numbers(rows: Repeated, name: str, row: int) -> list[Any]:
    """A quantity at a row in the file's units, angles in rad."""
    angle = rows.problem.quantities()[name].dimension == ANGLE
    unit = mp.pi / 180 if angle else mp.one
    parts = [part[row] for part in true_values(parse(name), rows)]
    return [unit * (mp.mpf(float(part.high)) + mp.mpf(float(part.low))) for part in parts]


def worst(rows: Repeated, row: int, wanted: dict[str, Any], condition: float) -> dict[str, float]:
    """The largest error of each family, in parts of what it may be."""
    lengths = [abs(x) for n, v in wanted.items() if kind(n).order == 0 for x in v]
    largest = scales(wanted, 1.0) | {"order 0": max(1.0, float(max(lengths)))}
    found = dict.fromkeys(largest, 0.0)
    for name, values in wanted.items():
        its = kind(name)
        limit = max(CLOSE, BY_CONDITION * condition ** (1 if its.order == 0 else 2))
        for x, y in zip(numbers(rows, name, row), values, strict=True):
            error = float(abs(x - y)) / (largest[its.family] * limit) if x != y else 0.0
            found[its.family] = max(found[its.family], error)
    return found


@pytest.mark.parametrize("name", NAMES)
def test_mechanisms_kept_here(name):
    """Loops with masses and loads, closed as written and by free bodies."""
    result = run(name).result
    known = result.problem.quantities()
    wanted = expected(mechanism(name), solution(name, ROW), reactions(name, ROW))
    wanted = {name: value for name, value in wanted.items() if name in known}
    rows = Repeated(result, wide_run(result))
    found = worst(rows, ROW, wanted, condition_of(result, ROW))
    assert max(found.values()) < 1.0, found


@pytest.mark.parametrize("name", RANDOM)
def test_random_mechanisms(name):
    """All pairs, several loops and inputs."""
    its = case(name)
    result = mk.loads(its.text).analyze(tables=[]).result
    wanted = expected(its.mechanism, its.solution, its.reactions)
    rows = Repeated(result, wide_run(result))
    found = worst(rows, its.row, wanted, condition_of(result, its.row))
    assert max(found.values()) < 1.0, found


def test_constants_as_doubles_are_seen(monkeypatch):
    """Rounding the constants alone moves a row by 1e-16."""
    original = KernelRows._constants
    monkeypatch.setattr(KernelRows, "_constants", lambda *given: original(*given) * [1.0, 0.0])
    its = case("loop 0")
    result = mk.loads(its.text).analyze(tables=[]).result
    wanted = expected(its.mechanism, its.solution, its.reactions)
    rows = Repeated(result, wide_run(result))
    assert max(worst(rows, its.row, wanted, condition_of(result, its.row)).values()) > 1e8


def crank_of(rocker: Any) -> Any:
    """The crank's angle of a four-bar by its circles, from the rocker's; both zero as drawn."""
    of = mpmath_context
    a, d, c = of.mpf("20.3"), of.mpf(70), (of.mpf("60.1"), of.mpf("50.7"))
    rod = (c[0] - a) ** 2 + c[1] ** 2
    x, y = c[0] - d, c[1]
    x, y = d + of.cos(rocker) * x - of.sin(rocker) * y, of.sin(rocker) * x + of.cos(rocker) * y
    size = of.sqrt(x * x + y * y)
    between = of.acos((size * size + a * a - rod) / (2 * a * size))
    return of.atan2(y, x) - between


def test_toward_a_dead_centre():
    """The rocker drives, down to 1e-9 degrees before its dead centre: conditions up to 1e6."""
    places = ["10", "39.93", "39.93118", "39.9311809", "39.9311809496"]
    text = ROCKER.replace("UNIT", "mm").replace(
        "VALUES", f"{{values: [0, {', '.join(places)}], rate: 1 rad/s}}"
    )
    r = mk.loads(text).analyze()
    rows = Repeated(r.result, wide_run(r.result))
    for row, place in enumerate(places, 1):
        rocker, condition = (
            mpmath_context.mpf(place) * mpmath_context.pi / 180,
            condition_of(r.result, row),
        )
        slope = mpmath_context.diff(crank_of, rocker, h=mpmath_context.mpf(10) ** -30)
        exact = mp.mpf(crank_of(rocker)), mp.mpf(slope)
        for name, value, power in zip(("A.theta", "A.theta_dot"), exact, (1, 2), strict=True):
            limit = max(CLOSE, BY_CONDITION * condition**power) * max(1.0, abs(float(value)))
            (found,) = numbers(rows, name, row)
            assert abs(found - value) < limit, (place, name)
    assert condition > 1e5
    assert (r.errors.states <= r["row.error_bound"]).all()
