"""Functions of coordinates whose slope jumps, as those with `abs` or sequences of laws, and curves
with corners.

Rates jump where they are passed. Rows at such a place stand there rightly and have the rates of one
of its sides; a motion under forces ends there.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import ExpressionOf, dimension_of
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple
from mechkin_cli.row_notes import Found, RowNote
from mechkin_cli.session import Ask, RowInputs
from mechkin_cli.tape import JetNumber, Operation, RowRecorder, orders_of
from mechkin_cli.tolerances import AT_LIMIT, COURSE_SAME, SLOPE_JUMP
from mechkin_cli.units import LENGTH

if TYPE_CHECKING:
    from mechkin_cli.mechanism import CoordinateLaw, Problem, Track, Wanted
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep.rows import RunRows
    from mechkin_cli.units import Dimension

_CHOICES = {
    Operation.MAGNITUDE,
    Operation.SIGN,
    Operation.LARGER,
    Operation.SMALLER,
    Operation.WHOLE,
    Operation.CHOOSE,
}

_PANELS = 4096
"""Stretches of a range that are searched: two jumps within one are told as one."""

_HALVINGS = 60


class Bend(NamedTuple):
    """A function that chooses: its slopes (components, places) at places (places,) of a coordinate,
    in SI.

    Attributes:
        owner: the coupling or joint.
        name: of the coordinate, `A.theta`.
        unit: the dimension of the slopes.
        noted: whether the reading of the file has told its jumps.
    """

    owner: str
    name: str
    unit: Dimension
    slopes: Callable[[Floats], Floats]
    noted: bool


class Jump(NamedTuple):
    """Where a slope jumps (rad, m, or a parameter), and by how much."""

    at: float
    size: float


def bends(problem: Problem) -> list[Bend]:
    """The functions of a mechanism's couplings and curves whose slopes may jump."""
    found = []
    for owner, relation in problem.mechanism.couplings.items():
        for term in relation.terms:
            law = term.law
            if law is None or law.value is None or not _chooses(law.value):
                continue
            dimension = dimension_of(term.coordinate)
            gives = dimension_of("s" if relation.length else "theta")
            noted = not isinstance(law.value, ExpressionOf)
            name = f"{term.joint.name}.{term.coordinate}"
            found.append(Bend(owner, name, gives / dimension, _of_law(law), noted))
    for joint in problem.mechanism.joints.values():
        for part in joint.parts:
            track = part.track
            if track is None or len(track.ends) > 1 or track.knots or not _bends(track):
                continue
            unit = LENGTH / dimension_of("u")
            found.append(Bend(joint.name, f"{joint.name}.u", unit, _of_track(track), noted=False))
    return found


def bending(problem: Problem) -> list[Wanted]:
    """The coordinates whose places tell of jumps that a sweep has to name."""
    names = {bend.name for bend in bends(problem) if not bend.noted}
    known = problem.quantities() if names else {}
    return [known[name] for name in sorted(names)]


def jumps_between(bend: Bend, low: float, high: float) -> list[Jump]:
    """The jumps of the slope between two places, rising; found where a stretch of the range keeps a
    change of the slope however often it is halved."""
    if not low < high:
        return []
    places = np.linspace(low, high, _PANELS + 1)
    slopes = bend.slopes(places)
    known = np.abs(slopes[np.isfinite(slopes)])
    least = SLOPE_JUMP * float(known.max(initial=0.0))
    one, other, before, behind = places[:-1], places[1:], slopes[:, :-1], slopes[:, 1:]
    for _ in range(_HALVINGS):
        kept = _change(before, behind) > least
        one, other, before, behind = one[kept], other[kept], before[:, kept], behind[:, kept]
        if not one.size:
            break
        middle = 0.5 * (one + other)
        half = bend.slopes(middle)
        first = _change(before, half) > _change(half, behind)
        one, other = np.where(first, one, middle), np.where(first, middle, other)
        before, behind = np.where(first, before, half), np.where(first, half, behind)
    sizes = _change(before, behind)
    near = COURSE_SAME * max(abs(low), abs(high))
    found: list[Jump] = []
    for at, size in zip(other.tolist(), sizes.tolist(), strict=True):
        if not found or at - found[-1].at > near:
            found.append(Jump(0.0 if abs(at) <= near else at, size))
    return found


def value_at(session: Session, name: str, state: Floats) -> float:
    """A coordinate (rad, m) at states (states,)."""
    readout = session.readout([session.problem.quantities()[name]])
    places = [session.layout.state(edge, freedom) for edge, freedom in session.graph.inputs]
    rows = RowInputs(state[places][:, None], state[:, None], np.zeros((len(places), 1)))
    batch = session.run(rows, Ask(Demand.VELOCITY, readout))
    assert batch.outputs is not None
    return float(batch.outputs[readout.slots[name].start, 0])


