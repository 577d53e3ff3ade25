"""Motions with Coulomb friction: joints that slip or stick, from event to event.

A joint's slip has components B V: slides of its surfaces, and turns times the radius. One that
slips is pushed by -B^T z d, with d the direction of its slip and z = mu N by fixed point from the
dense Newton-Euler equations; one that sticks holds B V' = -bias among the constraints. Events are
met by steps that end there. What rests on forces that are not unique is refused (`Undecided`).
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from oracle.document import document
from oracle.dynamics.integrate import Node
from oracle.dynamics.motion import Motion
from oracle.dynamics.response import prepare
from oracle.dynamics.rows import Array
from oracle.friction import rubbings, without_friction

_ROUNDS, _LONGEST = 400, 0.02
_ENDS = 1e-10
"""A slip of several components ends where it is as small as this, in m/s."""
_CLEAR = 1e-7
"""Accelerations, and forces beyond a limit, that tell."""


class Undecided(Exception):
    """Not told by this reference."""


@dataclass(frozen=True)
class Rub:
    """A joint that rubs: coefficients at rest and sliding, radius and lead per radian."""

    joint: str
    kind: str
    at_rest: float
    sliding: float
    radius: float
    lead: float


@dataclass
class Answer:
    """Accelerations, and by joint that rubs its normal load and its force along B's rows."""

    second: Array
    normal: list[float]
    force: list[Array]


