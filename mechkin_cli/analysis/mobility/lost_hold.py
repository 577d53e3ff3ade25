"""A coordinate that holds an idle freedom and comes to where it cannot keep its value.

What holds an idle freedom is an equation more, with dead centres of its own. At a place where a
branch ends the mechanism is looked at without it: the motions that all loops allow with the inputs
at rest. If these are as many as it has idle freedoms, the mechanism is as regular there as
anywhere, and the end is that of what is held.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.first_row import configuration_at
from mechkin_cli.freedoms.configurations import Body, Configuration
from mechkin_cli.freedoms.rank import rank_of
from mechkin_cli.mechanism.held import is_unnamed
from mechkin_cli.mechanism.legs import find_legs

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.held import Held
    from mechkin_cli.solver.session import Session


def lost_holds(session: Session, inputs: Floats, state: Floats) -> tuple[Held, ...]:
    """What is held and cannot be kept at a place, inputs (inputs,) and states (states,), that is
    regular without it; empty where the mechanism itself is singular or none is found."""
    problem = session.problem
    if not problem.held or not np.isfinite(state).all():
        return ()
    body = Body(problem.mechanism)
    place = configuration_at(session, body, inputs, state)
    if place is None:
        return ()
    driven = np.eye(body.count)[[body.column(*each) for each in problem.motion.driven]]
    at_rest = np.concatenate([_scaled(place), driven])
    motions = rank_of(at_rest, tolerances.REGULAR_WITHOUT_HOLDS).motions
    if motions.shape[1] != len(problem.held) + len(find_legs(problem.mechanism)):
        return ()
    return _dependent(problem.held, body, motions)


def _scaled(place: Configuration) -> Floats:
    """The loops' Jacobian with lengths in parts of how far the links are, where that is more than
    the size, and columns of length one."""
    far = max(1.0, *(float(np.abs(pose.place).max()) for pose in place.poses.values()))
    jacobian = place.jacobian
    parts = np.array([1.0, 1.0, 1.0, 1.0 / far, 1.0 / far, 1.0 / far])
    matrix = jacobian * np.tile(parts, len(jacobian) // 6)[:, None]
    lengths = np.sqrt((matrix * matrix).sum(axis=0))
    return np.asarray(matrix / np.where(lengths > 0.0, lengths, 1.0), dtype=np.float64)


def _dependent(held: tuple[Held, ...], body: Body, motions: Floats) -> tuple[Held, ...]:
    """Those whose coordinates the idle motions (freedoms, count) leave at rest, or change together;
    if those that have names are independent, those that have none."""
    named = [
        one for one in held if one.coordinate is not None and not is_unnamed(one.coordinate[1])
    ]
    unnamed = tuple(one for one in held if one.coordinate is not None and one not in named)
    if not named:
        return unnamed
    rates = motions[[body.column(*one.name.split(".")) for one in named]]
    left, values, _ = np.linalg.svd(rates)
    if unnamed and values[-1] > tolerances.HELD_INDEPENDENT:
        return unnamed
    parts = np.abs(left[:, -1])
    return tuple(
        one
        for one, part in zip(named, parts.tolist(), strict=True)
        if part > tolerances.HELD_PART * parts.max()
    )
