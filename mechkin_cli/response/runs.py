"""From a response's start to its rows: the moments and what is driven at them, assembly,
integration, a verdict per row.

The start's coordinates and the driven ones are inputs of a session of their own, whose assembly is
chosen as a sweep's first row is. Rates may be those of other coordinates, too (`beginning`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism import MotionInputs, read_for, response_problem
from mechkin_cli.memo import remembered
from mechkin_cli.record import replace
from mechkin_cli.response.integration import (
    Beginning,
    driven_laws,
    free_session,
    watched_stop,
    with_loads,
)
from mechkin_cli.response.jumps import BendsPassed
from mechkin_cli.response.result import ENERGIES, FreeResult, ResponseResult
from mechkin_cli.response.rows import Prepared, refuse_many_rows
from mechkin_cli.response.start import beginning
from mechkin_cli.response.stretches import gathered, integrated_rows
from mechkin_cli.session import Ask, Chart, Packing, Session, turn_count
from mechkin_cli.structure import structure_of
from mechkin_cli.sweep import (
    SweepRows,
    at_once,
    first_assembly,
    judge_condition,
    judge_limits,
    limited,
    rest_on_reactions,
    row_notes,
    unfounded_in_motion,
)
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Problem, ResponseProblem, Wanted
    from mechkin_cli.response.report import MotionReport


ANY_PACKING = Packing()
"""As many lanes and threads as pay."""


def respond(
    problem: Problem,
    response: ResponseProblem,
    quantities: Iterable[str] = (),
    packing: Packing = ANY_PACKING,
    session: Session | None = None,
) -> ResponseResult:
    """Integrates a response and reads some quantities.

    Args:
        problem: of the file.
        response: one of its responses.
        quantities: names out of `response_problem(problem, response).quantities()`.
        packing: how variants and rows are packed.
        session: of that problem, where there is one; it remembers the start.

    Raises:
        UnsolvableGraph: the start names too few or too many coordinates, or such that do not fix
            the place.
        KeyError: an unknown quantity.
    """
    prepared = prepare(problem, response, packing, session)
    (result,) = integrated([prepared], packing)
    read(result, quantities)
    return result


def prepare(
    problem: Problem,
    response: ResponseProblem,
    packing: Packing = ANY_PACKING,
    session: Session | None = None,
) -> Prepared:
    """The first assembly of a response, and how it moves there; arguments as those of `respond`.

    Raises:
        UnsolvableGraph: as `respond`.
    """
    if session is None:
        session = Session.of(response_problem(problem, response))
    one = _prepared(session, response)
    return replace(one, chosen=one.chosen.packed(packing), free=one.free.packed(packing))


@remembered
def _prepared(chosen: Session, response: ResponseProblem) -> Prepared:
    chosen, start = first_assembly(chosen)
    place = response.place
    placed = [one if one.place else one._replace(place=place) for one in start.diagnostics]
    start = replace(start, diagnostics=placed)
    free = free_session(chosen, response.independent)
    if start.state is None:
        return Prepared(response, chosen, start, free, None, None)
    begun = beginning(chosen, free, response, start.state)
    unfounded = unfounded_in_motion(free.problem, redundant=free.is_redundant)
    begun = begun if unfounded is None else unfounded
    if not isinstance(begun, Beginning):
        start = replace(start, diagnostics=[*start.diagnostics, begun])
        return Prepared(response, chosen, start, free, None, None)
    # equilibria are looked for at one moment
    laws = driven_laws(free, response) if response.search is None else None
    return Prepared(response, chosen, start, free, begun, laws)


def integrated(variants: Sequence[Prepared], packing: Packing) -> list[ResponseResult]:
    """The rows of variants of one response, before anything is read; those that share what the
    kernel takes once are integrated together in lanes."""
    results: dict[int, ResponseResult] = {}
    groups: dict[object, list[int]] = {}
    for number, one in enumerate(variants):
        refuse_many_rows(one)
        if one.begun is None:
            results[number] = _nothing(one)
        else:
            groups.setdefault(_shared(one, number), []).append(number)
    for numbers in groups.values():
        together = [variants[number] for number in numbers]
        for number, rows in zip(numbers, integrated_rows(together, packing), strict=True):
            one = variants[number]
            results[number] = _to_jumps(one, gathered(one, packing, rows), packing)
    return [results[number] for number in range(len(variants))]


def _shared(one: Prepared, number: int) -> object:
    """Equal for variants that the kernel takes in one call: with the same laws of drives, stops and
    moments, and plans of one structure."""
    if one.driven is not None:
        return number
    response, plan = one.response, one.free.plan
    return (
        response.moments.values.tobytes(),
        tuple(watched_stop(stop) for stop in response.stops),
        (response.tolerance, response.fixed_step),
        (structure_of(one.free.graph), one.free.layout.length, plan.constants.size),
    )


def _to_jumps(one: Prepared, result: ResponseResult, packing: Packing) -> ResponseResult:
    """The rows up to a place at which the slope of a function jumps, where the motion comes to one:
    no step across it is a motion."""
    passed = BendsPassed(result.problem)
    passed.add(result)
    again = ended_at_jumps(one, passed, result.report)
    if again is one:
        return result
    return gathered(again, packing)


def ended_at_jumps(one: Prepared, passed: BendsPassed, report: MotionReport | None) -> Prepared:
    """With an end at each jump of a slope that its motion has passed; itself without any."""
    ends = passed.ends(report, one.chosen, one.response)
    if not ends:
        return one
    response = replace(one.response, stops=(*one.response.stops, *ends))
    free = with_loads(one.free, replace(one.free.problem, response=response))
    return replace(one, response=response, free=free)


def _nothing(one: Prepared) -> ResponseResult:
    """Rows without a place: there is no first assembly."""
    response, free, start = one.response, one.free, one.start
    count, charts = response.rows, len(response.independent)
    rows = SweepRows.without_guesses(free.layout.states, turn_count(free.plan), count)
    rows.status[:] = Status.not_assembled if start.state is None else Status.branch_lost
    zeros = np.zeros((charts, count))
    directions = np.zeros((charts * free.plan.columns, count))
    chart = Chart(directions, zeros, zeros, np.zeros((0, count)))
    driven = response.driven_in(0, count)
    motion = MotionInputs(driven, count, response.moments, response.course)
    return ResponseResult(
        free.moved(replace(free.problem, motion=motion)),
        start,
        rows,
        chosen=one.chosen,
        chart=chart,
        work=np.full((2, count), np.nan),
        events=[""] * count,
        response=response,
        report=None,
    )


def read(result: FreeResult, quantities: Iterable[str]) -> None:
    """Closes the rows once more, judges them, and reads some quantities."""
    known = result.problem.quantities()
    requested: list[Wanted] = [known[name] for name in read_for(quantities, known)]
    rows = result.row_states
    if rows.reached.any():
        judging = [*(known[name] for name in ENERGIES), *limited(result.problem)]
        wanted, demand = at_once(result.session, [*requested, *judging], verdicts=True)
        wanted = [q for q in wanted if not result.is_given(q)]
        wanted += result.friction.beside(result.problem, wanted, demand)
        ask = Ask(demand, result.session.readout(wanted) if wanted else None)
        batch = result.run(ask)
        # what is read later is read on the same states
        rows.states = np.where(rows.reached & batch.good, batch.states, rows.states)
        failed = rows.reached & ~batch.good
        rows.status[failed] = Status.not_converged
        rows.reached &= ~failed
        judge_condition(result.session, rows, batch)
        result.keep(batch, ask)
        result.read(requested)
        judge_limits(result)
    on_reactions = rest_on_reactions(result.problem, requested)
    rows.diagnostics += row_notes(result, requested, rests_on_reactions=on_reactions)
