"""The assembly at the first row: continued from another model's, near some coordinates, a named
mode, the home drawing, or the nearest to it.

On a fold two branches meet. Near it a state is x0 + v h for inputs u0 + a h^2/2, v of length one.
So derivatives by the input at a distance h that rounding has left are x' = v/(a h) and
x'' = -v/(a^2 h^3), and a = |x''|/|x'|^3 is known although neither of them is (`left_for`). The
branch is judged at the next row that is clear of the fold, unless `near` decides at the first
(`judged_off_fold`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly.home import NamedModes, is_home_assembled, name_modes, rows_from_home
from mechkin_cli.assembly.near import (
    AssemblyStart,
    box_about,
    distances_home,
    distances_near,
    distances_of,
    far_notes,
    in_order,
    is_unclear,
    named_by,
    newton_from,
    nothing_found,
    unclear,
)
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, MechkinError
from mechkin_cli.kernel._kernel import Stepper
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand, Layout, TrackEnd, build_plan
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.search import (
    Assemblies,
    all_assemblies,
    is_in_reach,
    pose_number,
    with_assemblies,
)
from mechkin_cli.session import (
    Ask,
    Batch,
    Continued,
    ContinuedFrom,
    Followed,
    RowInputs,
    Session,
    input_numbers,
    input_text,
    step_limits,
)
from mechkin_cli.structure import structure_of
from mechkin_cli.tolerances import BEFORE_DEAD_CENTRE, OFF_FOLD
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.show import Floats


class PlacesBefore(NamedTuple):
    """Two places before a row at a dead centre, the second a hundredth as far from it: inputs
    (inputs, 2) in kernel units and states (states, 2)."""

    row: int
    inputs: Floats
    states: Floats


def at_unit_rate(session: Session, values: Floats, states: Floats, number: int) -> Batch:
    """The run with one input at unit rate, whose `first` and `second` (columns, places) are the
    derivatives of the columns by that input.

    Args:
        session: the mechanism as it is driven.
        values: (inputs, places) in kernel units, angles within a turn.
        states: (states, places) closed there.
        number: of the input.
    """
    rows = RowInputs(values, states, unit_rates(values, number), np.zeros_like(values))
    demand = Demand.VELOCITY | Demand.ACCELERATION
    return session.run(rows, Ask(demand, derivatives=True, iterations=0))


def unit_rates(values: Floats, number: int) -> Floats:
    """Rates (inputs, places): 1 of one input, 0 of all others."""
    rates = np.zeros_like(values)
    rates[number] = 1.0
    return rates


def left_for(session: Session, row: int, state: Floats) -> list[PlacesBefore]:
    """Places on the two branches that meet in a row at a state (states,), both on the side of the
    fold where they are; none where this is no fold."""
    state = np.ascontiguousarray(state[:, None])
    reduced = np.ascontiguousarray(session.inputs.reduced[:, [row]])
    inputs = range(reduced.shape[0])
    runs = [at_unit_rate(session, reduced, state, number) for number in inputs]
    sizes = [float(np.abs(batch.first).max()) for batch in runs if batch.first is not None]
    number = int(np.argmax(np.nan_to_num(sizes, nan=-1.0)))
    first, second, size = runs[number].first, runs[number].second, sizes[number]
    assert first is not None
    assert second is not None
    with np.errstate(all="ignore"):
        tangent = first / size
        bend = float(np.abs(second).max()) / (size * size * size)
    if not (np.isfinite(tangent).all() and 0.0 < bend < np.inf):
        return []
    before = np.array(BEFORE_DEAD_CENTRE)
    heights = np.sqrt(2.0 * before / bend)
    places = []
    for side in (1.0, -1.0):
        values = np.repeat(session.inputs.values[:, [row]], 2, axis=1)
        values[number] += side * before
        closed = []
        for sign in (1.0, -1.0):
            guess = session.moved_along(np.repeat(state, 2, axis=1), sign * tangent * heights)
            batch = session.close(values, np.ascontiguousarray(guess))
            off = np.abs(batch.states - guess).max(axis=0)
            if (batch.good & (off <= OFF_FOLD * heights)).all():
                closed.append(PlacesBefore(row, values, batch.states))
        if closed:
            places.append(closed)
    return places[0] if len(places) == 1 and len(places[0]) == 2 else []


def judged_off_fold(session: Session, start: AssemblyStart) -> AssemblyStart:
    """The same start unless it is singular: then, of the assemblies at the next clear row that come
    back to it, the one that the file means; with one row alone, the one on the branch that `near`
    means."""
    if start.state is None or start.row or not session.graph.blocks:
        return start
    condition = start.condition
    if condition is None:
        condition = condition_at(session, session.inputs.reduced[:, 0], start.state)
    if condition is None or condition <= tolerances.CONDITION_SIDE_UNCLEAR:
        return start
    row = _next_clear(session)
    return _judged_at(session, start, row) if row else _judged_alone(session, start, start.state)


def _judged_alone(session: Session, start: AssemblyStart, state: Floats) -> AssemblyStart:
    branches = left_for(session, 0, state) if session.problem.assembly.near else []
    if len(branches) < 2:
        return start
    off_fold = np.stack([branch.states[:, 0] for branch in branches], axis=1)
    distances, _ = distances_of(session, branches[0].inputs[:, 0], off_fold)
    if is_unclear(*sorted(distances)):
        return start
    branch = branches[int(np.argmin(distances))]
    path = np.concatenate([branch.inputs, session.inputs.values[:, :1]], axis=1)
    followed = session.follow(path, branch.states[:, 0], every_row=True)
    if followed.end != TrackEnd.FINISHED:
        return start
    state = np.ascontiguousarray(followed.guess[:, -1])
    condition = condition_at(session, session.inputs.reduced[:, 0], state)
    if condition is None or condition > tolerances.CONDITION_RANK_UNCLEAR:
        return start  # on the fold itself, where the branches are one
    how = f"{start.how}; next to a fold, where near tells its branches apart"
    return replace(start, state=state, how=how)


def _judged_at(session: Session, start: AssemblyStart, row: int) -> AssemblyStart:
    assert start.state is not None
    modes = name_modes(session, session.inputs.reduced[:, row], thorough=False)
    if modes.number == 0:
        return start
    home = distances_home(session, modes.points)
    near = session.problem.assembly.near
    distances = distances_near(session.problem, modes.coordinates) if near else home
    back = {
        i: _followed_back(session, modes.found.states[:, i], row) for i in in_order(distances, home)
    }
    first = start.state[:, None]
    order = [
        i
        for i, state in back.items()
        if state is not None
        and pose_number(session.layout, first, state, tolerances.SAME_FOLD) is not None
    ]
    if not order:
        return start
    notes = list(start.diagnostics)
    chosen, how = order[0], f"the first row lies on a fold, row {row + 1} decides"
    nearest = _nearest_of(session, [back[i] for i in order])
    if nearest is not None:
        chosen, how = order[nearest], "next to a fold, where near tells its branches apart"
    elif len(order) > 1 and is_unclear(distances[order[0]], distances[order[1]]):
        pair = (distances[order[0]], distances[order[1]])
        notes.append(unclear(f"two assemblies of row {row + 1}", pair))
    state = np.ascontiguousarray(modes.found.states[:, chosen])
    return replace(start, state=state, how=f"{start.how}; {how}", diagnostics=notes, row=row)


def _next_clear(session: Session) -> int:
    """The first row whose inputs are clear of a fold at the first row's, or the farthest one; 0
    where none differs."""
    values = session.inputs.values
    distance = np.abs(values - values[:, :1]).max(axis=0, initial=0.0)
    clear = np.flatnonzero(distance >= tolerances.BEFORE_DEAD_CENTRE[1])
    return int(clear[0]) if clear.size else int(np.argmax(distance))


def condition_at(session: Session, inputs: Floats, state: Floats) -> float | None:
    """The condition of an assembly; None where it is none."""
    batch = session.run(RowInputs(inputs[:, None], state[:, None]), Ask(Demand.CONDITION))
    return float(batch.condition[0]) if batch.good[0] and batch.condition is not None else None


def _followed_back(session: Session, state: Floats, row: int) -> Floats | None:
    """The first row's state on the branch of an assembly at another, or its end at a dead centre,
    which rounding may put before that row; None where it ends elsewhere."""
    back = session.follow_rows(state, row, -1)
    if back.end == TrackEnd.FINISHED:
        return back.guess[:, -1]
    ending = back.ending
    return ending.state if ending and ending.is_dead_centre else None


def _nearest_of(session: Session, states: list[Floats | None]) -> int | None:
    """Which of several assemblies at the first row `near` clearly means; None where it names none,
    or they are too near to each other for that."""
    if len(states) < 2 or not session.problem.assembly.near:
        return None
    together = np.stack([state for state in states if state is not None], axis=1)
    inputs = session.inputs.reduced[:, 0]
    closed = session.close(np.repeat(inputs[:, None], together.shape[1], axis=1), together)
    if not closed.good.all():
        return None
    distances, home = distances_of(session, inputs, closed.states)
    first, second = in_order(distances, home)[:2]
    return None if is_unclear(distances[first], distances[second]) else first


NEAR = "near"
"""In place of the letter of an assembly that was found without all others."""

HOME = "home"
"""In place of the letter of an assembled drawing."""

MAY_BE_RIGID = "an overconstrained loop moves only if its dimensions are exact (write expressions)"


@remembered
def choose_start(session: Session) -> AssemblyStart:
    """The assembly that the file means, or the one that is continued."""
    continued = continued_start(session)
    if continued is not None:
        return _continued(continued)
    start = _choose_start(session)
    by_mode = start.mode not in (NEAR, HOME) and session.problem.assembly.mode is not None
    return start if by_mode else judged_off_fold(session, start)


@remembered
def continued_start(session: Session) -> Continued | None:
    """The first assembly of a session that continues another's; None where it is to be chosen:
    nothing is continued, the base has no first assembly, or another structure."""
    first = session.first
    return _brought(session, first) if isinstance(first, ContinuedFrom) else first


def _brought(session: Session, line: ContinuedFrom) -> Continued | None:
    """The first assembly of the base brought to a session with a plan of its own, along the
    straight line in the parameters: the sessions between are built one by one, and the steps are
    those of every continuation (docs/numerics.md, Variants)."""
    base = line.base
    start = choose_start(base)
    if start.state is None or structure_of(session.graph) != structure_of(base.graph):
        return None
    rows = session.problem.motion.rows
    row = start.row if rows == base.problem.motion.rows else 0
    first, last = base.inputs.values[:, start.row], session.inputs.values[:, row]
    return Continued(_end_of_line(session, line, start.state, first, last), row)


def _end_of_line(
    session: Session, line: ContinuedFrom, state: Floats, first: Floats, last: Floats
) -> Floats | None:
    """States at the end of the line from inputs to inputs; None where the branch ends before."""
    plans = {0.0: line.base.plan, 1.0: session.plan}
    structure, unit = structure_of(session.graph), session.layout.length

    def plan(place: float) -> Plan:
        if place not in plans:
            between = line.between(place)
            if structure_of(between.graph) != structure:
                raise MechkinError("another structure on the way")
            problem = between.problem
            laid = Layout(problem.laid_mechanism, between.graph, unit, problem.laws)
            plans[place] = build_plan(laid)
        return plans[place]

    def at(place: float) -> tuple[Sequence[float], Sequence[float], Sequence[float]]:
        still = [0.0] * first.size
        return (first + place * (last - first)).tolist(), still, still

    limits = step_limits(tolerances.LONGEST_DIMENSION_STEP)
    try:
        node = Stepper.along(plan, at, True, limits).to_target(state.tolist())
    except MechkinError:
        return None  # what the file says does not hold somewhere on the way
    return None if node is None else np.array(node.state)


def _continued(continued: Continued) -> AssemblyStart:
    """From the variant of the file's own parameters."""
    if continued.state is not None:
        return AssemblyStart(
            continued.state, NEAR, "continued in the parameters", row=continued.row
        )
    diagnostic = Diagnostic(
        "variant-lost",
        "error",
        "the assembly of the file's own parameters ends before it comes to these",
        hint="take parameters nearer to the file's, or choose the assembly in the file itself",
    )
    return AssemblyStart(None, NEAR, "", [diagnostic], Status.branch_lost, continued.row)


