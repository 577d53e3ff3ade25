"""Places before a row at a dead centre, on its branch: what grows without bound shows there.

Near the fold a state is x0 + v h for inputs u0 + a h^2/2, v of length one. So derivatives by the
input at a distance h that rounding has left are x' = v/(a h) and x'' = -v/(a^2 h^3), and
a = |x''|/|x'|^3 is known although neither of them is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.solver.codes import Demand
from mechkin_cli.status import Status
from mechkin_cli.tolerances import BEFORE_DEAD_CENTRE, OFF_FOLD, ON_FOLD

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.batch import Batch
    from mechkin_cli.solver.session import Session


class Before(NamedTuple):
    """Two places before a row at a dead centre, the second a hundredth as far from it: inputs
    (inputs, 2) in kernel units and states (states, 2)."""

    row: int
    inputs: Floats
    states: Floats


def places_before(session: Session, rows: Rows, row: int) -> list[Before]:
    """The places before a row: followed from another row that is clear of the fold; where there
    is none, left for along the branches that meet in the row: along that of other rows, or that
    which `near` means, or along both."""
    found = _followed(session, rows, row)
    if found is not None:
        return [found]
    return _chosen(session, rows, row, left_for(session, row, rows.states[:, row]))


def _followed(session: Session, rows: Rows, row: int) -> Before | None:
    """Along the branch of the nearest row that is clear of the fold, towards it or, where that row
    stands nearer, away from it. None where there is no such row, or where the branch does not lead
    there."""
    values = session.inputs.values
    away = values - values[:, [row]]
    distance = np.abs(away).max(axis=0)
    serves = rows.reached & (rows.status == Status.ok) & (rows.section == rows.section[row])
    numbers = np.flatnonzero(serves & (distance > 0.0))
    if not numbers.size:
        return None
    far = distance[numbers] > BEFORE_DEAD_CENTRE[0]
    numbers = numbers[far] if far.any() else numbers
    start = numbers[np.argmin(np.abs(numbers - row))]
    parts = np.array([1.0, *(part / distance[start] for part in BEFORE_DEAD_CENTRE)])
    path = values[:, [row]] + away[:, [start]] * parts
    found = session.follow(path, rows.states[:, start], every_row=True)
    if found.reached < parts.size:
        return None
    places = np.ascontiguousarray(path[:, 1:])
    batch = session.close(places, np.ascontiguousarray(found.guess[:, 1:]))
    return Before(row, places, batch.states) if batch.good.all() else None


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


def _chosen(session: Session, rows: Rows, row: int, ways: list[Before]) -> list[Before]:
    """Those of two branches on which other rows lie, or which `near` means; both where nothing
    tells."""
    if len(ways) < 2:
        return ways
    apart = ways[0].states[:, :1] - ways[1].states[:, :1]
    others = rows.reached & (rows.section == rows.section[row])
    along = _products(apart, rows.states - rows.states[:, [row]])
    seen = np.flatnonzero(others & (np.abs(along) > ON_FOLD * _products(apart, apart)))
    if seen.size:
        nearest = seen[np.argmin(np.abs(seen - row))]
        return [ways[0 if along[nearest] > 0.0 else 1]]
    if not session.problem.assembly.near:
        return ways
    from mechkin_cli.analysis.assembly.distances import distances_of, is_unclear

    states = np.stack([way.states[:, 0] for way in ways], axis=1)
    distances, _ = distances_of(session, ways[0].inputs[:, 0], states)
    return ways if is_unclear(*sorted(distances)) else [ways[int(np.argmin(distances))]]


def _products(way: Floats, states: Floats) -> Floats:
    """Scalar products (places,) with a way (states, 1), added up in the order of the states."""
    total = np.zeros(states.shape[1])
    for along, state in zip(way[:, 0], states, strict=True):
        total = total + along * state
    return total
