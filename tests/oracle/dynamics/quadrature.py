"""One freedom under forces with a potential: time as an integral of the energy, without equations
of motion.

With T = J(q) q'^2 / 2 and T + V = E, the time from q0 to q is the integral of
sqrt(J / (2 (E - V))) dq. Where it starts from rest, q = q0 + (q1 - q0) u^2 takes the root away.
"""

from __future__ import annotations

import numpy as np

from oracle.dynamics.response import Response
from oracle.dynamics.rows import Array


class EnergyIntegral:
    """The way of a response's first coordinate `name`, in the base of its units."""

    def __init__(self, response: Response, name: str, nodes: int = 60) -> None:
        self.motion, self.name = response.motion, name
        self.state, self.begin = response.start, response.times[0]
        self.points, self.weights = np.polynomial.legendre.leggauss(nodes)
        place = self.motion.place(self.begin, self.state)
        self.first = place.quantity(name)
        self.rate = place.quantity(name + "_dot")
        kinetic, potential = self.motion.energies(self.begin, self.state)
        self.energy = kinetic + potential

    def times(self, values: Array) -> Array:
        """When the coordinate passes rising or falling values, all on its first way."""
        found, last, time = [], self.first, 0.0
        for value in values:
            time += self._time(last, float(value))
            found.append(time)
            last = float(value)
        return np.array(found)

    def _time(self, a: float, b: float) -> float:
        rests = a == self.first and self.rate == 0
        half = (b - a) / 2
        total = 0.0
        for x, weight in zip(self.points, self.weights, strict=True):
            u = (x + 1) / 2
            q = a + (b - a) * (u * u if rests else u)
            total += weight * abs(half) * (2 * u if rests else 1.0) * self._slowness(q)
        return float(total)

    def _slowness(self, q: float) -> float:
        motion = self.motion
        self.state = motion.close(self.begin, self.state, {self.name: q})
        moving = motion.rates(self.begin, self.state, {self.name: 1.0})
        inertia, potential = motion.energies(self.begin, moving)
        return float(np.sqrt(inertia / (self.energy - potential)))
