"""Why a response ended before its last row, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.response.weakest import weakest_coordinates
from mechkin_cli.analysis.sweep.branch_end import MOST_SHOWN
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.solver.free_motion import Fault, MotionEnd
from mechkin_cli.solver.inputs import input_numbers, input_text
from mechkin_cli.status import Status
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.free_motion import MotionReport
    from mechkin_cli.solver.session import Session


def ending(
    session: Session, response: Response, report: MotionReport, last: Floats
) -> tuple[Status, list[Diagnostic]]:
    """The verdict of rows that were not reached, and what is to say about the motion; `last`
    (states,) is the last place of it."""
    notes = []
    if report.crossings:
        notes.append(_passed(session, response, report))
    if report.stiff:
        text = f"from {_moment(session, report.stiff_from)} on the motion is stiff"
        hint = "an implicit method of order 5 (Radau IIA) has taken over; nothing is to be done"
        notes.append(Diagnostic("stiff", "note", text, response.place, hint=hint))
    if report.end in (MotionEnd.DONE, MotionEnd.STOPPED):
        return Status.ok, notes
    at = _moment(session, report.time)
    status, code, text, limit, hint = _reason(response, report, _rubbing(session, report))
    if status is Status.singular_inertia:
        text = _without_inertia(weakest_coordinates(session, response, last))
    is_point = code == "branch-point"
    numbers = place_numbers(session, np.array(report.branch_point) if is_point else last)
    shown = ", ".join(map(input_text, numbers))
    notes.append(
        Diagnostic(
            code,
            "error",
            f"the response ends at {at}: {text}",
            response.place,
            measured=shown if is_point else f"last place {shown}",
            limit=limit,
            hint=hint,
            numbers=numbers,
        )
    )
    return status, notes


def place_numbers(session: Session, state: Floats) -> tuple[Number, ...]:
    """The start's coordinates at a state (states,), in the file's units."""
    free = len(session.problem.motion.inputs)
    values = [state[session.layout.state(edge, dof)] for edge, dof in session.graph.inputs[:free]]
    return input_numbers(session.problem, session.layout, np.array(values))


def _passed(session: Session, response: Response, report: MotionReport) -> Diagnostic:
    """The branch points that a motion passed straight on."""
    places = [place_numbers(session, np.array(state)) for _, state in report.crossings]
    shown = [", ".join(map(input_text, numbers)) for numbers in places[:MOST_SHOWN]]
    more = len(places) - len(shown)
    return Diagnostic(
        "branch-point-passed",
        "note",
        f"the motion passes {'a branch point' if len(places) == 1 else 'branch points'} along its "
        "smooth continuation, as assembly: {at_branch_points: straight} asks",
        response.place,
        measured="; ".join(shown) + (f" and {more} more" if more else ""),
        numbers=tuple(number for numbers in places[:MOST_SHOWN] for number in numbers),
    )


def _without_inertia(names: list[str]) -> str:
    if not names:
        whose = "some freedom has"
    elif len(names) == 1:
        whose = f"{names[0]} has"
    else:
        whose = f"a motion of {', '.join(names[:-1])} and {names[-1]} together has"
    return f"{whose} no inertia, so that no acceleration follows from the forces"


def _moment(session: Session, time: float) -> str:
    units = session.problem.units
    return f"{float(units.from_si(time, TIME)):.6g} {units.label(TIME)}"


def _rubbing(session: Session, report: MotionReport) -> str:
    """The names of the joints whose friction ends a motion."""
    frictions = session.problem.mechanism.frictions
    return ", ".join(frictions[number].joint for number in report.joints)


def _reason(
    response: Response, report: MotionReport, rubbing: str
) -> tuple[Status, str, str, str | None, str]:
    """Verdict, code, words, limit and cure."""
    if report.end is MotionEnd.STEP_LIMIT and not report.singular:
        text = f"{report.steps + report.rejections} steps were not enough"
        hint = "widen the tolerance, shorten the time, or look for what moves so fast"
        limit = f"{tolerances.MOST_RESPONSE_STEPS} steps"
        return Status.step_limit, "step-limit", text, limit, hint
    if report.end is MotionEnd.HELD and rubbing:
        text = f"{rubbing} comes to rest and starts again and again, at one place"
        hint = "make the static coefficient a little larger than that of sliding"
        return Status.friction_undecided, "friction-undecided", text, None, hint
    if report.end is MotionEnd.HELD:
        text = "on both sides of a jump of a load the motion goes back to it"
        hint = "write what sticks as {type: friction, ...}, or make the load continuous"
        return Status.friction_undecided, "held-at-jump", text, None, hint
    if report.fault == Fault.NOT_FINITE or report.fault & Fault.UNDEFINED_LOAD:
        text = "a load or a rate has no finite value beyond"
        hint = "write loads that hold along the motion"
        return Status.step_limit, "load-undefined", text, None, hint
    if report.fault & Fault.FRICTION:
        whose = f"friction of {rubbing}" if rubbing else "friction"
        text = f"{whose} has no answer there, or more than one: the mechanism may jam, or slip"
        hint = "make a coefficient smaller, or bearings longer"
        return Status.friction_undecided, "friction-undecided", text, None, hint
    if report.fault & Fault.SINGULAR_INERTIA:
        hint = "give the links that it moves a mass, or drive it"
        return Status.singular_inertia, "singular-inertia", "", None, hint
    if report.branch_point:
        text = (
            "it comes to a branch point, where its branch crosses another and it may go either way"
        )
        hint = (
            "assembly: {at_branch_points: straight} goes on along the smooth continuation, unless "
            "joints rub; or end the response before it"
        )
        if response.assembly.straight:
            hint = (
                "with friction it is not passed, as the reactions that friction reads are not "
                "unique there: end the response before it"
            )
        return Status.branch_lost, "branch-point", text, None, hint
    if report.fault or report.singular:
        text = "no step, however short, is told to stay on the branch"
        return Status.branch_lost, "branch-lost", text, None, _cure_of_lost(response)
    text = "no step, however short, keeps the tolerance"
    asked = f"{response.tolerance:g}"
    return Status.step_limit, "step-limit", text, asked, "widen the tolerance"


def _cure_of_lost(response: Response) -> str:
    """What to do where a branch is lost that no branch point with a smooth way through ends."""
    if response.fixed_step is not None:
        return (
            "write a tolerance in place of fixed_step, or shorter steps; if that ends here, too, "
            "this is a special position: end the response before it"
        )
    return (
        "this may be a special position where the smooth continuation is not told apart from other "
        "branches: end the response before it"
    )
