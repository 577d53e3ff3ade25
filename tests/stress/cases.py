"""Texts of hard cases made of rcsr.yaml: sizes, dead centres, far drawings, sweeps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any

import numpy as np
from oracle.document import Document, document, to_text
from references import RCSR, exact

LENGTHS = ("P1", "P2", "P3", "P4", "s1", "s4", "cx", "cy", "cz")
DISTANCES = tuple(f"1e-{power}" for power in range(12))
"""From the dead centre, in degrees."""
DEAD_CENTRES = {"upper": "205.1439659451948204775", "lower": "133.9439778838147226667"}
"""Where the branch of mechanisms/dissertation/rcsr.yaml ends, in degrees."""
NEAR = {"O2.theta": "theta2", "O2.s": "s2", "O4.theta": "theta4"}


def with_motion(law: Mapping[str, Any], first: int) -> Document:
    """RCSR with another law of its input, on its branch at `first`, a degree of the exact table."""
    data = document(RCSR)
    old = data["motion"]["inputs"]["O1.theta"]
    rates = {name: old[name] for name in ("rate", "acceleration")}
    data["motion"]["inputs"]["O1.theta"] = dict(law) | rates
    data["assembly"]["near"] = {name: exact("rcsr")[c][row_of(first)] for name, c in NEAR.items()}
    return data


def row_of(degrees: int) -> int:
    """The row of the exact table."""
    return (degrees - 150) // 2


def scaled(factor: float) -> str:
    """RCSR with one inch drawn as `factor` metres, one pound as one kilogram.

    Angles and their rates stay, lengths and forces (in m, N) grow by `factor`, moments by its
    square.
    """
    data = document(RCSR)
    data["units"] = {"length": "m", "angle": "deg", "mass": "kg", "force": "N"}
    parameters = data["parameters"]
    for name in LENGTHS:
        number, _ = parameters[name].split()
        parameters[name] = f"{float(number) * factor!r} m"
    square = factor * factor
    for link in data["links"].values():
        inertia = link["inertia"]
        for entry in inertia.keys() - {"axes"}:
            inertia[entry] = repr(float(inertia[entry]) * square)
    data["loads"][0]["value"] = repr(10.0 * square)
    near = data["assembly"]["near"]
    near["O2.s"] = repr(float(near["O2.s"]) * factor)
    return to_text(data)


def towards(end: str) -> str:
    """Rows from inside the range to ever smaller distances from a dead centre."""
    limit = float(DEAD_CENTRES[end])
    first, sign = (202, -1) if end == "upper" else (150, 1)
    values = [repr(limit + sign * float(distance)) for distance in DISTANCES]
    return to_text(with_motion({"values": [str(first), *values]}, first))


def drawn_at(shift: Sequence[float]) -> str:
    """RCSR of one metre per inch, every place rounded to 2**-24 m, and then shifted.

    Shifts by powers of two up to 2**28 m lose no digit of such places, and metres none on reading.
    """
    data = document(scaled(1.0))
    for keys, place in _home_places().items():
        container: Any = data
        for key in keys[:-1]:
            container = container[key]
        coarse = np.round(place * 2.0**24) / 2.0**24
        container[keys[-1]] = [f"{Decimal(float(x)):f}" for x in coarse + np.asarray(shift, float)]
    return to_text(data)


def _home_places() -> dict[tuple[str, ...], np.ndarray]:
    """Every place of the drawing, by where it stands in the file."""
    a1, a4 = np.deg2rad(12), np.deg2rad(15)
    turned1 = np.array([[np.cos(a1), 0, -np.sin(a1)], [0, 1, 0], [np.sin(a1), 0, np.cos(a1)]])
    turned4 = np.array([[np.cos(a4), 0, np.sin(a4)], [0, 1, 0], [-np.sin(a4), 0, np.cos(a4)]])
    centre, o1 = np.array([0.5, 1.0, 1.0]), np.array([-5.0, 0.0, 0.0])
    o2, o4 = o1 - [0, 0.5, 0], turned4 @ [4.0, 0.5, 0.0]
    sphere = o2 - [0, 0.8, 0], o4 - [0, -0.4, 0]
    centres = {
        "crank": o1 + centre,
        "coupler": o2 + turned1 @ centre,
        "rocker": o4 + turned4 @ centre,
    }
    places: dict[tuple[str, ...], Any] = {
        ("joints", "O1", "point"): o1,
        ("joints", "O2", "point"): o2,
        ("joints", "O3", "point", "coupler"): sphere[0],
        ("joints", "O3", "point", "rocker"): sphere[1],
        ("joints", "O4", "point"): o4,
        ("points", "o2", "at"): o2,
        ("points", "o3", "at"): sphere[1],
    }
    for number, (link, place) in enumerate(centres.items(), start=1):
        places["links", link, "center_of_mass"] = place
        places["points", f"pm{number}", "at"] = place
    return places
