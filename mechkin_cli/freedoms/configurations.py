"""Assembled configurations of the opened mechanism, and the motion from one to the next.

The unknowns are the coordinates of all joints, loops and inputs alike; poses come from the kernel,
columns from the joint table's screws. A configuration closes by least-squares Newton steps on all
cuts (truncated singular values), so redundant constraints and free motions do no harm.
Twists are (angular, linear at the centre), lengths in parts of the size.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.freedoms.closed import closed
from mechkin_cli.freedoms.displacements import displacement
from mechkin_cli.freedoms.loops import Closing, Loops
from mechkin_cli.freedoms.opened import Pose, Poses, opened
from mechkin_cli.freedoms.parts import Part, parts
from mechkin_cli.mechanism.elementary import screws_at
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.mechanism.motion import Assembly, Motion
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.home import home_state
from mechkin_cli.solver.random_starts import RandomStarts
from mechkin_cli.solver.session import Session
from mechkin_cli.units import UnitSystem

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


class Body:
    """What all configurations share: the mechanism, its moving links, centre (m) and size (m), and
    the mechanism opened to a tree."""

    def __init__(self, mechanism: Mechanism) -> None:
        points = [at.vector for _, at in mechanism.joint_points()]
        self.mechanism = mechanism
        self.links = tuple(name for name in mechanism.links if name != GROUND_NAME)
        self.centre: Floats = np.mean(np.array(points), axis=0) if points else np.zeros(3)
        self.size = mechanism.box_diagonal()
        self.opened = opened(mechanism)
        tree = Problem(self.opened.mechanism, Motion((), 1), Assembly(), UnitSystem())
        self.session = Session(tree, self.opened.graph)
        self.layout = self.session.layout
        bodies = self.opened.mechanism.links
        poses = Poses(self.session, bodies, self.centre, self.size)
        self.loops = Loops(self.opened, self.layout, poses)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Loops that move on their own."""
        return parts(self.mechanism, self.loops)

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Columns that no loop passes."""
        return np.flatnonzero(~np.any(self.loops.signs != 0.0, axis=0))

    @cached_property
    def columns(self) -> dict[str, list[int]]:
        """Columns of each joint's freedoms."""
        starts = [carrier.column for carrier in self.layout.carriers]
        ends = [*starts[1:], self.count]
        return {
            name: [column for k in edges for column in range(starts[k], ends[k])]
            for name, edges in self.opened.elements.items()
        }

    @property
    def count(self) -> int:
        """Number of all joints' freedoms."""
        return self.loops.count

    @cached_property
    def signs(self) -> dict[str, Floats]:
        """How the loop of each cut (cuts,) passes each joint: outward +1, back to ground -1."""
        table, elements = self.loops.edge_signs, self.opened.elements
        return {name: table[:, numbers[0]] for name, numbers in elements.items()}

    def column(self, joint: str, coordinate: str) -> int:
        """Column of a coordinate."""
        freedom = self.mechanism.joints[joint].type.freedom_of[coordinate]
        return self.columns[joint][freedom]