def _choose_start(session: Session) -> AssemblyStart:
    # an assembly is the same whole turns of an input away
    path, wanted = session.inputs.reduced, session.problem.assembly
    if not wanted.near and wanted.mode is None and is_home_assembled(session):
        return _from_home(session)
    if wanted.near and wanted.mode is None:
        start = _from_near(session, path[:, 0])
        if start is not None:
            return _noted_if_far(session, path[:, 0], start)
    modes = name_modes(session, path[:, 0], thorough=wanted.mode is not None)
    if modes.number == 0:
        return AssemblyStart(None, "", "", [nothing_found(session, modes.found)])
    if wanted.mode is not None:
        return _by_name(modes, wanted.mode)
    home = distances_home(session, modes.points)
    if not wanted.near:
        return _nearest(modes, home, home, "nearest to home")
    start = _nearest(modes, distances_near(session.problem, modes.coordinates), home, "near")
    return _noted_if_far(session, path[:, 0], start)


def mode_letter(session: Session, start: AssemblyStart, *, thorough: bool = True) -> str:
    """The letter of an assembly at the first row, by a search if it is not known yet; `near` or
    `home` where it is on no letter's branch, or where only a `thorough` search finds all modes."""
    if start.mode not in (NEAR, HOME) or start.state is None:
        return start.mode
    first = session.inputs.reduced[:, 0]
    state = state_at_first_row(session, start)
    if state is None or not (thorough or is_in_reach(session.layout, state)):
        return start.mode
    modes = name_modes(session, first, thorough=thorough)
    if not modes.letters:
        return start.mode
    number = pose_number(session.layout, modes.found.states, state)
    return start.mode if number is None else modes.letters[number]


