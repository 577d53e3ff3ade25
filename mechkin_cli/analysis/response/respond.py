"""From a response's start to its rows: assembly, integration, a verdict per row."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.response.beginning import Beginning, beginning
from mechkin_cli.analysis.response.endings import ending
from mechkin_cli.analysis.response.moments import rows_problem, watched_stop
from mechkin_cli.analysis.response.result import ENERGIES, ResponseResult
from mechkin_cli.analysis.sweep.rows import Rows
from mechkin_cli.analysis.sweep.sweep import at_once, first_assembly, judge_condition, row_notes
from mechkin_cli.mechanism.motion import Motion
from mechkin_cli.mechanism.response import response_problem
from mechkin_cli.solver.batch import Chart
from mechkin_cli.solver.closing_turns import turn_slots
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
) -> ResponseResult:
    """Integrates a response and reads the quantities asked for.

    Args:
        problem: of the file.
        response: one of its responses.
        quantities: names out of `response_problem(problem, response).quantities()`.
        packing: how variants and rows are packed.

    Raises:
        UnsolvableGraph: the start names too few or too many coordinates, or such that do not fix
            the place.
        KeyError: an unknown quantity.
    """
    chosen = Session(response_problem(problem, response), packing=packing)
    chosen, start = first_assembly(chosen)
    free = free_session(chosen, response.independent)
    if start.state is None:
        return _nothing(chosen, free, start, response)
    begun = beginning(chosen, response, start.state)
    if not isinstance(begun, Beginning):
        start.diagnostics.append(begun)
        return _nothing(chosen, free, start, response)
    driven = driven_laws(free, response)
    found = _integrated(free, begun, response, driven, packing)
    result = _rows(chosen, free, start, response, driven, found)
    _read(result, quantities)
    return result


def _integrated(
    free: Session,
    begun: Beginning,
    response: Response,
    driven: DrivenLaws | None,
    packing: Packing,
) -> MotionRows:
    times = response.moments.values
    start = MotionStart(free.plan, begun.state, begun.first, begun.tangents)
    (found,) = integrate(
        [start],
        float(times[0]),
        times,
        stops=[watched_stop(stop) for stop in response.stops],
        driven=driven,
        tolerance=response.tolerance,
        fixed_step=response.fixed_step,
        packing=packing,
    )
    return found


def _rows(
    chosen: Session,
    free: Session,
    start: Start,
    response: Response,
    driven: DrivenLaws | None,
    found: MotionRows,
) -> ResponseResult:
    """The rows with their verdicts, before anything is read: those asked for, or up to a stop."""
    stopped = found.report.end is MotionEnd.STOPPED
    count = found.count if stopped else response.rows
    part = slice(0, count)
    reached = np.arange(count) < found.count
    rows = Rows.without_guesses(free.layout.states, 0, count)
    rows.states = np.where(reached, found.states[:, part], 0.0)
    rows.reached, rows.nodes = reached, found.report.steps
    rows.turns = _all_turns(free, found.turns[:, part])
    status, notes = ending(chosen, response, found.report)
    rows.status[~reached] = status
    rows.diagnostics += notes
    energy = free.layout.length * free.layout.length
    events = [""] * count
    if stopped:
        events[-1] = response.stops[found.report.stop].words
    chart = found.chart.at(part)
    return ResponseResult(
        free.moved(rows_problem(free, response, driven, found, count)),
        chosen,
        start,
        rows,
        Chart(*(np.where(reached, array, 0.0) for array in chart)),
        np.where(reached, energy * found.work[:, part], np.nan),
        events,
        response,
        found.report,
    )


def _nothing(chosen: Session, free: Session, start: Start, response: Response) -> ResponseResult:
    """Rows without a place: there is no first assembly."""
    count, charts = response.rows, len(response.independent)
    slots = turn_slots(free.plan)
    rows = Rows.without_guesses(free.layout.states, len(slots), count)
    rows.status[:] = Status.not_assembled if start.state is None else Status.branch_lost
    zeros = np.zeros((charts, count))
    chart = Chart(np.zeros((charts * free.plan.columns, count)), zeros, zeros)
    motion = Motion(response.driven, count, response.moments, response.course)
    session = free.moved(replace(free.problem, motion=motion))
    lost = np.full((2, count), np.nan)
    return ResponseResult(session, chosen, start, rows, chart, lost, [""] * count, response, None)


def _all_turns(free: Session, closing: Floats) -> Floats:
    """Turns of closing joints, and no whole turns of the tree's angles, whose states have them."""
    from mechkin_cli.solver.closing_turns import tree_slots

    tree = np.zeros((len(tree_slots(free.plan)), closing.shape[1]))
    return np.concatenate([closing, tree])


def _read(result: ResponseResult, quantities: Iterable[str]) -> None:
    """Closes the rows once more, judges them, and reads what is asked for."""
    known = result.problem.quantities()
    asked: list[Wanted] = [known[name] for name in dict.fromkeys(quantities)]
    rows = result.row_states
    if rows.reached.any():
        energies = [known[name] for name in ENERGIES]
        wanted, demand = at_once(result.session, [*asked, *energies], verdicts=True)
        wanted = [q for q in wanted if not result.is_given(q)]
        batch = result.run(wanted, demand, iterations=tolerances.NEWTON_ITERATIONS)
        failed = rows.reached & ~batch.good
        rows.status[failed] = Status.not_converged
        rows.reached &= ~failed
        judge_condition(rows, batch)
        result.keep(batch, wanted, demand)
        result.read(asked)
    result.row_states.diagnostics += row_notes(result, asked)
