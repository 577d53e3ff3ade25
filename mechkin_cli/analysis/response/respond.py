"""From a response's start to its rows: assembly, integration, a verdict per row."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.anew import structure_of
from mechkin_cli.analysis.response.beginning import Beginning, beginning
from mechkin_cli.analysis.response.endings import ending
from mechkin_cli.analysis.response.moments import rows_problem, watched_stop
from mechkin_cli.analysis.response.result import ENERGIES, ResponseResult
from mechkin_cli.analysis.sweep.friction import unfounded_in_motion
from mechkin_cli.analysis.sweep.question import at_once, rest_on_reactions
from mechkin_cli.analysis.sweep.rows import Rows
from mechkin_cli.analysis.sweep.sweep import first_assembly, judge_condition, row_notes
from mechkin_cli.mechanism.bearing_loads import read_for
from mechkin_cli.mechanism.motion import Motion
from mechkin_cli.mechanism.response import response_problem
from mechkin_cli.solver.batch import Chart
from mechkin_cli.solver.closing_turns import turn_count
from mechkin_cli.solver.driven_laws import driven_laws
from mechkin_cli.solver.free_motion import (
    MotionEnd,
    MotionRows,
    MotionStart,
    free_session,
    integrate,
)
from mechkin_cli.solver.session import Packing, Session
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.analysis.assembly.start import Start
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import DrivenLaws
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.mechanism.response import Response

ANY_PACKING = Packing()
"""As many lanes and threads as pay."""


def respond(
    problem: Problem,
    response: Response,
    quantities: Iterable[str] = (),
    packing: Packing = ANY_PACKING,
    session: Session | None = None,
) -> ResponseResult:
    """Integrates a response and reads the quantities asked for.

    Args:
        problem: of the file.
        response: one of its responses.
        quantities: names out of `response_problem(problem, response).quantities()`.
        packing: how variants and rows are packed.
        session: of that problem, where there is one; it keeps what is found of the start.

    Raises:
        UnsolvableGraph: the start names too few or too many coordinates, or such that do not fix
            the place.
        KeyError: an unknown quantity.
    """
    prepared = prepare(problem, response, packing, session)
    (result,) = integrated([prepared], packing)
    read(result, quantities)
    return result


@dataclass(frozen=True)
class Prepared:
    """A response before it is integrated: the session that its assembly was `chosen` in, that of
    the `free` motion, and how it begins; None where it cannot."""

    response: Response
    chosen: Session
    start: Start
    free: Session
    begun: Beginning | None
    driven: DrivenLaws | None


def prepare(
    problem: Problem,
    response: Response,
    packing: Packing = ANY_PACKING,
    session: Session | None = None,
) -> Prepared:
    """The first assembly of a response, and how it moves there; arguments as those of `respond`.

    Raises:
        UnsolvableGraph: as `respond`.
    """
    if session is None:
        session = Session(response_problem(problem, response))
    key = ("prepared", str(session.problem.assembly))
    found = session.once(key, lambda: _prepared(session, response))
    return replace(found, chosen=found.chosen.packed(packing), free=found.free.packed(packing))


def _prepared(chosen: Session, response: Response) -> Prepared:
    chosen, start = first_assembly(chosen)
    place = response.place
    start.diagnostics[:] = [
        told if told.place else told._replace(place=place) for told in start.diagnostics
    ]
    free = free_session(chosen, response.independent)
    if start.state is None:
        return Prepared(response, chosen, start, free, None, None)
    begun = beginning(chosen, response, start.state)
    unfounded = unfounded_in_motion(free.problem, redundant=free.is_redundant)
    begun = begun if unfounded is None else unfounded
    if not isinstance(begun, Beginning):
        start = replace(start, diagnostics=[*start.diagnostics, begun])
        return Prepared(response, chosen, start, free, None, None)
    return Prepared(response, chosen, start, free, begun, driven_laws(free, response))


def integrated(variants: Sequence[Prepared], packing: Packing) -> list[ResponseResult]:
    """The rows of variants of one response, before anything is read; those that share what the
    kernel takes once march together in lanes."""
    found: dict[int, ResponseResult] = {}
    groups: dict[object, list[int]] = {}
    for number, one in enumerate(variants):
        if one.begun is None:
            found[number] = _nothing(one)
        else:
            groups.setdefault(_shared(one, number), []).append(number)
    for numbers in groups.values():
        together = [variants[number] for number in numbers]
        for number, rows in zip(numbers, _integrated(together, packing), strict=True):
            found[number] = rows_of(variants[number], rows)
    return [found[number] for number in range(len(variants))]


def _shared(one: Prepared, number: int) -> object:
    """Equal for variants that the kernel takes in one call: it is given laws of drives, stops and
    moments once, and plans of one structure."""
    if one.driven is not None:
        return number
    response, plan = one.response, one.free.plan
    return (
        response.moments.values.tobytes(),
        tuple(watched_stop(stop) for stop in response.stops),
        (response.tolerance, response.fixed_step),
        (structure_of(one.free.graph), one.free.layout.length, plan.constants.size),
    )


def _integrated(together: Sequence[Prepared], packing: Packing) -> list[MotionRows]:
    first = together[0]
    response, times = first.response, first.response.moments.values
    starts = []
    for one in together:
        assert one.begun is not None
        plan = first.free.plan
        if one is not first:
            # of the same structure: plans of one call share it
            plan = plan.with_constants(one.free.plan.constants).with_size(one.free.plan.size)
        starts.append(MotionStart(plan, one.begun.state, one.begun.first, one.begun.tangents))
    return integrate(
        starts,
        float(times[0]),
        times,
        stops=[watched_stop(stop) for stop in response.stops],
        driven=first.driven,
        tolerance=response.tolerance,
        fixed_step=response.fixed_step,
        straight=first.chosen.problem.assembly.straight,
        packing=packing,
    )


def rows_of(one: Prepared, found: MotionRows) -> ResponseResult:
    """The rows with their verdicts, before anything is read: those asked for, or up to a stop."""
    response, chosen, free = one.response, one.chosen, one.free
    stopped = found.report.end is MotionEnd.STOPPED
    count = found.count if stopped else response.rows
    if stopped and _stops_at_row(response, found):
        count -= 1
    part = slice(0, count)
    reached = np.arange(count) < found.count
    rows = Rows.without_guesses(free.layout.states, 0, count)
    rows.states = np.where(reached, found.states[:, part], 0.0)
    rows.reached, rows.nodes = reached, found.report.steps
    rows.turns = _all_turns(free, found.turns[:, part])
    last = np.array(found.report.last)
    status, notes = ending(chosen, free, response, found.report, last)
    rows.status[~reached] = status
    rows.diagnostics += notes
    energy = free.layout.length * free.layout.length
    events = [""] * count
    if stopped:
        events[-1] = response.stops[found.report.stop].words
    chart = found.chart.at(part)
    return ResponseResult(
        free.moved(rows_problem(free, response, one.driven, found, count)),
        chosen,
        one.start,
        rows,
        Chart(*(np.where(reached, array, 0.0) for array in chart)),
        np.where(reached, energy * found.work[:, part], np.nan),
        events,
        response,
        found.report,
    )


def _stops_at_row(response: Response, found: MotionRows) -> bool:
    """Whether the stop's moment is that of the last row before it, which then is its row."""
    if not found.report.rows:
        return False
    row = float(response.moments.values[found.report.rows - 1])
    return abs(found.report.time - row) <= tolerances.SAME_MOMENT * abs(row)


