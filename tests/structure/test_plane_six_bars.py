"""A plane six-bar of Stephenson's third kind, driven at either end, against its vector loops.

Driven at the five-bar, its four-bar alone has equations enough by number but one freedom left: the
two loops belong together.
"""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

POINTS = {
    "A": (0, 0),
    "B": (1, 1),
    "C": (4, 2),
    "D": (5, 0),
    "E": (3, 3),
    "F": (6, 4),
    "G": (8, 0),
}
LINKS = {"A": "ground, a", "B": "a, t", "C": "t, c", "D": "ground, c", "E": "t, d"}
LINKS |= {"F": "d, e", "G": "ground, e"}
"""The triangle t carries B, C and E."""


def six_bar(driven: str, last: float) -> mk.Model:
    joints = "".join(
        f"  {n}: {{type: R, links: [{LINKS[n]}], point: [{x}, {y}, 0], axis: [0, 0, 1]}}\n"
        for n, (x, y) in POINTS.items()
    )
    motion = f"motion: {{inputs: {{{driven}.theta: {{from: 0, to: {last}, count: 11}}}}}}\n"
    links = "links: {a: {}, t: {}, c: {}, d: {}, e: {}}\n"
    return mk.loads(f"format: 1\n{links}joints:\n{joints}{motion}")


def distances(result: mk.Analysis) -> list[float]:
    """How much the rods between joints have changed their lengths."""
    rods = ("AB", "BC", "CE", "BE", "CD", "EF", "FG")
    changes = []
    for one, other in rods:
        gap = result[f"{one}.point"] - result[f"{other}.point"]
        length = np.sqrt((gap * gap).sum(axis=1))
        changes.append(
            float(np.abs(length - np.hypot(*np.subtract(POINTS[one], POINTS[other]))).max())
        )
    return changes


@pytest.mark.parametrize(("driven", "last", "blocks"), [("G", 20, [4]), ("A", 40, [2, 2])])
def test_both_ends_drive_it(driven: str, last: float, blocks: list[int]) -> None:
    model = six_bar(driven, last)
    assert [len(block.unknowns) for block in model.graph.blocks] == blocks
    result = model.analyze([f"{name}.point" for name in POINTS])
    assert set(result["row.status"]) == {"ok"}
    assert max(distances(result)) < 1e-13
    turned = np.radians(result[f"{driven}.theta"])
    pin, end = {"G": ("G", "F"), "A": ("A", "B")}[driven]
    arm = np.subtract(POINTS[end], POINTS[pin])
    x = POINTS[pin][0] + arm[0] * np.cos(turned) - arm[1] * np.sin(turned)
    assert np.abs(result[f"{end}.point"][:, 0] - x).max() < 1e-13


def test_driving_one_end_undoes_driving_the_other() -> None:
    """The crank's angles that the five-bar gives lead back to the five-bar's."""
    there = six_bar("G", 8).analyze(["A.theta"])
    back = six_bar("A", float(there["A.theta"][-1])).analyze(["G.theta"])
    assert abs(back["G.theta"][-1] - 8) < 1e-11
