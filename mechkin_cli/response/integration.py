"""The integration of a free motion by the kernel (kernel/core/response), and why it ended.

The plan of a free motion has a chart in place of the free inputs (`free_session`); coordinates that
are driven along it go by their laws of time (`driven_laws`). A motion that ends before its last row
gets a verdict, what was measured, and the cure (`ending`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic, Number, Place
from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.functions import threads_for, width
from mechkin_cli.mechanism import (
    CrossingEnd,
    DeadCentreEnd,
    SlopeEnd,
    SpacedMoments,
    dimension_of,
    rubbing_words,
)
from mechkin_cli.plan import Demand, Layout, kink_laws
from mechkin_cli.record import NamedTuple
from mechkin_cli.response.march import RowTimes
from mechkin_cli.response.report import Fault, MotionEnd, MotionReport, MotionRows, motion_of
from mechkin_cli.session import (
    RESIDUAL_TESTS,
    Ask,
    Coordinate,
    Packing,
    RowInputs,
    Session,
    Structure,
    held_values,
    input_numbers,
    input_text,
    input_unit,
)
from mechkin_cli.structure import charted
from mechkin_cli.sweep import ROUNDED, passed_straight_on
from mechkin_cli.tape import compiled
from mechkin_cli.units import TIME, UnitSystem
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import DrivenLaws, Plan
    from mechkin_cli.mechanism import Limit, LoadLaw, Problem, ResponseProblem, Rubbing, Stop
    from mechkin_cli.response.march import Taker
    from mechkin_cli.show import Floats
    from mechkin_cli.units import Dimension


class Beginning(NamedTuple):
    """States (states,), rates of the columns (columns,) and a basis of the free rates (freedoms,
    columns) at the first moment, in kernel units."""

    state: Floats
    first: Floats
    tangents: Floats


class Impact(NamedTuple):
    """What limits gave at a moment (s): of each that pushed, the limit, the outward rate of its
    coordinate before (rad/s, m/s), and the impulse (N*m*s, N*s); `held`: the limits at which
    coordinates then rest."""

    time: float
    limits: tuple[Limit, ...]
    rates: tuple[float, ...]
    impulses: tuple[float, ...]
    held: tuple[Limit, ...] = ()

    @property
    def rests(self) -> bool:
        """Whether a coordinate then rests."""
        return bool(self.held)

    def comes(self, limit: Limit) -> bool:
        """Whether the coordinate of a limit came to it, and was not at rest there."""
        still = tolerances.KINK_ROUNDING * max(1.0, *(abs(rate) for rate in self.rates))
        return self.rates[self.limits.index(limit)] > still


class Rebound(NamedTuple):
    """An impact, how the motion begins behind it, and what it put in and lost in kg, length units
    and s; the place at rest with the jumps of the rates as accelerations, the impulses along
    coordinates (joint, coordinate), and what the row says of it; `others`: impulses that are as
    good, where limits share one freedom."""

    impact: Impact
    begun: Beginning
    work: tuple[float, float]
    rows: RowInputs
    pushes: Mapping[tuple[str, str], float]
    words: str
    others: Sequence[Mapping[tuple[str, str], float]] = ()


WatchedStop = tuple[int, int, int, float, int, int]
"""What ends a motion, by a value that is watched: kind, direction, times, at, lengths, rates.

