"""Mechanisms of any structure: six unknowns per moving link, every joint's equations as written.

The pose of a link is x -> Q (R (x - c) ) + o + d: c a place amid its joints in the drawing, R and o
from the last step, Q the turn of Rodrigues parameters p; p and d are the unknowns of a step. The
equations are those of `oracle.pairs` at every joint, and coordinate - value = 0 at every input; no
tree, no loops.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from oracle.mechanism import Joint, Mechanism
from oracle.numerics import Number, mp
from oracle.pairs import Angles, Equation, Pair, Pose, coordinates, equations
from oracle.series import Series, coefficient
from oracle.vectors import IDENTITY, add, apply, cayley, frame, product, subtract, transpose

Inputs = Mapping[str, Sequence[Number]]
Steps = Mapping[str, Sequence[Any]]
"""Six unknowns by link: three Rodrigues parameters, three lengths."""

_STILL = (0,) * 6


@dataclass(frozen=True)
class Placement:
    """Rotation and place of every moving link, and angles near those of the joints."""

    poses: dict[str, Pose]
    """By link (R, o): the link's centre c of the drawing is at o."""
    angles: dict[str, Angles]
    """By joint."""


@dataclass(frozen=True)
class Bodies:
    """The constraints of a mechanism as functions of its links' poses."""

    mechanism: Mechanism

    @cached_property
    def centres(self) -> dict[str, list[Number]]:
        """The mean of a link's joint points in the drawing."""
        found = {}
        for link in self.mechanism.links:
            places = [
                joint.points[side]
                for joint in self.mechanism.joints.values()
                for side, name in enumerate((joint.first, joint.second))
                if name == link and joint.type != "W"
            ]
            count = max(len(places), 1)
            found[link] = [mp.fsum(p[i] for p in places) / count for i in range(3)]
        return found

    @property
    def width(self) -> int:
        return 6 * len(self.mechanism.links)

    def drawing(self) -> Placement:
        """All links as drawn, all coordinates zero."""
        poses = {link: (IDENTITY, centre) for link, centre in self.centres.items()}
        joints = self.mechanism.joints.items()
        return Placement(poses, {n: dict.fromkeys(j.coordinates, mp.zero) for n, j in joints})

    def poses(self, placement: Placement, steps: Steps) -> dict[str, Pose]:
        """x -> R x + p of every link, `ground` included."""
        found: dict[str, Pose] = {"ground": (IDENTITY, [mp.zero] * 3)}
        for link, (rotation, place) in placement.poses.items():
            step = steps.get(link, _STILL)
            if step is not _STILL:
                rotation = product(cayley(step[:3]), rotation)
                place = add(place, step[3:])
            found[link] = rotation, subtract(place, apply(rotation, self.centres[link]))
        return found

    def pair(self, name: str, poses: Mapping[str, Pose]) -> Pair:
        joint = self.mechanism.joints[name]
        return Pair(joint, poses[joint.first], poses[joint.second])

    def joint_equations(self, name: str, poses: Any, angles: Angles) -> list[Equation]:
        return equations(self.pair(name, poses), angles)

    def drive_equations(
        self, name: str, poses: Any, angles: Angles, inputs: Mapping[str, Any]
    ) -> list[Equation]:
        """Coordinate less value, of the inputs at one joint."""
        joint = self.mechanism.joints[name]
        driven = [c for c in joint.coordinates if f"{name}.{c}" in inputs]
        if not driven:
            return []
        # an angle's turn is the input's
        near = {c: coefficient(inputs.get(f"{name}.{c}", x), 0) for c, x in angles.items()}
        found = coordinates(self.pair(name, poses), near)
        return [Equation(found[c] - inputs[f"{name}.{c}"], not is_angle(c)) for c in driven]

    def equations(
        self, placement: Placement, poses: Any, inputs: Mapping[str, Any]
    ) -> list[Equation]:
        """All of them, joint by joint."""
        found: list[Equation] = []
        for name, angles in placement.angles.items():
            found += self.joint_equations(name, poses, angles)
            found += self.drive_equations(name, poses, angles, inputs)
        return found

    def jacobian(
        self, placement: Placement, inputs: Mapping[str, Any]
    ) -> tuple[list[list[Number]], list[bool]]:
        """Derivatives of all equations by all unknowns; which equations count in lengths."""
        still = self.poses(placement, {})
        places = {link: 6 * k for k, link in enumerate(self.mechanism.links)}
        moved = {link: self._nudged(placement, link) for link in places}
        rows: list[list[Number]] = []
        lengths: list[bool] = []
        for name, angles in placement.angles.items():
            joint = self.mechanism.joints[name]
            columns = {}
            for link in {joint.first, joint.second} - {"ground"}:
                for k, pose in enumerate(moved[link]):
                    poses = still | {link: pose}
                    found = self.joint_equations(name, poses, angles)
                    found += self.drive_equations(name, poses, angles, inputs)
                    columns[places[link] + k] = [coefficient(e.value, 1) for e in found]
                    kinds = [e.length for e in found]
            lengths += kinds
            for i in range(len(kinds)):
                row = [mp.zero] * self.width
                for k, column in columns.items():
                    row[k] = column[i]
                rows.append(row)
        return rows, lengths

    def _nudged(self, placement: Placement, link: str) -> list[Pose]:
        """The link's pose with each of its unknowns growing as t."""
        only = Placement({link: placement.poses[link]}, {})
        found = []
        for k in range(6):
            step: list[Any] = [mp.zero] * 6
            step[k] = Series([mp.zero, mp.one])
            found.append(self.poses(only, {link: step})[link])
        return found

    def moved(self, placement: Placement, step: Sequence[Number]) -> Placement:
        """The placement after a step of all unknowns, its angles brought up to date."""
        steps = {k: step[6 * i : 6 * i + 6] for i, k in enumerate(self.mechanism.links)}
        return self.placed(self.poses(placement, steps), placement.angles)

    def placed(self, poses: Mapping[str, Pose], angles: dict[str, Angles]) -> Placement:
        """The placement of poses; rotations are made orthonormal."""
        exact = {}
        for link, centre in self.centres.items():
            rotation, shift = poses[link]
            x, _, z = transpose(rotation)
            rotation = frame(_unit(z), x)
            exact[link] = rotation, add(apply(poses[link][0], centre), shift)
        found = {n: coordinates(self.pair(n, poses), near) for n, near in angles.items()}
        return Placement(exact, found)


def is_angle(coordinate: str) -> bool:
    """Whether a coordinate, `theta` or `J.theta`, is an angle."""
    return coordinate.rpartition(".")[2].startswith("theta")


def joint_names(joint: Joint, name: str) -> list[str]:
    """Full names of a joint's coordinates."""
    return [f"{name}.{c}" for c in joint.coordinates]


def _unit(vector: Sequence[Number]) -> list[Number]:
    length = mp.sqrt(mp.fsum(x * x for x in vector))
    return [x / length for x in vector]
