"""`Model.respond`: one of the file's responses, by its name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING

from mechkin_cli.analysis.response import respond as run_response
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.interface.analysis import Analysis
from mechkin_cli.interface.arguments import a_text
from mechkin_cli.interface.asking import a_packing, chosen_tables, known_mode, wanted_names
from mechkin_cli.mechanism.response import response_problem
from mechkin_cli.nearest import nearest_hint
from mechkin_cli.solver.session import Session

if TYPE_CHECKING:
    from mechkin_cli.building.build import Built
    from mechkin_cli.expressions import Quantity
    from mechkin_cli.interface.model import Model
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.solver.precise import Precise

_AS_WRITTEN: Mapping[str, Quantity] = MappingProxyType({})


def respond(
    model: Model,
    name: str | None,
    quantities: Iterable[str] | None,
    tables: Sequence[str] | None,
    mode: str | None,
    lanes: int,
    threads: int,
) -> Analysis:
    """Runs a response of a model; arguments and errors are those of `Model.respond`."""
    packing = a_packing(lanes, threads)
    run = response_name(model, name)
    session = model.session_of(run)
    problem = model.problem
    response = problem.responses[run]
    if mode is not None:
        a_text("mode", mode, '"A"')
        assembly = replace(response.assembly, near={}, mode=mode)
        response = replace(response, assembly=assembly)
        session = session.assembled(assembly)
    layouts = chosen_tables(model.built, tables, run)
    names = wanted_names(session, run, layouts, quantities)
    result = run_response(problem, response, names, packing, session)
    analysis = Analysis(model, layouts, result, run, asked=tuple(names))
    return analysis if mode is None else known_mode(analysis)


def session_at_start(model: Model, run: str) -> Session:
    """The mechanism in the kernel at the start of a response; errors as those of
    `Model.session_of`."""
    graph = model.response_graph(run)
    first = response_problem(model.problem, model.problem.responses[run])
    return Session(first, graph).reading(exactly_read(model.built, first, model._given))


def exactly_read(
    built: Built, first: Problem, given: Mapping[str, Quantity] = _AS_WRITTEN
) -> Callable[[], Precise]:
    """What gives the numbers of a response as its text says them, read when they are first asked
    for; `first` is its first moment, `given` are values of parameters that were set."""
    from mechkin_cli.building.recording import precise_response

    return cache(lambda: precise_response(built, first, given))


def response_name(model: Model, name: str | None) -> str:
    """The response that is meant; without a name the only one.

    Raises:
        UsageError: there is none, or none of this name.
    """
    known = list(model.built.problem.responses)
    if not known:
        raise UsageError(
            "the file has no responses; add responses: {NAME: {start: {...}, time: {...}}}"
        )
    if name is None:
        if len(known) > 1:
            raise UsageError(f"respond() needs a name; responses are {', '.join(known)}")
        return known[0]
    a_text("name", name, f'"{known[0]}"')
    if name not in known:
        hint = nearest_hint(name, known) or f"responses are {', '.join(known)}"
        raise UsageError(f"there is no response {name[:LONGEST_NAME]}; {hint}")
    return name
