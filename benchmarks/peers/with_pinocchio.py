"""Pinocchio: its kinematics of the open chain, the loops closed here by Newton's method.

Placements, Jacobians and accelerations of joints are the library's; the closing equations and the
small systems are numpy's, row by row, as a script has it. Each row starts from the row before.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from benchmarks.closure import named_motion
from mechkin_cli.bench.chain import (
    EQUATIONS,
    GROUND,
    CommonFrame,
    CommonPoint,
    Distance,
    TreeDisplacement,
)
from mechkin_cli.bench.measurement import Method
from mechkin_cli.bench.methods import RowByRow

if TYPE_CHECKING:
    from mechkin_cli.bench.chain import Place
    from mechkin_cli.bench.scene import BenchScene, Values
    from mechkin_cli.mechanism.vectors import Frame
    from mechkin_cli.show import Floats

FAMILY = "Pinocchio"
STEPS = (1, 2, 3, 4)


def methods(scene: BenchScene) -> Iterator[Method]:
    """Newton's method over its steps, and the whole motion."""
    loops = Loops(import_module("pinocchio"), RowByRow(scene))
    for steps in STEPS:
        call = partial(loops.sweep, steps, moving=False)
        name, count = "Newton on its Jacobians", scene.rows
        yield Method(FAMILY, name, str(steps), "position", call, count, call, slow=True)
    call = partial(loops.sweep, STEPS[-1], moving=True)
    name, setting = "Newton and rates", str(STEPS[-1])
    yield Method(FAMILY, name, setting, "motion", call, scene.rows, call, slow=True)


class Spot(NamedTuple):
    """A point or frame on a joint's moving side: the joint, and the place there."""

    joint: int
    frame: Any


class Here(NamedTuple):
    """Place, velocity Jacobian (3, velocities) or angular and linear (6, velocities)."""

    place: Any
    jacobian: Any


