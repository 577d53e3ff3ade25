"""Masses on springs and dampers, each on its own slide: m x'' + c x' + k x = 0, solved exactly.

With d = c / (2 m) and D = d^2 - k / m the motion is x0 e^(r t) in the roots r = -d +- root(D);
where D < 0 it swings at root(-D).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.stress.linkages.moving import Field
from benchmarks.stress.linkages.writing import document, joint, number
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Number
from benchmarks.stress.quantity import Quantity, Rows

DIRECTIONS = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Oscillator:
    """Masses, stiffnesses, dampings and starts (mechanisms, masses) in SI, let go at rest."""

    mass: Rows
    stiffness: Rows
    damping: Rows
    start: Rows
    field: Field = DoubleDouble

    def quantities(self, time: Number) -> tuple[Quantity, ...]:
        """At moments (mechanisms, rows)."""
        count = self.mass.shape[1]
        return tuple(Quantity(f"P{k + 1}.s", "length", self._motion(k, time)) for k in range(count))

    def _motion(self, k: int, time: Number) -> Number:
        mass, stiffness, damping, start = (
            self.field(item[:, k : k + 1])
            for item in (self.mass, self.stiffness, self.damping, self.start)
        )
        decay = damping / mass * 0.5
        square = decay * decay - stiffness / mass
        swings = square.high < 0.0
        rate = _magnitude(square).sqrt()
        sine, cosine = (rate * time * np.where(swings, 1.0, 0.0)).sin_cos()
        falling = (-(decay * time)).exp() * start
        swung = falling * (cosine + decay / rate * sine)
        # -d + root(D) by the product of the roots, which does not cancel
        fast = -(decay + rate)
        slow = stiffness / mass / fast
        still = np.where(swings, 0.0, 1.0)
        one, two = (slow * time * still).exp(), (fast * time * still).exp()
        crept = (fast * one - slow * two) * start / (fast - slow)
        return swung * (1.0 - still) + crept * still

    def size(self) -> Rows:
        """The largest start, (mechanisms, 1), in m."""
        largest: Rows = np.abs(self.start).max(axis=1, keepdims=True)
        return largest

    def text(self, k: int, name: str, moments: Rows) -> str:
        """Mechanism k as a file."""
        count = self.mass.shape[1]
        links = [f"m{n}" for n in range(1, count + 1)]
        joints, loads, starts = {}, ["loads:"], []
        for n, (link, axis) in enumerate(zip(links, DIRECTIONS, strict=False), start=1):
            joints[f"P{n}"] = joint("P", ("ground", link), point=(0.0, 0.0, 0.0), axis=axis)
            stiff, damp = number(self.stiffness[k, n - 1]), number(self.damping[k, n - 1])
            on = f"joint: P{n}, coordinate: s"
            loads.append(f"  - {{type: spring, {on}, stiffness: {stiff}, free: 0}}")
            loads.append(f"  - {{type: damper, {on}, damping: {damp}}}")
            starts.append(f"P{n}.s: {number(self.start[k, n - 1])}")
        masses = {
            link: f"{{mass: {number(self.mass[k, n])}, center_of_mass: [0, 0, 0]}}"
            for n, link in enumerate(links)
        }
        listed = ", ".join(map(number, moments))
        response = (
            "responses:\n  let_go:\n    start: {" + ", ".join(starts) + "}\n"
            f"    time: {{values: [{listed}]}}"
        )
        return document(name, masses, joints, *loads, response)


def _magnitude(a: Number) -> Number:
    return a * np.where(a.high < 0.0, -1.0, 1.0)