class Configuration:
    """The opened mechanism at a state of the kernel."""

    def __init__(self, body: Body, state: Floats) -> None:
        self.body = body
        self.state = state

    @cached_property
    def _arrays(self) -> tuple[Floats, Floats]:
        return self.body.loops.poses.at(np.empty((0, 1)), self.state[:, None])

    @cached_property
    def poses(self) -> dict[str, Pose]:
        """Poses of all bodies, copies of links at cuts among them."""
        turns, places = self._arrays
        return self.body.loops.poses.named(turns[0], places[0])

    @cached_property
    def twists(self) -> dict[str, Floats]:
        """Twists (6, freedoms) of all bodies for unit rates of the joints' freedoms."""
        loops = self.body.loops
        twists = loops.twists(*self._arrays)[0]
        return {name: twists[k] for name, k in loops.number.items()}

    @cached_property
    def closing(self) -> Closing:
        """Misses and Jacobian of all loops, in arrays of one row."""
        return self.body.loops.closing_of(*self._arrays)

    @property
    def jacobian(self) -> Floats:
        """Twists of the copies against their links: (6 cuts, freedoms)."""
        return np.asarray(self.closing.jacobian[0])

    @property
    def misses(self) -> Floats:
        """Displacements of the copies against their links (6 cuts,): rad, parts of the size."""
        return np.asarray(self.closing.misses[0])

    @property
    def miss(self) -> float:
        """Largest part of `misses`."""
        return float(np.abs(self.misses).max(initial=0.0))

    @property
    def assembled(self) -> bool:
        """Whether all loops close."""
        return self.miss < tolerances.MOBILITY_CLOSED

    def point(self, joint: Joint) -> Floats:
        """Where the joint's point on its first link is."""
        pose = self.poses[joint.first]
        at = (np.array(joint.on_first.o) - self.body.centre) / self.body.size
        return np.asarray(pose.turn @ at + pose.place, dtype=np.float64)

    def wider(self, joint: Joint, letter: str) -> Floats:
        """The Jacobian's columns of a softer joint of one part, on the frames of a joint of one
        part."""
        (edge,) = self.body.opened.elements[joint.name]
        signs = self.body.signs[joint.name]
        found = self._screws(edge, letter)
        return np.array([np.outer(signs, screw).ravel() for screw in found]).T

    def _screws(self, edge: int, letter: str) -> Floats:
        """Unit screws (freedoms, 6) of a displacement `letter` in place of that of an edge: of the
        body it carries against the one before, whose place it is drawn on."""
        body = self.body
        before, joint = body.layout.carriers[edge].part.before, body.opened.graph.edges[edge].joint
        pose = self.poses[body.opened.graph.edges[edge].parent]
        origin = (np.array(before.o) - body.centre) / body.size
        frame = before._replace(o=tuple(origin.tolist()))
        found = [np.zeros((0, 6))]
        for angular, linear in screws_at(letter, frame, joint.pitch / body.size):
            spin = pose.turn @ np.array(angular)
            found.append(np.array([[*spin, *(pose.turn @ linear + np.cross(pose.place, spin))]]))
        return np.concatenate(found)

    def moved(self, steps: Floats) -> Configuration:
        """Displaced by steps (freedoms,) of the joints' freedoms."""
        return Configuration(self.body, self.body.loops.moved(self.state[None], steps[None])[0])

    def closed(self) -> Configuration:
        """The configuration that steps of Levenberg and Marquardt reach from here."""
        state = self.state
        for part in self.body.parts:
            state = closed(part, state[None]).states[0]
        return Configuration(self.body, state)


def least_squares(matrix: Floats, right: Floats) -> Floats:
    """The shortest of the best solutions."""
    found = np.linalg.lstsq(matrix, right, rcond=tolerances.MOBILITY_RANK)[0]
    return np.asarray(found, dtype=np.float64)


def home(body: Body) -> Configuration:
    """The drawing, assembled or not."""
    return Configuration(body, home_state(body.layout))


def with_links_at(start: Configuration, target: Mapping[str, Pose]) -> Configuration:
    """The configuration next to `start` whose links, and copies of them, have given poses."""
    body = start.body
    bodies = {link: link for link in body.links} | {c.copy: c.link for c in body.opened.cuts}
    here = start
    for _ in range(tolerances.MOBILITY_STUCK):
        pairs = [(here.poses[name], target[link]) for name, link in bodies.items()]
        miss = np.concatenate([displacement(*one, *two) for one, two in pairs])
        if np.abs(miss).max() < tolerances.MOBILITY_TIGHT:
            break
        matrix = np.concatenate([here.twists[name] for name in bodies])
        here = here.moved(-least_squares(matrix, miss))
    return here


def assembled(body: Body) -> Configuration | None:
    """An assembled configuration: the home drawing, next to it, or from random coordinates."""
    found = home(body).closed()
    random = RandomStarts()
    tries = 0
    while not found.assembled and tries < tolerances.MOBILITY_STARTS:
        tries += 1
        found = _scattered(body, random).closed()
    return found if found.assembled else None


def _scattered(body: Body, random: RandomStarts) -> Configuration:
    """Turns and orientations anywhere, slides within the size."""
    state = home_state(body.layout)
    for carrier in body.layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state : carrier.state + 4] = random.quaternions(1)[:, 0]
            continue
        for k, freedom in enumerate(carrier.part.type.freedoms):
            half = body.size / body.layout.length if freedom.is_slide else np.pi
            state[carrier.state + k] += random.between(half, 1)[0]
    return Configuration(body, state)
