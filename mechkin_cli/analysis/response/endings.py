"""Why a response ended before its last row, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.response.weakest import weakest_coordinates
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
    (states,) is the last state that is known."""
    notes = []
    if report.stiff:
        text = f"from {_moment(session, report.stiff_from)} on the motion is stiff"
        hint = "an implicit method of order 5 (Radau IIA) has taken over; nothing is to be done"
        notes.append(Diagnostic("stiff", "note", text, response.place, hint=hint))
    if report.passed:
        count = f"{report.passed} branch point{'s' * (report.passed > 1)}"
        text = f"the motion passes {count} along the smooth continuation"
        notes.append(Diagnostic("branch-point-passed", "note", text, response.place))
    if report.end in (MotionEnd.DONE, MotionEnd.STOPPED):
        return Status.ok, notes
    at = _moment(session, report.time)
    status, code, text, hint = _reason(report, _rubbing(session, report))
    if status is Status.singular_inertia:
        text = _without_inertia(weakest_coordinates(session, response, last))
    numbers = place_numbers(session, last)
    notes.append(
        Diagnostic(
            code,
            "error",
            f"the response ends at {at}: {text}",
            response.place,
            measured=f"last row at {', '.join(map(input_text, numbers))}",
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


def _reason(report: MotionReport, rubbing: str) -> tuple[Status, str, str, str]:
    """Verdict, code, words and cure."""
    if report.end is MotionEnd.STEP_LIMIT:
        text = f"{report.steps + report.rejections} steps were not enough"
        hint = "widen the tolerance, shorten the time, or look for what moves so fast"
        return Status.step_limit, "step-limit", text, hint
    if report.end is MotionEnd.HELD and rubbing:
        text = f"{rubbing} comes to rest and starts again and again, at one place"
        hint = "make the static coefficient a little larger than that of sliding"
        return Status.friction_undecided, "friction-undecided", text, hint
    if report.end is MotionEnd.HELD:
        text = "on both sides of a jump of a load the motion goes back to it"
        hint = "write what sticks as {type: friction, ...}, or make the load continuous"
        return Status.friction_undecided, "held-at-jump", text, hint
    if report.fault == Fault.NOT_FINITE or report.fault & Fault.UNDEFINED_LOAD:
        text = "a load or a rate has no finite value beyond"
        return Status.step_limit, "load-undefined", text, "write loads that hold along the motion"
    if report.fault & Fault.FRICTION:
        whose = f"friction of {rubbing}" if rubbing else "friction"
        text = f"{whose} has no answer there, or more than one: the mechanism may jam, or slip"
        hint = "make a coefficient smaller, or bearings longer"
        return Status.friction_undecided, "friction-undecided", text, hint
    if report.fault & Fault.SINGULAR_INERTIA:
        hint = "give the links that it moves a mass, or drive it"
        return Status.singular_inertia, "singular-inertia", "", hint
    if report.fault:
        text = "no step, however short, is told to stay on the branch"
        hint = (
            "there is a branch point or a special position; at_branch_points: straight passes "
            "branch points along the smooth continuation"
        )
        return Status.branch_lost, "branch-lost", text, hint
    text = "no step, however short, keeps the tolerance"
    return Status.step_limit, "step-limit", text, "widen the tolerance"
