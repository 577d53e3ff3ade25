"""Why a response ended before its last row, in words: verdict, what was measured, and the cure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic, Number, Place
from mechkin_cli.plan import Demand, kink_laws
from mechkin_cli.record import NamedTuple
from mechkin_cli.response.integration import Fault, MotionEnd, MotionReport
from mechkin_cli.session import Ask, RowInputs, Session, input_numbers, input_text
from mechkin_cli.sweep import passed_straight_on
from mechkin_cli.units import TIME, UnitSystem
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.mechanism import LoadLaw, ResponseProblem, Stop
    from mechkin_cli.show import Floats


class Reason(NamedTuple):
    """Why no row follows; `place` in the file of what ends the motion, where that is not the whole
    response."""

    status: Status
    code: str
    text: str
    hint: str
    measured: str = ""
    place: Place | None = None
    limit: str | None = None


def reason(free: Session, response: ResponseProblem, report: MotionReport) -> Reason:
    """The reason of a premature end; `free` is the session that moved."""
    law = _law(free, report.which) if report.met else None
    if law is not None and report.value < tolerances.KINK_ROUNDING:
        # a jump whose side rounding chooses, of a load that moves something
        text = f"{_words(law)} jumps with the sign of what is zero all along but for rounding"
        hint = "leave the jump out: what it asks for does not move"
        measured = f"at most {report.value:.1e}"
        return Reason(Status.friction_undecided, "held-at-jump", text, hint, measured, law.place)
    if report.end is MotionEnd.STEP_LIMIT and not report.singular:
        return _step_limit(free, report)
    if report.end is MotionEnd.HELD:
        return _held(free, report)
    fault = report.fault
    if fault == Fault.NOT_FINITE or fault & Fault.UNDEFINED_LOAD:
        text = "a load or a rate has no finite value beyond"
        hint = "write loads that hold along the motion"
        return Reason(Status.step_limit, "load-undefined", text, hint)
    if fault & Fault.UNDEFINED_STOP:
        stop = response.stops[report.stop]
        text = f"the value of the stop {stop.words} is not defined there"
        hint = "write a value that is defined along the motion"
        return Reason(Status.step_limit, "stop-undefined", text, hint, "", stop.place)
    if fault & Fault.FRICTION:
        rubbing = _rubbing(free, report)
        whose = f"friction of {rubbing}" if rubbing else "friction"
        text = f"{whose} has no answer there, or more than one: the mechanism may jam, or slip"
        hint = "make a coefficient smaller, or bearings longer"
        return Reason(Status.friction_undecided, "friction-undecided", text, hint)
    # the steps end as rates grow without bound where an inertia goes to zero
    loses_inertia = (
        not fault and _runs_away(response, report) and report.lightest < tolerances.LOST_INERTIA
    )
    if fault & Fault.SINGULAR_INERTIA or loses_inertia:
        hint = "give the links that it moves a mass, or drive it"
        return Reason(Status.singular_inertia, "singular-inertia", "", hint)
    if report.branch_point:
        return _branch_point(response)
    if fault and response.fixed_step is not None:
        return _long_step(free.problem.units, report)
    if fault or report.singular:
        text = "no step, however short, surely stays on the branch"
        hint = (
            "this may be a special position where the smooth continuation cannot be distinguished "
            "from other branches: end the response before it"
        )
        return Reason(Status.branch_lost, "branch-lost", text, hint)
    if report.joints:
        text = f"{_rubbing(free, report)} starts to slip in a direction that no step determines"
        hint = "make its static coefficient a little larger than that of sliding"
        return Reason(Status.friction_undecided, "friction-undecided", text, hint)
    return _tolerance(response, report)


def _rubbing(free: Session, report: MotionReport) -> str:
    """The names of the joints whose friction ends a motion."""
    frictions = free.problem.mechanism.frictions
    return ", ".join(frictions[number].joint for number in report.joints)


def _branch_point(response: ResponseProblem) -> Reason:
    text = "it comes to a branch point, where its branch crosses another and it may go either way"
    hint = (
        "assembly: {at_branch_points: straight} goes on along the smooth continuation, unless "
        "joints rub; or end the response before it"
    )
    if response.assembly.straight:
        hint = (
            "with friction it is not passed, as the reactions that friction reads are not unique "
            "there: end the response before it"
        )
    return Reason(Status.branch_lost, "branch-point", text, hint)


def _step_limit(free: Session, report: MotionReport) -> Reason:
    count, units = report.steps + report.rejections, free.problem.units
    text = f"{count} steps were not enough"
    measured = f"{report.rejections} of them refused, the last {_time(units, report.step)} long"
    law = _law(free, report.which)
    if law is not None and report.met > tolerances.MANY_KINKS * report.steps:
        text += f": {report.met} end where {_words(law)} bends or jumps"
        hint = "write it smoothly there, or what sticks as {type: friction, ...}"
        return Reason(Status.step_limit, "step-limit", text, hint, measured, law.place)
    hint = "widen the tolerance, shorten the time, or look for what moves so fast"
    limit = f"{tolerances.MOST_RESPONSE_STEPS} steps"
    return Reason(Status.step_limit, "step-limit", text, hint, measured, limit=limit)


def _held(free: Session, report: MotionReport) -> Reason:
    law = _law(free, report.which)
    if law is None:
        whose = _rubbing(free, report) or "the motion"
        text = f"{whose} comes to rest again and again at one place"
        hint = "make a static coefficient a little larger than that of sliding, or bearings longer"
        return Reason(Status.friction_undecided, "friction-undecided", text, hint)
    text = (
        f"it is held where {_words(law)} jumps: from both sides the motion goes back to the jump, "
        "where the load may have any value between those of the sides"
    )
    hint = (
        "write what sticks as {type: friction, ...}, or a steep slope for the jump, as "
        "max(-1, min(1, x/small)) for sign(x)"
    )
    return Reason(Status.friction_undecided, "held-at-jump", text, hint, "", law.place)


def _runs_away(response: ResponseProblem, report: MotionReport) -> bool:
    moments = response.moments.values
    duration = float(moments[-1] - moments[0])
    return report.growth * duration > tolerances.RUNAWAY


def _long_step(units: UnitSystem, report: MotionReport) -> Reason:
    text = (
        f"a fixed step of {_time(units, report.step)} is too long there: its stages may leave the "
        "branch"
    )
    hint = (
        "write a shorter fixed_step, or a tolerance in its place, which chooses the steps; if that "
        "ends here, too, this is a special position: end the response before it"
    )
    return Reason(Status.step_limit, "step-limit", text, hint)


def _tolerance(response: ResponseProblem, report: MotionReport) -> Reason:
    if not _runs_away(response, report):
        text = "no step, however short, keeps the tolerance"
        limit = f"{response.tolerance:g}"
        return Reason(Status.step_limit, "step-limit", text, "widen the tolerance", limit=limit)
    growth = f"rates grow by themselves in {1.0 / report.growth:.1e} s"
    if response.driven:
        names = ", ".join(f"{d.joint}.{d.coordinate}" for d in response.driven)
        text = f"{names} cannot be driven further: rates and forces grow without bound"
        hint = "it is a dead centre of what is driven; let its law turn back before"
        return Reason(Status.branch_lost, "branch-lost", text, hint, growth)
    text = "rates grow without bound"
    hint = "look for a load that grows with what it moves, or for links without mass"
    return Reason(Status.step_limit, "step-limit", text, hint, growth)


def _law(free: Session, which: int) -> LoadLaw | None:
    """The load that has a kink of the kernel's number."""
    if which < 0 or free.layout.laws is None:
        return None
    laws = kink_laws(free.layout)
    return laws[which] if which < len(laws) else None


