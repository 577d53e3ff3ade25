"""Rows of parallel cranks of length 1 with unit rods between them, in gravity: one freedom, which
passes singular positions wherever all rods lie in one line (the N four-bar mechanism of the IFToMM
library of benchmark problems); while the cranks stay parallel they are one compound pendulum."""

from __future__ import annotations

from typing import Any

import mpmath as mp

GRAVITY = 9.81


def parallel_cranks(
    loops: int, *lines: str, straight: bool = True, more: str = "", flat: bool = False
) -> str:
    """The mechanism with a response `run` of the `lines`; uniform rods of 1 kg. `flat`: in a plane,
    where each loop has two equations."""
    rod = f"inertia: {{zz: {1 / 12!r}, xx: {1 / 24!r}, yy: {1 / 24!r}}}"
    links, joints = "", ""
    for i in range(loops + 1):
        links += f"  crank{i}: {{mass: 1, center_of_mass: [{i}, 0.5, 0], {rod}}}\n"
        joints += f"  A{i}: {{type: R, links: [ground, crank{i}], point: [{i}, 0, 0], {AXIS}}}\n"
    for i in range(loops):
        links += f"  bar{i}: {{mass: 1, center_of_mass: [{i + 0.5}, 1, 0], {rod}}}\n"
        joints += f"  B{i}: {{type: R, links: [crank{i}, bar{i}], point: [{i}, 1, 0], {AXIS}}}\n"
        joints += (
            f"  C{i}: {{type: R, links: [bar{i}, crank{i + 1}], point: [{i + 1}, 1, 0], {AXIS}}}\n"
        )
    asked = "assembly: {at_branch_points: straight}\n" if straight else ""
    plane = "plane: xy\n" if flat else ""
    if flat:
        links = links.replace(rod, f"inertia: {1 / 12!r}").replace(", 0]", "]")
        joints = joints.replace(f", 0], {AXIS}", "]")
    down = f"[0, -{GRAVITY}]" if flat else f"[0, -{GRAVITY}, 0]"
    return (
        f"format: 1\nname: parallel cranks\n{plane}units: {{angle: rad}}\n"
        f"links:\n{links}joints:\n{joints}"
        f"loads: [{{type: gravity, g: {down}}}]\n{asked}{more}"
        f"responses:\n  run:\n" + "".join(f"    {line}\n" for line in lines)
    )


AXIS = "axis: [0, 0, 1]"


class CompoundPendulum:
    """theta'^2 = w^2 + 4 a sin^2(theta / 2) from upright at the rate w, with a = G / J: the time is
    an elliptic integral."""

    def __init__(self, loops: int, rate: float) -> None:
        inertia = mp.mpf(loops + 1) / 3 + loops
        self.a = mp.mpf(GRAVITY) * (mp.mpf(loops + 1) / 2 + loops) / inertia
        self.rate = mp.mpf(rate)

    def time(self, angle: Any) -> Any:
        """When an angle is reached, s."""
        return 2 / self.rate * mp.ellipf(mp.mpf(angle) / 2, -4 * self.a / self.rate**2)

    def rate_at(self, angle: Any) -> Any:
        """The rate at an angle, rad/s."""
        whole = mp.sqrt(self.rate**2 + 4 * self.a * mp.sin(mp.mpf(angle) / 2) ** 2)
        return whole if self.rate > 0 else -whole