class Loops:
    """A scene's chain as a model of the library, with its closings."""

    def __init__(self, pin: Any, rows: RowByRow) -> None:
        self.pin, self.rows, self.chain = pin, rows, rows.chain
        self.model = pin.Model()
        self.first: dict[int, int] = {}
        self.bodies: list[Spot | None] = []
        for body in self.chain.bodies:
            self.bodies.append(None if body is None else self._carried(body.parent, body.by))
        ends = [c for c in self.chain.closings if isinstance(c, CommonFrame)]
        self.ends = {id(c): self._frame_ends(c) for c in ends}
        self.data = self.model.createData()
        self.unknowns = [self._velocity(k) for k in rows.unknowns]
        self.driven = [self._velocity(k) for k in rows.driven]

    def _spot(self, body: int) -> Spot:
        if body == GROUND:
            return Spot(0, self.pin.SE3.Identity())
        spot = self.bodies[body]
        assert spot is not None
        return spot

    def _carried(self, parent: int, by: TreeDisplacement) -> Spot:
        """The joint of a displacement, and the drawing of what it carries in the joint's frame."""
        joint = self._joint(self._spot(parent), by)
        return Spot(joint.joint, joint.frame * self._se3(by.after).inverse())

    def _joint(self, on: Spot, by: TreeDisplacement) -> Spot:
        pin, place = self.pin, on.frame * self._se3(by.before)
        kinds = {
            "R": [pin.JointModelRZ],
            "P": [pin.JointModelPZ],
            "H": [partial(pin.JointModelHZ, by.pitch)],
            "C": [pin.JointModelRZ, pin.JointModelPZ],
            "S": [pin.JointModelSpherical],
            "W": [],
        }[by.kind]
        joint = on.joint
        for kind in kinds:
            joint = self.model.addJoint(joint, kind(), place, f"{self.model.njoints}")
            place = pin.SE3.Identity()
            size = 3 if by.kind == "S" else 1
            start = self.model.joints[joint].idx_v
            for local in range(size):
                self.first[by.first + local + (kind is kinds[-1] and len(kinds) - 1)] = (
                    start + local
                )
        return Spot(joint, place)

    def _frame_ends(self, closing: CommonFrame) -> tuple[Spot, Spot]:
        one = self._spot(closing.first)
        for by in closing.chain[:-1]:
            behind = self._joint(one, by)
            one = Spot(behind.joint, behind.frame * self._se3(by.after).inverse())
        last = closing.chain[-1]
        two = self._spot(closing.second)
        return self._joint(one, last), Spot(two.joint, two.frame * self._se3(last.after))

    def _se3(self, frame: Frame) -> Any:
        return self.pin.SE3(np.column_stack([frame.x, frame.y, frame.z]), np.array(frame.o))

    def _velocity(self, coordinate: int) -> int:
        if coordinate not in self.first:  # the slide of a leg, which has no joint here
            return -1
        return self.first[coordinate]

    def sweep(self, steps: int, *, moving: bool) -> Values:
        """All rows; positions, or the whole motion."""
        rows, model = self.rows, self.model
        q, last = self._start(), rows.inputs[:, 0]
        found = np.repeat(rows.start[:, None], rows.inputs.shape[1], axis=1)
        rates, accelerations = np.zeros_like(found), np.zeros_like(found)
        orientations = []
        for row in range(rows.inputs.shape[1]):
            given = rows.inputs[:, row]
            move = np.zeros(model.nv)
            self._drive(move, given - last)
            last = given
            q = self.pin.integrate(model, q, move)
            for _ in range(steps):
                gap, columns = self.closed(q, given)
                step = np.zeros(model.nv)
                step[self.unknowns] = _solved(columns[:, self.unknowns], -gap)
                q = self.pin.integrate(model, q, step)
            found[:, row], turned = self._coordinates(q, given)
            orientations.append(turned)
            if moving:
                both = self._moved(q, row)
                for k, at in self.first.items():
                    rates[k, row], accelerations[k, row] = both[0][at], both[1][at]
                for ball in rows.turned:
                    # the library's are components of the angular acceleration on the second body,
                    # the chain's second derivatives of three turns one after the other
                    a, b, c = rates[ball : ball + 3, row]
                    accelerations[ball : ball + 3, row] -= (b * c, -a * c, a * b)
        if moving:
            return named_motion(rows, found, orientations, rates, accelerations)
        return rows.named(found, orientations)

    def _drive(self, velocity: Floats, values: Floats) -> None:
        for at, value in zip(self.driven, values, strict=True):
            if at >= 0:
                velocity[at] = value

    def _start(self) -> Any:
        """The configuration of the first row."""
        q = self.pin.neutral(self.model)
        move = np.zeros(self.model.nv)
        for k, at in self.first.items():
            move[at] = self.rows.start[k]
        for ball, matrix in self.rows.turned.items():
            move[self.first[ball] : self.first[ball] + 3] = self.pin.log3(np.array(matrix))
        return self.pin.integrate(self.model, q, move)

    def _coordinates(self, q: Any, given: Floats) -> tuple[Floats, dict[int, Any]]:
        """As the chain counts them."""
        found, turned = self.rows.start.copy(), {}
        for k, at in self.first.items():
            joint = int(np.searchsorted(self.model.idx_vs, at, side="right")) - 1
            if self.model.nvs[joint] == 1:
                found[k] = q[self.model.idx_qs[joint]]
        for ball in self.rows.turned:
            at = self.first[ball]
            joint = int(np.searchsorted(self.model.idx_vs, at, side="right")) - 1
            place = self.model.idx_qs[joint]
            turned[ball] = self.pin.Quaternion(q[place : place + 4]).matrix()
        found[self.rows.driven] = given
        return found, turned

    def closed(self, q: Any, given: Floats) -> tuple[Any, Any]:
        """Gaps (equations,) and their Jacobian (equations, velocities)."""
        self.pin.computeJointJacobians(self.model, self.data, q)
        gaps: list[Any] = []
        columns: list[Any] = []
        for closing in self.chain.closings:
            if isinstance(closing, CommonFrame):
                one, two = (self._frame(spot) for spot in self.ends[id(closing)])
                turn = self.pin.log3(one.place.rotation @ two.place.rotation.T)
                gaps.append(np.concatenate([turn, one.place.translation - two.place.translation]))
                columns.append(one.jacobian - two.jacobian)
                continue
            one, two = self._points(closing)
            apart, moving = one.place - two.place, one.jacobian - two.jacobian
            if isinstance(closing, CommonPoint):
                gaps.append(apart)
                columns.append(moving)
                continue
            wanted = closing.length + closing.sign * self._slide(closing, given)
            gaps.append([(apart @ apart - wanted * wanted) / (2.0 * closing.length)])
            columns.append((apart @ moving)[None, :] / closing.length)
        return np.concatenate(gaps), np.concatenate(columns)

    def _slide(self, closing: Distance, given: Floats) -> float:
        if closing.slide is None:
            return 0.0
        return float(given[self.rows.driven.index(closing.slide)])

    def _points(self, closing: Any) -> tuple[Here, Here]:
        return self._point(closing.first, closing.on_first), self._point(
            closing.second, closing.on_second
        )

    def _jacobian(self, joint: int) -> Any:
        return self.pin.getJointJacobian(self.model, self.data, joint, self.pin.LOCAL_WORLD_ALIGNED)

    def _point(self, body: int, at: Place) -> Here:
        spot = self._spot(body)
        if spot.joint == 0:
            return Here(spot.frame.act(np.array(at)), np.zeros((3, self.model.nv)))
        place = self.data.oMi[spot.joint]
        arm = place.rotation @ spot.frame.act(np.array(at))
        jacobian = self._jacobian(spot.joint)
        return Here(place.translation + arm, jacobian[:3] - self.pin.skew(arm) @ jacobian[3:])

    def _frame(self, spot: Spot) -> Here:
        """The Jacobian has angular rows first."""
        if spot.joint == 0:
            return Here(spot.frame, np.zeros((6, self.model.nv)))
        place = self.data.oMi[spot.joint]
        arm, jacobian = place.rotation @ spot.frame.translation, self._jacobian(spot.joint)
        linear = jacobian[:3] - self.pin.skew(arm) @ jacobian[3:]
        return Here(place * spot.frame, np.concatenate([jacobian[3:], linear]))

    def _moved(self, q: Any, row: int) -> tuple[Floats, Floats]:
        """Velocities and accelerations (velocities,) of all joints."""
        rows, given = self.rows, self.rows.inputs[:, row]
        _, columns = self.closed(q, given)
        inner = columns[:, self.unknowns]
        first, second = np.zeros(self.model.nv), np.zeros(self.model.nv)
        self._drive(first, rows.rates[:, row])
        first[self.unknowns] = _solved(inner, -(columns @ first) - self._legs(row, given)[0])
        self._drive(second, rows.accelerations[:, row])
        self.pin.forwardKinematics(self.model, self.data, q, first, second)
        drift = self._drift(given) + self._legs(row, given)[1]
        second[self.unknowns] = _solved(inner, -drift)
        return first, second

    def _legs(self, row: int, given: Floats) -> tuple[Floats, Floats]:
        """What driven slides of legs add to the equations' first and second derivatives."""
        found = np.zeros((2, self.chain.equations))
        place = 0
        for closing in self.chain.closings:
            if isinstance(closing, Distance) and closing.slide is not None:
                k, sign, length = (
                    self.rows.driven.index(closing.slide),
                    closing.sign,
                    closing.length,
                )
                w = length + sign * given[k]
                rate, second = self.rows.rates[k, row], self.rows.accelerations[k, row]
                found[0, place] = -w * sign * rate / length
                found[1, place] = -(rate * rate + w * sign * second) / length
            place += EQUATIONS[type(closing)]
        return found[0], found[1]

    def _drift(self, given: Floats) -> Any:
        """Second derivatives of the equations, but for those of driven slides."""
        found: list[Any] = []
        for closing in self.chain.closings:
            if isinstance(closing, CommonFrame):
                one, two = (
                    self._acceleration(s.joint, s.frame.translation) for s in self.ends[id(closing)]
                )
                found.append(np.concatenate([one[2] - two[2], one[1] - two[1]]))
                continue
            ends = ((closing.first, closing.on_first), (closing.second, closing.on_second))
            spots = [(self._spot(body), at) for body, at in ends]
            one, two = (self._acceleration(s.joint, s.frame.act(np.array(at))) for s, at in spots)
            if isinstance(closing, CommonPoint):
                found.append(one[1] - two[1])
                continue
            places = [self._point(body, at).place for body, at in ends]
            apart, rate = places[0] - places[1], one[0] - two[0]
            found.append([(rate @ rate + apart @ (one[1] - two[1])) / closing.length])
        return np.concatenate(found)

    def _acceleration(self, joint: int, local: Any) -> tuple[Any, Any, Any]:
        """Velocity and acceleration of a point of a joint's frame, and the angular acceleration."""
        if joint == 0:
            return np.zeros(3), np.zeros(3), np.zeros(3)
        pin, frame = self.pin, self.pin.LOCAL_WORLD_ALIGNED
        arm = self.data.oMi[joint].rotation @ local
        velocity = pin.getVelocity(self.model, self.data, joint, frame)
        second = pin.getClassicalAcceleration(self.model, self.data, joint, frame)
        w, alpha = velocity.angular, second.angular
        across = np.cross(w, arm)
        at = second.linear + np.cross(alpha, arm) + np.cross(w, across)
        return velocity.linear + across, at, alpha


def _solved(matrix: Any, right: Any) -> Any:
    if matrix.shape[0] == matrix.shape[1]:
        return np.linalg.solve(matrix, right)
    return np.linalg.lstsq(matrix, right, rcond=None)[0]
