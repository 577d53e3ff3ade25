"""The first row's assembly as poses of the links."""

from __future__ import annotations

import numpy as np

from mechkin_cli.analysis.assembly.start import choose_start
from mechkin_cli.analysis.mobility.configurations import Body, Configuration, Poses
from mechkin_cli.mechanism.model import Attached
from mechkin_cli.solver.session import Session


def first_row(session: Session, body: Body) -> Configuration | None:
    """The assembly that a sweep starts from; None if the file drives nothing."""
    if not session.driven:
        return None
    start = choose_start(session)
    if start.state is None:
        return None
    inputs = session.inputs.values[:, start.row]
    marks = [body.centre, *(body.centre + body.size * axis for axis in np.eye(3))]
    points = [Attached(link, tuple(mark.tolist())) for link in body.links for mark in marks]
    readout = session.readout((), points)
    values = session.run(inputs[:, None], start.state[:, None], readout=readout).outputs
    assert values is not None
    turns, places = [], []
    for number in range(len(body.links)):
        link = readout.points[4 * number : 4 * number + 4]
        origin, *tips = ((values[s : s + 3, 0] - body.centre) / body.size for s in link)
        turns.append(np.stack([tip - origin for tip in tips], axis=1))
        places.append(origin)
    found = Configuration(body, Poses(np.array(turns), np.array(places)))
    return found if found.assembled else None
