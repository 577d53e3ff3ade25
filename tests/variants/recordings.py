"""Recordings of mechanism files, and every number of what is built from them in one list."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np
from references import FILE_OF

from mechkin_cli.building.builder import Built, build
from mechkin_cli.building.recording import record
from mechkin_cli.building.source import open_file
from mechkin_cli.expressions.quantity import Quantity
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.plan.layout import Layout
from mechkin_cli.plan.plan import plan_records
from mechkin_cli.plan.records import flatten
from mechkin_cli.show import Floats
from mechkin_cli.structure.graph import SolverGraph, graph_of
from mechkin_cli.tape.recorder import Traced, register
from mechkin_cli.tape.tape import Tape, compiled

WITH_PARAMETERS = [
    path.stem
    for path in list(FILE_OF.values())
    if {"parameters:", "motion:"} <= set((text := path.read_text(encoding="utf-8")).splitlines())
    and "step: step" not in text
]
"""A step decides how many rows there are, which no recording leaves open."""


def base_of(stem: str) -> Built:
    return build(*open_file(FILE_OF[stem]))


def parameters_of(built: Built) -> dict[str, float]:
    return {name: quantity.value for name, quantity in built.problem.parameters.items()}


def built_anew(base: Built, values: Mapping[str, float]) -> Built:
    """By the ordinary path."""
    known = base.problem.parameters
    given = {n: Quantity(float(v), known[n].dimension) for n, v in values.items()}
    return build(base.file, base.document, given)


def numbers_in(value: Any) -> Iterator[Any]:
    """Every number of some nested data, in a fixed order; whole numbers are structure."""
    if isinstance(value, float | Traced):
        yield value
    elif isinstance(value, np.ndarray):
        if value.dtype in (np.float64, object):
            yield from value.flat
    elif isinstance(value, Mapping):
        for key in value:
            yield from numbers_in(value[key])
    elif isinstance(value, tuple | list):
        for item in value:
            yield from numbers_in(item)
    elif is_dataclass(value):
        for field in fields(value):
            # a sweep is recorded, without the responses that its file may have
            if field.name not in ("units", "diagnostics", "load_laws", "dimension", "responses"):
                yield from numbers_in(getattr(value, field.name))


def constants_of(problem: Problem, graph: SolverGraph) -> list[Any]:
    return flatten(plan_records(Layout(problem.mechanism, graph)))


def everything(problem: Problem, graph: SolverGraph) -> list[Any]:
    """All numbers of the problem, then all constants of its plan."""
    return [*numbers_in(problem), *constants_of(problem, graph)]


@cache
def tape_of(stem: str) -> tuple[Built, Tape, Any]:
    """A file, the tape from all its parameters to `everything`, and the same for the kernel."""
    base = base_of(stem)
    recorder, problem = record(base, list(base.problem.parameters))
    assert isinstance(base.graph, SolverGraph)
    numbers = everything(problem, graph_of(problem.mechanism, base.graph))
    tape = recorder.tape(register(recorder, number) for number in numbers)
    return base, tape, compiled(tape)


def near(base: Built, count: int, seed: int, spread: float = 0.05) -> Floats:
    """Values (parameters, count) about the file's own, which stand in the first column."""
    own = np.array(list(parameters_of(base).values()))
    generator = np.random.default_rng(seed)
    values = own[:, None] * (1.0 + spread * generator.standard_normal((own.size, count)))
    values[:, 0] = own
    return values