def state_at_first_row(session: Session, start: AssemblyStart) -> Floats | None:
    """States of the first assembly's branch at the first row; an assembled drawing may be followed
    from another."""
    if start.state is None or start.row == 0:
        return start.state
    values = session.inputs.values
    path = np.stack([values[:, start.row], values[:, 0]], axis=1)
    followed = session.follow(path, start.state)
    return followed.state if followed.end == TrackEnd.FINISHED else None


def _from_near(session: Session, inputs: Floats) -> AssemblyStart | None:
    """By Newton's method: at once if what it finds is proven to be the nearest, else after a search
    about what is named; None where it finds none that narrows the search."""
    named = named_by(session)
    newton = newton_from(session, inputs, named) if named[1] else None
    if newton is None:
        return None
    state, unique, condition = newton
    distance = distances_of(session, inputs, state[:, None])[0][0]
    if (1.0 + tolerances.NEAR_RUNNER_UP) * distance < unique:
        how = (
            f"{distance:.2g} rad or sizes off what near names, found by Newton's method; no other "
            f"within {unique:.2g}"
        )
        return AssemblyStart(state, NEAR, how, off=distance, condition=condition)
    # coordinates that are exact are so but for rounding
    radius = tolerances.NEAR_RUNNER_UP * max(distance, tolerances.SAME_MODE)
    if radius > tolerances.NEAR_BALL:
        return None
    inside = all_assemblies(session, inputs, box_about(session, named, radius), thorough=False)
    return _nearest_about(session, inputs, state, inside, radius)


