"""Why a response ended before its last row, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.response.reasons import reason
from mechkin_cli.analysis.response.weakest import weakest_coordinates
from mechkin_cli.analysis.sweep.branch_end import passed_straight_on
from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.solver.free_motion import MotionEnd
from mechkin_cli.solver.inputs import input_numbers, input_text
from mechkin_cli.status import Status
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.free_motion import MotionReport
    from mechkin_cli.solver.session import Session


def ending(
    session: Session, free: Session, response: Response, report: MotionReport, last: Floats
) -> tuple[Status, list[Diagnostic]]:
    """The verdict of rows that were not reached, and what is to say about the motion; `last`
    (states,) is the last place of it, `free` the session that moved."""
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
    why = reason(free, response, report)
    text = why.text
    if why.status is Status.singular_inertia:
        text = _without_inertia(weakest_coordinates(session, response, last))
    is_point = why.code == "branch-point"
    numbers = place_numbers(session, np.array(report.branch_point) if is_point else last)
    shown = ", ".join(map(input_text, numbers))
    measured = shown if is_point else f"last place {shown}"
    notes.append(
        Diagnostic(
            why.code,
            "error",
            f"the response ends at {at}: {text}",
            why.place or response.place,
            measured=f"{why.measured}, {measured}" if why.measured else measured,
            limit=why.limit,
            hint=why.hint,
            numbers=numbers,
        )
    )
    return why.status, notes


def place_numbers(session: Session, state: Floats) -> tuple[Number, ...]:
    """The start's coordinates at a state (states,), in the file's units."""
    free = len(session.problem.motion.inputs)
    values = [state[session.layout.state(edge, dof)] for edge, dof in session.graph.inputs[:free]]
    return input_numbers(session.problem, session.layout, np.array(values))


def _passed(session: Session, response: Response, report: MotionReport) -> Diagnostic:
    """The branch points that a motion passed straight on."""
    places = [place_numbers(session, np.array(state)) for _, state in report.crossings]
    return passed_straight_on("motion", places, response.place)


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
