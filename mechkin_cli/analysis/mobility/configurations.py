"""Assembled configurations as poses of the links, and the motion from one to the next.

A configuration closes by least-squares Newton steps on all constraints (truncated singular values),
so redundant constraints and free motions do no harm.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.mobility.constraints import (
    Axes,
    Constraint,
    carried,
    constraints,
    freedoms,
    on_side,
)
from mechkin_cli.mechanism.model import GROUND_NAME, Joint, Mechanism
from mechkin_cli.solver.random_starts import RandomStarts

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


class Poses(NamedTuple):
    """Poses of the moving links in the order of the mechanism: (links, 3, 3) and (links, 3)."""

    turns: Floats
    places: Floats

    def moved(self, twists: Floats) -> Poses:
        """Displaced by finite twists (6 links,) at the origin."""
        turns, places = self.turns.copy(), self.places.copy()
        for k, twist in enumerate(twists.reshape(-1, 6)):
            turn = _turned(twist[:3])
            turns[k], places[k] = turn @ turns[k], turn @ places[k] + twist[3:]
        return Poses(turns, places)

    def distance(self, other: Poses) -> float:
        """Root of the sum of squares of all differences."""
        turned, moved = self.turns - other.turns, self.places - other.places
        return float(np.sqrt(np.sum(turned * turned) + np.sum(moved * moved)))


class Body(NamedTuple):
    """What all configurations share: the mechanism, its moving links, centre (m) and size (m)."""

    mechanism: Mechanism
    links: tuple[str, ...]
    centre: Floats
    size: float


class Configuration:
    """The mechanism with its links at given poses."""

    def __init__(self, body: Body, poses: Poses) -> None:
        self.body = body
        self.poses = poses

    @cached_property
    def frames(self) -> dict[str, tuple[Axes, Axes]]:
        """Frames of every joint on its first and second link."""
        joints = self.body.mechanism.joints
        return {
            name: (self._frame(joint, 0), self._frame(joint, 1)) for name, joint in joints.items()
        }

    def _frame(self, joint: Joint, side: int) -> Axes:
        link, frame = ((joint.first, joint.on_first), (joint.second, joint.on_second))[side]
        turn, place = np.eye(3), np.zeros(3)
        if link != GROUND_NAME:
            k = self.body.links.index(link)
            turn, place = self.poses.turns[k], self.poses.places[k]
        return carried(frame, turn, place, self.body.centre, self.body.size)

    @cached_property
    def rows(self) -> list[tuple[Joint, Constraint]]:
        """All constraints, joint by joint."""
        joints, size = self.body.mechanism.joints, self.body.size
        return [
            (joint, row)
            for name, joint in joints.items()
            for row in constraints(joint, *self.frames[name], size)
        ]

    @cached_property
    def gradient(self) -> Floats:
        """The wrenches of all constraints: (rows, 6 links)."""
        matrix = np.zeros((len(self.rows), 6 * len(self.body.links)))
        for i, (joint, row) in enumerate(self.rows):
            for link, part in ((joint.first, row.on_first), (joint.second, row.on_second)):
                if link != GROUND_NAME:
                    k = self.body.links.index(link)
                    matrix[i, 6 * k : 6 * k + 6] += part
        return matrix

    @cached_property
    def miss(self) -> float:
        """Largest equation: lengths in parts of the size, cosines."""
        return max((abs(row.miss) for _, row in self.rows), default=0.0)

    @property
    def assembled(self) -> bool:
        """Whether all equations and their side conditions hold."""
        joints = self.body.mechanism.joints.items()
        return self.miss < tolerances.MOBILITY_CLOSED and all(
            on_side(joint, *self.frames[name]) for name, joint in joints
        )

    def rates(self, joint: Joint, twists: Floats) -> Floats:
        """Rates of the joint's freedoms (freedoms, motions) for link twists (6 links, motions)."""
        relative = self._twist(joint.second, twists) - self._twist(joint.first, twists)
        screws = freedoms(joint, *self.frames[joint.name], self.body.size)
        return np.asarray(np.linalg.lstsq(screws.T, relative, rcond=None)[0], dtype=np.float64)

    def _twist(self, link: str, twists: Floats) -> Floats:
        if link == GROUND_NAME:
            return np.zeros((6, twists.shape[1]))
        k = self.body.links.index(link)
        return twists[6 * k : 6 * k + 6]

    def closed(self) -> Configuration:
        """The configuration that Newton's method reaches from here."""
        here, least, stuck = self, np.inf, 0
        for _ in range(tolerances.MOBILITY_ITERATIONS):
            stuck = 0 if here.miss < 0.9 * least else stuck + 1
            least = min(least, here.miss)
            if here.miss < tolerances.MOBILITY_TIGHT or stuck > tolerances.MOBILITY_STUCK:
                break
            misses = np.array([row.miss for _, row in here.rows])
            step = -np.linalg.lstsq(here.gradient, misses, rcond=tolerances.MOBILITY_RANK)[0]
            largest = float(np.max(np.abs(step)))
            if not largest < np.inf:
                break
            here = Configuration(
                here.body, here.poses.moved(step * min(1.0, tolerances.MOBILITY_STRIDE / largest))
            )
        return here


def body_of(mechanism: Mechanism) -> Body:
    """The mechanism about the centre of its joint points."""
    links = tuple(name for name in mechanism.links if name != GROUND_NAME)
    points = [at.vector for _, at in mechanism.joint_points()]
    centre = np.mean(np.array(points), axis=0) if points else np.zeros(3)
    return Body(mechanism, links, centre, mechanism.box_diagonal())


def home(body: Body) -> Configuration:
    """The drawing, assembled or not."""
    count = len(body.links)
    return Configuration(body, Poses(np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 3))))


def assembled(body: Body) -> Configuration | None:
    """An assembled configuration: the home drawing, next to it, or from random poses."""
    found = home(body).closed()
    random = RandomStarts()
    tries = 0
    while not found.assembled and tries < tolerances.MOBILITY_STARTS:
        tries += 1
        poses = home(body).poses
        twists = np.stack([random.between(np.pi, len(body.links)) for _ in range(6)], axis=1)
        twists[:, 3:] /= np.pi
        found = Configuration(body, poses.moved(twists.ravel())).closed()
    return found if found.assembled else None


def along_motion(
    start: Configuration, motions: Floats, random: RandomStarts
) -> Configuration | None:
    """A configuration a finite step away along one of the first-order `motions` (6 links, count).

    None where every step closes back to the start: the motion exists to first order only.
    """
    if motions.shape[1] == 0:
        return None
    step = tolerances.MOBILITY_STEP
    for _ in range(tolerances.MOBILITY_TRIES):
        direction = motions @ random.between(1.0, motions.shape[1])
        direction *= step / np.max(np.abs(direction))
        there = Configuration(start.body, start.poses.moved(direction)).closed()
        if there.assembled and there.poses.distance(start.poses) > step / 4:
            return there
    return None


def _turned(vector: Floats) -> Floats:
    """Rotation by a rotation vector."""
    angle = float(np.sqrt(vector @ vector))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn: Floats = np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k)
    return turn
