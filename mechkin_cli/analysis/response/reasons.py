"""What ends a response before its last row: verdict, words, what was measured, and the cure."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from mechkin_cli import tolerances
from mechkin_cli.solver.free_motion import Fault, MotionEnd
from mechkin_cli.solver.quantity_program import kink_laws
from mechkin_cli.status import Status
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Place
    from mechkin_cli.mechanism.load_laws import LoadLaw
    from mechkin_cli.mechanism.response import Response
    from mechkin_cli.solver.free_motion import MotionReport
    from mechkin_cli.solver.session import Session
    from mechkin_cli.units import UnitSystem


class Reason(NamedTuple):
    """Why no row follows; `place` where the file says what ends the motion, if it is no whole
    response."""

    status: Status
    code: str
    text: str
    hint: str
    measured: str = ""
    place: Place | None = None
    limit: str | None = None


def reason(free: Session, response: Response, report: MotionReport) -> Reason:
    """The reason of an end that was not wanted; `free` is the session that moved."""
    law = _law(free, report.which) if report.met else None
    if law is not None and report.value < tolerances.KINK_ROUNDING:
        return _rounding(law, report)
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
        return _undefined_stop(response, report)
    if fault & Fault.FRICTION:
        rubbing = _rubbing(free, report)
        whose = f"friction of {rubbing}" if rubbing else "friction"
        text = f"{whose} has no answer there, or more than one: the mechanism may jam, or slip"
        hint = "make a coefficient smaller, or bearings longer"
        return Reason(Status.friction_undecided, "friction-undecided", text, hint)
    if fault & Fault.SINGULAR_INERTIA or _loses_inertia(response, report):
        hint = "give the links that it moves a mass, or drive it"
        return Reason(Status.singular_inertia, "singular-inertia", "", hint)
    if report.branch_point:
        return _branch_point(response)
    if fault and response.fixed_step is not None:
        return _long_step(free.problem.units, report)
    if fault or report.singular:
        text = "no step, however short, is told to stay on the branch"
        hint = (
            "this may be a special position where the smooth continuation is not told apart from "
            "other branches: end the response before it"
        )
        return Reason(Status.branch_lost, "branch-lost", text, hint)
    if report.joints:
        text = f"{_rubbing(free, report)} starts to slip in a direction that no step tells"
        hint = "make its static coefficient a little larger than that of sliding"
        return Reason(Status.friction_undecided, "friction-undecided", text, hint)
    return _tolerance(response, report)


def _rubbing(free: Session, report: MotionReport) -> str:
    """The names of the joints whose friction ends a motion."""
    frictions = free.problem.mechanism.frictions
    return ", ".join(frictions[number].joint for number in report.joints)


def _branch_point(response: Response) -> Reason:
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
    measured = f"{report.rejections} of them refused, the last {_length(units, report.step)} long"
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


def _rounding(law: LoadLaw, report: MotionReport) -> Reason:
    """A jump whose side rounding chooses, of a load that moves something."""
    text = f"{_words(law)} jumps with the sign of what is zero all along but for rounding"
    hint = "leave the jump out: what it asks for does not move"
    measured = f"at most {report.value:.1e}"
    return Reason(Status.friction_undecided, "held-at-jump", text, hint, measured, law.place)


def _undefined_stop(response: Response, report: MotionReport) -> Reason:
    stop = response.stops[report.stop]
    text = f"the value of the stop {stop.words} is not defined there"
    hint = "write a value that is defined along the motion"
    return Reason(Status.step_limit, "stop-undefined", text, hint, "", stop.place)


def _loses_inertia(response: Response, report: MotionReport) -> bool:
    """Whether the steps end as rates grow without bound where an inertia goes to zero."""
    return (
        not report.fault
        and _runs_away(response, report)
        and report.lightest < tolerances.LOST_INERTIA
    )


def _runs_away(response: Response, report: MotionReport) -> bool:
    moments = response.moments.values
    duration = float(moments[-1] - moments[0])
    return report.growth * duration > tolerances.RUNAWAY


def _long_step(units: UnitSystem, report: MotionReport) -> Reason:
    text = (
        f"a fixed step of {_length(units, report.step)} is too long there: its stages are not told "
        "to stay on the branch"
    )
    hint = (
        "write a shorter fixed_step, or a tolerance in its place, which chooses the steps; if that "
        "ends here, too, this is a special position: end the response before it"
    )
    return Reason(Status.step_limit, "step-limit", text, hint)


def _tolerance(response: Response, report: MotionReport) -> Reason:
    if not _runs_away(response, report):
        text = "no step, however short, keeps the tolerance"
        asked = f"{response.tolerance:g}"
        return Reason(Status.step_limit, "step-limit", text, "widen the tolerance", limit=asked)
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


def _length(units: UnitSystem, step: float) -> str:
    return f"{float(units.from_si(step, TIME)):.6g} {units.label(TIME)}"
