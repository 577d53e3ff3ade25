"""Dense equations of motion of a tree of hinges and slides whose loops close in balls.

Mass matrix and bias by the Jacobians of all mass centres (R. Featherstone, Rigid Body Dynamics
Algorithms, 2008, 2.14 and 3.1), loops by multipliers f (8.5), with rates u and the gaps' drift g:
[M J^T; J 0] [u'; -f] = [Q - h; -g]. Written with numpy for any of its numbers, as a script has it;
nothing of it is mechkin's kernel.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from benchmarks.closure import solved
from mechkin_cli.mechanism.model import Mechanism, RigidLink

GROUND = -1


class Carried(NamedTuple):
    """A hinge R or slide P as drawn, what it hangs on (its number), and the link that it carries
    (None between two joints of one pair)."""

    joint: str
    kind: str
    parent: int
    link: str | None


class Ball(NamedTuple):
    """A ball that closes a loop: its joint, and the numbers of the joints that carry both links."""

    joint: str
    first: int
    second: int


class _Body(NamedTuple):
    mass: Any
    centre: Any
    inertia: Any


class _Moving(NamedTuple):
    """Of all links: rotation, and place of what is drawn at the origin; angular velocity; at
    constant rates, angular acceleration, and acceleration of what is drawn at the origin."""

    turned: list[Any]
    place: list[Any]
    spin: list[Any]
    turn: list[Any]
    fall: list[Any]


class Tree:
    """A mechanism's open tree and its balls.

    Args:
        mechanism: its geometry, masses and gravity.
        carried: hinges and slides, each after what it hangs on.
        efforts: constant, one for each.
        balls: what closes loops.
        kind: the number that everything is counted in.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        carried: Sequence[Carried],
        efforts: Sequence[float],
        balls: Sequence[Ball] = (),
        kind: type = np.float64,
    ) -> None:
        self.mechanism, self.carried, self.kind = mechanism, carried, kind
        self.balls = balls
        self.efforts: Any = np.array(efforts, kind)
        frames = [mechanism.joints[c.joint].on_first for c in carried]
        self.axes: list[Any] = [np.array(f.z, kind) for f in frames]
        self.points: list[Any] = [np.array(f.o, kind) for f in frames]
        self.bodies = [self._body(c.link) for c in carried]
        self.gravity: Any = np.array(mechanism.gravity, kind)
        self.above = [self._above(k) for k in range(len(carried))]
        self.ends = [self._ends(ball) for ball in balls]

    def rates(self, q: Any, u: Any) -> Any:
        """Second derivatives of the coordinates (joints,) at coordinates and rates (joints,)."""
        size = len(self.carried)
        moving = self._moving(q, u)
        columns = self._columns(moving)
        matrix: Any = np.zeros((size, size), self.kind)
        right = self.efforts.copy()
        for k, body in enumerate(self.bodies):
            if body is None:
                continue
            arm = moving.turned[k] @ body.centre
            linear, angular = self._jacobian(k, moving.place[k] + arm, columns)
            inertia = moving.turned[k] @ body.inertia @ moving.turned[k].T
            spin, turn = moving.spin[k], moving.turn[k]
            fall = moving.fall[k] + _carried(spin, turn, arm)
            matrix += body.mass * (linear.T @ linear) + angular.T @ inertia @ angular
            right += linear.T @ (body.mass * (self.gravity - fall))
            right -= angular.T @ (inertia @ turn + np.cross(spin, inertia @ spin))
        if not self.balls:
            return self.solve(matrix, right)
        rows, drift = self._closed(moving, columns)
        none: Any = np.zeros((len(drift), len(drift)), self.kind)
        whole = np.block([[matrix, rows.T], [rows, none]])
        return self.solve(whole, np.concatenate([right, -drift]))[:size]

    def gap(self, q: Any) -> Any:
        """By how much the balls are open (3 balls,)."""
        moving = self._moving(q, np.zeros_like(q))
        return np.concatenate([one - other for one, other in self._pairs(moving)])

    def columns(self, q: Any) -> Any:
        """Derivatives of the gap by the coordinates (3 balls, joints)."""
        moving = self._moving(q, np.zeros_like(q))
        return self._closed(moving, self._columns(moving))[0]

    def solve(self, matrix: Any, right: Any) -> Any:
        """A square system (n, n) with its right side (n,)."""
        if self.kind is np.float64:
            return np.linalg.solve(matrix, right)
        return solved(matrix[None], right[None])[0]

    def _moving(self, q: Any, u: Any) -> _Moving:
        found = _Moving([], [], [], [], [])
        none: Any = np.zeros(3, self.kind)
        for k, one in enumerate(self.carried):
            at = one.parent
            root = at == GROUND
            turned = np.eye(3, dtype=self.kind) if root else found.turned[at]
            place, spin, turn, fall = (none if root else part[at] for part in found[1:])
            axis, point = turned @ self.axes[k], self.points[k]
            # the joint's point on the link before, and its acceleration
            arm = turned @ point
            falls = fall + _carried(spin, turn, arm)
            if one.kind == "R":
                found.turned.append(_turn(axis, q[k]) @ turned)
                found.spin.append(spin + axis * u[k])
                found.turn.append(turn + np.cross(spin, axis * u[k]))
                back = found.turned[k] @ point
                found.place.append(place + arm - back)
                found.fall.append(falls - _carried(found.spin[k], found.turn[k], back))
                continue
            found.turned.append(turned)
            found.spin.append(spin)
            found.turn.append(turn)
            found.place.append(place + axis * q[k])
            shift = _carried(spin, turn, axis * q[k]) + 2 * np.cross(spin, axis * u[k])
            found.fall.append(fall + shift)
        return found

    def _columns(self, moving: _Moving) -> list[tuple[str, Any, Any]]:
        """Kind, axis and a point of each joint where it stands."""
        found = []
        for k, one in enumerate(self.carried):
            turned, place = moving.turned[k], moving.place[k]
            found.append((one.kind, turned @ self.axes[k], place + turned @ self.points[k]))
        return found

    def _jacobian(self, link: int, at: Any, columns: list[tuple[str, Any, Any]]) -> tuple[Any, Any]:
        """Velocity of a place on a link and its angular velocity by the rates (3, joints)."""
        linear: Any = np.zeros((3, len(self.carried)), self.kind)
        angular: Any = np.zeros_like(linear)
        for k in self.above[link] if link != GROUND else ():
            kind, axis, point = columns[k]
            if kind == "R":
                angular[:, k] = axis
                linear[:, k] = np.cross(axis, at - point)
            else:
                linear[:, k] = axis
        return linear, angular

    def _pairs(self, moving: _Moving) -> list[tuple[Any, Any]]:
        def placed(link: int, point: Any) -> Any:
            return point if link == GROUND else moving.place[link] + moving.turned[link] @ point

        return [(placed(*one), placed(*other)) for one, other in self.ends]

    def _closed(self, moving: _Moving, columns: list[tuple[str, Any, Any]]) -> tuple[Any, Any]:
        """Derivatives of the gaps (3 balls, joints), and their accelerations at constant rates."""
        rows, drift = [], []
        for ends, places in zip(self.ends, self._pairs(moving), strict=True):
            parts = []
            for (link, _), place in zip(ends, places, strict=True):
                linear, _ = self._jacobian(link, place, columns)
                fall: Any = np.zeros(3, self.kind)
                if link != GROUND:
                    arm = place - moving.place[link]
                    fall = moving.fall[link] + _carried(moving.spin[link], moving.turn[link], arm)
                parts.append((linear, fall))
            rows.append(parts[0][0] - parts[1][0])
            drift.append(parts[0][1] - parts[1][1])
        return np.concatenate(rows), np.concatenate(drift)

    def _body(self, name: str | None) -> _Body | None:
        link: RigidLink | None = None if name is None else self.mechanism.links[name]
        if link is None or not link.has_mass:
            return None
        xx, yy, zz, xy, xz, yz = link.inertia
        tensor: Any = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], self.kind)
        return _Body(self.kind(link.mass), np.array(link.center_of_mass, self.kind), tensor)

    def _ends(self, ball: Ball) -> list[tuple[int, Any]]:
        joint = self.mechanism.joints[ball.joint]
        places = ((ball.first, joint.on_first.o), (ball.second, joint.on_second.o))
        return [(link, np.array(place, self.kind)) for link, place in places]

    def _above(self, k: int) -> list[int]:
        found = [k]
        while self.carried[found[-1]].parent != GROUND:
            found.append(self.carried[found[-1]].parent)
        return found


def _carried(spin: Any, turn: Any, arm: Any) -> Any:
    """The acceleration of a place against another on the same link."""
    return np.cross(turn, arm) + np.cross(spin, np.cross(spin, arm))


def _turn(axis: Any, angle: Any) -> Any:
    """The rotation about a unit axis (O. Rodrigues, 1840)."""
    x, y, z = axis
    zero = axis[0] * 0
    cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]])
    turned: Any = np.eye(3, dtype=axis.dtype) + np.sin(angle) * cross
    return turned + (1 - np.cos(angle)) * (cross @ cross)
