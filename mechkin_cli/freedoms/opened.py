"""A mechanism opened to a tree of elementary displacements, and the poses of its bodies.

Every joint is carried, part by part. One that would close a loop carries a copy of its second link
(a cut), so that a configuration is a point in the space of all joint coordinates and closes where
every copy lies on its link. No joint has closing equations here, and nothing is driven.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.mechanism.model import GROUND_NAME, Attached, Joint, Link, Mechanism
from mechkin_cli.solver.graph import SolverGraph, TreeEdge

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.session import Session


class Pose(NamedTuple):
    """Where a body stands: its drawing's point p is at turn p + place (lengths in sizes, about the
    centre)."""

    turn: Floats
    place: Floats


class Cut(NamedTuple):
    """A joint that closes a loop: the copy that it carries, and the link on which that lies."""

    joint: str
    copy: str
    link: str


class Opened(NamedTuple):
    """The tree: `mechanism` and `graph` of elementary joints, each one edge; `elements` are the
    edges of every joint of the mechanism in the order of its parts."""

    mechanism: Mechanism
    graph: SolverGraph
    elements: Mapping[str, tuple[int, ...]]
    cuts: tuple[Cut, ...]


def opened(mechanism: Mechanism) -> Opened:
    """The mechanism as a tree, breadth first from ground."""
    edges: list[TreeEdge] = []
    elements: dict[str, tuple[int, ...]] = {}
    reached, front = {GROUND_NAME}, [GROUND_NAME]
    while front:
        link = front.pop(0)
        for name, joint in mechanism.joints.items():
            far = {joint.first: joint.second, joint.second: joint.first}.get(link)
            if name in elements or far is None or far in reached:
                continue
            elements[name] = _carry(edges, _parts_of(joint, joint.second), link)
            reached.add(far)
            front.append(far)
    cuts = []
    for name, joint in mechanism.joints.items():
        if name not in elements:
            cut = Cut(name, f"{name} | cut", joint.second)
            elements[name] = _carry(edges, _parts_of(joint, cut.copy), joint.first)
            cuts.append(cut)
    links = {edge.child: Link(edge.child) for edge in edges}
    joints = {edge.joint.name: edge.joint for edge in edges}
    tree = Mechanism(mechanism.name, links, joints)
    return Opened(tree, SolverGraph(tuple(edges), (), (), (), ()), elements, tuple(cuts))


def _parts_of(joint: Joint, second: str) -> list[Joint]:
    """The parts of a joint, from its first link to `second`, as joints of their own."""
    between = [f"{joint.name} | {k}" for k in range(1, len(joint.parts))]
    bodies = [joint.first, *between, second]
    return [
        Joint(
            f"{joint.name} | part {k + 1}",
            part.letter,
            bodies[k],
            bodies[k + 1],
            part.before,
            part.after,
            (part,),
            joint.lead,
        )
        for k, part in enumerate(joint.parts)
    ]


def _carry(edges: list[TreeEdge], parts: list[Joint], link: str) -> tuple[int, ...]:
    """Adds the parts outward from `link`, at either end; their edges from first to last."""
    forward = link == parts[0].first
    for part in parts if forward else parts[::-1]:
        ends = (part.first, part.second) if forward else (part.second, part.first)
        edges.append(TreeEdge(part, *ends))
    numbers = tuple(range(len(edges) - len(parts), len(edges)))
    return numbers if forward else numbers[::-1]


class Poses:
    """The kernel's poses of bodies, about `centre` (m) in parts of `size` (m)."""

    def __init__(
        self, session: Session, bodies: Iterable[str], centre: Floats, size: float
    ) -> None:
        self.session, self.bodies = session, tuple(bodies)
        self.centre, self.size = centre, size
        marks = [centre, *(centre + size * axis for axis in np.eye(3))]
        points = [Attached(body, tuple(mark.tolist())) for body in self.bodies for mark in marks]
        self.readout = session.readout((), points)
        slots = np.array(self.readout.points, dtype=np.intp)
        self._slots = (slots[:, None] + np.arange(3)).ravel()

    def at(self, inputs: Floats, states: Floats) -> tuple[Floats, Floats]:
        """Turns (rows, bodies, 3, 3) and places (rows, bodies, 3) of ground and the bodies, in this
        order, at inputs (inputs, rows) and states (states, rows)."""
        batch = self.session.run(inputs, states, readout=self.readout)
        assert batch.outputs is not None
        rows = states.shape[1]
        marks = batch.outputs[self._slots].reshape(len(self.bodies), 4, 3, rows)
        marks = (marks.transpose(3, 0, 1, 2) - self.centre) / self.size
        turns = np.empty((rows, len(self.bodies) + 1, 3, 3))
        places = np.zeros((rows, len(self.bodies) + 1, 3))
        turns[:, 0] = np.eye(3)
        places[:, 1:] = marks[:, :, 0]
        turns[:, 1:] = np.swapaxes(marks[:, :, 1:] - marks[:, :, :1], -1, -2)
        return turns, places

    def named(self, turns: Floats, places: Floats) -> dict[str, Pose]:
        """The poses of one row by the names of the bodies."""
        names = (GROUND_NAME, *self.bodies)
        return {name: Pose(turns[k], places[k]) for k, name in enumerate(names)}
