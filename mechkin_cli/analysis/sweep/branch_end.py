"""Why a branch ends: at a dead centre, which is located, or somewhere it could not be followed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.start import MAY_BE_RIGID
from mechkin_cli.analysis.sweep.rows import Rows
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.solver.branch_limit import find_limit
from mechkin_cli.solver.branch_point import BranchPoint
from mechkin_cli.solver.dead_centre import DeadCentre
from mechkin_cli.solver.follow import Followed
from mechkin_cli.solver.inputs import input_number, input_numbers, input_text
from mechkin_cli.solver.runaway import Runaway
from mechkin_cli.status import Status
from mechkin_cli.units import LENGTH

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


MAY_BE_SPECIAL = "this may be a branch point or a special position; sweep from its other side"
MAY_BE_FOLD = (
    "this may be a dead centre of the inputs that move together (it is located where one moves), a "
    "branch point or a special position"
)


def explain_end(session: Session, path: Floats, followed: Followed, rows: Rows) -> int | None:
    """Finds why a branch ended; rows before a dead centre get their guesses from its shape.

    `path` (inputs, rows) in kernel units and `rows` are in the order in which they were followed.

    Returns the row from which the way can be followed anew, back from the last place on the branch;
    None where it ends.
    """
    locked = _locked_inputs(session, path, followed)
    if locked:
        rows.status[~rows.reached] = Status.branch_lost
        rows.diagnostics.extend(locked)
        return None
    if not len(path):
        rows.status[~rows.reached] = Status.branch_lost
        rows.diagnostics.append(_lost_note(session, followed, rows))
        return None
    far = tolerances.BRANCH_POINT_SPANS[0]
    row = followed.reached - 1
    while row > 0 and np.max(np.abs(followed.inputs - path[:, row])) <= far:
        row -= 1
    limit = find_limit(session, followed, path[:, row], rows.states[:, row])
    if isinstance(limit, DeadCentre):
        number = int(np.flatnonzero(followed.direction)[0])
        back = _fill_before(limit, path, followed, number, rows)
        if back is not None or rows.reached.all():
            return back
        rows.status[~rows.reached] = Status.beyond_dead_centre
        rows.diagnostics.append(_dead_centre_note(session, limit, number, path, rows))
        return None
    rows.status[~rows.reached] = Status.branch_lost
    if isinstance(limit, Runaway):
        rows.diagnostics.append(_runaway_note(session, followed, limit, rows))
    elif isinstance(limit, BranchPoint):
        rows.diagnostics.append(_branch_point_note(session, followed, limit, rows))
    else:
        rows.diagnostics.append(_lost_note(session, followed, rows))
    return None


def input_faults(session: Session) -> list[Diagnostic]:
    """What the mobility of an overconstrained mechanism says of inputs that are locked, dependent
    or too few; by the count of their equations its loops would be driven."""
    if not session.is_redundant:
        return []
    from mechkin_cli.analysis.mobility import find_mobility
    from mechkin_cli.analysis.mobility.inputs import undriven_notes

    found = find_mobility(session.problem, session)
    if not session.problem.motion.driven:
        return undriven_notes(found.mobility or 0, len(found.idle), 0)
    driven, useful = session.problem.motion.driven, found.useful
    if useful and len(driven) > useful:
        # at the first row one of them may stand still by chance; together they cannot move
        return [_too_many(driven, useful)]
    codes = ("input-locked", "inputs-dependent", "undriven-freedom")
    return [diagnostic for diagnostic in found.diagnostics if diagnostic.code in codes]


def _too_many(driven: Sequence[tuple[str, str]], useful: int) -> Diagnostic:
    names = ", ".join(".".join(each) for each in driven)
    freedoms = "one freedom" if useful == 1 else f"{useful} freedoms"
    return Diagnostic(
        "inputs-dependent",
        "error",
        f"the inputs {names} are not independent",
        measured=f"{len(driven)} inputs drive {freedoms}",
        hint="drive fewer coordinates",
    )


def _locked_inputs(session: Session, path: Floats, followed: Followed) -> list[Diagnostic]:
    """The same of inputs that hardly moved."""
    way = float(np.max(np.abs(followed.inputs - path[:, 0]), initial=0.0))
    return input_faults(session) if way <= tolerances.PASSED else []


def _fill_before(
    fold: DeadCentre, path: Floats, followed: Followed, number: int, rows: Rows
) -> int | None:
    """Guesses for the rows between the last place followed and the fold.

    Returns the first row after them that turns back from the fold, None if there is none.
    """
    others = np.arange(len(path)) != number
    before = float(followed.inputs[number])
    for row in range(followed.reached, rows.reached.size):
        if np.any(path[others, row] != followed.inputs[others]):
            return None
        value = float(path[number, row])
        if (value - before) * float(followed.direction[number]) < 0.0:
            return row if row > followed.reached else None
        guess = fold.guess(value, followed.state)
        if guess is None:
            return None
        rows.states[:, row] = guess
        rows.turns[:, row] = np.nan
        rows.limit[row] = tolerances.JUMP_LIMIT
        rows.reached[row] = True
        before = value
    return None


def _row_span(rows: Rows) -> str:
    missing = np.sort(rows.numbers[~rows.reached]) + 1
    return f"row {missing[0]}" if missing.size == 1 else f"rows {missing[0]} to {missing[-1]}"


def _stay_empty(rows: Rows, where: str = "") -> str:
    """The missing rows in words, and `where` they lie."""
    one = int(np.count_nonzero(~rows.reached)) == 1
    lie = f"{'lies' if one else 'lie'} {where} and " if where else ""
    return f"{_row_span(rows)} {lie}{'stays' if one else 'stay'} empty"


def _dead_centre_note(
    session: Session, fold: DeadCentre, number: int, path: Floats, rows: Rows
) -> Diagnostic:
    place = input_number(session.problem, session.layout, number, fold.value)
    inwards = float(fold.second[fold.exchanged.input_column])
    beyond = (path[number, ~rows.reached] - fold.value) * inwards <= 0.0
    where = "beyond it" if beyond.all() else "beyond it on the way of the rows"
    return Diagnostic(
        "dead-centre",
        "warning",
        f"the branch ends at a dead centre; {_stay_empty(rows, where)}",
        measured=input_text(place),
        hint="end the sweep before it, or choose another assembly",
        numbers=(place,),
    )


def _runaway_note(session: Session, followed: Followed, limit: Runaway, rows: Rows) -> Diagnostic:
    places = input_numbers(session.problem, session.layout, followed.inputs)
    units = session.problem.units
    slide = float(units.from_si(limit.slide * session.layout.length, LENGTH))
    return Diagnostic(
        "unbounded",
        "error",
        f"the slide of {limit.joint} grows out of bounds, the branch seems to go to infinity; "
        f"{_stay_empty(rows)}",
        measured=f"{slide:.6g} {units.label(LENGTH)} at the last place followed, "
        f"{', '.join(map(input_text, places))}",
        hint="end the sweep before it, or choose another assembly",
        numbers=places,
    )


def _branch_point_note(
    session: Session, followed: Followed, point: BranchPoint, rows: Rows
) -> Diagnostic:
    places = input_numbers(
        session.problem, session.layout, followed.inputs + point.distance * followed.direction
    )
    return Diagnostic(
        "branch-point",
        "error",
        "the branch comes to a branch point, where it crosses another and the mechanism may go "
        f"either way; {_stay_empty(rows)}",
        measured=", ".join(map(input_text, places)),
        hint="begin another sweep beyond it with assembly: {near: ...}, or change the dimensions "
        "a little",
        numbers=places,
    )


def _lost_note(session: Session, followed: Followed, rows: Rows) -> Diagnostic:
    places = input_numbers(session.problem, session.layout, followed.inputs)
    together = np.count_nonzero(followed.direction) > 1
    special = MAY_BE_FOLD if together else MAY_BE_SPECIAL
    return Diagnostic(
        "branch-lost",
        "error",
        f"the branch could not be followed further; {_stay_empty(rows)}",
        measured=f"last place {', '.join(map(input_text, places))}",
        hint=MAY_BE_RIGID if session.is_redundant else special,
        numbers=places,
    )
