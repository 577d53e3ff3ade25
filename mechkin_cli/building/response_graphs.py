"""The solver graph of each response at its start, and whether the start names as many coordinates
as are free."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from mechkin_cli.building.idle import held_of, note_spins, settled
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism.response import Response, response_problem
from mechkin_cli.solver.graph import SolverGraph, UnsolvableGraph, build_graph, is_redundant
from mechkin_cli.solver.graph.errors import listed
from mechkin_cli.solver.graph.left_free import left_free

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.building.fields import Fields
    from mechkin_cli.mechanism.model import Mechanism
    from mechkin_cli.mechanism.problem import Problem

Graphs = dict[str, SolverGraph | Diagnostic]

HINT = "start as many independent coordinates as are free: start: {O1.theta: 20}"


def with_graphs(fields: Fields, problem: Problem) -> tuple[Problem, Graphs]:
    """The problem whose responses have their idle freedoms held, and their graphs; what would spin
    is noted."""
    responses, graphs = {}, Graphs()
    for name, response in problem.responses.items():
        first = response_problem(problem, response)
        first = replace(first, held=held_of(first))
        response = replace(response, held=first.held)
        graphs[name] = response_graph(fields, problem, response)
        if isinstance(graphs[name], SolverGraph):
            note_spins(fields, first, free=True)
            response = replace(response, mechanism=settled(first).mechanism)
        responses[name] = response
    return replace(problem, responses=responses), graphs


def response_graph(
    fields: Fields, problem: Problem, response: Response
) -> SolverGraph | Diagnostic:
    """The solver graph with the start's coordinates driven, or why there is none: the start names
    too few coordinates or too many.

    Where constraints are redundant their equations do not tell how many are free; then the motion
    at the assembled start does.
    """
    first = response_problem(problem, response)
    driven, mechanism = first.driven, first.solved_mechanism
    place = fields.document.place(("responses", response.name, "start"))
    try:
        graph = build_graph(mechanism, driven)
    except UnsolvableGraph as error:
        if error.missing:
            return _too_few(response, error)._replace(place=place)
        return error.diagnostic._replace(place=place)
    if not is_redundant(graph) and response.independent:
        return graph
    at = [float(item.values[0]) for item in first.motion.inputs]
    standing = dict(zip(driven, [*at, *first.held_at.values()], strict=True))
    moving = left_free(mechanism, standing)
    # the drawing alone may be a special position
    if len(moving) > 1 and all(moving):
        return _undetermined(response, mechanism, driven)._replace(place=place)
    for extra in reversed(response.independent):
        fewer = {one: value for one, value in standing.items() if one != extra}
        moving = left_free(mechanism, fewer)
        if moving and not any(moving):
            return _too_many(response, extra)._replace(place=place)
    return graph


def _too_few(response: Response, error: UnsolvableGraph) -> Diagnostic:
    free = len(response.independent) + error.missing
    return Diagnostic(
        "start-count",
        "error",
        f"the start of {response.name} names {_coordinates(response.independent)}, but "
        f"{free} {'is' if free == 1 else 'are'} free; candidates: {listed(error.candidates)}",
        measured=f"{error.missing} more unknown{'s' * (error.missing > 1)} than closing equations",
        hint=HINT,
    )


def _undetermined(
    response: Response, mechanism: Mechanism, driven: Sequence[tuple[str, str]]
) -> Diagnostic:
    names = [
        f"{joint.name}.{name}"
        for joint in mechanism.joints.values()
        for name in joint.type.coordinates
        if (joint.name, name) not in driven
    ]
    return Diagnostic(
        "start-count",
        "error",
        f"the start of {response.name} names {_coordinates(response.independent)}, but more are "
        f"free; candidates: {listed(names)}",
        measured="links move at every assembled place while these coordinates rest",
        hint=HINT,
    )


def _too_many(response: Response, extra: tuple[str, str]) -> Diagnostic:
    name = ".".join(extra)
    return Diagnostic(
        "start-count",
        "error",
        f"the start of {response.name} names {_coordinates(response.independent)}, which is more "
        f"than are free: {name} follows from the others",
        hint=f"remove {name} from start; to choose among assemblies write near: {{{name}: ...}}",
    )


def _coordinates(named: Sequence[object]) -> str:
    count = len(named)
    return "no coordinate" if not count else f"{count} coordinate{'s' * (count > 1)}"
