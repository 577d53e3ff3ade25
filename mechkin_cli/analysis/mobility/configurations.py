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
from mechkin_cli.analysis.assembly.home import home_state
from mechkin_cli.analysis.mobility.displacements import between, turned
from mechkin_cli.analysis.mobility.opened import Pose, Poses, opened
from mechkin_cli.mechanism.elementary import screws_at
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.mechanism.motion import Assembly, Motion
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.random_starts import RandomStarts
from mechkin_cli.solver.session import Session
from mechkin_cli.units import UnitSystem

if TYPE_CHECKING:
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
        self.poses = Poses(self.session, bodies, self.centre, self.size)

    @cached_property
    def columns(self) -> dict[str, list[int]]:
        """Columns of each joint's freedoms."""
        starts = [carrier.column for carrier in self.layout.carriers]
        ends = [*starts[1:], self.count]
        return {
            name: [column for k in edges for column in range(starts[k], ends[k])]
            for name, edges in self.opened.elements.items()
        }

    @cached_property
    def count(self) -> int:
        """Number of all joints' freedoms."""
        return sum(len(carrier.part.type.freedoms) for carrier in self.layout.carriers)

    @cached_property
    def signs(self) -> dict[str, Floats]:
        """How the loop of each cut (cuts,) passes each joint: outward +1, back to ground -1."""
        edges, opened = self.opened.graph.edges, self.opened
        passed = {GROUND_NAME: np.zeros(len(edges))}
        for k, edge in enumerate(edges):
            passed[edge.child] = passed[edge.parent].copy()
            passed[edge.child][k] = 1.0
        loops = [passed[cut.copy] - passed[cut.link] for cut in opened.cuts]
        table = np.array(loops).reshape(len(loops), len(edges))
        return {name: table[:, elements[0]] for name, elements in opened.elements.items()}

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
    def poses(self) -> dict[str, Pose]:
        """Poses of all bodies, copies of links at cuts among them."""
        return self.body.poses.at(np.empty(0), self.state)

    @cached_property
    def twists(self) -> dict[str, Floats]:
        """Twists (6, freedoms) of all bodies for unit rates of the joints' freedoms."""
        found = {GROUND_NAME: np.zeros((6, self.body.count))}
        for edge, carrier in zip(
            self.body.opened.graph.edges, self.body.layout.carriers, strict=True
        ):
            own = self._screws(carrier.edge, carrier.part.letter)
            twists = found[edge.parent].copy()
            twists[:, carrier.column : carrier.column + len(own)] += own.T
            found[edge.child] = twists
        return found

    @cached_property
    def jacobian(self) -> Floats:
        """Twists of the copies against their links: (6 cuts, freedoms)."""
        cuts = self.body.opened.cuts
        rows = [self.twists[cut.copy] - self.twists[cut.link] for cut in cuts]
        return np.concatenate([np.zeros((0, self.body.count)), *rows])

    @cached_property
    def misses(self) -> Floats:
        """Displacements of the copies against their links (6 cuts,): rad, parts of the size."""
        cuts = self.body.opened.cuts
        rows = [between(self.poses[cut.copy], self.poses[cut.link]) for cut in cuts]
        return np.concatenate([np.zeros(0), *rows])

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

    def distance(self, other: Configuration) -> float:
        """Root of the sum of squares of all differences of the links' poses."""
        total = 0.0
        for link in self.body.links:
            here, there = self.poses[link], other.poses[link]
            for one, two in zip(here, there, strict=True):
                total += float(np.sum((one - two) ** 2))
        return float(np.sqrt(total))

    def moved(self, steps: Floats) -> Configuration:
        """Displaced by steps (freedoms,) of the joints' freedoms."""
        state = self.state.copy()
        for carrier in self.body.layout.carriers:
            freedoms = carrier.part.type.freedoms
            own = steps[carrier.column : carrier.column + len(freedoms)]
            if carrier.part.type.is_ball:
                place = slice(carrier.state, carrier.state + 4)
                state[place] = turned(state[place], own)
                continue
            for k, freedom in enumerate(freedoms):
                unit = self.body.size / self.body.layout.length if freedom.is_slide else 1.0
                state[carrier.state + k] += own[k] * unit
        return Configuration(self.body, state)

    def closed(self) -> Configuration:
        """The configuration that Newton's method reaches from here."""
        here, least, stuck = self, np.inf, 0
        for _ in range(tolerances.MOBILITY_ITERATIONS):
            stuck = 0 if here.miss < 0.9 * least else stuck + 1
            least = min(least, here.miss)
            if here.miss < tolerances.MOBILITY_TIGHT or stuck > tolerances.MOBILITY_STUCK:
                break
            step = -least_squares(here.jacobian, here.misses)
            largest = float(np.abs(step).max(initial=0.0))
            if not largest < np.inf:
                break
            if largest > tolerances.MOBILITY_STRIDE:
                step = step * (tolerances.MOBILITY_STRIDE / largest)
            here = here.moved(step)
        return here


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
        misses = [between(here.poses[name], target[link]) for name, link in bodies.items()]
        miss = np.concatenate(misses)
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
    state = np.zeros(body.layout.states)
    for carrier in body.layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state : carrier.state + 4] = random.quaternions(1)[:, 0]
            continue
        for k, freedom in enumerate(carrier.part.type.freedoms):
            half = body.size / body.layout.length if freedom.is_slide else np.pi
            state[carrier.state + k] = random.between(half, 1)[0]
    return Configuration(body, state)


def along_motion(
    start: Configuration, motions: Floats, random: RandomStarts
) -> Configuration | None:
    """A configuration a finite step away along one of the first-order `motions` (freedoms, count).

    None where every step closes back to the start: the motion exists to first order only.
    """
    if motions.shape[1] == 0:
        return None
    step = tolerances.MOBILITY_STEP
    for _ in range(tolerances.MOBILITY_TRIES):
        direction = motions @ random.between(1.0, motions.shape[1])
        direction *= step / np.max(np.abs(direction))
        there = start.moved(direction).closed()
        if there.assembled and there.distance(start) > step / 4:
            return there
    return None
