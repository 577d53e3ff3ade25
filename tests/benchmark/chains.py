"""Four-bars in a chain: the rocker of each is the crank of the next."""

from __future__ import annotations

STEP = 4.0
"""Distance of the ground pins."""


def chain_text(loops: int, order: list[int] | None = None) -> str:
    """A mechanism file with `loops` planar four-bars one behind the other.

    The k-th rocker turns about (4 k, 0); bars are 1.6 and 1.7 long by turns, so that no loop is a
    parallelogram. `order` gives the order of the loops in the file.
    """
    links, joints = (
        ["  bar0: {}"],
        ["  G0: {type: R, links: [ground, bar0], point: [0, 0, 0], axis: [0, 0, 1]}"],
    )
    for k in range(loops) if order is None else order:
        x0, x1 = STEP * k, STEP * (k + 1)
        start, end = f"[{x0}, {1.6 + 0.1 * (k % 2)}, 0]", f"[{x1}, {1.6 + 0.1 * ((k + 1) % 2)}, 0]"
        links += [f"  bar{k + 1}: {{}}", f"  coupler{k + 1}: {{}}"]
        joints += [
            pin(f"A{k + 1}", f"bar{k}, coupler{k + 1}", start),
            pin(f"B{k + 1}", f"coupler{k + 1}, bar{k + 1}", end),
            pin(f"G{k + 1}", f"ground, bar{k + 1}", f"[{x1}, 0, 0]"),
        ]
    motion = "motion: {inputs: {G0.theta: {from: 0 deg, to: 10 deg, step: 1 deg}}}"
    head = ["format: 1", f"name: chain of {loops}"]
    return "\n".join([*head, "links:", *links, "joints:", *joints, motion, ""])


def pin(name: str, links: str, point: str) -> str:
    """A line of a file: a revolute square to the plane."""
    return f"  {name}: {{type: R, links: [{links}], point: {point}, axis: [0, 0, 1]}}"