class Rubbed:
    """A response of a document with friction, integrated by `run`."""

    def __init__(self, source: Any, name: str) -> None:
        data = document(source)
        self.response = prepare(without_friction(data), name)
        self.motion: Motion = self.response.motion
        self.rubs = []
        for each in rubbings(data):
            joint = self.response.mechanism.joints[each.joint]
            radius = float(each.lengths.get("radius", 0))
            lead = float(joint.lead or 0) / (2 * np.pi)
            at_rest, sliding = float(each.at_rest), float(each.sliding)
            self.rubs.append(Rub(each.joint, joint.type, at_rest, sliding, radius, lead))
        self.sense: list[float] = [1.0] * len(self.rubs)
        """0: sticks; else slips, along its one component with this sign."""
        self.events = 0
        self.quiet: set[int] = set()
        """Joints that start, with the coefficient of rest."""

    # slips

    def _frame(self, at: Any, rub: Rub) -> tuple[int, int, Array, Array]:
        """Links, the joint's point and its axis."""
        joint, drawn = self.response.mechanism.joints[rub.joint], self.motion.drawn
        i, j = drawn.link(joint.first), drawn.link(joint.second)
        side = 0 if rub.kind in ("Sp", "Sg") else 1
        link = (i, j)[side]
        arm = np.array(joint.points[side], dtype=float) - drawn.centre[link]
        axis = np.array(joint.axes[1] if joint.axes else [0, 0, 1], dtype=float)
        return i, j, at.x[link] + at.R[link] @ arm, at.R[j] @ axis

    def _slip(self, at: Any, rub: Rub) -> tuple[Array, Array]:
        """B, and its rate times V where the joint sticks."""
        i, j, p, z = self._frame(at, rub)
        e = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
        e /= np.linalg.norm(e)
        none, r = np.zeros(3), rub.radius
        size = np.hypot(rub.lead, r) or 1.0
        pairs = {
            "R": [(none, r * z)],
            "P": [(z, none)],
            "C": [(z, none), (none, r * z)],
            "H": [(rub.lead / size * z, r * r / size * z)],
            "S": [(none, r * axis) for axis in np.eye(3)],
            "Sp": [(e, none), (np.cross(z, e), none)],
            "Sg": [(z, none)],
        }[rub.kind]
        rows = np.zeros((len(pairs), self.motion.links + 1, 6))
        bias = np.zeros(len(pairs))
        for row, (force, couple) in enumerate(pairs):
            for link, sign in ((j, 1.0), (i, -1.0)):
                arm = p - at.x[link]
                rows[row, link, :3] += sign * force
                rows[row, link, 3:] += sign * (couple + np.cross(arm, force))
                w = at.w[link]
                bias[row] += sign * force @ np.cross(w, np.cross(w, arm))
        return rows[:, :-1].reshape(len(pairs), -1), bias

    def _normal(self, at: Any, rub: Rub, G: Array, forces: Array) -> float:
        drawn = self.motion.drawn
        first = 0
        for name, limits in drawn.limits.items():
            if name == rub.joint:
                rows = slice(first, first + len(limits))
            first += len(limits)
        i, j, p, z = self._frame(at, rub)
        of, sign = (j, 1.0) if j < self.motion.links else (i, -1.0)
        wrench = sign * (forces[rows] @ G[rows]).reshape(-1, 6)[of]
        force, moment = wrench[:3], wrench[3:] + np.cross(at.x[of] - p, wrench[:3])
        along = z @ force
        if rub.kind == "S":
            return float(np.linalg.norm(force))
        if rub.kind == "Sp":
            return float(abs(along))
        if rub.kind == "H":
            size = np.hypot(rub.lead, rub.radius)
            return float(abs(along * rub.radius - z @ moment * rub.lead / rub.radius) / size)
        return float(np.linalg.norm(force - along * z))

    # equations

    def _bordered(self, held: Array, tensors: Array) -> Array:
        """Masses and inertias with the rows that hold the links."""
        m = self.motion
        n = 6 * m.links
        matrix = np.zeros((n + len(held), n + len(held)))
        for k in range(m.links):
            i = 6 * k
            matrix[range(i, i + 3), range(i, i + 3)] = m.drawn.mass[k]
            matrix[i + 3 : i + 6, i + 3 : i + 6] = tensors[k]
        matrix[n:, :n], matrix[:n, n:] = held, held.T
        return matrix

    def solved(self, time: float, state: Array, aim: dict[int, Array] | None = None) -> Answer:
        """What follows from how the joints slip; `aim` are directions of slips that begin."""
        m = self.motion
        place = m.place(time, state)
        at, n = place.posture, 6 * m.links
        V = np.hstack([at.v, at.w])[:-1].ravel()
        G = m.held @ m.drawn.relations.jacobian(at)
        right = [-(m.held @ m.drawn.relations.bias(at))]
        slips = [self._slip(at, rub) for rub in self.rubs]
        sticks = [k for k, sense in enumerate(self.sense) if sense == 0.0]
        rows = [G, *(slips[k][0] for k in sticks)]
        right += [-slips[k][1] for k in sticks]
        held = np.vstack(rows)
        scaled = held * m.scales
        scaled = scaled / np.linalg.norm(scaled, axis=1)[:, None]
        if np.linalg.matrix_rank(scaled, tol=1e-8) < len(held):
            raise Undecided("forces are not unique")
        tensors = at.R @ m.drawn.inertia @ at.R.transpose(0, 2, 1)
        force, _ = m._forces(place)
        force[:, 3:] -= np.cross(at.w, np.einsum("kij,kj->ki", tensors, at.w))
        matrix = self._bordered(held, tensors)
        going = [k for k in range(len(self.rubs)) if k not in sticks]
        columns = [np.concatenate([force[:-1].ravel(), *right])]
        directions = {}
        for k in going:
            B = slips[k][0]
            slip = B @ V
            d = np.array([self.sense[k]]) if len(slip) == 1 else slip / np.linalg.norm(slip)
            directions[k] = aim[k] if aim and k in aim else d
            columns.append(np.concatenate([-B.T @ directions[k], np.zeros(len(held))]))
        parts = np.linalg.solve(matrix, np.array(columns).T)
        z = np.zeros(len(going))
        for _ in range(_ROUNDS):
            found = parts @ np.append(1.0, z)
            normal = [self._normal(at, rub, G, -found[n:]) for rub in self.rubs]
            new = np.array([self._coefficient(k) * normal[k] for k in going])
            change = np.max(np.abs(new - z), initial=0.0)
            z = new
            if change <= 1e-13 * max(np.max(z, initial=0.0), 1e-13):
                break
        else:
            raise Undecided("friction feeds itself")
        forces, first = [np.zeros(1)] * len(self.rubs), n + len(G)
        for k in sticks:
            count = len(slips[k][1])
            forces[k] = -found[first : first + count]
            first += count
        for number, k in enumerate(going):
            forces[k] = -z[number] * directions[k]
        return Answer(found[:n], normal, forces)

    def _coefficient(self, k: int) -> float:
        return self.rubs[k].at_rest if k in self.quiet else self.rubs[k].sliding

    def _slip_rate(self, state: Array, k: int) -> Array:
        at = self.motion.posture(state)
        V = np.hstack([at.v, at.w])[:-1].ravel()
        return np.asarray(self._slip(at, self.rubs[k])[0] @ V)

    def _values(self, time: float, state: Array) -> list[float]:
        """By joint: positive as long as it goes on as it does."""
        found, answer = [], None
        for k, rub in enumerate(self.rubs):
            if self.sense[k] == 0.0:
                answer = answer or self.solved(time, state)
                found.append(
                    rub.at_rest * answer.normal[k] - float(np.linalg.norm(answer.force[k]))
                )
                continue
            slip = self._slip_rate(state, k)
            single = len(slip) == 1
            size = float(np.linalg.norm(slip))
            found.append(self.sense[k] * float(slip[0]) if single else size - _ENDS)
        return found

    # events

    def _begin(self, time: float, state: Array) -> None:
        resting = []
        for k in range(len(self.rubs)):
            slip = self._slip_rate(state, k)
            if np.linalg.norm(slip) < 1e-12:
                resting.append(k)
            self.sense[k] = float(np.sign(slip[0])) if len(slip) == 1 else 1.0
        if resting:
            self._set_going(time, state, resting)

    def _set_going(self, time: float, state: Array, resting: list[int]) -> None:
        """The one way that holds of joints which stick or start, forth or back."""
        good = []
        choices = [
            (0.0, 1.0, -1.0) if len(self._slip_rate(state, k)) == 1 else (0.0,) for k in resting
        ]
        self.quiet = set(resting)
        for way in itertools.product(*choices):
            for k, sense in zip(resting, way, strict=True):
                self.sense[k] = sense
            try:
                answer = self.solved(time, state)
            except Undecided:
                continue
            at = self.motion.posture(state)
            holds = True
            for k in resting:
                B, bias = self._slip(at, self.rubs[k])
                limit = self.rubs[k].at_rest * answer.normal[k]
                beyond = limit - float(np.linalg.norm(answer.force[k]))
                going = self.sense[k] * float((B @ answer.second + bias)[0])
                margin = beyond if self.sense[k] == 0.0 else going
                if abs(margin) < _CLEAR:
                    raise Undecided("it may hold or not")
                holds = holds and margin > 0.0
            if holds:
                good.append(way)
        self.quiet = set()
        if len(good) != 1:
            raise Undecided(f"{len(good)} ways to start")
        for k, sense in zip(resting, good[0], strict=True):
            self.sense[k] = sense

    def _second(self, time: float, state: Array, k: int) -> float:
        """The derivative of a single slip."""
        answer = self.solved(time, state)
        at = self.motion.posture(state)
        B, bias = self._slip(at, self.rubs[k])
        return float((B @ answer.second + bias)[0])

    def _pass(self, time: float, state: Array, k: int) -> Array:
        """Joint k has come to rest, or is held no longer."""
        self.events += 1
        if self.sense[k] != 0.0:
            before, self.sense[k] = self.sense[k], 0.0
            state = self._held(state)
            answer = self.solved(time, state)
            force, limit = answer.force[k], self.rubs[k].at_rest * answer.normal[k]
            size = float(np.linalg.norm(force))
            if abs(size - limit) < _CLEAR * limit:
                raise Undecided("it may hold or not")
            if size < limit:
                return state
            if len(force) > 1:
                raise Undecided("a slip of several components turns")
            self.sense[k] = -float(np.sign(force[0]))
            if self.sense[k] == before or self._second(time, state, k) * self.sense[k] <= 0:
                raise Undecided("it jams")
            return state
        force = self.solved(time, state).force[k]
        if len(force) > 1:
            raise Undecided("a slip of several components begins")
        self.sense[k] = -float(np.sign(force[0]))
        jumps = self.rubs[k].at_rest != self.rubs[k].sliding
        if jumps and self._second(time, state, k) * self.sense[k] <= 0:
            raise Undecided("it jams")
        return state

    def _held(self, state: Array) -> Array:
        """The state without the slips of what sticks, by impulses of the joints."""
        m = self.motion
        at, n = m.posture(state), 6 * m.links
        tensors = at.R @ m.drawn.inertia @ at.R.transpose(0, 2, 1)
        rows = [m.held @ m.drawn.relations.jacobian(at)]
        rows += [
            self._slip(at, rub)[0]
            for rub, sense in zip(self.rubs, self.sense, strict=True)
            if sense == 0.0
        ]
        held = np.vstack(rows)
        matrix = self._bordered(held, tensors)
        V = np.hstack([at.v, at.w])[:-1].ravel()
        right = np.concatenate([np.zeros(n), -held @ V])
        change = np.linalg.lstsq(matrix, right, rcond=1e-13)[0][:n]
        state = state.copy()
        one = state[:-1].reshape(m.links, -1)
        one[:, 7:] += change.reshape(m.links, 6)
        return state

    # integration

    def _rate(self, time: float, state: Array) -> Array:
        return self.motion.moving(state, self.solved(time, state).second, 0.0)

    def _advanced(self, time: float, state: Array, step: float) -> Array:
        end, tolerance = time + step, self.tolerance
        solver = DOP853(
            self._rate, time, state, end, rtol=tolerance, atol=tolerance, first_step=end - time
        )
        while solver.status == "running":
            solver.step()
        if solver.status == "failed":
            raise ArithmeticError("no step")
        return self._held(self.motion.projected(time + step, solver.y))

    def run(self, tolerance: float = 1e-12) -> list[Node]:
        """Nodes at the response's times."""
        self.tolerance = tolerance
        m, times = self.motion, self.response.times
        m.turns = self.response.turns.copy()
        state = m.projected(times[0], self.response.start.copy())
        m.keep_turns(state)
        self._begin(times[0], state)
        nodes, time = [(state, m.turns)], times[0]
        for end in times[1:]:
            while time < end:
                step = min(_LONGEST, end - time)
                after = self._advanced(time, state, step)
                values = self._values(time + step, after)
                before = self._values(time, state)
                bad = [k for k, x in enumerate(values) if x < 0.0 and before[k] >= 0.0]
                if any(x < -1e-9 for x in before):
                    raise Undecided("another joint goes, too")
                if bad:
                    first, which = min((self._meets(time, state, step, k), k) for k in bad)
                    state = self._advanced(time, state, first) if first > 0.0 else state
                    time += first
                    state = self._pass(time, state, which)
                    # a slip that has just begun
                    after = self._advanced(time, state, 1e-7)
                    time, state = time + 1e-7, after
                else:
                    time, state = time + step, after
                m.keep_turns(state)
            time = end
            nodes.append((state, m.turns))
        return nodes

    def _meets(self, time: float, state: Array, step: float, k: int) -> float:
        def value(part: float) -> float:
            if part == 0.0:
                return max(self._values(time, state)[k], 1e-300)
            return self._values(time + part, self._advanced(time, state, part))[k]

        return float(brentq(value, 0.0, step, xtol=1e-15, rtol=1e-14))
