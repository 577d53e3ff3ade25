"""Rows that stand at a dead centre: there a coordinate goes as the root of what is left of the
input, so that its rates, and what a load costs the input, grow without bound.

Doubles give the position there to half its digits, and of the rates none. So these are not read off
the row: two places a little before it on its branch tell what grows towards it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.status import Status
from mechkin_cli.tolerances import (
    BEFORE_DEAD_CENTRE,
    DEAD_CENTRE_LOST,
    GROWS_WITHOUT_BOUND,
    REACTION_ROUNDING,
)

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.places import Places
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.batch import Batch
    from mechkin_cli.solver.demand import Slot
    from mechkin_cli.solver.session import Session


class Before(NamedTuple):
    """Two places before a row at a dead centre, the second a hundredth as far from it: inputs
    (inputs, 2) in kernel units and states (states, 2)."""

    row: int
    inputs: Floats
    states: Floats


def judge_dead_centres(session: Session, rows: Rows) -> None:
    """Finds the rows that stand at a dead centre as nearly as a double can say, among those near a
    singular position, and says so."""
    near = rows.reached & np.isin(rows.status, (Status.near_singular, Status.rank_unclear))
    if not near.any() or not session.driven:
        return
    for row in np.flatnonzero(near & _is_lost(session, rows, near)).tolist():
        found = _before(session, rows, row)
        if found is not None and _grows(session, found):
            rows.dead_centres.append(found)
            rows.status[row] = Status.dead_centre
    if rows.dead_centres:
        rows.diagnostics.append(_note(rows))


def _is_lost(session: Session, rows: Rows, near: Bools) -> Bools:
    """Rows (rows,) whose rates say nothing."""
    lost: Bools = np.asarray(rows.status == Status.rank_unclear)
    numbers = np.flatnonzero(near & ~lost)
    if numbers.size:
        values = np.ascontiguousarray(session.inputs.reduced[:, numbers])
        states = np.ascontiguousarray(rows.states[:, numbers])
        lost[numbers] = lost_rates(session, values, states).any(axis=0)
    return lost


def lost_rates(session: Session, values: Floats, states: Floats) -> Bools:
    """Where the rounding of an input changes the rates at its unit rate by more than a part of
    themselves: |x''| times that rounding against |x'|.

    Args:
        session: the mechanism as it is driven.
        values: (inputs, places) in kernel units, angles within a turn.
        states: (states, places) closed there.

    Returns:
        (inputs, places), by each input in turn.
    """
    lost = np.zeros(values.shape, dtype=bool)
    still = np.zeros_like(values)
    for number in range(values.shape[0]):
        rates = still.copy()
        rates[number] = 1.0
        batch = session.run(
            values,
            states,
            demand=Demand.VELOCITY | Demand.ACCELERATION,
            rates=rates,
            accelerations=still,
            derivatives=True,
            iterations=0,
        )
        assert batch.first is not None
        assert batch.second is not None
        first, second = (np.abs(part).max(axis=0) for part in (batch.first, batch.second))
        rounding = np.spacing(np.maximum(1.0, np.abs(values[number])))
        lost[number] = ~(second * rounding < DEAD_CENTRE_LOST * first)
    return lost


def _before(session: Session, rows: Rows, row: int) -> Before | None:
    """The two places, followed from the nearest row that is far enough away; None where there is
    none, or where the branch does not lead here."""
    values = session.inputs.values
    away = values - values[:, [row]]
    distance = np.abs(away).max(axis=0)
    serves = rows.reached & (rows.status == Status.ok) & (rows.section == rows.section[row])
    numbers = np.flatnonzero(serves & (distance > BEFORE_DEAD_CENTRE[0]))
    if not numbers.size:
        return None
    start = numbers[np.argmin(np.abs(numbers - row))]
    parts = np.array([1.0, *(part / distance[start] for part in BEFORE_DEAD_CENTRE)])
    path = values[:, [row]] + away[:, [start]] * parts
    found = session.follow(path, rows.states[:, start], every_row=True)
    if found.reached < parts.size:
        return None
    places = np.ascontiguousarray(path[:, 1:])
    batch = session.close(places, np.ascontiguousarray(found.guess[:, 1:]))
    return Before(row, places, batch.states) if batch.good.all() else None


def _grows(session: Session, before: Before) -> bool:
    """Whether rates along the way to a dead centre grow without bound."""
    way = before.inputs[:, 1] - before.inputs[:, 0]
    batch = session.run(
        before.inputs,
        before.states,
        demand=Demand.VELOCITY,
        rates=np.repeat((way / np.abs(way).max())[:, None], 2, axis=1),
        derivatives=True,
        iterations=0,
    )
    assert batch.first is not None
    far, close = np.abs(batch.first).max(axis=0)
    return bool(close >= GROWS_WITHOUT_BOUND * far > 0.0)


def put_unbounded(
    session: Session,
    rows: Rows,
    wanted: Sequence[Wanted],
    batch: Batch,
    places: Places,
    asked: Mapping[str, Any],
) -> None:
    """Puts the infinite with its sign into a run's outputs, in place, where a quantity grows
    without bound towards a row at a dead centre; others that take rates or reactions have no value.

    Args:
        session: the one that ran.
        rows: the run's.
        wanted: what it read.
        batch: what it found.
        places: of its rows.
        asked: what else it was told.
    """
    assert batch.outputs is not None
    slots = session.readout(wanted).slots
    read = [quantity for quantity in wanted if demand_of(session.problem.mechanism, [quantity])]
    forces = [q for q in read if demand_of(session.problem.mechanism, [q]) & Demand.FORCES]
    rates = [q for q in read if q not in forces]
    alike = [_slots(slots, some) for some in (rates, forces) if some]
    for before in rows.dead_centres if alike else ():
        there = places.at([before.row] * 2)._replace(inputs=before.inputs, guess=before.states)
        outputs = session.run(**there.arguments, **asked, iterations=0).outputs
        assert outputs is not None
        for lost in alike:
            far, close = outputs[lost].T
            grows = np.abs(close) >= GROWS_WITHOUT_BOUND * np.abs(far)
            # what is zero but for rounding does not grow with the others; where friction jams,
            # forces have no value even before the dead centre
            level = np.abs(close).max(where=np.isfinite(close), initial=0.0)
            grows &= np.abs(close) > REACTION_ROUNDING * level
            batch.outputs[lost, before.row] = np.where(grows, np.copysign(np.inf, close), np.nan)


def _slots(slots: Mapping[str, Slot], quantities: Sequence[Wanted]) -> list[int]:
    """The output rows of some quantities."""
    return [slots[q.name].first + part for q in quantities for part in range(slots[q.name].width)]


def _note(rows: Rows) -> Diagnostic:
    numbers = [before.row + 1 for before in rows.dead_centres]
    where = f"row {numbers[0]} stands" if len(numbers) == 1 else f"{len(numbers)} rows stand"
    first = "" if len(numbers) == 1 else f", the first is row {numbers[0]}"
    return Diagnostic(
        "at-dead-centre",
        "warning",
        f"{where} at a dead centre of the inputs{first}: cells that grow without bound towards it "
        "say inf, and others that depend on rates or reactions are empty",
        hint="end the sweep before it, or drive another coordinate",
    )
