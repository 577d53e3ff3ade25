"""The sweep: first assembly, following, one batched run of what is demanded, a verdict per row."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.start import choose_start
from mechkin_cli.analysis.sweep.actuation import actuation_notes
from mechkin_cli.analysis.sweep.following import follow_rows
from mechkin_cli.analysis.sweep.locked_poses import locked_pose_notes
from mechkin_cli.analysis.sweep.notes import (
    condition_notes,
    not_converged_note,
    open_turn_note,
    redundancy_note,
)
from mechkin_cli.analysis.sweep.question import Question, question
from mechkin_cli.analysis.sweep.result import Result
from mechkin_cli.mechanism.bearing_loads import read_for
from mechkin_cli.mechanism.legs import find_legs
from mechkin_cli.solver.batch import assembly_size
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.free_inputs import moves_freely
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from mechkin_cli.analysis.assembly.start import Start
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Bools
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.batch import Batch
    from mechkin_cli.solver.session import Session


def analyze(session: Session, quantities: Iterable[str] = (), *, verdicts: bool = True) -> Result:
    """Runs the sweep of a session's problem and reads the quantities asked for.

    Args:
        session: the problem in the kernel.
        quantities: names out of `problem.quantities()`.
        verdicts: compute each row's condition, and its power error where forces are computed.

    Raises:
        KeyError: an unknown quantity.
    """
    names = list(dict.fromkeys(quantities))
    known = session.problem.quantities() if names else {}
    asked = [known[name] for name in read_for(names, known)]
    session = _followed_part(session, asked)
    session, start = first_assembly(session)
    if start.stuck:
        from mechkin_cli.analysis.sweep.branch_end import input_faults

        start = replace(start, diagnostics=input_faults(session) or start.diagnostics)
    wanted = question(session, asked, verdicts=verdicts)
    result = _closed(session, start, wanted)
    result.read(wanted.asked)
    result.row_states.diagnostics += row_notes(
        result, wanted.asked, rests_on_reactions=wanted.rests_on_reactions
    )
    result.row_states.diagnostics += [*actuation_notes(result), *locked_pose_notes(result)]
    return result


def closed_rows(
    session: Session, start: Start, asked: Sequence[Wanted] = (), *, verdicts: bool = False
) -> Result:
    """The rows of a session on the branch through the start, with what is asked for and their
    conditions where `verdicts` are, too."""
    wanted = question(session, asked, verdicts=verdicts)
    result = _closed(session, start, wanted)
    result.read(wanted.asked)
    return result


def first_assembly(session: Session) -> tuple[Session, Start]:
    """The first assembly, and the session with residual and condition in parts of its size."""
    start = choose_start(session)
    if start.state is None or session.size is not None:
        return session, start
    inputs, state = session.inputs.reduced[:, start.row], start.state
    return session.own(
        "in parts of its size",
        lambda: session.sized(assembly_size(session.plan, inputs, state)),
    ), start


def _followed_part(session: Session, asked: list[Wanted]) -> Session:
    """The session of the loops that `follow:` leaves."""
    if session.problem.follow is None:
        return session
    from mechkin_cli.analysis.sweep.followed import followed_session

    return followed_session(session, asked)


def _closed(session: Session, start: Start, asked: Question) -> Result:
    """Follows and closes all rows and reads what can be read at once."""
    result = _closed_once(session, start, asked, every_row=False)
    if result.row_states.has_failed:
        # a filled-in row ended away from its guess: take every row as a careful step
        result = _closed_once(session, start, asked, every_row=True)
    return result


def _closed_once(session: Session, start: Start, asked: Question, *, every_row: bool) -> Result:
    """The same by one way of following; rows that do not close lose their place among the
    reached."""
    rows = follow_rows(session, start, every_row=every_row)
    result = Result(session, start, rows)
    if not rows.reached.any():
        return result
    batch = result.run(asked.wanted, asked.demand, iterations=tolerances.NEWTON_ITERATIONS)
    slow = rows.reached & ~batch.good
    if result.graph.blocks and (slow | rows.reached & _is_near_singular(batch)).any():
        batch = _closed_on_fold(result, asked)
        # what takes more steps and is no fold had a wrong guess
        slow &= ~_is_near_singular(batch)
    failed = slow | _failed(batch, rows)
    if failed.any():
        rows.status[failed] = Status.not_converged
        rows.diagnostics.append(not_converged_note(rows, batch.residual))
        rows.reached &= ~failed
    if rows.reached.any():
        if rows.reached.all():
            rows.states = batch.states
        else:
            rows.states[:, rows.reached] = batch.states[:, rows.reached]
        judge_condition(session, rows, batch)
        _judge_inputs(session, rows)
        if rows.dead_centres and asked.wanted:
            batch = batch._replace(outputs=result.run(asked.wanted, asked.demand).outputs)
    result.keep(batch, asked.wanted, asked.demand)
    return result


def _is_near_singular(batch: Batch) -> Bools:
    """Rows (rows,) above that condition, as far as it was computed."""
    if batch.condition is None:
        return np.zeros(batch.residual.size, dtype=bool)
    found: Bools = batch.condition > tolerances.CONDITION_NEAR_SINGULAR
    return found


def _closed_on_fold(result: Result, asked: Question) -> Batch:
    """The run with so many steps that rows on a fold close, too, where each only halves what is
    left; and with conditions, which tell that they do."""
    demand = asked.demand | Demand.CONDITION
    return result.run(asked.wanted, demand, iterations=tolerances.FOLD_ITERATIONS)


def _failed(batch: Batch, rows: Rows) -> Bools:
    """Rows with a guess that did not close near it, on its side of every fold.

    Sides are there where the run demanded more than positions.
    """
    limit = rows.limit
    if batch.condition is not None:
        # next to singular places branches may be nearer than a position is known to rounding
        known = np.where(
            batch.condition <= tolerances.CONDITION_RANK_UNCLEAR,
            tolerances.CORRECTION_ROUNDING * batch.condition,
            0.0,
        )
        limit = np.maximum(limit, known)
        on_fold = batch.condition > tolerances.CONDITION_SIDE_UNCLEAR
        limit = np.where(on_fold, tolerances.FOLD_CORRECTION * limit, limit)
    failed: Bools = rows.reached & ~(batch.good & (batch.correction <= limit))
    if not (batch.side != batch.side[:, :1]).any():
        return failed
    # on a fold or a branch point a sign is rounding
    told = rows.reached.copy()
    if batch.condition is not None:
        told &= batch.condition <= tolerances.CONDITION_SIDE_UNCLEAR
    # where a branch point was passed sides change with it: each section has its own
    turned = np.zeros(told.size, dtype=bool)
    for section in set(rows.section[told].tolist()):
        own = np.flatnonzero(told & (rows.section == section))
        turned[own] = (batch.side[:, own] != batch.side[:, own[:1]]).any(axis=0)
    return failed | rows.reached & turned


def judge_condition(session: Session, rows: Rows, batch: Batch) -> None:
    """Verdicts by condition."""
    condition = batch.condition
    if condition is None or (condition <= tolerances.CONDITION_RATES_UNCLEAR).all():
        return
    singular = rows.reached & ~(condition <= tolerances.CONDITION_NEAR_SINGULAR)
    unclear = rows.reached & ~(condition <= tolerances.CONDITION_RANK_UNCLEAR)
    rows.status[singular & (rows.status == Status.ok)] = Status.near_singular
    rows.status[unclear & (rows.status == Status.near_singular)] = Status.rank_unclear
    from mechkin_cli.analysis.sweep.dead_centre_rows import judge_dead_centres

    judge_dead_centres(session, rows, condition)
    rows.diagnostics += condition_notes(rows, condition)


def _judge_inputs(session: Session, rows: Rows) -> None:
    """Names inputs that cannot move; the rates of no row mean anything where they are to move: more
    equations than unknowns leave a least square, whose condition tells nothing."""
    if not session.is_redundant or not session.driven or not rows.reached.any():
        return
    from mechkin_cli.analysis.sweep.branch_end import input_faults

    row = int(np.argmax(rows.reached))
    if moves_freely(session, session.inputs.values[:, row], rows.states[:, row]):
        return
    faults = input_faults(session)
    rows.diagnostics.extend(fault for fault in faults if fault not in rows.diagnostics)
    if faults and any(moved.any() for moved in session.inputs.orders[1:]):
        rows.status[rows.reached] = Status.rank_unclear
        rows.dead_centres.clear()


def _read_by_loads(result: Result) -> list[Wanted]:
    """What loads that vary read, where forces are computed."""
    if not (result.demand & Demand.FORCES and result.problem.load_laws):
        return []
    from mechkin_cli.mechanism.load_laws import quantities_read

    known = result.problem.quantities()
    return [known[name] for name in quantities_read(result.problem)]


def row_notes(
    result: Result, asked: Sequence[Wanted], *, rests_on_reactions: bool
) -> list[Diagnostic]:
    """What is conventional, left open by a full turn, held, or not unique."""
    problem, session, rows = result.problem, result.session, result.row_states
    notes: list[Diagnostic] = []
    if find_legs(problem.mechanism) or problem.held:
        from mechkin_cli.mechanism.idle import (
            conventional_notes,
            holding_notes,
            idle_freedoms,
            nearly_common_notes,
        )

        notes += nearly_common_notes(problem)
        read = [*asked, *_read_by_loads(result)]
        key = ("conventional", tuple(quantity.name for quantity in read))
        notes += session.own(key, lambda: conventional_notes(problem, read))
        if problem.hold_idle:
            named = {idle.holding for idle in idle_freedoms(problem)}
            found = {q.name: result.columns[q.name] for q in asked if q.name in named}
            notes += holding_notes(problem, found)
    unclear = rows.status == Status.rank_unclear
    if unclear.any() and (session.is_redundant or unclear[rows.reached].all()):
        from mechkin_cli.analysis.sweep.branch_end import input_faults

        said = {diagnostic.code for diagnostic in rows.diagnostics}
        notes += [fault for fault in input_faults(session) if fault.code not in said]
    if problem.mechanism.frictions and result.demand & Demand.FORCES:
        from mechkin_cli.analysis.sweep.friction import uncounted_notes

        notes += uncounted_notes(result)
    note = open_turn_note(session, rows.states, rows.reached)
    notes += [note] if note else []
    if rests_on_reactions and session.is_redundant and rows.reached.any():
        notes.append(redundancy_note(result, asked))
    return notes
