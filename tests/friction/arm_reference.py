"""Planar arms of pins that rub, integrated from event to event: each body's own equations, dense.

Link k goes from its pin along its x axis; the pins' forces, the accelerations of the mass centres
and the couples of friction are one linear system, friction itself a fixed point of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

G = 9.80665
Floats = NDArray[np.float64]
Senses = tuple[int, ...]


@dataclass(frozen=True)
class Arm:
    """Links with a length, mass, way from pin to mass centre, moment of inertia about it; pins with
    a radius and coefficients; `push`: couples on the pins' second links as they grow in time."""

    length: Sequence[float]
    mass: Sequence[float]
    centre: Sequence[float]
    inertia: Sequence[float]
    radius: Sequence[float]
    static: Sequence[float]
    sliding: Sequence[float]
    push: Sequence[float] = field(default=())

    @property
    def count(self) -> int:
        """How many links."""
        return len(self.length)

    def solved(
        self, time: float, angle: Floats, rate: Floats, senses: Senses, quiet: Sequence[bool]
    ) -> tuple[Floats, Floats, Floats]:
        """Accelerations of the relative angles, couples of friction on the outer links and what the
        pins carry."""
        n = self.count
        normal = np.zeros(n)
        for _ in range(400):
            wanted = [
                -s * self._coefficient(k, quiet) * self.radius[k] * normal[k]
                for k, s in enumerate(senses)
            ]
            second, couple, force = self._balanced(time, angle, rate, senses, wanted)
            now = np.hypot(force[:, 0], force[:, 1])
            if np.max(np.abs(now - normal)) <= 1e-15 * np.max(now):
                break
            normal = now
        return second, couple, normal

    def _coefficient(self, k: int, quiet: Sequence[bool]) -> float:
        return self.static[k] if quiet[k] else self.sliding[k]

    def _balanced(
        self,
        time: float,
        angle: Floats,
        rate: Floats,
        senses: Senses,
        couples: Sequence[float],
    ) -> tuple[Floats, Floats, Floats]:
        """Unknown: absolute angular accelerations (n), pin forces on the outer link (2n), couples
        of friction on it (n)."""
        n = self.count
        phi, omega = np.cumsum(angle), np.cumsum(rate)
        a, b = np.zeros((4 * n, 4 * n)), np.zeros(4 * n)
        push = list(self.push) or [0.0] * n
        # accelerations of a point: linear in the angular ones, and a rest
        linear, rest = np.zeros((2, n)), np.zeros(2)
        for k in range(n):
            along = np.array([np.cos(phi[k]), np.sin(phi[k])])
            across = np.array([-along[1], along[0]])
            centre, centre_rest = linear.copy(), rest - self.centre[k] * omega[k] ** 2 * along
            centre[:, k] += self.centre[k] * across
            at, to = n + 2 * k, n + 2 * (k + 1)
            for axis in range(2):
                a[2 * k + axis, :n] += self.mass[k] * centre[axis]
                a[2 * k + axis, at + axis] -= 1.0
                b[2 * k + axis] = -self.mass[k] * (centre_rest[axis] + G * (axis == 1))
            row = 2 * n + k
            arm, far = -self.centre[k] * along, (self.length[k] - self.centre[k]) * along
            a[row, k] = self.inertia[k]
            a[row, at], a[row, at + 1] = arm[1], -arm[0]
            a[row, 3 * n + k] = -1.0
            b[row] = push[k] * time
            if k + 1 < n:
                a[2 * k, to] += 1.0
                a[2 * k + 1, to + 1] += 1.0
                a[row, to], a[row, to + 1] = -far[1], far[0]
                a[row, 3 * n + k + 1] = 1.0
                b[row] -= push[k + 1] * time
            rest = rest - self.length[k] * omega[k] ** 2 * along
            linear = linear.copy()
            linear[:, k] += self.length[k] * across
            row = 3 * n + k
            if senses[k] == 0:
                a[row, k] = 1.0
                if k:
                    a[row, k - 1] = -1.0
            else:
                a[row, 3 * n + k] = 1.0
                b[row] = couples[k]
        x = np.linalg.solve(a, b)
        return np.diff(x[:n], prepend=0.0), x[3 * n :], x[n : 3 * n].reshape(n, 2)

    def holds(self, couple: Floats, normal: Floats, k: int) -> float:
        """What a pin that sticks has left."""
        return float(self.static[k] * self.radius[k] * normal[k] - abs(couple[k]))

    def settle(self, time: float, angle: Floats, rate: Floats, resting: Sequence[int]) -> Senses:
        """How pins at rest go on, the others as they slip."""
        known = [0 if k in resting else int(np.sign(rate[k])) for k in range(self.count)]
        quiet = [k in resting for k in range(self.count)]
        while True:
            still = [k for k in range(self.count) if known[k] == 0 and quiet[k]]
            found = []
            for tried in product((0, 1, -1), repeat=len(still)):
                senses = list(known)
                for k, s in zip(still, tried, strict=True):
                    senses[k] = s
                second, couple, normal = self.solved(time, angle, rate, tuple(senses), quiet)
                if all(
                    second[k] * senses[k] > 0 if senses[k] else self.holds(couple, normal, k) >= 0
                    for k in still
                ):
                    found.append(senses)
            assert len(found) == 1, found
            went = [k for k in still if found[0][k]]
            known = found[0]
            for k in went:
                quiet[k] = False
            if not any(self.static[k] != self.sliding[k] for k in went):
                return tuple(known)

    def integrated(self, angle: Sequence[float], rate: Sequence[float], times: Floats) -> Floats:
        """Angles and rates (2n, times)."""
        n = self.count
        y = np.array([*angle, *rate], dtype=float)
        senses = self.settle(times[0], y[:n], y[n:], [k for k in range(n) if y[n + k] == 0.0])
        rows, now = np.full((2 * n, times.size), np.nan), float(times[0])
        rows[:, 0] = y
        while now < times[-1]:
            asked = times[(times > now) & (times <= times[-1])]
            found = solve_ivp(
                self._slope(senses),
                (now, times[-1]),
                y,
                method="DOP853",
                rtol=1e-12,
                atol=1e-13,
                t_eval=asked,
                events=[self._event(k, senses, now) for k in range(n)],
                max_step=0.05,
            )
            for t, column in zip(found.t, np.transpose(found.y), strict=True):
                rows[:, np.searchsorted(times, t)] = column
            if found.status == 0:
                break
            met = [k for k in range(n) if found.t_events[k].size]
            now, y = float(found.t_events[met[0]][-1]), found.y_events[met[0]][-1].copy()
            for k in range(n):
                if senses[k] == 0 or k in met:
                    y[n + k] = 0.0
            breaking = [k for k in met if senses[k] == 0]
            if breaking:
                senses = self._broken(now, y, senses, breaking[0])
            else:
                senses = self.settle(now, y[:n], y[n:], [k for k in range(n) if y[n + k] == 0.0])
            now += 1e-14
        return rows

    def _slope(self, senses: Senses) -> Callable[[float, Floats], Floats]:
        n, none = self.count, [False] * self.count

        def slope(t: float, y: Floats) -> Floats:
            second, _, _ = self.solved(t, y[:n], y[n:], senses, none)
            return np.concatenate([y[n:], np.where(np.array(senses) == 0, 0.0, second)])

        return slope

    def _event(self, k: int, senses: Senses, since: float) -> Callable[[float, Floats], float]:
        """Falls through zero where a pin's slip ends, or friction holds it no longer."""
        n, none = self.count, [False] * self.count

        def value(t: float, y: Floats) -> float:
            if senses[k]:
                # a slip that begins is zero, to rounding
                return float(senses[k] * y[n + k]) + (1e-13 if t <= since + 1e-9 else 0.0)
            _, couple, normal = self.solved(t, y[:n], y[n:], senses, none)
            return self.holds(couple, normal, k)

        value.terminal, value.direction = True, -1  # type: ignore[attr-defined]
        return value

    def _broken(self, time: float, y: Floats, senses: Senses, which: int) -> Senses:
        """A pin that friction holds no longer, and what sticks beside it."""
        n = self.count
        _, couple, _ = self.solved(time, y[:n], y[n:], senses, [False] * n)
        changed = list(senses)
        changed[which] = -int(np.sign(couple[which]))
        while True:
            _, couple, normal = self.solved(time, y[:n], y[n:], tuple(changed), [False] * n)
            lost = [
                k for k in range(n) if changed[k] == 0 and self.holds(couple, normal, k) < -1e-12
            ]
            if not lost:
                return tuple(changed)
            changed[lost[0]] = -int(np.sign(couple[lost[0]]))

    def text(self, angle: Sequence[float], rate: Sequence[float], step: str, last: float) -> str:
        """The file of the arm, its pins J0, J1 ..."""
        links, joints, loads, start, efforts = [], [], [], [], []
        at, n = 0.0, self.count
        for k in range(n):
            centre = at + self.centre[k]
            i = self.inertia[k]
            links.append(
                f"  l{k}: {{mass: {self.mass[k]!r}, center_of_mass: [{centre!r}, 0, 0], "
                f"inertia: {{xx: {i!r}, yy: {i!r}, zz: {i!r}}}}}"
            )
            before = f"l{k - 1}" if k else "ground"
            joints.append(
                f"  J{k}: {{type: R, links: [{before}, l{k}], point: [{at!r}, 0, 0], "
                "axis: [0, 0, 1]}"
            )
            loads.append(
                f"  - {{type: friction, joint: J{k}, radius: {self.radius[k]!r}, "
                f"coefficient: {{static: {self.static[k]!r}, sliding: {self.sliding[k]!r}}}}}"
            )
            start.append(f"J{k}.theta: {angle[k]!r}, J{k}.theta_dot: {rate[k]!r}")
            if self.push:
                efforts.append(f'J{k}.theta: "{self.push[k]!r} N*m/s*time"')
            at += self.length[k]
        more = f", efforts: {{{', '.join(efforts)}}}" if efforts else ""
        rows = "\n".join
        return f"""format: 1
name: arm
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
{rows(links)}
joints:
{rows(joints)}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
{rows(loads)}
responses:
  go:
    start: {{{", ".join(start)}}}
    time: {{from: 0, to: {last!r}, step: {step}}}
    tolerance: 1e-11{more}
"""
