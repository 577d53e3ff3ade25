"""Accelerations of all links from dense Newton-Euler equations, and states that meet the joints.

With V the velocities of all links (of the mass centre, angular), F forces and couples less the
gyroscopic ones, G the Jacobian of what the joints hold:

    [M  G^T] [V']     [   F    ]
    [G   0 ] [-f]  =  [a - bias]

a is the second rate of what is held: zero, or that of the law which drives a coordinate. Where the
constraints repeat each other, an orthonormal basis of their rows stands in G.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from oracle.dynamics.drawn import Drawn
from oracle.dynamics.loads import Place, Pull
from oracle.dynamics.rows import Array, Posture

Course = Callable[[float], tuple[float, float, float]]
"""Value, rate and acceleration of a driven coordinate at a time."""

_DEPENDENT = 1e-9
_ENOUGH = 3e-15
_WIDTH = 13


class Motion:
    """A mechanism that moves by itself.

    A state holds 13 numbers a link (mass centre, quaternion, velocity, angular velocity) and the
    work of all loads without a potential.
    """

    def __init__(
        self, drawn: Drawn, loads: list[Pull], driven: Mapping[str, Course] | None = None
    ) -> None:
        self.drawn, self.loads = drawn, loads
        self.driven = dict(driven or {})
        self.links = len(drawn.names)
        held = [terms for sums in drawn.limits.values() for terms in sums]
        self.joints = len(held)
        held += [drawn.coordinates[name] for name in self.driven]
        self.held = drawn.matrix(held)
        self.counted = drawn.matrix(list(drawn.coordinates.values()))
        self.turns = np.zeros(drawn.relations.count)
        self.rank: int | None = None
        self.scales = np.tile([drawn.size] * 3 + [1.0] * 3, self.links)
        self.evaluations = 0

    # states

    def home(self) -> Array:
        """The state at rest as drawn."""
        one = np.zeros((self.links, _WIDTH))
        one[:, :3] = self.drawn.centre[:-1]
        one[:, 3] = 1.0
        return np.append(one.ravel(), 0.0)

    def posture(self, state: Array) -> Posture:
        one = state[:-1].reshape(self.links, _WIDTH)
        rest = np.zeros((1, 3))
        R = np.concatenate([_matrices(one[:, 3:7]), np.eye(3)[None]])
        x, v, w = (np.concatenate([one[:, k : k + 3], rest]) for k in (0, 7, 10))
        return Posture(x, R, v, w)

    def keep_turns(self, state: Array) -> None:
        """Count whole turns on from this state."""
        self.turns = self.relations(state)

    def relations(self, state: Array) -> Array:
        first = len(self.drawn.relations.angle) + len(self.drawn.relations.gap)
        return self.drawn.relations.values(self.posture(state), self.turns[first:])

    def residual(self, time: float, state: Array) -> Array:
        """What joints and laws miss: lengths in parts of the size."""
        found = self.held @ self.relations(state)
        found[self.joints :] -= [course(time)[0] for course in self.driven.values()]
        return found

    def close(
        self, time: float, state: Array, wanted: Mapping[str, float], tries: int = 50
    ) -> Array:
        """The nearest state that meets the joints, the laws and wanted values of coordinates."""
        names = list(self.drawn.coordinates)
        extra = np.array([self.counted[names.index(name)] for name in wanted])
        for _ in range(tries):
            miss = self.residual(time, state)
            G = self.held @ self.drawn.relations.jacobian(self.posture(state))
            if wanted:
                values = extra @ self.relations(state) - list(wanted.values())
                miss = np.append(miss, values)
                G = np.vstack([G, extra @ self.drawn.relations.jacobian(self.posture(state))])
            step = -np.linalg.lstsq(G * self.scales, miss, rcond=_DEPENDENT)[0]
            largest = np.max(np.abs(step))
            state = self.moved(state, step * self.scales * min(1.0, 0.4 / max(largest, 1e-300)))
            self.keep_turns(state)
            if largest < 1e-14:
                break
        return state

    def rates(self, time: float, state: Array, wanted: Mapping[str, float]) -> Array:
        """The state with the velocities that the laws and rates of coordinates determine."""
        names = list(self.drawn.coordinates)
        extra = self.drawn.matrix([self.drawn.coordinates[name] for name in wanted])
        J = self.drawn.relations.jacobian(self.posture(state))
        right = [0.0] * self.joints + [course(time)[1] for course in self.driven.values()]
        right += list(wanted.values())
        assert set(wanted) <= set(names)
        G = np.vstack([self.held, extra]) @ J
        V, _, rank, _ = np.linalg.lstsq(G * self.scales, np.array(right), rcond=_DEPENDENT)
        assert rank == G.shape[1], "the rates do not determine the motion"
        state = state.copy()
        state[:-1].reshape(self.links, _WIDTH)[:, 7:] = (V * self.scales).reshape(self.links, 6)
        return state

    def moved(self, state: Array, step: Array) -> Array:
        """The state after small shifts and turns of all links."""
        state = state.copy()
        one = state[:-1].reshape(self.links, _WIDTH)
        by_link = step.reshape(self.links, 6)
        one[:, :3] += by_link[:, :3]
        one[:, 3:7] += _spun(one[:, 3:7], by_link[:, 3:])
        one[:, 3:7] /= np.sqrt(np.sum(one[:, 3:7] ** 2, axis=1))[:, None]
        return state

    def projected(self, time: float, state: Array) -> Array:
        """The nearest state that meets the joints and the laws, in place and in velocity."""
        one = state[:-1].reshape(self.links, _WIDTH)
        one[:, 3:7] /= np.sqrt(np.sum(one[:, 3:7] ** 2, axis=1))[:, None]
        J = self.drawn.relations.jacobian(self.posture(state))
        back = np.linalg.pinv((self.held @ J) * self.scales, rcond=_DEPENDENT)
        miss = self.residual(time, state)
        if np.max(np.abs(miss), initial=0.0) > _ENOUGH * self.drawn.size:
            state = self.moved(state, -(back @ miss) * self.scales)
            J = self.drawn.relations.jacobian(self.posture(state))
        state = state.copy()
        V = state[:-1].reshape(self.links, _WIDTH)[:, 7:]
        right = np.zeros(len(self.held))
        right[self.joints :] = [course(time)[1] for course in self.driven.values()]
        V -= ((back @ (self.held @ J @ V.ravel() - right)) * self.scales).reshape(self.links, 6)
        return state

    # equations of motion

    def place(self, time: float, state: Array) -> Place:
        """What loads read."""
        at = self.posture(state)
        J = self.counted @ self.drawn.relations.jacobian(at)
        V = np.hstack([at.v, at.w])[:-1].ravel()
        rows = dict(zip(self.drawn.coordinates, J, strict=True))
        values = dict(zip(rows, self.counted @ self.relations(state), strict=True))

        def quantity(name: str) -> float:
            if name == "time":
                return time
            if name in values:
                return float(values[name])
            if name.endswith("_dot") and name[:-4] in rows:
                return float(rows[name[:-4]] @ V)
            return self._of_link(at, name)

        return Place(at, quantity, rows)

    def _of_link(self, at: Posture, name: str) -> float:
        owner, word, component = name.split(".")
        k = "xyz".index(component)
        if word == "omega":
            return float(at.w[self.drawn.link(owner)][k])
        link, point = self.drawn.mechanism.points[owner]
        i = self.drawn.link(link)
        arm = at.R[i] @ (np.array(point, dtype=float) - self.drawn.centre[i])
        found = at.x[i] + arm if word == "position" else at.v[i] + np.cross(at.w[i], arm)
        return float(found[k])

    def accelerations(self, time: float, state: Array) -> tuple[Array, float]:
        """V' of all links, and the power of all loads that have no potential."""
        found, power, _ = self.solved(time, state)
        return found, power

    def solved(self, time: float, state: Array) -> tuple[Array, float, Array]:
        """V', the power as in `accelerations`, and the forces f (held,); nan where these are not
        unique."""
        self.evaluations += 1
        drawn, place = self.drawn, self.place(time, state)
        at, n = place.posture, 6 * self.links
        J = drawn.relations.jacobian(at)
        G = self.held @ J
        right = -(self.held @ drawn.relations.bias(at))
        right[self.joints :] += [course(time)[2] for course in self.driven.values()]
        if self.rank is None:
            self.rank = int(
                np.linalg.matrix_rank(G * self.scales, tol=_DEPENDENT * self.drawn.size)
            )
        if self.rank < len(G):
            U, S, W = np.linalg.svd(G * self.scales, full_matrices=False)
            U, S, W = U[:, : self.rank], S[: self.rank], W[: self.rank]
            G, right = W / self.scales, (U.T @ right) / S
        tensors = at.R @ drawn.inertia @ at.R.transpose(0, 2, 1)
        force, power = self._forces(place)
        spin = np.einsum("kij,kj->ki", tensors, at.w)
        force[:, 3:] -= np.cross(at.w, spin)
        matrix = np.zeros((n + len(G), n + len(G)))
        for k in range(self.links):
            i = 6 * k
            matrix[range(i, i + 3), range(i, i + 3)] = drawn.mass[k]
            matrix[i + 3 : i + 6, i + 3 : i + 6] = tensors[k]
        matrix[n:, :n] = G
        matrix[:n, n:] = G.T
        found = np.linalg.solve(matrix, np.concatenate([force[:-1].ravel(), right]))
        unique = self.rank == len(self.held)
        return found[:n], power, -found[n:] if unique else np.full(len(self.held), np.nan)

    def reactions(self, time: float, state: Array) -> dict[str, tuple[Array, Array]]:
        """Force and moment about the joint point that each joint's first link exerts on the second,
        without what drives it or loads its coordinates."""
        forces = self.solved(time, state)[2]
        at = self.posture(state)
        G = self.held @ self.drawn.relations.jacobian(at)
        found, k = {}, 0
        for name, joint in self.drawn.mechanism.joints.items():
            rows = slice(k, k + len(self.drawn.limits[name]))
            k = rows.stop
            wrenches = (forces[rows] @ G[rows]).reshape(-1, 6)
            i, j = self.drawn.link(joint.first), self.drawn.link(joint.second)
            of, sign = (j, 1.0) if j < self.links else (i, -1.0)
            force, couple = sign * wrenches[of, :3], sign * wrenches[of, 3:]
            side = 0 if joint.type in ("Sp", "Sg") else 1
            link = (i, j)[side]
            arm = np.array(joint.points[side], dtype=float) - self.drawn.centre[link]
            place = at.x[link] + at.R[link] @ arm
            found[name] = force, couple + np.cross(at.x[of] - place, force)
        return found

    def _forces(self, place: Place) -> tuple[Array, float]:
        at = place.posture
        force, power = np.zeros((self.links + 1, 6)), 0.0
        for load in self.loads:
            for k, f, m in load.apply(place):
                force[k, :3] += f
                force[k, 3:] += m
                if load.energy is None:
                    power += float(f @ at.v[k] + m @ at.w[k])
        return force, power

    def rate(self, time: float, state: Array) -> Array:
        """The state's derivative by time."""
        V, power = self.accelerations(time, state)
        return self.moving(state, V, power)

    def moving(self, state: Array, V: Array, power: float) -> Array:
        """The derivative of a state with accelerations V and a power."""
        one = state[:-1].reshape(self.links, _WIDTH)
        found = np.empty_like(one)
        found[:, :3] = one[:, 7:10]
        found[:, 3:7] = _spun(one[:, 3:7], one[:, 10:])
        found[:, 7:] = V.reshape(self.links, 6)
        return np.append(found.ravel(), power)

    def energies(self, time: float, state: Array) -> tuple[float, float]:
        """Kinetic and potential energy."""
        place = self.place(time, state)
        at, drawn = place.posture, self.drawn
        local = np.einsum("kji,kj->ki", at.R, at.w)
        spin = np.einsum("ki,kij,kj->", local, drawn.inertia, local)
        kinetic = (float(np.sum(drawn.mass * np.sum(at.v**2, axis=1))) + float(spin)) / 2
        return kinetic, sum(load.energy(place) for load in self.loads if load.energy)


def _matrices(q: Array) -> Array:
    """Rotations of quaternions of any length, scalar first."""
    s = 2 / np.sum(q * q, axis=1)
    a, b, c, d = q.T
    rows = [
        [1 - s * (c * c + d * d), s * (b * c - a * d), s * (b * d + a * c)],
        [s * (b * c + a * d), 1 - s * (b * b + d * d), s * (c * d - a * b)],
        [s * (b * d - a * c), s * (c * d + a * b), 1 - s * (b * b + c * c)],
    ]
    return np.array(rows).transpose(2, 0, 1)


def _spun(q: Array, w: Array) -> Array:
    """dq = 1/2 (0, w) q."""
    scalar = -np.einsum("ki,ki->k", w, q[:, 1:])[:, None]
    return np.hstack([scalar, w * q[:, :1] + np.cross(w, q[:, 1:])]) / 2
