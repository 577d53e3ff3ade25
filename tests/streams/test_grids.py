"""Grids of many rows go line by line, in parts that share a line."""

from __future__ import annotations

import numpy as np
import pytest
from sweep.cut import cut
from sweep.test_grids import FIVE_BAR

import mechkin_cli as mk

GRID = """motion:
  grid: true
  inputs:
    A.theta: {{from: {slow[0]}, to: {slow[1]}, count: {lines}, rate: 1 rad/s}}
    E.theta: {{from: {fast[0]}, to: {fast[1]}, count: {width}, rate: -2 rad/s}}
"""
NAMES = [
    "A.theta",
    "E.theta",
    "B.theta",
    "C.theta",
    "p.position.x",
    "p.velocity.y",
    "A.effort",
    "row.status",
]


def grid(slow: tuple, fast: tuple, lines: int, width: int) -> str:
    return FIVE_BAR + GRID.format(slow=slow, fast=fast, lines=lines, width=width)


TEXTS = {
    "from the drawing on": grid((0, 30), (0, -20), 9, 5),
    "both ways": grid((-20, 30), (20, -20), 11, 7),
    "many turns": grid((0, 720), (0, 720), 13, 13),
    "lost at the ends": grid((-150, 150), (-90, 90), 15, 9),
    "wide lines": grid((-20, 30), (40, -20), 4, 31),
    "past half a turn of what is no input": grid((-140, -2), (49, 104), 7, 4),
}


def close(one: np.ndarray, other: np.ndarray) -> bool:
    if one.dtype.kind not in "fc":
        return bool((one == other).all())
    return bool(np.allclose(one, other, rtol=1e-12, atol=1e-12, equal_nan=True))


@pytest.mark.parametrize("rows", [4, 8, 20, 60])
@pytest.mark.parametrize("name", TEXTS)
def test_lines_in_parts_are_those_of_the_grid(
    name: str, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    once = mk.loads(TEXTS[name]).analyze(NAMES)
    cut(monkeypatch, rows)
    model = mk.loads(TEXTS[name])
    whole = model.analyze(NAMES)
    for each in NAMES:
        assert close(whole[each], once[each]), each
    for block_rows in (1, 7, 4096):
        stream = model.stream(NAMES, rows=block_rows)
        found = [[block[each] for each in NAMES] for block in stream]
        for number, each in enumerate(NAMES):
            values = np.concatenate([block[number] for block in found])
            assert values.tobytes() == whole[each].tobytes(), each
        assert {str(one) for one in stream.diagnostics} == {str(one) for one in whole.diagnostics}
        assert stream.verdicts.rows == once.rows
