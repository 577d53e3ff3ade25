"""The closure as written: poses along a tree of joints, full pose equations at the others.

A pose (R, p) puts the point x of the home drawing at R x + p. A joint displaces its second link
against its first by x -> P + s a + Q(theta) (x - P'), with P, a on the first link, P' on the
second, and Q the turn about a after the turn that makes the drawings agree at zero (for S a free
rotation). An S stands as three Rodrigues parameters from a base rotation, which follows the
solution, so they are never singular.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from oracle.mechanism import Joint, Mechanism
from oracle.numerics import Number, mp
from oracle.series import Series, coefficient
from oracle.vectors import (
    IDENTITY,
    Matrix,
    Vector,
    add,
    apply,
    cayley,
    product,
    rodrigues_parameters,
    scale,
    subtract,
    transpose,
    turn,
)

Pose = tuple[Matrix, Vector]


@dataclass(frozen=True)
class State:
    """Numbers of all unknown and input coordinates by name; base rotations of S joints by joint."""

    values: dict[str, Number]
    rotations: dict[str, Matrix]


@dataclass(frozen=True)
class Closure:
    """The loop equations of a mechanism as functions of its coordinates' Taylor series."""

    mechanism: Mechanism

    @cached_property
    def names(self) -> list[str]:
        """All coordinates: `J.theta`, `J.s`, and `J.1`, `J.2`, `J.3` of an S; one for an H."""
        return [n for name, joint in self.mechanism.joints.items() for n in _names(name, joint)]

    @cached_property
    def tree(self) -> list[tuple[str, str, bool]]:
        """(joint, link that it reaches, whether this is its second link), from ground outwards."""
        joints = sorted(self.mechanism.joints.items(), key=lambda item: item[1].type == "S")
        reached, tree = {"ground"}, []
        while len(reached) <= len(self.mechanism.links):
            for name, joint in joints:
                if (joint.first in reached) != (joint.second in reached):
                    forward = joint.first in reached
                    link = joint.second if forward else joint.first
                    tree.append((name, link, forward))
                    reached.add(link)
                    break
            else:
                raise ValueError("some links are not connected to ground")
        return tree

    @cached_property
    def closing(self) -> list[str]:
        """The joints outside the tree: one independent loop each."""
        inside = {name for name, _, _ in self.tree}
        return [name for name in self.mechanism.joints if name not in inside]

    def start(self, values: dict[str, Number], rotations: dict[str, Matrix]) -> State:
        """The state of a guess; S joints without a rotation close their loop's orientation."""
        state = State(dict.fromkeys(self.names, mp.zero) | values, dict(rotations))
        missing = [n for n, j in self.mechanism.joints.items() if j.type == "S"]
        missing = [name for name in missing if name not in rotations]
        state.rotations.update(dict.fromkeys(missing, IDENTITY))
        poses = self.poses(state.values, state)
        for name in set(missing) & set(self.closing):
            joint = self.mechanism.joints[name]
            state.rotations[name] = product(
                transpose(poses[joint.first][0]), poses[joint.second][0]
            )
        return state

    def series(self, state: State, higher: dict[str, list[Number]], order: int) -> dict[str, Any]:
        """All coordinates; `higher` holds coefficients of t, t^2, ... of those that change."""
        padded = {n: [*c, *[mp.zero] * order][:order] for n, c in higher.items()}
        return state.values | {n: Series([state.values[n], *c]) for n, c in padded.items()}

    def poses(self, q: dict[str, Any], state: State) -> dict[str, Pose]:
        """The pose of every link."""
        poses: dict[str, Pose] = {"ground": (IDENTITY, [mp.zero] * 3)}
        for name, link, forward in self.tree:
            joint = self.mechanism.joints[name]
            step = _displacement(name, joint, q, state.rotations)
            base = poses[joint.first if forward else joint.second]
            poses[link] = _compose(base, step if forward else _inverse(step))
        return poses

    def residual(self, q: dict[str, Any], state: State) -> list[Any]:
        """Three rotation and three translation equations per loop.

        The rotation equations are the Rodrigues parameters of the rotation error: unlike its skew
        part they are zero nowhere but at an assembly.
        """
        poses = self.poses(q, state)
        equations: list[Any] = []
        for name in self.closing:
            rotation, shift = self._error(name, q, state, poses)
            equations += [*rodrigues_parameters(rotation), *shift]
        return equations

    def coefficients(self, q: dict[str, Any], state: State, k: int) -> list[Number]:
        """The coefficient of t^k of every equation."""
        return [coefficient(equation, k) for equation in self.residual(q, state)]

    def misfit(self, state: State) -> Number:
        """The largest entry of any loop's rotation error minus one, and of its gap / size."""
        poses, size = self.poses(state.values, state), self.mechanism.size
        worst = mp.zero
        for name in self.closing:
            rotation, shift = self._error(name, state.values, state, poses)
            turned = [abs(rotation[i][j] - IDENTITY[i][j]) for i in range(3) for j in range(3)]
            worst = max(worst, *turned, *(abs(x) / size for x in shift))
        return worst

    def _error(self, name: str, q: Any, state: State, poses: dict[str, Pose]) -> Pose:
        joint = self.mechanism.joints[name]
        step = _displacement(name, joint, q, state.rotations)
        rotation, shift = _compose(poses[joint.first], step)
        other, other_shift = poses[joint.second]
        return product(transpose(rotation), other), subtract(other_shift, shift)

    def rebased(self, state: State) -> State:
        """The same state with all Rodrigues parameters zero."""
        values, rotations = dict(state.values), dict(state.rotations)
        for name, base in state.rotations.items():
            parameters = [f"{name}.{i}" for i in (1, 2, 3)]
            rotations[name] = product(base, cayley([values[p] for p in parameters]))
            values.update(dict.fromkeys(parameters, mp.zero))
        return replace(state, values=values, rotations=rotations)

    def scale_of(self, name: str) -> Number:
        """The unit of a coordinate's steps: the size for lengths, 1 for angles."""
        return self.mechanism.size if name.endswith(".s") else mp.one


def _names(name: str, joint: Joint) -> list[str]:
    if joint.type == "S":
        return [f"{name}.{i}" for i in (1, 2, 3)]
    return [f"{name}.{c}" for c in joint.coordinates if not (joint.type == "H" and c == "s")]


def _displacement(name: str, joint: Joint, q: dict[str, Any], rotations: Any) -> Pose:
    place, other_place = joint.points
    if joint.type == "S":
        rotation = product(rotations[name], cayley([q[f"{name}.{i}"] for i in (1, 2, 3)]))
        return rotation, subtract(place, apply(rotation, other_place))
    axis = joint.axes[0] if joint.axes else []
    theta, s = q.get(f"{name}.theta", mp.zero), q.get(f"{name}.s", mp.zero)
    if joint.type == "H":
        s = theta * (joint.lead / (2 * mp.pi))
    rotation = turn(axis, theta)
    if joint.zero is not IDENTITY:
        rotation = product(rotation, joint.zero)
    foot = add(place, [s * a for a in axis])
    return rotation, subtract(foot, apply(rotation, other_place))


def _compose(outer: Pose, inner: Pose) -> Pose:
    return product(outer[0], inner[0]), add(apply(outer[0], inner[1]), outer[1])


def _inverse(pose: Pose) -> Pose:
    back = transpose(pose[0])
    return back, scale(apply(back, pose[1]), -1)
