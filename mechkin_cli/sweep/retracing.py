"""Inputs that come to a dead centre, or to a branch point, and turn back: behind it the branch is
retraced.

There a row has no branch of its own, and next to it rounding decides: so the rows beside it are
each followed from a place clear of it, on the way that led there, and so is the first row behind
that is clear of it again. Rows that go beyond it end the branch.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.plan import Demand, PassageEnd
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import Ask, RowInputs
from mechkin_cli.sweep.rows import sections
from mechkin_cli.verdict import Status, rates_are_clear

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.session import Followed, Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep.rows import SweepRows

SAMPLES = 65
"""Places between the ends of a piece of the inputs' course at which its farthest is looked for,
and again about the farthest of them."""


class SingularPlace(NamedTuple):
    """A dead centre or a branch point at which the inputs turn back.

    Attributes:
        kind: which of them.
        inputs: (inputs,) in kernel units.
        state: (states,) there, where they are known.
        row: the row there, or the last one before it.
        is_row: whether the row itself stands there.
    """

    kind: PassageEnd
    inputs: Floats
    state: Floats | None = None
    row: int = 0
    is_row: bool = False

    def is_at(self, inputs: Floats) -> bool:
        """Whether some inputs (inputs,) are those of the place."""
        off = float(np.abs(inputs - self.inputs).max(initial=0.0))
        return off <= tolerances.BEFORE_DEAD_CENTRE[1]

    @property
    def is_dead_centre(self) -> bool:
        """Whether it is a dead centre."""
        return self.kind == PassageEnd.DEAD_CENTRE


class BranchPlace(NamedTuple):
    """A place on the branch: inputs, states, turns and the correction that is left."""

    inputs: Floats
    state: Floats
    turn: Floats
    limit: float = 0.0


def retraced(
    session: Session, rows: SweepRows, followed: Followed, first: int, *, every_row: bool
) -> tuple[SingularPlace, Followed | None, int] | None:
    """Goes on behind a place at which the inputs turn back, where the way ended at one.

    Args:
        session: the mechanism as it is driven.
        rows: in the order in which they are followed; those beside the place and behind it are put
            into them.
        followed: the way that ended, from the row `first` of these on.
        every_row: follow each row as a careful step.

    Returns:
        The place; the way behind it and its first row, None where no row is clear of the place.
        None where the inputs do not turn back at a place that is one.
    """
    values = np.ascontiguousarray(session.inputs.values[:, rows.numbers])
    last = first + followed.reached - 1
    earlier = np.flatnonzero(rows.reached[: last + 1])
    ending = followed.ending
    about = np.asarray(followed.inputs if ending is None else ending.inputs)
    base = _last_clear(values, earlier, about)
    if base is None:
        return None
    beside = earlier[earlier > base]
    if ending is None and beside.size:
        places = np.concatenate([values[:, beside], about[:, None]], axis=1)
        about = places[:, np.argmax(_distance(places, values[:, base]))]
    start = BranchPlace(values[:, base], closed(session, rows, base), rows.turns[:, base])
    place = _singular_place(session, start, about)
    if place is None or not (place.is_dead_centre or session.problem.assembly.straight):
        return None
    away = _distance(values, place.inputs)
    far, near = tolerances.BEFORE_DEAD_CENTRE
    clear = last + 1 + np.flatnonzero(away[last + 1 :] > near)
    behind = int(clear[0]) if clear.size else away.size
    if session.route is not None and behind < away.size:
        numbers = int(rows.numbers[last]), int(rows.numbers[behind])
        if not _stays(session, numbers, start.inputs, place.inputs):
            return None
    off = straight_to(session, start, _towards(place.inputs, start.inputs, far))
    if off is None:
        return None
    on = None
    if behind < away.size:
        turned = straight_to(session, off, _towards(place.inputs, values[:, behind], far))
        on = None if turned is None else straight_to(session, turned, values[:, behind])
        if on is None:
            return None
    # where branches cross following has told the rows up to the place
    unplaced = range((base if place.is_dead_centre else last) + 1, behind)
    if not _put_beside(session, rows, values, unplaced, off, place):
        return None
    close = np.arange(base + 1, behind)
    row = int(close[np.argmin(away[close])]) if close.size else last
    touched = place._replace(
        row=int(rows.numbers[row]), is_row=bool(close.size and away[row] <= near)
    )
    if on is None:
        return touched, None, behind
    step, end = int(rows.numbers[1] - rows.numbers[0]), int(rows.numbers[-1])
    again = session.follow_rows(
        on.state, int(rows.numbers[behind]), step, every_row=every_row, turn=on.turn, last=end
    )
    part = rows.part(slice(behind, None))
    part.take(again, 0)
    part.section[:] = rows.section[base] + step * sections(again, part.section.size)
    rows.nodes += again.steps
    return touched, again, behind


def unclear_rows(session: Session, rows: SweepRows, numbers: NDArray[np.intp]) -> list[int]:
    """Those of some rows that were followed, by their numbers, whose rates are unclear: where the
    inputs turn back there, following may have gone on on either branch."""
    if not numbers.size:
        return []
    inputs = np.ascontiguousarray(session.inputs.reduced[:, rows.numbers[numbers]])
    states = np.ascontiguousarray(rows.states[:, numbers])
    batch = session.run(RowInputs(inputs, states), Ask(Demand.CONDITION))
    if batch.condition is None:
        return []
    unclear: list[int] = numbers[~rates_are_clear(batch.condition)].tolist()
    return unclear


def _distance(values: Floats, inputs: Floats) -> Floats:
    """Of places (inputs, places) from one, by the input that is farthest off."""
    away: Floats = np.abs(values - inputs[:, None]).max(axis=0, initial=0.0)
    return away


def _last_clear(values: Floats, earlier: NDArray[np.intp], about: Floats) -> int | None:
    """The last of some rows that is clear of a place, or the farthest from it."""
    away = _distance(values[:, earlier], about)
    clear = earlier[away > tolerances.BEFORE_DEAD_CENTRE[1]]
    if clear.size:
        return int(clear[-1])
    return int(earlier[np.argmax(away)]) if (away > 0.0).any() else None


def _towards(inputs: Floats, other: Floats, far: float) -> Floats:
    """The place at most that far off, on the way to another one."""
    away = other - inputs
    return inputs + min(1.0, far / float(np.abs(away).max())) * away


def closed(session: Session, rows: SweepRows, row: int) -> Floats:
    """The states (states,) of one of the rows, closed; its guess where that does not close."""
    inputs = np.ascontiguousarray(session.inputs.reduced[:, [rows.numbers[row]]])
    guess = np.ascontiguousarray(rows.states[:, row, None])
    batch = session.close(inputs, guess)
    return np.ascontiguousarray((batch.states if batch.good[0] else guess)[:, 0])


def straight_to(session: Session, start: BranchPlace, inputs: Floats) -> BranchPlace | None:
    """From a place straight to some inputs; None where the branch does not lead there."""
    if not (inputs != start.inputs).any():
        return start
    path = np.stack([start.inputs, inputs], axis=1)
    found = session.follow(path, start.state, every_row=True, turns=True, turn=start.turn)
    if found.reached < 2:
        return None
    batch = session.close(path[:, 1:], np.ascontiguousarray(found.guess[:, 1:]))
    state = (batch.states if batch.good[0] else found.guess[:, 1:])[:, 0]
    assert found.turns is not None
    turn = np.ascontiguousarray(found.turns[:, 1])
    return BranchPlace(inputs, np.ascontiguousarray(state), turn, float(found.limit[1]))


def _singular_place(session: Session, start: BranchPlace, about: Floats) -> SingularPlace | None:
    """The dead centre or branch point at which the way from a place to some inputs and a little
    farther on ends, or which it passes, if it lies there."""
    far, near = tolerances.BEFORE_DEAD_CENTRE
    came = about - start.inputs
    size = float(np.abs(came).max(initial=0.0))
    if size == 0.0:
        return None
    beyond = np.stack([start.inputs, about + (far / size) * came], axis=1)
    found = session.follow(beyond, start.state, every_row=True)
    places = [SingularPlace(PassageEnd.BRANCH_POINT, inputs) for _, inputs in found.crossings]
    if found.ending is not None:
        places.append(SingularPlace(found.ending.kind, found.ending.inputs, found.ending.state))
    named = (PassageEnd.DEAD_CENTRE, PassageEnd.BRANCH_POINT)
    for place in places:
        if place.kind in named and float(np.abs(place.inputs - about).max()) <= near:
            return place
    return None


def _put_beside(
    session: Session,
    rows: SweepRows,
    values: Floats,
    beside: range,
    off: BranchPlace,
    place: SingularPlace,
) -> bool:
    """Puts the rows beside a singular place into the rows, each followed from a place `off` it; at
    a dead centre itself its own states serve. False, and nothing is put, where one lies beyond."""
    rounding = tolerances.TURNED_BACK * max(1.0, float(np.abs(place.inputs).max(initial=0.0)))
    at_once = rows.reached | (_distance(values, place.inputs) <= rounding)
    section = int(rows.section[max(beside.start - 1, 0)])
    known: dict[bytes, BranchPlace | None] = {}
    for row in beside:
        inputs = np.ascontiguousarray(values[:, row])
        key = inputs.tobytes()
        if key not in known:
            found = straight_to(session, off, inputs)
            if found is None and not at_once[row]:
                return False
            known[key] = found or _at(session, inputs, off, place)
    for row in beside:
        found = known[np.ascontiguousarray(values[:, row]).tobytes()]
        rows.section[row] = section
        if found is None:
            if not rows.reached[row]:
                rows.status[row] = Status.beyond_dead_centre
            continue
        rows.reached[row] = True
        rows.states[:, row], rows.turns[:, row] = found.state, found.turn
        rows.limit[row] = max(found.limit, tolerances.BESIDE_CORRECTION)
    return True


def _at(
    session: Session, inputs: Floats, off: BranchPlace, place: SingularPlace
) -> BranchPlace | None:
    """A place at a dead centre but for rounding; None where it does not close there."""
    if place.state is None:
        return None
    ask = Ask(iterations=tolerances.FOLD_ITERATIONS)
    batch = session.run(RowInputs(inputs[:, None], place.state[:, None]), ask)
    if not batch.good[0]:
        return None
    path = np.stack([off.inputs, inputs], axis=1)
    came = session.follow(path, off.state, every_row=True, turns=True, turn=off.turn)
    turn = off.turn if came.turn is None else np.asarray(came.turn)
    return BranchPlace(inputs, np.ascontiguousarray(batch.states[:, 0]), turn)


def _stays(session: Session, numbers: tuple[int, int], start: Floats, place: Floats) -> bool:
    """Whether the inputs' course between two rows stays on the line from `start` to a place, and
    goes beyond that by no more than rounding."""
    assert session.route is not None
    first, last = numbers
    way = session.route.way(first, 1 if last > first else -1)
    along = (place - start) / float(np.abs(place - start).max())
    number = int(np.argmax(np.abs(along)))
    rounding = tolerances.TURNED_BACK * max(1.0, float(np.abs(place).max()))
    end = int(np.flatnonzero(way.rows == last)[0])
    for here in range(end):
        cell = int(way.cells[here])
        low, high = sorted((float(way.at[here]), float(way.at[here + 1])))
        for _ in range(8 if cell >= 0 else 1):
            at = low + (high - low) * np.linspace(0.0, 1.0, SAMPLES)
            inputs = np.ascontiguousarray(way.values[:, here : here + 2])
            if cell >= 0:
                count = session.route.units.size
                inputs = np.repeat(inputs[:, :1], SAMPLES, axis=1)
                inputs[:count] = session.route.jets(cell, at)[:, :, 0].T
            beyond = (inputs[number] - place[number]) * along[number]
            aside = np.abs(inputs - place[:, None] - along[:, None] * beyond).max()
            if beyond.max() > rounding or aside > rounding:
                return False
            best = int(np.argmax(beyond))
            low, high = float(at[max(best - 1, 0)]), float(at[min(best + 1, SAMPLES - 1)])
    return True