def _noted_if_far(session: Session, inputs: Floats, start: AssemblyStart) -> AssemblyStart:
    if start.state is None or start.off <= tolerances.NEAR_FAR:
        # no coordinate is off by more than all together
        return start
    notes = far_notes(session, inputs, start.state)
    return replace(start, diagnostics=[*start.diagnostics, *notes])


def _nearest_about(
    session: Session, inputs: Floats, newton: Floats, found: Assemblies, radius: float
) -> AssemblyStart | None:
    """The nearest of all assemblies about as near as the one that Newton's method found."""
    found = with_assemblies(session.layout, session.plan, inputs, found, newton[:, None])
    distances, home = distances_of(session, inputs, found.states)
    order = [i for i in in_order(distances, home) if distances[i] <= radius]
    if not order:
        return None
    best = distances[order[0]]
    how = (
        f"{best:.2g} rad or sizes off what near names, nearest of {len(order)} that "
        f"{found.starts} starts found within {radius:.2g}"
    )
    notes = []
    if len(order) > 1 and is_unclear(best, distances[order[1]]):
        notes.append(unclear("two assemblies", (best, distances[order[1]])))
    condition = float(found.condition[order[0]])
    return AssemblyStart(found.states[:, order[0]], NEAR, how, notes, off=best, condition=condition)


