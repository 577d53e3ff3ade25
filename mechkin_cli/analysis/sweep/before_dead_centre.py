"""Places before a row at a dead centre, on its branch: what grows without bound shows there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.assembly.off_fold import Before, left_for
from mechkin_cli.status import Status
from mechkin_cli.tolerances import BEFORE_DEAD_CENTRE, ON_FOLD

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.rows import Rows
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


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
    # a variant's branch is the base's, which `near` names where the base stands
    if not session.problem.assembly.near or session.continued is not None:
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
