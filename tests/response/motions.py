"""Responses of short files, and what every one of them must keep."""

from __future__ import annotations

from typing import Any

import numpy as np

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths

Array = np.ndarray[Any, np.dtype[np.float64]]

ENERGY = 1e-11
"""Limit of `row.energy_error`."""

PLANAR = """format: 1
links:
  crank: {mass: 1, center_of_mass: [0.05, 0.1, 0], inertia: {zz: 0.01}}
  coupler: {mass: 2, center_of_mass: [0.3, 0.3, 0], inertia: {zz: 0.05}}
  rocker: {mass: 1, center_of_mass: [0.7, 0.2, 0], inertia: {zz: 0.02}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, coupler], point: [0.05, 0.2, 0], axis: [0, 0, 1]}
  C: {type: R, links: [coupler, rocker], point: [0.65, 0.4, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [0.75, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - LOAD
"""
"""A four-bar in space whose pins are parallel, so that constraints are redundant."""


def respond(text: str, name: str = "run", *, ends: str = "ok", energy: float = ENERGY) -> Any:
    """The response of a text, whose rows are all `ok` but a last one that ends otherwise."""
    found = mk.loads(text).respond(name)
    status = [str(word) for word in found["row.status"]]
    assert set(status) in ({"ok"}, {"ok", ends}), status
    assert np.nanmax(found["row.energy_error"]) <= energy
    return found


def off(found: Any, expected: Any) -> float:
    """The largest difference in parts of the largest value, at least one."""
    found, expected = np.array(found, dtype=float), np.array(expected, dtype=float)
    assert found.shape == expected.shape
    size = max(1.0, float(np.max(np.abs(expected))))
    return float(np.max(np.abs(found - expected))) / size


def last_time(found: Any) -> float:
    return float(found["time"][-1])


def has_same_bits(text: str, names: list[str]) -> None:
    """Asserts that quantities of the response `run` do not depend on lanes or threads."""
    runs = [
        mk.loads(text).respond("run", names, lanes=lanes, threads=threads)
        for lanes in widths()
        for threads in (1, 2)
    ]
    for name in names:
        assert len({np.asarray(run[name], float).tobytes() for run in runs}) == 1, name
