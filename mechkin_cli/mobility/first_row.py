"""The first row's assembly as a configuration of the opened mechanism, and locked coordinates that
cannot keep their values on the path.

What locks an idle freedom is an equation more, with dead centres of its own. At a place where a
branch ends the mechanism is looked at without it (`lost_holds`): the motions that all loops allow
with the inputs at rest. If these are as many as it has idle freedoms, the mechanism is as regular
there as anywhere, and the end is that of what is locked.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.assembly import choose_start, probe_of
from mechkin_cli.mechanism import LockedFreedom, is_unnamed
from mechkin_cli.mobility.configurations import Body, Configuration, home, with_links_at
from mechkin_cli.mobility.opened import Pose, Poses, quaternion_of, rank_of

if TYPE_CHECKING:
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats


def first_row(session: Session, body: Body) -> Configuration | None:
    """The assembly that a sweep starts from; None if the file drives nothing."""
    if not session.driven:
        return None
    start = choose_start(session)
    if start.state is None:
        return None
    return configuration_at(session, body, session.inputs.values[:, start.row], start.state)


def configuration_at(
    session: Session, body: Body, inputs: Floats, state: Floats
) -> Configuration | None:
    """The configuration of the opened mechanism whose links are where a session has them at inputs
    (inputs,) and a state (states,), kernel units; None if none is found."""
    poses = Poses(session, body.links, body.centre, body.size)
    turns, places = poses.at(inputs[:, None], state[:, None])
    links = poses.named(turns[0], places[0])
    coordinates, _ = probe_of(session).read(inputs, state[:, None])
    seed = _seed(body, {name: float(value[0]) for name, value in coordinates.items()}, links)
    place = with_links_at(seed, links)
    return place if place.assembled else None


def _seed(body: Body, coordinates: Mapping[str, float], links: Mapping[str, Pose]) -> Configuration:
    """The coordinates that have names, and the orientations of balls; other slides at zero."""
    state, layout = home(body).state.copy(), body.layout
    for name, joint in body.mechanism.joints.items():
        columns = body.columns[name]
        values = {columns[c.freedom]: c for c in joint.type.named if not c.on_thread}
        for k in body.opened.elements[name]:
            carrier, edge = layout.carriers[k], body.opened.graph.edges[k]
            part = edge.joint.parts[0]
            if part.type.is_ball:
                # slides beside a ball do not turn
                before = links[joint.first].turn @ np.array(part.before[:3]).T
                after = links[joint.second].turn @ np.array(part.after[:3]).T
                turn = before.T @ after if edge.forward else after.T @ before
                state[carrier.state : carrier.state + 4] = quaternion_of(turn)
                continue
            for number in range(len(part.type.freedoms)):
                known = values.get(carrier.column + number)
                if known is not None:
                    unit = joint.unit_of(known.name, layout.length)
                    value = coordinates[f"{name}.{known.name}"] / unit
                    state[carrier.state + number] = value
    return Configuration(body, state)


def lost_holds(session: Session, inputs: Floats, state: Floats) -> tuple[LockedFreedom, ...]:
    """What is locked and cannot keep its value at a place, inputs (inputs,) and states (states,),
    that is regular without it; empty where the mechanism itself is singular or none is found."""
    problem = session.problem
    if not problem.held or not np.isfinite(state).all():
        return ()
    body = Body(problem.mechanism)
    place = configuration_at(session, body, inputs, state)
    if place is None:
        return ()
    # lengths in parts of how far the links are, where that is more than the size; unit columns
    far = max(1.0, *(float(np.abs(pose.place).max()) for pose in place.poses.values()))
    jacobian = place.jacobian
    parts = np.array([1.0, 1.0, 1.0, 1.0 / far, 1.0 / far, 1.0 / far])
    matrix = jacobian * np.tile(parts, len(jacobian) // 6)[:, None]
    lengths = np.sqrt((matrix * matrix).sum(axis=0))
    driven = np.eye(body.count)[[body.column(*each) for each in problem.motion.driven]]
    at_rest = np.concatenate([matrix / np.where(lengths > 0.0, lengths, 1.0), driven])
    motions = rank_of(at_rest, tolerances.REGULAR_WITHOUT_HOLDS).motions
    if motions.shape[1] != len(problem.held) + len(problem.mechanism.spins):
        return ()
    return _dependent(problem.held, body, motions)


def _dependent(
    held: tuple[LockedFreedom, ...], body: Body, motions: Floats
) -> tuple[LockedFreedom, ...]:
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
