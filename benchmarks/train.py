"""A train of four-bars: the rocker of each is the crank of the next."""

from __future__ import annotations

STEP = 4.0
"""Distance of the ground pins, m."""

LOOPS = 10


def text(loops: int = LOOPS, motion: str = "{from: 0 deg, to: 60 deg, step: 0.25 deg}") -> str:
    """A mechanism file with `loops` planar four-bars one behind the other.

    The k-th rocker turns about (4 k, 0); bars are 1.6 and 1.7 long by turns, so that no loop is a
    parallelogram.
    """
    links = ["  bar0: {mass: 1, center_of_mass: [0, 0.8, 0], inertia: {xx: 0.2, yy: 0.1, zz: 0.2}}"]
    joints = ["  G0: {type: R, links: [ground, bar0], point: [0, 0, 0], axis: [0, 0, 1]}"]
    for k in range(loops):
        x0, x1 = STEP * k, STEP * (k + 1)
        start, end = (f"[{x}, {_bar(n)}, 0]" for x, n in ((x0, k), (x1, k + 1)))
        centre = f"[{x1}, {_bar(k + 1) / 2.0}, 0]"
        links += [f"  bar{k + 1}: {{mass: 1, center_of_mass: {centre}, inertia: {{zz: 0.2}}}}"]
        links += [f"  coupler{k + 1}: {{}}"]
        joints += [
            _pin(f"A{k + 1}", f"bar{k}, coupler{k + 1}", start),
            _pin(f"B{k + 1}", f"coupler{k + 1}, bar{k + 1}", end),
            _pin(f"G{k + 1}", f"ground, bar{k + 1}", f"[{x1}, 0, 0]"),
        ]
    drive = f"{motion[:-1]}, rate: 2 rad/s, acceleration: 0.7 rad/s^2}}"
    head = ["format: 1", f"name: train of {loops} four-bars"]
    units = ["units: {length: m, angle: rad, mass: kg, force: N}"]
    motions = ["motion:", "  inputs:", f"    G0.theta: {drive}"]
    loads = ["loads:", "  - {type: gravity, g: [0, -9.81, 0]}"]
    return "\n".join([*head, *units, "links:", *links, "joints:", *joints, *motions, *loads, ""])


def _bar(number: int) -> float:
    return 1.6 + 0.1 * (number % 2)


def _pin(name: str, links: str, point: str) -> str:
    """A line of a file: a revolute square to the plane."""
    return f"  {name}: {{type: R, links: [{links}], point: {point}, axis: [0, 0, 1]}}"
