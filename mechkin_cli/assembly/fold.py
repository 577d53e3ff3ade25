"""A first row on a fold: places on the two branches that meet there, and which of them is meant.

Near the fold a state is x0 + v h for inputs u0 + a h^2/2, v of length one. So derivatives by the
input at a distance h that rounding has left are x' = v/(a h) and x'' = -v/(a^2 h^3), and
a = |x''|/|x'|^3 is known although neither of them is (`left_for`).

The branch is judged at the next row that is clear of the fold, unless `near` decides at the first
(`judged_off_fold`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly.home import name_modes
from mechkin_cli.assembly.near import (
    NEAR,
    AssemblyStart,
    distances_home,
    distances_near,
    distances_of,
    in_order,
    is_unclear,
    nearer_clearly,
    unclear,
)
from mechkin_cli.plan import Demand, TrackEnd
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.search import pose_number
from mechkin_cli.session import Ask, Batch, RowInputs, Session
from mechkin_cli.tolerances import BEFORE_DEAD_CENTRE, OFF_FOLD

if TYPE_CHECKING:
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
    branch = meant_branch(session, _branches(session, state))
    if branch is None:
        return start
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


def _branches(session: Session, state: Floats) -> list[PlacesBefore]:
    return left_for(session, 0, state) if session.problem.assembly.near else []


def meant_branch(session: Session, branches: list[PlacesBefore]) -> PlacesBefore | None:
    """The one of two branches that meet in a fold that `near` means; None where it is silent."""
    if len(branches) < 2:
        return None
    off_fold = np.stack([branch.states[:, 0] for branch in branches], axis=1)
    nearer = nearer_clearly(session, branches[0].inputs[:, 0], off_fold)
    return None if nearer is None else branches[nearer]


def next_to_fold(session: Session) -> AssemblyStart | None:
    """The assembly at the first row where that is a dead centre which a search cannot tell from
    places on a motion: found a little off it, where it is clear, and followed back."""
    inputs = np.ascontiguousarray(session.inputs.values[:, 0])
    found: list[tuple[float, float, Floats]] = []
    for number in range(inputs.size):
        for way in (1.0, -1.0):
            place = inputs.copy()
            place[number] += way * BEFORE_DEAD_CENTRE[0]
            modes = name_modes(session, place, thorough=False)
            if modes.number == 0:
                continue
            near, home = distances_of(session, place, modes.found.states)
            for i in range(modes.number):
                state = _back_on_fold(session, place, modes.found.states[:, i])
                if state is not None:
                    found.append((near[i], home[i], state))
        if found:
            break
    if not found:
        return None
    best = in_order([one[0] for one in found], [one[1] for one in found])[0]
    how = f"followed from beside a dead centre, 1 of {len(found)} found there"
    return AssemblyStart(found[best][2], NEAR, how, off=found[best][0])


def _back_on_fold(session: Session, place: Floats, state: Floats) -> Floats | None:
    """The first row's state on the branch of an assembly at a place beside it, where it closes."""
    first = np.ascontiguousarray(session.inputs.values[:, :1])
    path = np.concatenate([place[:, None], first], axis=1)
    back = session.follow(path, np.ascontiguousarray(state), every_row=True)
    guess = back.guess[:, -1] if back.end == TrackEnd.FINISHED else None
    if guess is None and back.ending is not None and back.ending.is_dead_centre:
        guess = back.ending.state
    if guess is None:
        return None
    ask = Ask(iterations=tolerances.FOLD_ITERATIONS)
    batch = session.run(RowInputs(first, np.ascontiguousarray(guess[:, None])), ask)
    return np.ascontiguousarray(batch.states[:, 0]) if batch.good[0] else None


def _judged_at(session: Session, start: AssemblyStart, row: int) -> AssemblyStart:
    assert start.state is not None
    branch = meant_branch(session, _branches(session, start.state))
    if branch is not None:
        path = np.stack([branch.inputs[:, 0], session.inputs.values[:, row]], axis=1)
        onward = session.follow(path, branch.states[:, 0])
        if onward.end == TrackEnd.FINISHED:
            how = f"{start.how}; at a fold, where near tells its branches apart"
            return replace(start, state=onward.state, how=how, row=row)
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
