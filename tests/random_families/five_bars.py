"""A planar five-bar in closed form along any motion of its two inputs; no code of the package.

Cranks of length 1 turn about (0, 0) and (3, 0); two rods meet in a pin that is drawn above
them. The pin is where two circles cut, on the left of the way from one crank's end to the other's;
the branch ends where the circles touch.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Motion = Callable[[Numbers], Numbers]

TEXT = """
format: 1
name: five-bar
units: {{length: m, angle: deg}}
links: {{a: {{}}, b: {{}}, c: {{}}, d: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [a, b], point: [1, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [b, c], point: [{x!r}, {y!r}, 0], axis: [0, 0, 1]}}
  D: {{type: R, links: [c, d], point: [4, 0, 0], axis: [0, 0, 1]}}
  E: {{type: R, links: [ground, d], point: [3, 0, 0], axis: [0, 0, 1]}}
motion: {motion}
"""
SAMPLES = 20001


@dataclass
class FiveBar:
    """Drawn with the pin at (x, y)."""

    x: float
    y: float

    def text(self, motion: str) -> str:
        """The mechanism's file."""
        return TEXT.format(x=self.x, y=self.y, motion=motion)

    def along(self, a: Motion, e: Motion, rows: int) -> Way:
        """Along cranks' angles in degrees over s in [0, 1], zero at s = 0."""
        at = np.arange(rows) / max(rows - 1, 1)
        s = np.unique(np.concatenate([np.linspace(0.0, 1.0, SAMPLES), at]))
        first, second = np.radians(a(s)) + 0.0 * s, np.radians(e(s)) + 0.0 * s
        angle, margin = self.pin(first, second)
        beyond = np.flatnonzero(margin < 0.0)
        end = int(beyond[0]) if beyond.size else s.size
        rod = np.unwrap(angle)
        turned = np.degrees(rod - rod[0] - (first - first[0]))
        return Way(s, np.searchsorted(s, at), turned, margin, end)

    def pin(self, first: Numbers, second: Numbers) -> tuple[Numbers, Numbers]:
        """The left rod's angle at cranks' angles in rad, and how far the circles are from
        touching."""
        ends = np.stack([np.cos(first), np.sin(first)])
        others = np.stack([3.0 + np.cos(second), np.sin(second)])
        one, other = np.hypot(self.x - 1.0, self.y), np.hypot(self.x - 4.0, self.y)
        way = others - ends
        distance = np.hypot(*way)
        along = (distance**2 + one**2 - other**2) / (2.0 * distance)
        height = np.sqrt(np.maximum(one**2 - along**2, 0.0))
        ahead = way / distance
        rod = along * ahead + height * np.stack([-ahead[1], ahead[0]])
        margin = np.minimum(distance - abs(one - other), one + other - distance)
        return np.arctan2(rod[1], rod[0]), margin

    def dead_centre(self, way: Way, a: Motion, e: Motion) -> tuple[float, float]:
        """The cranks' angles in degrees where the circles touch, by bisection."""
        low, high = way.s[way.end - 1], way.s[way.end]
        for _ in range(60):
            middle = np.array([0.5 * (low + high)])
            _, margin = self.pin(np.radians(a(middle)), np.radians(e(middle)))
            low, high = (low, middle[0]) if margin[0] < 0.0 else (middle[0], high)
        at = np.array([low])
        return float(a(at)[0]), float(e(at)[0])


@dataclass
class Way:
    """Samples s, which of them are rows, B.theta in degrees, how far the circles are from touching,
    and the first sample beyond the branch."""

    s: Numbers
    rows: NDArray[np.int64]
    angle: Numbers
    margin: Numbers
    end: int

    @property
    def reached(self) -> int:
        """Rows on the branch."""
        return int(np.count_nonzero(self.rows < self.end))

    @property
    def is_clear(self) -> bool:
        """Whether samples decide: the branch ends steeply or stays away from its end."""
        before = self.margin[: self.end]
        if self.end == self.s.size:
            return bool(before.min() > 1e-3)
        inner = (before[1:-1] < before[:-2]) & (before[1:-1] < before[2:])
        near = np.flatnonzero(np.isin(self.rows, range(self.end - 5, self.end + 5)))
        return not (inner & (before[1:-1] < 1e-3)).any() and not near.size and before[0] > 1e-3
