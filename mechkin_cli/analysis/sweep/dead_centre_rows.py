"""Rows that stand at a dead centre: there a coordinate goes as the root of what is left of the
input, so that its rates, and what a load costs the input, grow without bound.

Doubles give the position there to half its digits, and of the rates none. So these are not read off
the row: two places a little before it on its branch tell what grows towards it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.analysis.assembly.off_fold import Before
from mechkin_cli.analysis.sweep.before_dead_centre import places_before
from mechkin_cli.analysis.sweep.lost_rates import lost_rates
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.demand import demand_of
from mechkin_cli.status import Status
from mechkin_cli.tolerances import (
    CONDITION_RATES_UNCLEAR,
    GROWS_WITHOUT_BOUND,
    REACTION_ROUNDING,
    RESTS,
)

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.places import Places
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.mechanism.quantities import Wanted
    from mechkin_cli.solver.batch import Batch
    from mechkin_cli.solver.demand import Slot
    from mechkin_cli.solver.session import Session


def judge_dead_centres(session: Session, rows: Rows, condition: Floats) -> None:
    """Finds the rows that stand at a dead centre as nearly as a double can say, among those whose
    condition (rows,) leaves it open, and says so."""
    judged = np.isin(rows.status, (Status.ok, Status.near_singular, Status.rank_unclear))
    near = rows.reached & judged & ~(condition <= CONDITION_RATES_UNCLEAR)
    if not near.any() or not session.driven:
        return
    for row in np.flatnonzero(near & _is_lost(session, rows, near)).tolist():
        found = [way for way in places_before(session, rows, row) if _grows(session, way)]
        if found:
            rows.dead_centres += found
            rows.status[row] = Status.dead_centre
    if rows.dead_centres:
        rows.diagnostics.append(_note(rows))


def _is_lost(session: Session, rows: Rows, near: Bools) -> Bools:
    """Rows (rows,) whose rates say nothing."""
    lost: Bools = np.asarray(rows.status == Status.rank_unclear)
    numbers = np.flatnonzero(near & ~lost)
    if numbers.size:
        states = np.ascontiguousarray(rows.states[:, numbers])
        lost[numbers] = lost_rates(session, numbers, states).any(axis=0)
    return lost


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
    put: set[int] = set()
    for before in rows.dead_centres if alike else ():
        there = places.at([before.row] * 2)._replace(inputs=before.inputs, guess=before.states)
        outputs = session.run(**there.arguments, **asked, iterations=0).outputs
        assert outputs is not None
        rests = _comes_to_rest(places.rates, before.row)
        for lost in alike:
            far, close = outputs[lost].T
            grows = np.abs(close) >= GROWS_WITHOUT_BOUND * np.abs(far)
            # what is zero but for rounding does not grow with the others; where friction jams,
            # forces have no value even before the dead centre
            level = np.abs(close).max(where=np.isfinite(close), initial=0.0)
            grows &= np.abs(close) > REACTION_ROUNDING * level
            grows &= not rests
            told = np.where(grows, np.copysign(np.inf, close), np.nan)
            if before.row in put:
                # of two branches that meet in the row
                told[told != batch.outputs[lost, before.row]] = np.nan
            batch.outputs[lost, before.row] = told
        put.add(before.row)


def _comes_to_rest(rates: Floats | None, row: int) -> bool:
    """Whether the inputs (inputs, rows) rest in a row of a motion: the limits are then those of its
    law, along which rates go to zero with the distance."""
    if rates is None or not rates.any():
        return False
    largest = np.abs(rates).max(axis=1)
    return bool((np.abs(rates[:, row]) <= RESTS * largest).all())


def _slots(slots: Mapping[str, Slot], quantities: Sequence[Wanted]) -> list[int]:
    """The output rows of some quantities."""
    return [slots[q.name].first + part for q in quantities for part in range(slots[q.name].width)]


def _note(rows: Rows) -> Diagnostic:
    ways = [before.row + 1 for before in rows.dead_centres]
    numbers = list(dict.fromkeys(ways))
    where = f"row {numbers[0]} stands" if len(numbers) == 1 else f"{len(numbers)} rows stand"
    first = "" if len(numbers) == 1 else f", the first is row {numbers[0]}"
    lone = [number for number in numbers if ways.count(number) > 1]
    both = ""
    if lone:
        both = (
            f"; nothing tells on which of two branches row {lone[0]} is, so what is infinite with "
            "another sign on each is empty, too"
        )
    return Diagnostic(
        "at-dead-centre",
        "warning",
        f"{where} at a dead centre of the inputs{first}: cells that grow without bound towards it "
        f"say inf, and others that depend on rates or reactions are empty{both}",
        hint="end the sweep before it, or drive another coordinate",
    )
