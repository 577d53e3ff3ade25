"""A first row on a fold has two branches; which is meant is judged at the second row, unless `near`
tells them apart at the first."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.distances import (
    distances_home,
    distances_near,
    distances_of,
    in_order,
    is_unclear,
    unclear,
)
from mechkin_cli.analysis.assembly.named_modes import name_modes
from mechkin_cli.solver.clusters import pose_keys, same_poses
from mechkin_cli.solver.codes import Demand
from mechkin_cli.solver.follow import TrackEnd

if TYPE_CHECKING:
    from mechkin_cli.analysis.assembly.start import Start
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


def judged_at_second_row(session: Session, start: Start) -> Start:
    """The same start, or where it is singular the assembly at the second row that the file means
    among those that come back to it."""
    inputs = session.inputs.reduced
    if start.state is None or start.row or inputs.shape[1] < 2 or not session.graph.blocks:
        return start
    condition = start.condition
    if condition is None:
        condition = _condition(session, inputs[:, 0], start.state)
    if condition is None or condition <= tolerances.CONDITION_NEAR_SINGULAR:
        return start
    modes = name_modes(session, inputs[:, 1], thorough=False)
    if modes.number == 0:
        return start
    home = distances_home(session, modes.points)
    near = session.problem.assembly.near
    distances = distances_near(session.problem, modes.coordinates) if near else home
    back = {i: _followed_back(session, modes.found.states[:, i]) for i in in_order(distances, home)}
    order = [i for i, state in back.items() if _is_same(session, state, start.state)]
    if not order:
        return start
    notes = list(start.diagnostics)
    chosen, how = order[0], "the first row lies on a fold, the second one decides"
    told = _told_apart(session, [back[i] for i in order])
    if told is not None:
        chosen, how = order[told], "next to a fold, where near tells its branches apart"
    elif len(order) > 1 and is_unclear(distances[order[0]], distances[order[1]]):
        pair = (distances[order[0]], distances[order[1]])
        notes.append(unclear("two assemblies of the second row", pair))
    state = np.ascontiguousarray(modes.found.states[:, chosen])
    return replace(start, state=state, how=f"{start.how}; {how}", diagnostics=notes, row=1)


def _condition(session: Session, inputs: Floats, state: Floats) -> float | None:
    """The condition of an assembly; None where it is none."""
    batch = session.run(inputs[:, None], state[:, None], demand=Demand.CONDITION)
    return float(batch.condition[0]) if batch.good[0] and batch.condition is not None else None


def _followed_back(session: Session, state: Floats) -> Floats | None:
    """The first row's state on the branch of an assembly at the second row; None where it ends."""
    back = session.follow_rows(state, 1, -1)
    return back.guess[:, -1] if back.end == TrackEnd.FINISHED else None


def _is_same(session: Session, state: Floats | None, first: Floats) -> bool:
    """Whether a state at the first row is its assembly, or the other one on the same fold."""
    if state is None:
        return False
    keys = [pose_keys(session.layout, s[:, None]) for s in (first, state)]
    return bool(same_poses(keys[0], keys[1], tolerances.SAME_FOLD)[0, 0])


def _told_apart(session: Session, states: list[Floats | None]) -> int | None:
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