def _from_home(session: Session) -> AssemblyStart:
    """Followed from the drawing to the row whose inputs are nearest to it, or on its other side."""
    first = None
    for row, followed, turned in rows_from_home(session):
        if followed.end == TrackEnd.FINISHED:
            how = "followed from the home drawing" + (", whole turns away" if turned else "")
            return AssemblyStart(followed.state, HOME, how, row=row)
        first = first or followed
    assert first is not None
    return _ends_before_rows(session, first)


def _ends_before_rows(session: Session, followed: Followed) -> AssemblyStart:
    """Why no row has the assembly of the drawing: how the path to the nearest one ended."""
    places = input_numbers(session.problem, session.layout, followed.inputs)
    rigid = f"; {MAY_BE_RIGID}" if session.is_redundant else ""
    diagnostic = Diagnostic(
        "home-branch-ends",
        "error",
        "the assembly drawn at home ends before it comes to a row",
        measured=f"followed up to {', '.join(map(input_text, places))}",
        hint=f"choose another assembly with assembly: {{near: ...}}{rigid}",
        numbers=places,
    )
    ending = followed.ending
    folds = ending is not None and ending.is_dead_centre
    status = Status.beyond_dead_centre if folds else Status.branch_lost
    stuck = float(np.max(np.abs(followed.inputs), initial=0.0)) <= tolerances.PASSED
    return AssemblyStart(None, HOME, "", [diagnostic], status, stuck=stuck)


def _by_name(modes: NamedModes, name: str) -> AssemblyStart:
    for i, letter in modes.letters.items():
        if letter == name:
            return AssemblyStart(modes.found.states[:, i], name, "by name")
    diagnostic = Diagnostic(
        "no-such-mode",
        "error",
        f"there is no mode {name[:LONGEST_NAME]} at the first row",
        measured=f"modes {', '.join(modes.letters.values())}",
        hint="take one of these",
    )
    return AssemblyStart(None, name, "", [diagnostic])


def _nearest(
    modes: NamedModes, distances: list[float], home: list[float], how: str
) -> AssemblyStart:
    order = in_order(distances, home)
    best, second = order[0], order[1] if len(order) > 1 else None
    notes = []
    if second is not None and is_unclear(distances[best], distances[second]):
        both = "two assemblies"
        if modes.letters:
            both = f"modes {modes.letters[best]} and {modes.letters[second]}"
        notes.append(unclear(both, (distances[best], distances[second])))
    how = f"{how}, 1 of {modes.number} found"
    state, condition = modes.found.states[:, best], float(modes.found.condition[best])
    return AssemblyStart(state, modes.letters.get(best, NEAR), how, notes, condition=condition)
