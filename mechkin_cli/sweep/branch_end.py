"""Why a branch ends: at a dead centre, which is located, or somewhere it could not be followed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import mobility, modes, tolerances
from mechkin_cli.assembly import MAY_BE_RIGID, condition_at
from mechkin_cli.diagnostics import Diagnostic, Number, Place
from mechkin_cli.kernel._kernel import MOST_PATH_STEPS
from mechkin_cli.plan import PassageEnd, TrackEnd
from mechkin_cli.row_notes import MOST_PLACES, Found, RowNote
from mechkin_cli.session import (
    Ending,
    Followed,
    Runaway,
    find_limit,
    input_number,
    input_numbers,
    input_text,
)
from mechkin_cli.sweep.rows import SweepRows
from mechkin_cli.sweep.slopes import place_text, turning_corner
from mechkin_cli.units import LENGTH, TIME
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep.retracing import SingularPlace
    from mechkin_cli.sweep.slopes import Bend, Jump


NEAR_SINGULAR = "a singular position lies next to that place; sweep from its other side"
NOT_SINGULAR = "that place itself is regular: take smaller steps, or sweep from the other side"


def explain_end(session: Session, path: Floats, followed: Followed, rows: SweepRows) -> None:
    """Says why a branch ended, and gives the rows that it does not reach their status.

    `path` (inputs, rows) in kernel units and `rows` are in the order in which they were followed.
    """
    missing = ~rows.reached
    rows.status[missing] = Status.branch_lost
    locked = locked_inputs(session, followed.inputs - path[:, 0])
    if locked:
        rows.diagnostics.extend(fault for fault in locked if fault not in rows.diagnostics)
        return
    if followed.end == TrackEnd.EXHAUSTED:
        rows.diagnostics.append(_exhausted_note(session, followed, rows))
        return
    limit = find_limit(session, followed) if len(path) else None
    dead_centre = limit if isinstance(limit, Ending) and limit.is_dead_centre else None
    if dead_centre is not None:
        rows.status[missing] = Status.beyond_dead_centre
    if session.problem.held and (held := _lost_hold_note(session, followed, limit, rows)):
        rows.diagnostics.append(held)
    elif dead_centre is not None:
        rows.ends.append((int(rows.numbers[rows.reached][-1]), dead_centre))
        rows.diagnostics.append(_dead_centre_note(session, followed, dead_centre, path, rows))
    elif isinstance(limit, Runaway):
        rows.diagnostics.append(_runaway_note(session, followed, limit, rows))
    elif limit is not None:
        rows.diagnostics.append(_branch_point_note(session, followed, limit, rows))
    elif (corner := turning_corner(session, followed.state)) is not None:
        rows.status[missing] = Status.beyond_dead_centre
        rows.diagnostics.append(_corner_note(session, followed, corner, rows))
    else:
        rows.diagnostics.append(_lost_note(session, followed, path, rows))


def without_repeats(diagnostics: Sequence[Diagnostic]) -> list[Diagnostic]:
    """The diagnostics of the lines of a grid: the first of each kind, with the number of others."""
    first: dict[str, Diagnostic] = {}
    counts: dict[str, int] = {}
    for one in diagnostics:
        first.setdefault(one.code, one)
        counts[one.code] = counts.get(one.code, 0) + 1
    more = {
        code: f" (and {count - 1} more such places on the grid)" for code, count in counts.items()
    }
    return [
        one._replace(message=one.message + more[code]) if counts[code] > 1 else one
        for code, one in first.items()
    ]


def crossing_note(
    session: Session, rows: SweepRows, passed: Sequence[tuple[int, Floats]]
) -> RowNote:
    """The branch points that the rows passed straight on, each by the first row behind it, in the
    order in which they were followed, and its inputs."""
    last = rows.numbers.size - 1
    places = [
        (int(rows.numbers[min(row, last)]), _numbers(session, inputs)) for row, inputs in passed
    ]
    code, nowhere = "branch-point-passed", np.zeros(rows.span.rows, dtype=bool)
    return RowNote(code, "note", "", nowhere, _passed, places=places)


def _numbers(session: Session, inputs: Floats) -> tuple[Number, ...]:
    return tuple(input_numbers(session.problem, session.layout, inputs))


def _passed(found: Found) -> Diagnostic:
    return passed_straight_on("branch", [place for _, place in found.places], found.place_count)


_TURNED_BACK = {
    PassageEnd.DEAD_CENTRE: (
        "dead-centre-touched",
        "a dead centre",
        "to go over to the other branch there, drive another coordinate",
    ),
    PassageEnd.BRANCH_POINT: (
        "branch-point-touched",
        "a branch point",
        "the mechanism may also go the other way behind it: begin another sweep there with "
        "assembly: {near: ...}",
    ),
}
"""What the inputs may come to where they turn back: code, words, hint."""


def retraced_notes(
    session: Session, rows: SweepRows, touched: Sequence[SingularPlace]
) -> list[RowNote]:
    """The places at which the inputs come to a dead centre or a branch point and turn back."""
    notes, last = [], rows.span.rows - 1
    nowhere = np.zeros(rows.span.rows, dtype=bool)
    step = 1 if rows.numbers[-1] >= rows.numbers[0] else -1
    for kind, (code, _, _) in _TURNED_BACK.items():
        places = []
        for place in touched:
            if place.kind == kind:
                row = rows.span.first + place.row + 1
                where = f"{'at' if place.is_row else 'behind'} row {row}"
                behind = place.row if place.is_row else place.row + step
                shown = where, _numbers(session, place.inputs)
                places.append((min(max(behind, 0), last), shown))
        if places:
            words = partial(_turned_back, kind)
            notes.append(RowNote(code, "note", "", nowhere, words, places=places))
    return notes


def _turned_back(kind: PassageEnd, found: Found) -> Diagnostic:
    code, name, hint = _TURNED_BACK[kind]
    shown, places = zip(*(place for _, place in found.places), strict=True)
    left = found.place_count - len(shown)
    more = f" and {left} more" if left else ""
    return Diagnostic(
        code,
        "note",
        f"{', '.join(shown)}{more} the inputs come to {name} and turn back; the rows behind it "
        "retrace the branch",
        measured="; ".join(_words(numbers) for numbers in places),
        hint=hint,
        numbers=tuple(number for numbers in places for number in numbers),
    )


def passed_straight_on(
    subject: str,
    places: Sequence[Sequence[Number]],
    count: int | None = None,
    place: Place | None = None,
) -> Diagnostic:
    """The note that a branch or a motion went straight on through branch points.

    Args:
        subject: what passed them.
        places: numbers of each branch point, or of the first of them.
        count: how many there are; None: as many.
        place: of what asked for the motion.
    """
    shown = [_words(numbers) for numbers in places[:MOST_PLACES]]
    count = len(places) if count is None else count
    more = count - len(shown)
    return Diagnostic(
        "branch-point-passed",
        "note",
        f"the {subject} passes {'a branch point' if count == 1 else 'branch points'} along "
        "its smooth continuation, as assembly: {at_branch_points: straight} asks",
        place,
        measured="; ".join(shown) + (f" and {more} more" if more else ""),
        numbers=tuple(number for numbers in places[:MOST_PLACES] for number in numbers),
    )


def input_faults(session: Session) -> list[Diagnostic]:
    """What mobility says of inputs that are locked, dependent or too few, where by the count of
    their equations all loops would be driven.

    For runs that are stuck or whose rank is unclear from their first row on. At a branch point
    motions of several kinds meet, and inputs that are locked on one drive another: then only
    freedoms are named that are left undriven on all of them.
    """
    found = mobility.find_mobility(session.problem, session)
    driven, idle, useful = session.problem.motion.driven, len(found.idle), found.useful
    codes = {"input-locked", "inputs-dependent", "undriven-freedom"}
    is_at_branch_point = found.first_order != found.mobility and not session.is_redundant
    if is_at_branch_point:
        least = min(found.dimensions, default=0)
        codes = {"undriven-freedom"} if least > len(driven) + idle else set()
    elif useful and len(driven) > useful:
        # at the first row one of them may stand still by chance; together they cannot move
        freedoms = "one freedom" if useful == 1 else f"{useful} freedoms"
        return [
            Diagnostic(
                "inputs-dependent",
                "error",
                f"the inputs {', '.join(map('.'.join, driven))} are not independent",
                measured=f"{len(driven)} inputs drive {freedoms}",
                hint="drive fewer coordinates",
            )
        ]
    notes = found.diagnostics if driven else mobility.undriven_notes(found.mobility or 0, idle, 0)
    return [note._replace(severity="error") for note in notes if note.code in codes]


def locked_inputs(session: Session, moved: Floats) -> list[Diagnostic]:
    """The same of inputs that hardly `moved` (inputs,)."""
    farthest = float(np.max(np.abs(moved), initial=0.0))
    return input_faults(session) if farthest <= tolerances.PASSED else []


def _words(places: Iterable[Number]) -> str:
    return ", ".join(map(input_text, places))


def _stay_empty(rows: SweepRows, where: str = "") -> str:
    """The missing rows in words, and `where` they lie."""
    missing = np.sort(rows.numbers[~rows.reached])
    first, last = (rows.span.first + int(missing[end]) + 1 for end in (0, -1))
    # of a part of a run those before it, or behind it, are missing, too
    first = 1 if missing[0] == 0 else first
    last = rows.span.run_rows if missing[-1] == rows.span.rows - 1 else last
    lie, stay, span = "lie", "stay", f"rows {first} to {last}"
    if first == last:
        lie, stay, span = "lies", "stays", f"row {first}"
    return f"{span} {lie} {where} and {stay} empty" if where else f"{span} {stay} empty"


def _place(
    session: Session, followed: Followed, inputs: Floats, shown: Iterable[int] | None = None
) -> tuple[Number, ...]:
    """Where the branch ended: time, where inputs move by laws, and the inputs, or those `shown`."""
    course = session.problem.motion.course
    numbers = input_numbers(session.problem, session.layout, inputs)
    if shown is not None:
        numbers = tuple(numbers[number] for number in shown)
    if followed.parameter is None or course is None or course.parameter.name != "time":
        return numbers
    moment = Number("time", followed.parameter, session.problem.units.label(TIME))
    return (moment, *numbers)


def _dead_centre_note(
    session: Session, followed: Followed, limit: Ending, path: Floats, rows: SweepRows
) -> Diagnostic:
    moving = np.flatnonzero(limit.inputs_beyond != limit.inputs)
    shown = _place(session, followed, limit.inputs, moving if moving.size else None)
    beyond = _all_beyond(limit, path, rows)
    where = "beyond it" if beyond else "beyond it on the way of the rows"
    again = _assembled_again(session, followed, limit, path, rows)
    cure = "end the sweep before it, or choose another assembly"
    if again:
        cure = f"end the sweep before it; from {input_text(again)} on it can be assembled again"
    return Diagnostic(
        "dead-centre",
        "warning",
        f"the branch ends at a dead centre; {_stay_empty(rows, where)}",
        measured=_words(shown),
        hint=f"{cure}{_chords(session, path)}",
        numbers=shown,
    )


def _chords(session: Session, path: Floats) -> str:
    """A remark on rows that no law joins."""
    course = session.problem.motion.course
    together = np.count_nonzero((path != path[:, :1]).any(axis=1)) > 1
    if not together or (course is not None and course.parameter.name != "row"):
        return ""
    return "; between rows that list their values the inputs go straight from one to the next"


def _assembled_again(
    session: Session, followed: Followed, limit: Ending, path: Floats, rows: SweepRows
) -> Number | None:
    """Where a sweep of one turning input comes to the branch's other end, a whole turn on, before
    its last row."""
    moving = np.flatnonzero((path != path[:, :1]).any(axis=1))
    if moving.size != 1 or not rows.reached[0] or session.problem.motion.grid is not None:
        return None
    number = int(moving[0])
    walker = modes.Walker(session, number, path[:, 0])
    direction = float(np.sign(followed.direction[number]))
    if walker.period is None or direction == 0.0:
        return None
    other = walker.end((float(path[number, 0]), rows.states[:, 0]), -direction)
    value = other.value + direction * walker.period
    ahead = direction * (path[number, ~rows.reached] - value)
    behind = direction * (value - float(limit.inputs[number]))
    if other.kind != "dead-centre" or behind <= 0.0 or not (ahead >= 0.0).any():
        return None
    return input_number(session.problem, session.layout, number, value)


def _all_beyond(limit: Ending, path: Floats, rows: SweepRows) -> bool:
    """Whether the missing rows lie where the branch does not come at all."""
    back = limit.inputs_beyond - limit.inputs
    off = path[:, ~rows.reached] - limit.inputs[:, None]
    along = sum(one * other for one, other in zip(off, back, strict=True))
    return bool(np.all(along <= 0.0))


def _error(
    code: str, rows: SweepRows, places: tuple[Number, ...], text: str, measured: str, hint: str
) -> Diagnostic:
    """A branch that ends at these places, in no dead centre of the mechanism."""
    message = f"{text}; {_stay_empty(rows)}"
    return Diagnostic(code, "error", message, measured=measured, hint=hint, numbers=places)


def _runaway_note(
    session: Session, followed: Followed, limit: Runaway, rows: SweepRows
) -> Diagnostic:
    places = _place(session, followed, followed.inputs)
    units = session.problem.units
    slide = float(units.from_si(limit.slide * session.layout.length, LENGTH))
    return _error(
        "unbounded",
        rows,
        places,
        f"the slide of {limit.joint} grows out of bounds, the branch seems to go to infinity",
        f"{slide:.6g} {units.label(LENGTH)} at the last place followed, {_words(places)}",
        "end the sweep before it, or choose another assembly",
    )


def _branch_point_note(
    session: Session, followed: Followed, point: Ending, rows: SweepRows
) -> Diagnostic:
    places = _place(session, followed, point.inputs)
    return _error(
        "branch-point",
        rows,
        places,
        "the branch comes to a branch point, where it crosses another and the mechanism may go "
        "either way",
        _words(places),
        "assembly: {at_branch_points: straight} goes on along the smooth continuation; or "
        "begin another sweep beyond it with assembly: {near: ...}",
    )


def _lost_hold_note(
    session: Session,
    followed: Followed,
    limit: Ending | Runaway | None,
    rows: SweepRows,
) -> Diagnostic | None:
    """Says where the hold of an idle freedom ends the branch, and not the mechanism."""
    at = limit if isinstance(limit, Ending) else followed
    held = mobility.lost_holds(session, at.inputs, at.state)
    if not held:
        return None
    places = _place(session, followed, at.inputs)
    text, hint = mobility.hold_ends(held)
    return _error("hold-ends", rows, places, text, _words(places), hint)


def _exhausted_note(session: Session, followed: Followed, rows: SweepRows) -> Diagnostic:
    places = _place(session, followed, followed.inputs)
    note = _error(
        "steps-exhausted",
        rows,
        places,
        "following the branch takes too many steps: the way to the next row is too long, or the "
        "mechanism turns too fast on it",
        f"{followed.steps} steps, last place {_words(places)}",
        "check the range of the input and its unit",
    )
    limit = f"{MOST_PATH_STEPS} steps, {tolerances.MOST_STEPS} for half a radian or length unit"
    return note._replace(limit=limit)


def _corner_note(
    session: Session, followed: Followed, corner: tuple[Bend, Jump], rows: SweepRows
) -> Diagnostic:
    bend, jump = corner
    where = place_text(session.problem, bend, jump.at)
    shown = _place(session, followed, followed.inputs)
    return Diagnostic(
        "dead-centre",
        "warning",
        f"the branch turns back where the slope of {bend.owner} changes its sign with a jump, at "
        f"{where}; {_stay_empty(rows, 'beyond it')}",
        measured=_words(shown),
        hint=f"end the sweep before it, or drive {bend.name}",
        numbers=shown,
    )


def _lost_note(session: Session, followed: Followed, path: Floats, rows: SweepRows) -> Diagnostic:
    places = _place(session, followed, followed.inputs)
    measured, hint = f"last place {_words(places)}", MAY_BE_RIGID
    if not session.is_redundant:
        condition = condition_at(session, followed.inputs, followed.state)
        singular = condition is None or condition > tolerances.CONDITION_NEAR_SINGULAR
        hint = NEAR_SINGULAR if singular else NOT_SINGULAR
        if condition is not None:
            measured += f", where the condition is {condition:.2g}"
    text = "the branch could not be followed further"
    return _error("branch-lost", rows, places, text, measured, hint + _chords(session, path))