Kind 0: the value crosses `at` for the `times`th time, upwards (1), downwards (-1) or in either
direction (0); 1: it changes its sign for the `times`th time; 2: it lies `times` turns from where it
began; 3: it is a condition that holds for the `times`th time. `lengths` and `rates` are the powers
of length and 1/time in its dimension, by which its rounding is estimated; `rates` -1: not known."""


def free_session(session: Session, free: Sequence[Coordinate]) -> Session:
    """The session of a problem whose inputs `free` are left to move: the same tree, so the same
    states; residual and condition in parts of the same size."""
    problem, graph = session.problem, charted(session.graph, set(free))
    # a variant's length unit is that of what it is continued from
    laid = Layout(problem.laid_mechanism, graph, session.layout.length, laws=problem.laws)
    structure = Structure(laid, tuple(graph.driven), session.closed_at)
    return Session(problem, structure, size=session.size, packing=session.packing)


def with_loads(session: Session, problem: Problem) -> Session:
    """The session of a free motion for a problem that differs in loads alone."""
    laid = Layout(problem.laid_mechanism, session.graph, session.layout.length, laws=problem.laws)
    structure = Structure(laid, tuple(session.graph.driven), session.closed_at)
    return Session(problem, structure, size=session.size, packing=session.packing)


def integrate(
    starts: Sequence[tuple[Plan, Beginning]],
    begin: float,
    times: Floats | RowTimes,
    response: ResponseProblem,
    *,
    stops: Sequence[WatchedStop] | None = None,
    driven: DrivenLaws | None = None,
    packing: Packing,
    method: int = 0,
    block: int = 0,
    taker: Taker | None = None,
) -> list[MotionRows]:
    """Integrates motions of plans of one structure, each from its beginning, packed into lanes,
    from time `begin` (s) over the rows' `times` (rows,), with the steps of a response, and through
    branch points as that wants.

    `stops`, else the response's, go with the values that the plans watch, in order; `driven` with
    their inputs. A `taker` takes the rows of one motion in blocks of so many as they are reached,
    all but the last of them, which are given back: their first one has the number `report.first`.
    With one, none of equally spaced times is held.

    Raises:
        ValueError: times that do not rise from `begin` on.
    """
    spaced, some, parts, last = None, (0, -1), 1, None
    if isinstance(times, RowTimes) and taker:
        some, parts, last = (times.first, times.rows), times.parts, times.last
        moments = times.moments
        spaced = moments.steps if isinstance(moments, SpacedMoments) else None
        # those are of the kernel's making
        times = (moments.part(slice(1)) if spaced else moments).values
    elif isinstance(times, RowTimes):
        times = times.between(0, times.size, begin)
    reports, *arrays = _kernel.respond(
        plans=[plan for plan, _ in starts],
        state=np.ascontiguousarray([start.state for _, start in starts]),
        first=np.ascontiguousarray([start.first for _, start in starts]),
        tangent=np.ascontiguousarray([start.tangents.ravel() for _, start in starts]),
        begin=begin,
        times=np.ascontiguousarray(times),
        spaced=spaced,
        stops=[watched_stop(stop) for stop in response.stops] if stops is None else list(stops),
        driven=driven,
        tolerance=response.tolerance,
        fixed_step=response.fixed_step or 0.0,
        most_steps=tolerances.MOST_RESPONSE_STEPS,
        dense_rows=tolerances.DENSE_ROWS,
        method=method,
        tests=list(RESIDUAL_TESTS),
        iterations=tolerances.NEWTON_ITERATIONS,
        jump=tolerances.JUMP_LIMIT,
        radius=tolerances.SPECTRAL_RADIUS,
        straight=response.assembly.straight,
        # one motion needs no more than the narrowest packs
        lanes=width(packing.lanes) if packing.lanes or len(starts) > 2 else 2,
        threads=threads_for(len(starts), packing.threads),
        block=block,
        taker=taker,
        some=some,
        parts=parts,
        last=last,
    )
    motions = []
    for number, fields in enumerate(reports):
        report = MotionReport(**{**fields, "end": MotionEnd(fields["end"])})
        motions.append(motion_of(report, [array[number] for array in arrays]))
    return motions


def driven_laws(
    session: Session, response: ResponseProblem, resting: Sequence[float] = ()
) -> _kernel.DrivenLaws | None:
    """The laws of a session's inputs: the response's driven coordinates, those `resting` at limits
    (kernel units), then those at which idle freedoms are held; None without any.

    The course of the driven ones is a tape over the time in the file's unit, in cells.
    """
    problem, layout = session.problem, session.layout
    held = [*resting, *held_values(problem, layout)]
    units = [input_unit(layout, item) for item in response.driven]
    if not units and not held:
        return None
    course, time_unit = response.course, float(problem.units.to_si(1.0, TIME))
    if course is None:
        assert not units
        return _kernel.DrivenLaws(None, [], [], [], [], time_unit, held)
    # no step has to end where a cell does, but nothing bends
    own = np.concatenate([[True], course.bends])
    edges = course.edges[1:-1][course.bends] * time_unit
    return _kernel.DrivenLaws(
        compiled(course.tape),
        edges.tolist(),
        np.ravel(course.constants[own]).tolist(),
        np.ravel(course.ways[own]).tolist(),
        units,
        time_unit,
        held,
    )


def formula_ends(response: ResponseProblem, units: UnitSystem) -> Floats:
    """The moments (s) at which a formula of a driven coordinate's law ends."""
    if response.course is None:
        return np.empty(0)
    return response.course.ends * float(units.to_si(1.0, TIME))


_DIRECTIONS = {"up": 1, "down": -1, "any": 0}


def watched_stop(stop: Stop) -> WatchedStop:
    """A stop as the kernel takes it."""
    if isinstance(stop, CrossingEnd):
        if stop.at is None:
            return 3, 1, stop.count, 0.0, 0, -1
        direction = _DIRECTIONS[stop.direction]
        return 0, direction, stop.count, stop.at, *_powers(stop.dimension)
    if isinstance(stop, DeadCentreEnd):
        rate = dimension_of(stop.coordinate) / TIME
        return 1, 0, stop.count, 0.0, *_powers(rate)
    if isinstance(stop, SlopeEnd):
        return 0, 0, 1, stop.at, *_powers(dimension_of(stop.coordinate))
    return 2, 0, stop.count, 0.0, 0, -1


