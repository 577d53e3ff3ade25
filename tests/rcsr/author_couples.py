"""The source's load model: RCSR without masses, its inertia forces and couples as applied loads.

In every row link i carries the force -m a at its mass centre's acceleration, through the ground
origin, and the inertia couple of the source. A force through the origin is written as one at the
mass centre with the torque -r x F.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from oracle.document import document, to_text
from rcsr.columns import exact_values
from references import RCSR

import mechkin_cli as mk

MASSES = {"crank": 2.0, "coupler": 5.0, "rocker": 5.0}
TABLES = ("table_15", "table_16", "table_17", "table_18")


def cells() -> dict[tuple[str, str], np.ndarray]:
    """All 27 rows of the load tables by (table, label)."""
    found: dict[tuple[str, str], list[float]] = {}
    for row, theta1 in enumerate(exact_values("theta1")):
        for table in mk.loads(_text(row, theta1)).analyze(tables=TABLES).tables:
            for column in table.columns:
                found.setdefault((table.name, column.label), []).append(column.values[0])
    return {key: np.array(values) for key, values in found.items()}


def _text(row: int, theta1: float) -> str:
    data = document(RCSR)
    data["links"] = {link: {} for link in data["links"]}
    data.pop("accept")
    data["motion"]["inputs"] = {"O1.theta": {"at": _number(theta1)}}
    near = {"O2.theta": "theta2", "O2.s": "s2", "O4.theta": "theta4"}
    data["assembly"] = {"near": {n: _number(exact_values(c)[row]) for n, c in near.items()}}
    for number, link in enumerate(MASSES, start=1):
        data["loads"] += _loads_of(link, number, row, data["points"][f"pm{number}"]["at"])
    return to_text(data)


def _loads_of(link: str, number: int, row: int, place: list[str]) -> list[dict[str, Any]]:
    force = -MASSES[link] * _vector(f"a_pm{number}", row)
    couple = _vector(f"author_MI{number}", row) - np.cross(_vector(f"pm{number}", row), force)
    return [
        {"type": "force", "link": link, "point": place, "force": list(map(_number, force))},
        {"type": "torque", "link": link, "torque": list(map(_number, couple))},
    ]


def _vector(column: str, row: int) -> np.ndarray:
    return np.array([exact_values(f"{column}_{axis}")[row] for axis in "xyz"])


def _number(value: float) -> str:
    return repr(float(value))
