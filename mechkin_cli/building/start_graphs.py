"""The solver graphs at the starts of responses and equilibria, which show whether a start names as
many coordinates as are free; idle freedoms of what moves freely are held."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from mechkin_cli import mobility
from mechkin_cli.building.responses import held_of, note_spins, settled
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import Problem, ResponseProblem, StartValue, response_problem
from mechkin_cli.record import replace
from mechkin_cli.session import left_free, solver_graph
from mechkin_cli.structure import SolverGraph, UnsolvableGraph, is_redundant, listed

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields
    from mechkin_cli.mechanism import Mechanism

Graphs = dict[str, SolverGraph | Diagnostic]

HINT = "start as many independent coordinates as are free: start: {O1.theta: 20}"
HINTS = {
    "start": HINT,
    "near": "name as many independent coordinates as are free: near: {O1.theta: 20}",
    "window": "name as many independent coordinates as are free: window: {O1.theta: {from: -90, "
    "to: 90}}",
}


def with_graphs(fields: Fields, problem: Problem) -> tuple[Problem, Graphs]:
    """The problem whose responses have their idle freedoms held, and are held to the family that
    their coordinates name, and their graphs; links that would spin are noted."""
    responses, graphs = {}, Graphs()
    for name, response in with_starts(problem).responses.items():
        first = response_problem(problem, response)
        first = replace(first, held=held_of(first))
        response = replace(response, held=first.held)
        graphs[name] = response_graph(fields, problem, response)
        if isinstance(graphs[name], SolverGraph):
            held = mobility.held_to_family(first)
            if held != first.held:
                first, response = replace(first, held=held), replace(response, held=held)
                graphs[name] = response_graph(fields, problem, response)
        if isinstance(graphs[name], SolverGraph):
            note_spins(fields, first, free=True)
            response = replace(response, mechanism=settled(first).mechanism)
        responses[name] = response
    return replace(problem, responses=responses), graphs


def with_starts(problem: Problem) -> Problem:
    """The problem with a start of each of its equilibria."""
    started = {name: _with_independent(problem, one) for name, one in problem.responses.items()}
    return replace(problem, responses=started)


def _with_independent(problem: Problem, response: ResponseProblem) -> ResponseProblem:
    """Equilibria that name no coordinate have those of the drawing: the first that fix the place,
    in the order of the file; a response as it is."""
    if response.search is None or response.start:
        return response
    for name in problem.mechanism.coordinates:
        first = response_problem(problem, response)
        try:
            solver_graph(first.solved_mechanism, first.driven)
        except UnsolvableGraph as error:
            if not error.missing:
                break
            if name not in error.candidates:
                continue
            joint, _, coordinate = name.rpartition(".")
            more = StartValue(joint, coordinate, 0.0, 0.0)
            response = replace(response, start=(*response.start, more))
        else:
            break
    return response


def response_graph(
    fields: Fields, problem: Problem, response: ResponseProblem
) -> SolverGraph | Diagnostic:
    """The solver graph with the start's coordinates driven, or why there is none: the start names
    too few coordinates or too many.

    Where constraints are redundant the number of their equations does not determine how many
    coordinates are free; then the motion at the assembled start does.
    """
    first = response_problem(problem, response)
    driven, mechanism = first.driven, first.solved_mechanism
    place = fields.document.place((response.section, response.name, response.named))
    try:
        graph = solver_graph(mechanism, driven)
    except UnsolvableGraph as error:
        if error.missing:
            return _too_few(response, error)._replace(place=place)
        for extra in reversed(response.independent):
            if _is_solvable(mechanism, [one for one in driven if one != extra]):
                return _too_many(response, extra)._replace(place=place)
        return error.diagnostic._replace(place=place)
    if not is_redundant(graph) and response.independent:
        return graph
    at = [float(item.values[0]) for item in first.motion.inputs]
    standing = dict(zip(driven, [*at, *first.held_at.values()], strict=True))
    if _is_left_free(first, standing):
        return _undetermined(response, mechanism, driven)._replace(place=place)
    for extra in reversed(response.independent):
        fewer = {one: value for one, value in standing.items() if one != extra}
        if _is_left_free(first, fewer) is False:
            return _too_many(response, extra)._replace(place=place)
    return graph


def _is_left_free(first: Problem, standing: Mapping[tuple[str, str], float]) -> bool | None:
    """Whether some link can move while some coordinates rest; None where that is not clear."""
    if not first.mechanism.couplings:  # of which the ranks of pairs know nothing
        places = left_free(first.solved_mechanism, standing)
        if not places:
            return None
        if not all(places):
            return None if any(places) else False
        if len(places) > 1:
            return True
    # the drawing alone may be a special position
    motion = first.motion
    resting = tuple(item for item in motion.inputs if (item.joint, item.coordinate) in standing)
    found = mobility.find_mobility(first.moved(motion._replace(inputs=resting)))
    if found.mobility is None:
        return None
    is_undriven = any(note.code == "undriven-freedom" for note in found.diagnostics)
    return is_undriven or (not resting and found.mobility > len(found.idle))


def _is_solvable(mechanism: Mechanism, driven: Sequence[tuple[str, str]]) -> bool:
    try:
        solver_graph(mechanism, driven)
    except UnsolvableGraph:
        return False
    return True


def _too_few(response: ResponseProblem, error: UnsolvableGraph) -> Diagnostic:
    free = len(response.independent) + error.missing
    return Diagnostic(
        "start-count",
        "error",
        f"the {response.named} of {response.name} names {_coordinates(response.independent)}, but "
        f"{free} {'is' if free == 1 else 'are'} free; candidates: {listed(error.candidates)}",
        measured=f"{error.missing} more unknown{'s' * (error.missing > 1)} than closing equations",
        hint=HINTS[response.named],
    )


def _undetermined(
    response: ResponseProblem, mechanism: Mechanism, driven: Sequence[tuple[str, str]]
) -> Diagnostic:
    places = {".".join(place) for place in driven}
    names = [name for name in mechanism.coordinates if name not in places]
    return Diagnostic(
        "start-count",
        "error",
        f"the {response.named} of {response.name} names {_coordinates(response.independent)}, but "
        f"more are free; candidates: {listed(names)}",
        measured="links move at every assembled place while these coordinates rest",
        hint=HINTS[response.named],
    )


def _too_many(response: ResponseProblem, extra: tuple[str, str]) -> Diagnostic:
    name = ".".join(extra)
    hint = f"remove {name} from {response.named}"
    if response.search is None:
        hint += f"; to choose among assemblies write near: {{{name}: ...}}"
    return Diagnostic(
        "start-count",
        "error",
        f"the {response.named} of {response.name} names {_coordinates(response.independent)}, "
        f"which is more than are free: {name} follows from the others",
        hint=hint,
    )


def _coordinates(named: Sequence[object]) -> str:
    count = len(named)
    return "no coordinate" if not count else f"{count} coordinate{'s' * (count > 1)}"
