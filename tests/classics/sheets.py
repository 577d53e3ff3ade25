"""Rigid origami: flat sheets of panels hinged along creases.

At a vertex of four creases of which two are in line, a sheet folds along these two, the others
flat, or along all four (Huffman 1976; Tachi 2009). A flat sheet shakes with two freedoms at every
vertex.
"""

from __future__ import annotations

import numpy as np

from classics.drawing import GROUND, Classic, Drawn


def sheet(rows: int, columns: int, lean: float) -> str:
    """Parallelograms in rows between straight creases; the others zigzag by `lean`."""

    def corner(i: int, j: int) -> np.ndarray:
        return np.array([i + lean * (j % 2), float(j), 0.0])

    def panel(i: int, j: int) -> str:
        return GROUND if i == j == 0 else f"p{i}_{j}"

    drawn = Drawn()
    for i in range(columns):
        for j in range(rows):
            if i + 1 < columns:
                one, two = corner(i + 1, j), corner(i + 1, j + 1)
                drawn.add("R", panel(i, j), panel(i + 1, j), one, axis=two - one)
            if j + 1 < rows:
                one, two = corner(i, j + 1), corner(i + 1, j + 1)
                drawn.add("R", panel(i, j), panel(i, j + 1), one, axis=two - one)
    return drawn.text


# every straight crease folds on its own, or the zigzags fold and with them all: Miura's fold
MIURA = [
    Classic("Miura fold, one vertex", sheet(2, 2, 0.3), (1,), 2),
    Classic("Miura fold, a straight crease", sheet(2, 3, 0.3), (1,), 3),
    Classic("Miura fold, two straight creases", sheet(3, 2, 0.3), (2, 1), 3),
    Classic("Miura fold, four vertices", sheet(3, 3, 0.3), (2, 1), 4),
    Classic("Miura fold, six vertices", sheet(4, 3, 0.3), (3, 1), 5),
]
# creases of one direction fold on their own, those of the other stay flat
MAPS = [
    Classic("map, one vertex", sheet(2, 2, 0.0), (1,), 2),
    Classic("map, two vertices", sheet(2, 3, 0.0), (2, 1), 3),
    Classic("map, four vertices", sheet(3, 3, 0.0), (2,), 4),
    Classic("map, six vertices", sheet(4, 3, 0.0), (3, 2), 5),
]
CASES = [*MIURA, *MAPS]