def _words(law: LoadLaw) -> str:
    return "a load's table" if law.expression is None else f'the load "{law.expression.text}"'


def _time(units: UnitSystem, time: float) -> str:
    return f"{float(units.from_si(time, TIME)):.6g} {units.label(TIME)}"


_TAKES_PART = 0.3
"""A coordinate is named if it moves by so much of the one that moves most; lengths in parts of the
size."""


def weakest_coordinates(session: Session, response: ResponseProblem, state: Floats) -> list[str]:
    """Names of the independent coordinates that move with least inertia at `state` (states,), for a
    message.

    `session` has the independent coordinates as inputs, then the driven ones. The inertias follow
    from the kinetic energies T at unit rates: m_ij = T(i and j) - T(i) - T(j).
    """
    free, count = len(response.independent), len(session.graph.inputs)
    if free == 1:
        return [".".join(response.independent[0])]
    pairs = [(i, j) for i in range(free) for j in range(i)]
    rates = np.zeros((count, free + len(pairs)))
    rates[range(free), range(free)] = 1.0
    for column, pair in enumerate(pairs, free):
        rates[list(pair), column] = 1.0
    wanted = session.problem.quantities()["row.kinetic_energy"]
    readout = session.readout([wanted])
    cases = np.zeros(rates.shape[1], dtype=np.intp)
    places = [session.layout.state(edge, freedom) for edge, freedom in session.graph.inputs]
    rows = RowInputs(state[places][:, None][:, cases], state[:, None][:, cases], rates)
    batch = session.run(rows, Ask(Demand.VELOCITY, readout))
    assert batch.outputs is not None
    energies = batch.outputs[readout.slots[wanted.name].first]
    inertia = np.diag(2.0 * energies[:free])
    for energy, (i, j) in zip(energies[free:], pairs, strict=True):
        inertia[i, j] = inertia[j, i] = energy - energies[i] - energies[j]
    if not np.all(np.isfinite(inertia)):
        return []
    moves = np.abs(np.linalg.eigh(inertia)[1][:, 0])
    return [
        ".".join(coordinate)
        for coordinate, much in zip(response.independent, moves, strict=True)
        if much > _TAKES_PART * moves.max()
    ]


def ending(
    session: Session, free: Session, response: ResponseProblem, report: MotionReport, last: Floats
) -> tuple[Status, list[Diagnostic]]:
    """The verdict of rows that were not reached, and notes on the motion; `last` (states,) is the
    last place of it, `free` the session that moved."""
    notes, units = [], session.problem.units
    if report.crossings:
        passed = [place_numbers(session, np.array(state)) for _, state in report.crossings]
        notes.append(passed_straight_on("motion", passed, response.place))
    if report.stiff:
        text = f"from {_time(units, report.stiff_from)} on the motion is stiff"
        hint = "an implicit method of order 5 (Radau IIA) has taken over; nothing is to be done"
        notes.append(Diagnostic("stiff", "note", text, response.place, hint=hint))
    for number, stop in enumerate(response.stops):
        times = [time for touched, time in report.touches if touched == number]
        if times:
            notes.append(_touched(stop, [_time(units, time) for time in times]))
    if report.end in (MotionEnd.DONE, MotionEnd.STOPPED):
        return Status.ok, notes
    at = _time(units, report.time)
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


def _touched(stop: Stop, times: Sequence[str]) -> Diagnostic:
    more = f" and {len(times) - 1} more times" if len(times) > 1 else ""
    text = f"{stop.words} is touched at {times[0]}{more}, but not passed"
    hint = "the response goes on; move the value of at: if it is to end there"
    return Diagnostic("stop-touched", "note", text, stop.place, hint=hint)


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
