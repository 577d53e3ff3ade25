"""Why a response ended before its last row, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.response.reasons import reason
from mechkin_cli.analysis.response.weakest import weakest_coordinates
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
    (states,) is the last state that is known, `free` the session that moved."""
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
    why = reason(free, response, report)
    text = why.text
    if why.status is Status.singular_inertia:
        text = _without_inertia(weakest_coordinates(session, response, last))
    numbers = place_numbers(session, last)
    measured = f"last row at {', '.join(map(input_text, numbers))}"
    notes.append(
        Diagnostic(
            why.code,
            "error",
            f"the response ends at {at}: {text}",
            why.place or response.place,
            measured=f"{why.measured}, {measured}" if why.measured else measured,
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