def _nothing(one: Prepared) -> ResponseResult:
    """Rows without a place: there is no first assembly."""
    response, free, start = one.response, one.free, one.start
    count, charts = response.rows, len(response.independent)
    rows = Rows.without_guesses(free.layout.states, turn_count(free.plan), count)
    rows.status[:] = Status.not_assembled if start.state is None else Status.branch_lost
    zeros = np.zeros((charts, count))
    directions = np.zeros((charts * free.plan.columns, count))
    chart = Chart(directions, zeros, zeros, np.zeros((0, count)))
    motion = Motion(response.driven, count, response.moments, response.course)
    session = free.moved(replace(free.problem, motion=motion))
    lost = np.full((2, count), np.nan)
    events = [""] * count
    return ResponseResult(session, one.chosen, start, rows, chart, lost, events, response, None)


def _all_turns(free: Session, closing: Floats) -> Floats:
    """Turns of closing joints, and no whole turns of the tree's angles, whose states have them."""
    tree = np.zeros((len(free.turn_slots.tree), closing.shape[1]))
    return np.concatenate([closing, tree])


def read(result: ResponseResult, quantities: Iterable[str]) -> None:
    """Closes the rows once more, judges them, and reads what is asked for."""
    known = result.problem.quantities()
    asked: list[Wanted] = [known[name] for name in read_for(quantities, known)]
    rows = result.row_states
    if rows.reached.any():
        energies = [known[name] for name in ENERGIES]
        wanted, demand = at_once(result.session, [*asked, *energies], verdicts=True)
        wanted = [q for q in wanted if not result.is_given(q)]
        wanted += result.friction.beside(result.problem, wanted, demand)
        batch = result.run(wanted, demand, iterations=tolerances.NEWTON_ITERATIONS)
        # what is read later is read on the same states
        rows.states = np.where(rows.reached & batch.good, batch.states, rows.states)
        failed = rows.reached & ~batch.good
        rows.status[failed] = Status.not_converged
        rows.reached &= ~failed
        judge_condition(result.session, rows, batch)
        result.keep(batch, wanted, demand)
        result.read(asked)
    result.row_states.diagnostics += row_notes(
        result, asked, rests_on_reactions=rest_on_reactions(result.problem, asked)
    )