def turning_corner(session: Session, state: Floats) -> tuple[Bend, Jump] | None:
    """The function and its place, next to states (states,), at which its slope changes the sign
    with a jump: what follows it turns back there, and cannot lead beyond. None where there is
    none."""
    for bend in bends(session.problem):
        value = value_at(session, bend.name, state)
        slack = AT_LIMIT * max(1.0, abs(value))
        for jump in jumps_between(bend, value - slack, value + slack):
            sides = bend.slopes(np.array([jump.at - slack, jump.at + slack]))
            if len(sides) == 1 and sides[0, 0] * sides[0, 1] < 0.0:
                return bend, jump
    return None


def slope_notes(result: RunRows) -> list[RowNote]:
    """Names the places between the rows at which slopes jump, and the rows there."""
    problem, notes = result.problem, []
    for bend in _bends_of(result.session):
        if bend.noted or not result.solved.any():
            continue
        values = np.broadcast_to(
            np.asarray(result.quantity(bend.name).value), result.row_states.reached.shape
        )
        values = np.where(result.solved, values, np.nan)
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        jumps = jumps_between(bend, *_around(low, high))
        if jumps:
            there = np.zeros(values.shape, dtype=np.bool_)
            for jump in jumps:
                there |= np.abs(values - jump.at) <= COURSE_SAME * max(1.0, abs(jump.at))
            words = partial(_note, problem, bend)
            marks = [(jump, None) for jump in jumps]
            about = bend.owner, bend.name
            notes.append(RowNote("slope-jump", "warning", about, there, words, marks=marks))
    return notes


@remembered
def _bends_of(session: Session) -> list[Bend]:
    return bends(session.problem)


def coordinate_unit(problem: Problem, name: str) -> tuple[float, str]:
    """What one file unit of a coordinate is in SI, and its label; parameters of curves are plain
    numbers."""
    dimension = dimension_of(name.rpartition(".")[2])
    return float(problem.units.to_si(1.0, dimension)), problem.units.label(dimension)


def place_text(problem: Problem, bend: Bend, at: float) -> str:
    """`A.theta = 0.1 rad`."""
    unit, label = coordinate_unit(problem, bend.name)
    return f"{bend.name} = {at / unit:.6g} {label}".rstrip()


def size_text(problem: Problem, bend: Bend, size: float) -> str:
    """A change of the slope in the file's units."""
    value = float(problem.units.from_si(size, bend.unit))
    return f"{value:.6g} {problem.units.label(bend.unit)}".rstrip()


ROUNDED = "round it off, as by sqrt(x^2 + e^2) for abs(x) with a small e"
"""The cure."""


def _note(problem: Problem, bend: Bend, found: Found) -> Diagnostic:
    jumps: list[Jump] = []
    for jump in sorted(found.marks):
        # one that lies next to a border of parts is found in both
        if not jumps or jump.at - jumps[-1].at > COURSE_SAME * max(1.0, abs(jump.at)):
            jumps.append(jump)
    largest = max(jumps, key=lambda jump: jump.size)
    more = f", the largest of {len(jumps)} such jumps" if len(jumps) > 1 else ""
    text = f"the slope of {bend.owner} jumps at {place_text(problem, bend, largest.at)}{more}"
    if found.some_rows is not None:
        one = found.rows.size == 1
        stands = "stands there and has" if one else "stand there and have"
        text += f"; {found.rows} {stands} the rates of one side"
    unit, label = coordinate_unit(problem, bend.name)
    return Diagnostic(
        "slope-jump",
        "warning",
        text,
        measured=size_text(problem, bend, largest.size),
        hint=f"forces are infinite there; {ROUNDED}",
        numbers=(Number(bend.name, largest.at / unit, label),),
    )


def _around(low: float, high: float) -> tuple[float, float]:
    """A range and what rounding leaves beside it."""
    slack = COURSE_SAME * max(1.0, abs(low), abs(high))
    return low - slack, high + slack


def _change(one: Floats, other: Floats) -> Floats:
    """The largest difference of some components (components, places); 0 where one is not known."""
    off = np.abs(other - one)
    largest: Floats = np.where(np.isfinite(off), off, 0.0).max(axis=0, initial=0.0)
    return largest


def _chooses(value: Callable[[Any], Any]) -> bool:
    """Whether the slope of a function is computed by choices."""
    recorder = RowRecorder(1)
    orders_of(value(JetNumber([recorder.number(0), 1.0, 0.0, 0.0])))
    return any(operation in _CHOICES for operation, *_ in recorder.instructions)


def _bends(track: Track) -> bool:
    recorder = RowRecorder(1)
    track.orders([recorder.number(0)])
    return any(operation in _CHOICES for operation, *_ in recorder.instructions)


def _of_law(law: CoordinateLaw) -> Callable[[Floats], Floats]:
    return lambda at: law.orders(at)[1:2]


def _of_track(track: Track) -> Callable[[Floats], Floats]:
    def slopes(at: Floats) -> Floats:
        with np.errstate(all="ignore"):
            return np.stack(track.derivatives(at, 1)[0])

    return slopes
