"""Rows in double-double against references at 60 digits: 1e-28 of the largest number of their kind,
where the condition is large 1e-31 times it, of rates and loads times its square."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mechanisms.runs import run
from mechanisms.test_oracle import NAMES, mechanism, reactions, solution
from oracle import mp
from properties.answers import kind, scales
from properties.cases import case
from properties.expected import expected

import mechkin_cli as mk
from mechkin_cli.analysis.errors import Repeated
from mechkin_cli.analysis.errors.wide import KernelRows, wide_run
from mechkin_cli.analysis.sweep import Result
from mechkin_cli.expressions import parse
from mechkin_cli.tables.true_columns import true_values
from mechkin_cli.units import ANGLE

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