def _powers(dimension: Dimension) -> tuple[int, int]:
    """The powers of length and of 1/time of a `WatchedStop`."""
    length, mass, time, _ = dimension.exponents
    if mass or time > 0 or length != int(length) or time != int(time):
        return 0, -1
    return int(length), -int(time)


Reason = tuple[Status, Diagnostic]
"""Why no row follows: the verdict of the rows, and the words; `place` in the file of what ends the
motion, where that is not the whole response."""


def _error(
    code: str,
    text: str,
    hint: str,
    measured: str | None = None,
    place: Place | None = None,
    limit: str | None = None,
) -> Diagnostic:
    return Diagnostic(code, "error", text, place, measured, limit, hint)


def reason(free: Session, response: ResponseProblem, report: MotionReport) -> Reason:
    """The reason of a premature end; `free` is the session that moved."""
    law = _law(free, report.which) if report.met else None
    if law is not None and report.value < tolerances.KINK_ROUNDING:
        # a jump whose side rounding chooses, of a load that moves something
        text = f"{_words(law)} jumps with the sign of what is zero all along but for rounding"
        hint = "leave the jump out: what it asks for does not move"
        measured = f"at most {report.value:.1e}"
        return Status.friction_undecided, _error("held-at-jump", text, hint, measured, law.place)
    met = response.stops[report.stop] if report.stop >= 0 else None
    if isinstance(met, SlopeEnd):
        text = f"the slope of {met.owner} jumps at {met.words}, and rates of what it moves with it"
        hint = f"{ROUNDED}, or end the response before it"
        return Status.step_limit, _error("slope-jump", text, hint, met.by)
    if report.end is MotionEnd.STEP_LIMIT and not report.singular:
        return _step_limit(free, report)
    if report.end is MotionEnd.HELD:
        return _held(free, report)
    fault = report.fault
    if fault == Fault.NOT_FINITE or fault & Fault.UNDEFINED_LOAD:
        text = "a load or a rate has no finite value beyond"
        hint = "write loads that hold along the motion"
        return Status.step_limit, _error("load-undefined", text, hint)
    if fault & Fault.UNDEFINED_STOP:
        stop = response.stops[report.stop]
        text = f"the value of the stop {stop.words} is not defined there"
        hint = "write a value that is defined along the motion"
        return Status.step_limit, _error("stop-undefined", text, hint, place=stop.place)
    if fault & Fault.FRICTION:
        whose = rubbing_words(_rubbing(free, report)) or "friction"
        text = f"{whose} has no answer there, or more than one: the mechanism may jam, or slip"
        hint = "make a coefficient smaller, or bearings longer"
        return Status.friction_undecided, _error("friction-undecided", text, hint)
    # the steps end as rates grow without bound where an inertia goes to zero
    loses_inertia = (
        not fault and _runs_away(response, report) and report.lightest < tolerances.LOST_INERTIA
    )
    if fault & Fault.SINGULAR_INERTIA or loses_inertia:
        hint = "give the links that it moves a mass, or drive it"
        return Status.singular_inertia, _error("singular-inertia", "", hint)
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
        return Status.branch_lost, _error("branch-lost", text, hint)
    if report.joints and _runs_away(response, report):
        named = rubbing_words(_rubbing(free, report))
        text = f"{named} feeds itself without bound: the mechanism jams"
        hint = "make a coefficient smaller, or bearings longer"
        growth = f"rates grow by themselves in {1.0 / report.growth:.1e} s"
        return Status.friction_undecided, _error("friction-undecided", text, hint, growth)
    if report.joints:
        named = _names(_rubbing(free, report))
        text = f"{named} starts to slip in a direction that no step determines"
        hint = "make its static coefficient a little larger than that of sliding"
        return Status.friction_undecided, _error("friction-undecided", text, hint)
    return _tolerance(response, report)


def _rubbing(free: Session, report: MotionReport) -> list[Rubbing]:
    """The joints and couplings whose friction ends a motion."""
    frictions = free.problem.mechanism.frictions
    return [frictions[number] for number in report.joints]


def _names(named: Sequence[Rubbing]) -> str:
    return ", ".join(one.joint for one in named)


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
    return Status.branch_lost, _error("branch-point", text, hint)


