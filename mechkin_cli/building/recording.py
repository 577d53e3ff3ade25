"""A problem built of recorded numbers: how everything in it depends on some parameters, or on the
exact numbers of the text.

The file is built once more, with the same values, but on a recorder; each decision on one of them
becomes a guard. A dependence that no tape can hold (a number of rows, a table, an uncertain
warning) raises `TraceLost`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from mechkin_cli import idle
from mechkin_cli.building.builder import Built, build_problem, check_spins, read_fields, used_by
from mechkin_cli.building.datum import exact_numbers
from mechkin_cli.building.exact_motion import (
    exact_moment,
    exact_moments,
    exact_motion,
    start_motion,
)
from mechkin_cli.building.fields import Fields
from mechkin_cli.building.responses import settled
from mechkin_cli.expressions import Move, Quantity
from mechkin_cli.mechanism import (
    ExactMotion,
    LockedFreedom,
    Problem,
    response_problem,
)
from mechkin_cli.record import replace
from mechkin_cli.session import Precise, ShiftingPrecise
from mechkin_cli.tape import (
    ExactRecorder,
    ExactRows,
    Recorded,
    Recorder,
    ShiftingRecorder,
    Traced,
    TraceLost,
)
from mechkin_cli.units import TIME
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


_NOTHING: Mapping[str, Quantity] = MappingProxyType({})


def record_exactly(
    built: Built,
    given: Mapping[str, Quantity] = _NOTHING,
    recorder: ExactRecorder | None = None,
    moved: Move | None = None,
) -> tuple[ExactRecorder, Problem, ExactMotion]:
    """The problem of a file and its motion over the rows, each number `Traced` down to the decimals
    of the text.

    Args:
        built: the file, which has no errors.
        given: the values of parameters that replaced their texts when it was built.
        recorder: of the recording; None: a new one.
        moved: as in `evaluate_parameters`, of recorded values.

    Raises:
        TraceLost: a number depends on the text in a way that no tape holds.
    """
    base = built.problem
    recorder = recorder or ExactRecorder()
    with exact_numbers(recorder):
        fields = _fields(built, given, recorder, moved)
        file = built.file
        problem = build_problem(fields, file, responses=False, motion=base.motion)
        motion = exact_motion(fields, file.motion, base.motion, recorder)
    _refuse_errors(fields)
    problem = _completed(problem, base, _held(base, problem, recorder))
    return recorder, settled(problem), motion


def _refuse_errors(fields: Fields) -> None:
    if fields.error_count:
        raise TraceLost("the recording came to an error that the file does not have")


def _completed(problem: Problem, base: Problem, held: tuple[LockedFreedom, ...]) -> Problem:
    """A recorded problem, with the settings that the recording does not build."""
    problem = replace(problem, hold_idle=base.hold_idle, held=held)
    return replace(problem, follow=base.follow, diagnostics=base.diagnostics)


def _fields(
    built: Built, given: Mapping[str, Quantity], recorder: ExactRecorder, moved: Move | None = None
) -> Fields:
    """Units and parameters of a file, those `given` as exact doubles."""
    recorded = {
        name: Quantity(recorder.written(float(one.value), Fraction(one.value)), one.dimension)  # type: ignore[arg-type]
        for name, one in given.items()
    }
    return read_fields(
        built.file, built.document, recorded, moved, datum=built.problem.mechanism.datum
    )


def _held(base: Problem, problem: Problem, recorder: ExactRecorder) -> tuple[LockedFreedom, ...]:
    """The locks of the idle freedoms, with their pairs on the recording."""

    def lift(value: float) -> Any:
        return recorder.number(recorder.constant(value))

    own, recorded = base.mechanism, problem.mechanism
    return tuple(idle.exact_holds(held, own, recorded, lift) for held in base.held)


def precise(built: Built, problem: Problem, given: Mapping[str, Quantity] = _NOTHING) -> Precise:
    """The exact numbers of a file's text, for the sessions of its `problem` in doubles; the other
    arguments and errors as those of `record_exactly`."""
    return Precise(*record_exactly(built, given), problem)


def shifting(
    built: Built, problem: Problem, given: Mapping[str, Quantity] = _NOTHING
) -> ShiftingPrecise:
    """As `precise`, and any parameter can be shifted, with all that depends on it."""
    recorder = ShiftingRecorder()
    leaves: dict[str, int] = {}

    def moved(name: str, quantity: Quantity) -> Quantity:
        leaves[name] = recorder.leaf()
        shift: Any = recorder.number(leaves[name])
        return Quantity(quantity.value + shift, quantity.dimension, quantity.rest)

    _, recorded, motion = record_exactly(built, given, recorder, moved)
    return ShiftingPrecise(recorder, recorded, motion, problem, leaves)


def precise_response(
    built: Built, first: Problem, given: Mapping[str, Quantity] = _NOTHING
) -> Precise:
    """The exact numbers of a response's text, for the sessions of its first moment in doubles.

    Args:
        built: the file, which has no errors.
        first: `response_problem` of the response, in doubles.
        given: as `record_exactly`.

    Raises:
        TraceLost: a number depends on the text in a way that no tape holds.
    """
    response = first.response
    assert response is not None
    if response.driven and response.search is None:
        raise TraceLost("a coordinate that is driven by a law of time")
    recorder = ExactRecorder()
    file, name = built.file, response.name
    with exact_numbers(recorder):
        fields = _fields(built, given, recorder)
        base = built.problem
        problem = build_problem(fields, file, motion=base.motion, moving=base.responses)
        recorded = replace(problem.responses[name], held=())
        path = (response.section, name)
        if response.search is None:
            motion = start_motion(fields, recorded, recorder)
        else:
            motion = start_motion(fields, recorded, recorder, file.equilibria[name].driven)
    _refuse_errors(fields)
    problem = replace(response_problem(problem, recorded, first.motion), hold_idle=first.hold_idle)
    problem = replace(problem, held=_held(first, problem, recorder))

    def moments() -> Floats:
        over = ExactRows(recorder, response.rows)
        with exact_numbers(recorder):
            if response.search is None:
                section = file.responses[name].time
                written = exact_moments(fields, (*path, "time"), section, over)
            else:
                written = exact_moment(fields, (*path, "time"), file.equilibria[name].time, over)
            both = [fields.units.to_si(written, TIME), written]
        return over.double_doubles(both)

    return Precise(recorder, settled(problem), motion, first, moments)


def record(built: Built, names: Sequence[str], *, motion: bool = True) -> tuple[Recorder, Problem]:
    """The problem of a file, its numbers `Traced` where they depend on some of its parameters;
    without its `motion` that stays as it is, of which the mechanism's numbers do not know.

    Raises:
        TraceLost: it depends on one of them in a way that no tape holds.
    """
    base = built.problem
    recorder, fields = _recorded_fields(built, names)
    kept = None if motion else base.motion
    problem = build_problem(fields, built.file, responses=False, motion=kept)
    problem = _completed(problem, base, base.held)
    _refuse_varied_lines(problem)
    check_spins(fields, problem, used_by(problem, built.tables_of(SWEEP)))
    _refuse_errors(fields)
    return recorder, settled(problem)


def record_response(built: Built, names: Sequence[str], run: str) -> tuple[Recorder, Problem]:
    """The problem at the first moment of a response (`response_problem`), recorded likewise.

    Raises:
        TraceLost: it depends on one of them in a way that no tape holds, as moments, stops and
            tolerances do.
    """
    base = built.problem
    response = base.responses[run]
    if response.driven or response.held:
        raise TraceLost("a coordinate that a law of time drives, or that is held")
    if response.search is not None:
        raise TraceLost("a coordinate that is found where the loads balance")
    given = set(names) & _read_by(built, run)
    if given:
        raise TraceLost(f"moments, stops or tolerances read {', '.join(sorted(given))}")
    recorder, fields = _recorded_fields(built, names)
    problem = build_problem(fields, built.file, motion=base.motion, moving=base.responses)
    _refuse_errors(fields)
    if any(isinstance(end, Recorded) for one in problem.limits for end in (one.low, one.high)):
        raise TraceLost("the limit of a coordinate, which ends the response")
    recorded = response_problem(problem, problem.responses[run])
    first = replace(recorded, hold_idle=base.hold_idle, diagnostics=base.diagnostics)
    if first.has_idle:
        raise TraceLost("an idle freedom, which may move by itself")
    return recorder, settled(first)


def _read_by(built: Built, run: str) -> set[str]:
    """The parameters that a response reads where no recording goes: moments, stops, tolerances."""
    data: Any = built.document.data
    section, parameters = data["responses"][run], data.get("parameters", {})
    recorded = ("start", "near", "efforts")
    words = _words([value for key, value in section.items() if key not in recorded])
    found: set[str] = set()
    while more := (words & parameters.keys()) - found:
        found |= more
        words = _words([parameters[name] for name in more])
    return found


def _words(data: Any) -> set[str]:
    """The words of all values in plain data."""
    if isinstance(data, dict):
        return _words(list(data.values()))
    if isinstance(data, list | tuple):
        return set().union(*map(_words, data))
    return set(re.findall(r"\w+", str(data)))


def _recorded_fields(built: Built, names: Sequence[str]) -> tuple[Recorder, Fields]:
    """Units and parameters of a file, those of some names on a recorder."""
    base = built.problem
    quantities = [base.parameters[name] for name in names]
    recorder = Recorder(names, [quantity.value for quantity in quantities])  # type: ignore[misc]
    given = {
        name: Quantity(Traced(recorder, number), quantity.dimension)  # type: ignore[arg-type]
        for number, (name, quantity) in enumerate(zip(names, quantities, strict=True))
    }
    return recorder, read_fields(built.file, built.document, given, datum=base.mechanism.datum)


def _refuse_varied_lines(problem: Problem) -> None:
    """A held freedom is idle as long as the joints around it, or all, lie as they are drawn.

    Raises:
        TraceLost: one of them depends on a parameter.
    """
    for held in problem.held:
        for name in held.joints if held.everywhere else problem.mechanism.joints:
            joint = problem.mechanism.joints[name]
            drawn = [*joint.on_first, *joint.on_second]
            numbers = [joint.lead, *(number for vector in drawn for number in vector)]
            if any(isinstance(number, Recorded) for number in numbers):
                raise TraceLost(f"whether {held.words} depends on a parameter")
