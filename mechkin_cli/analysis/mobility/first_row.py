"""The first row's assembly as a configuration of the opened mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.assembly.probe import Probe
from mechkin_cli.analysis.assembly.start import choose_start
from mechkin_cli.freedoms.configurations import (
    Body,
    Configuration,
    home,
    with_links_at,
)
from mechkin_cli.freedoms.displacements import quaternion_of
from mechkin_cli.freedoms.opened import Pose, Poses
from mechkin_cli.mechanism.frames import Frame

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


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
    coordinates, _ = Probe.of(session).read(inputs, state[:, None])
    seed = _seed(body, {name: float(value[0]) for name, value in coordinates.items()}, links)
    found = with_links_at(seed, links)
    return found if found.assembled else None


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
                before = links[joint.first].turn @ _axes(part.before)
                after = links[joint.second].turn @ _axes(part.after)
                seen = (before, after) if edge.forward else (after, before)
                state[carrier.state : carrier.state + 4] = quaternion_of(seen[0].T @ seen[1])
                continue
            for number in range(len(part.type.freedoms)):
                known = values.get(carrier.column + number)
                if known is not None:
                    unit = joint.unit_of(known.name, layout.length)
                    value = coordinates[f"{name}.{known.name}"] / unit
                    state[carrier.state + number] = value
    return Configuration(body, state)


def _axes(frame: Frame) -> Floats:
    """The axes of a frame as columns."""
    return np.array([frame.x, frame.y, frame.z]).T
