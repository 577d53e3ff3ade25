"""Places on the branches that meet in a fold, left for from a state there.

Near the fold a state is x0 + v h for inputs u0 + a h^2/2, v of length one. So derivatives by the
input at a distance h that rounding has left are x' = v/(a h) and x'' = -v/(a^2 h^3), and
a = |x''|/|x'|^3 is known although neither of them is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.solver.codes import Demand
from mechkin_cli.tolerances import BEFORE_DEAD_CENTRE, OFF_FOLD

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.batch import Batch
    from mechkin_cli.solver.session import Session


class Before(NamedTuple):
    """Two places before a row at a dead centre, the second a hundredth as far from it: inputs
    (inputs, 2) in kernel units and states (states, 2)."""

    row: int
    inputs: Floats
    states: Floats


def at_unit_rate(session: Session, values: Floats, states: Floats, number: int) -> Batch:
    """The run with one input at unit rate, whose `first` and `second` (states, places) are the
    derivatives of the states by that input.

    Args:
        session: the mechanism as it is driven.
        values: (inputs, places) in kernel units, angles within a turn.
        states: (states, places) closed there.
        number: of the input.
    """
    return session.run(
        values,
        states,
        demand=Demand.VELOCITY | Demand.ACCELERATION,
        rates=unit_rates(values, number),
        accelerations=np.zeros_like(values),
        derivatives=True,
        iterations=0,
    )


def unit_rates(values: Floats, number: int) -> Floats:
    """Rates (inputs, places): 1 of one input, 0 of all others."""
    rates = np.zeros_like(values)
    rates[number] = 1.0
    return rates


def left_for(session: Session, row: int, state: Floats) -> list[Before]:
    """Places on the two branches that meet in a row at a state (states,), both on the side of the
    fold where they are; none where this is no fold."""
    state = np.ascontiguousarray(state[:, None])
    reduced = np.ascontiguousarray(session.inputs.reduced[:, [row]])
    inputs = range(reduced.shape[0])
    found = [at_unit_rate(session, reduced, state, number) for number in inputs]
    sizes = [float(np.abs(batch.first).max()) for batch in found if batch.first is not None]
    number = int(np.argmax(np.nan_to_num(sizes, nan=-1.0)))
    first, second = found[number].first, found[number].second
    assert first is not None
    assert second is not None
    with np.errstate(all="ignore"):
        way = first / sizes[number]
        size = sizes[number]
        bend = float(np.abs(second).max()) / (size * size * size)
    if not (np.isfinite(way).all() and 0.0 < bend < np.inf):
        return []
    before = np.array(BEFORE_DEAD_CENTRE)
    heights = np.sqrt(2.0 * before / bend)
    places = []
    for side in (1.0, -1.0):
        values = np.repeat(session.inputs.values[:, [row]], 2, axis=1)
        values[number] += side * before
        both = [Before(row, values, state + sign * way * heights) for sign in (1.0, -1.0)]
        places.append([closed for one in both if (closed := _closed(session, one, heights))])
    there = [side for side in places if side]
    return there[0] if len(there) == 1 and len(there[0]) == 2 else []


def _closed(session: Session, guessed: Before, heights: Floats) -> Before | None:
    """The places closed near their guesses."""
    batch = session.close(guessed.inputs, np.ascontiguousarray(guessed.states))
    off = np.abs(batch.states - guessed.states).max(axis=0)
    near = batch.good & (off <= OFF_FOLD * heights)
    return guessed._replace(states=batch.states) if near.all() else None