def _step_limit(free: Session, report: MotionReport) -> Reason:
    count, units = report.steps + report.rejections, free.problem.units
    text = f"{count} steps were not enough"
    measured = f"{report.rejections} of them refused, the last {_time(units, report.step)} long"
    law = _law(free, report.which)
    if law is not None and report.met > tolerances.MANY_KINKS * report.steps:
        text += f": {report.met} end where {_words(law)} bends or jumps"
        hint = "write it smoothly there, or what sticks as {type: friction, ...}"
        return Status.step_limit, _error("step-limit", text, hint, measured, law.place)
    hint = "widen the tolerance, shorten the time, or look for what moves so fast"
    limit = f"{tolerances.MOST_RESPONSE_STEPS} steps"
    return Status.step_limit, _error("step-limit", text, hint, measured, limit=limit)


def _held(free: Session, report: MotionReport) -> Reason:
    law = _law(free, report.which)
    if law is None:
        whose = _names(_rubbing(free, report)) or "the motion"
        text = f"{whose} comes to rest again and again at one place"
        hint = "make a static coefficient a little larger than that of sliding, or bearings longer"
        return Status.friction_undecided, _error("friction-undecided", text, hint)
    text = (
        f"it is held where {_words(law)} jumps: from both sides the motion goes back to the jump, "
        "where the load may have any value between those of the sides"
    )
    hint = (
        "write what sticks as {type: friction, ...}, or a steep slope for the jump, as "
        "max(-1, min(1, x/small)) for sign(x)"
    )
    return Status.friction_undecided, _error("held-at-jump", text, hint, place=law.place)


def _runs_away(response: ResponseProblem, report: MotionReport) -> bool:
    return report.growth * response.moments.duration > tolerances.RUNAWAY


def _long_step(units: UnitSystem, report: MotionReport) -> Reason:
    text = (
        f"a fixed step of {_time(units, report.step)} is too long there: its stages may leave the "
        "branch"
    )
    hint = (
        "write a shorter fixed_step, or a tolerance in its place, which chooses the steps; if that "
        "ends here, too, this is a special position: end the response before it"
    )
    return Status.step_limit, _error("step-limit", text, hint)


def _tolerance(response: ResponseProblem, report: MotionReport) -> Reason:
    if not _runs_away(response, report):
        text = "no step, however short, keeps the tolerance"
        limit = f"{response.tolerance:g}"
        return Status.step_limit, _error("step-limit", text, "widen the tolerance", limit=limit)
    growth = f"rates grow by themselves in {1.0 / report.growth:.1e} s"
    if response.driven:
        names = ", ".join(f"{d.joint}.{d.coordinate}" for d in response.driven)
        text = f"{names} cannot be driven further: rates and forces grow without bound"
        hint = "it is a dead centre of what is driven; let its law turn back before"
        return Status.branch_lost, _error("branch-lost", text, hint, growth)
    text = "rates grow without bound"
    hint = "look for a load that grows with what it moves, or for links without mass"
    return Status.step_limit, _error("step-limit", text, hint, growth)


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
    energies = batch.outputs[readout.slots[wanted.name].start]
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
        notes.append(passed_straight_on("motion", passed, place=response.place))
    if report.stiff:
        text = f"from {_time(units, report.stiff_from)} on the motion is stiff"
        hint = "an implicit method of order 5 (Radau IIA) has taken over; nothing is to be done"
        notes.append(Diagnostic("stiff", "note", text, response.place, hint=hint))
    for number, stop in enumerate(response.stops):
        times = [time for touched, time in report.touches if touched == number]
        if times and not isinstance(stop, SlopeEnd):
            notes.append(_touched(stop, [_time(units, time) for time in times]))
    if report.end in (MotionEnd.DONE, MotionEnd.STOPPED, MotionEnd.UNDER_WAY):
        return Status.ok, notes
    at = _time(units, report.time)
    status, why = reason(free, response, report)
    text = why.message
    if status is Status.singular_inertia:
        text = _without_inertia(weakest_coordinates(session, response, last))
    is_point = why.code == "branch-point"
    numbers = place_numbers(session, np.array(report.branch_point) if is_point else last)
    shown = ", ".join(map(input_text, numbers))
    measured = shown if is_point else f"last place {shown}"
    notes.append(
        why._replace(
            message=f"the response ends at {at}: {text}",
            place=why.place or response.place,
            measured=f"{why.measured}, {measured}" if why.measured else measured,
            numbers=numbers,
        )
    )
    return status, notes


def _touched(stop: Stop, times: Sequence[str]) -> Diagnostic:
    more = f" and {len(times) - 1} more times" if len(times) > 1 else ""
    text = f"{stop.words} is touched at {times[0]}{more}, but not passed"
    hint = "the response goes on; move the value of at: if it is to end there"
    rounding = "up to 1e-12 of its values beside is rounding"
    return Diagnostic("stop-touched", "note", text, stop.place, rounding, hint=hint)


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
