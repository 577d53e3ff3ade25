"""Where a mechanism is drawn, how it is turned there and its size change no answer.

Every kept mechanism is drawn up to a million sizes from the ground origin, turned, and a million
times larger or smaller, in multiple precision; what is expected is the mechanism as it stands.
"""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.runs import LECTURES, NAMES, model, run
from oracle import document, moved, mp, rotation_matrix, scaled, to_text
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.units import LENGTH

STILL = rotation_matrix(1, 0, 0, 0)
TURNED = rotation_matrix(3, -1, 2, 5)
DRAWINGS = {
    "near": (STILL, (1e3, 1e3, 1e3), "1"),
    "aside": (STILL, (-3e3, 1e4, 2e3), "1"),
    "far": (STILL, (1e6, -1e6, 1e6), "1"),
    "turned": (TURNED, (-1e6, 1e6, 1e6), "1"),
    "far and small": (STILL, (1e6, 1e6, 0.0), "1e-6"),
    "far and large": (STILL, (0.0, 1e6, -1e6), "1e6"),
    "turned and small": (TURNED, (1e4, 1e4, -1e5), "1e-6"),
    "turned and large": (TURNED, (1e6, -1e6, 1e6), "1e6"),
}
"""How each is turned, where it is drawn in sizes of the drawing, and its scale."""

ROUNDING = 1e-10
"""Of the drawing, whose digits are rounded anew, in parts of a column's largest value. Without a
datum a million sizes away cost six digits more."""

UNMOVED = {"double_wishbone", "ride_height"}
"""The heights that the first is driven to are written with a parameter of its drawing; a force on
the second grows with time, and is turned by no oracle."""

PLACED = [
    name
    for name in (*NAMES, *LECTURES)
    if not document(FILE_OF[name]).get("plane") and name not in UNMOVED
]


def drawn(name: str, drawing: str) -> tuple[mk.Model, np.ndarray]:
    """The mechanism drawn elsewhere, and how far in the file's unit of length (3,)."""
    rotation, sizes, factor = DRAWINGS[drawing]
    data, problem = document(FILE_OF[name]), model(name).problem
    size = float(problem.units.from_si(problem.mechanism.box_diagonal(), LENGTH)) * float(factor)
    shift = [mp.mpf(f"{each * size:.3g}") for each in sizes]
    data = data if factor == "1" else scaled(data, factor)
    return mk.loads(to_text(moved(data, rotation, shift)), name), np.array(shift, dtype=float)


def turns_of(name: str) -> list[str]:
    """Angles of the joints and their rates, which are the same for every drawing."""
    words = ("theta", "theta1", "theta2")
    return [
        f"{joint.name}.{coordinate}{order}"
        for joint in model(name).problem.mechanism.joints.values()
        for coordinate in joint.type.coordinates
        if coordinate in words and f"{joint.name}.{coordinate}" in model(name).quantities
        for order in ("", "_dot", "_ddot")
    ]


@pytest.mark.parametrize("drawing", DRAWINGS)
@pytest.mark.parametrize("name", PLACED)
def test_the_rows_stay(name: str, drawing: str) -> None:
    wanted, quantities = run(name), turns_of(name)
    found = drawn(name, drawing)[0].analyze(quantities, tables=[])
    assert (found.result.status == wanted.result.status).all()
    for quantity in quantities:
        one, other = np.asarray(found[quantity]), np.asarray(wanted[quantity])
        known = np.isfinite(other)
        assert (np.isfinite(one) == known).all(), quantity
        if known.any():
            off = (one - other)[known]
            if not quantity.endswith("dot"):
                off = off - 360.0 * np.round(off / 360.0)
            scale = max(1.0, float(np.abs(other[known]).max()))
            assert np.abs(off).max() < ROUNDING * scale, quantity


@pytest.mark.parametrize("name", PLACED)
def test_places_are_told_in_the_axes_of_the_ground(name: str) -> None:
    """Shifted back, to the last digits of a place so far away."""
    other, shift = drawn(name, "far")
    quantities = [f"{point}.position" for point in model(name).problem.mechanism.points]
    found, wanted = other.analyze(quantities, tables=[]), run(name)
    for quantity in quantities:
        one, own = np.asarray(found[quantity]), np.asarray(wanted[quantity])
        known = np.isfinite(own)
        limit = 4.0 * np.finfo(float).eps * np.abs(shift).max()
        assert (np.abs(one - own - shift)[known] < limit).all(), quantity
