"""A first row on a fold has two branches; which is meant is judged at the second row."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.assembly.distances import (
    distances_home,
    distances_near,
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
    order = [
        i
        for i in in_order(distances, home)
        if _comes_back(session, modes.found.states[:, i], start.state)
    ]
    if not order:
        return start
    notes = list(start.diagnostics)
    if len(order) > 1 and is_unclear(distances[order[0]], distances[order[1]]):
        pair = (distances[order[0]], distances[order[1]])
        notes.append(unclear("two assemblies of the second row", pair))
    how = f"{start.how}; the first row lies on a fold, the second one decides"
    state = np.ascontiguousarray(modes.found.states[:, order[0]])
    return replace(start, state=state, how=how, diagnostics=notes, row=1)


def _condition(session: Session, inputs: Floats, state: Floats) -> float | None:
    """The condition of an assembly; None where it is none."""
    batch = session.run(inputs[:, None], state[:, None], demand=Demand.CONDITION)
    return float(batch.condition[0]) if batch.good[0] and batch.condition is not None else None


def _comes_back(session: Session, state: Floats, first: Floats) -> bool:
    """Whether the branch of an assembly at the second row leads to the first row's."""
    back = session.follow_rows(state, 1, -1)
    if back.end != TrackEnd.FINISHED:
        return False
    keys = [pose_keys(session.layout, s[:, None]) for s in (first, back.guess[:, -1])]
    return bool(same_poses(keys[0], keys[1], tolerances.SAME_FOLD)[0, 0])
