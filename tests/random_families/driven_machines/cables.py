"""Cables on drums and pulleys and in tackles, driven from either end.

The free stretch off a circle moves as the string of an involute: its length changes by the part of
an end's rate along it, its direction by the part across it. Tensions follow from virtual work.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from random_families.driven_machines.judged import Judged, begun, numbers
from scipy.optimize import brentq

KINDS = ("tackle", "pulley", "drum", "driven drum")
LIMIT = 1e-9


class Stretch(NamedTuple):
    """A cable from a circle about the origin to a place that slides.

    Attributes:
        length: free, and what is wound off the circle since its first axis.
        slope: of the length by the slide.
        bend: of the slope by the slide.
    """

    length: Any
    slope: Any
    bend: Any


def _stretch(place: Any, radius: float, side: int, along: complex) -> Stretch:
    """Off a circle to places (complex numbers), which slide along a direction; with side 1 the
    cable touches left of the way to the place, with -1 right of it."""
    far = np.abs(place)
    free = np.sqrt(far**2 - radius**2)
    contact = np.angle(place) + side * np.arccos(radius / far)
    way = (place - radius * np.exp(1j * contact)) / free
    part = along * np.conj(way)  # along and across the stretch
    return Stretch(free - side * radius * contact, part.real, part.imag**2 / free)


def _tackle(rng: np.random.Generator, judged: Judged, size: float) -> None:
    path = ["a", "b"] * int(rng.integers(1, 5))
    path = path[: int(rng.integers(2, len(path) + 1))]
    path = [*path, *(["a"] if path[-1] == "b" else []), "c"]
    strands = path.count("b") * 2
    rate, acceleration = (float(x) for x in rng.uniform(-2, 2, 2) * size)
    weight, pulled = float(rng.uniform(0.5, 5)), np.array([-0.5, 0.0, 0.5]) * size
    data = begun(plane=True) | {
        "links": {"m": {}, "e": {}},
        "points": {
            "a": {"link": "ground", "at": [0, 0]},
            "b": {"link": "m", "at": [0, -2 * size]},
            "c": {"link": "e", "at": [size, 0]},
        },
        "joints": {
            "S": {"type": "P", "links": ["ground", "m"], "point": [0, 0], "axis": [0, 1]},
            "E": {"type": "P", "links": ["ground", "e"], "point": [size, 0], "axis": [1, 0]},
        },
        "couplings": {"K": {"type": "cable", "path": path}},
        "loads": [{"type": "force", "joint": "S", "value": -weight}],
    }
    swept = {"values": numbers(pulled), "rate": rate, "acceleration": acceleration}
    data["motion"] = {"inputs": {"E.s": swept}}
    result = judged.model(data).analyze()
    if not judged.is_ok(result):
        return
    still = np.zeros(3)
    wanted = {
        "S.s": pulled / strands,
        "S.s_dot": rate / strands + still,
        "S.s_ddot": acceleration / strands + still,
        "K.tension": weight / strands + still,
        "E.effort": weight / strands + still,
    }
    judged.values(result, wanted, LIMIT)


def _around(rng: np.random.Generator, judged: Judged, size: float, kind: str) -> None:
    """A mass hangs beside a circle, from which the cable goes to it, downward."""
    radius, beside = float(rng.uniform(0.1, 0.4)) * size, float(rng.uniform(0.6, 1.5)) * size
    hung = complex(beside, float(rng.uniform(-2, -1)) * size)
    side = 1 if kind == "pulley" else int(rng.choice([1, -1]))
    weight, pull = (float(x) for x in rng.uniform(0.5, 5, 2))
    rate, acceleration = (float(x) for x in rng.uniform(-2, 2, 2))
    slides = np.array([-0.3, 0.0, 0.3]) * size
    stretch = _stretch(hung + 1j * slides, radius, side, 1j)
    hangs = {"type": "P", "links": ["ground", "m"], "point": [beside, 0], "axis": [0, 1]}
    data: dict[str, Any] = begun(plane=True) | {
        "links": {"m": {}, "w": {}},
        "points": {"q": {"link": "m", "at": [hung.real, hung.imag]}},
        "joints": {"S": hangs},
        "loads": [{"type": "force", "joint": "S", "value": -weight}],
    }
    circle: dict[str, Any] = {"radius": radius, "side": "left" if side == 1 else "right"}
    path: list[Any] = [circle, "q"]
    if kind == "pulley":
        end = complex(-2, -0.3) * size
        circle["pulley"], path = "g", ["p", circle, "q"]
        data["points"]["g"] = {"link": "ground", "at": [0, 0]}
        data["points"]["p"] = {"link": "w", "at": [end.real, end.imag]}
        slide = {"type": "P", "links": ["ground", "w"], "point": [0, end.imag], "axis": [1, 0]}
        data["joints"]["E"] = slide
        data["loads"].append({"type": "force", "joint": "E", "value": -pull})
        other = "E.s"

        def total(moved: float) -> float:  # the cable comes to the circle from the left
            return float(_stretch(end + moved, radius, -1, 1.0).length)

        drawn = stretch.length - stretch.length[1] - total(0.0)
        moved = np.array(
            [brentq(lambda e, d=d: total(e) + d, -size, size, xtol=1e-15 * size) for d in drawn]
        )
        far = _stretch(end + moved, radius, -1, 1.0)
        slope = -stretch.slope / far.slope
        bend = -(stretch.bend + far.bend * slope**2) / far.slope
        tension = -pull / far.slope
    else:
        circle["drum"], other = "A", "A.theta"
        data["joints"]["A"] = {"type": "R", "links": ["ground", "w"], "point": [0, 0]}
        data["loads"].append({"type": "torque", "joint": "A", "value": side * pull * size})
        moved = -side * (stretch.length - stretch.length[1]) / radius
        slope, bend = -side * stretch.slope / radius, -side * stretch.bend / radius
        tension = pull * size / radius + 0.0 * slides
    data["couplings"] = {"K": {"type": "cable", "path": path}}
    if kind == "driven drum":
        driven, values, told = "A.theta", moved, "S.s"
        back = rate / slope
        wanted: dict[str, Any] = {
            "S.s_dot": back,
            "S.s_ddot": (acceleration - bend * back**2) / slope,
        }
        wanted |= {"K.tension": -weight / stretch.slope}
        wanted["A.effort"] = weight / slope - side * pull * size
    else:
        rate, acceleration = rate * size, acceleration * size
        driven, values, told = "S.s", slides, other
        wanted = {f"{other}_dot": slope * rate}
        wanted[f"{other}_ddot"] = bend * rate**2 + slope * acceleration
        wanted |= {"K.tension": tension, "S.effort": weight + tension * stretch.slope}
    swept = {"values": numbers(values), "rate": rate, "acceleration": acceleration}
    data["motion"] = {"inputs": {driven: swept}}
    result = judged.model(data).analyze()
    if not judged.is_ok(result):
        return
    place = slides if told == "S.s" else moved
    judged.compare(told, result[told], place, float(np.max(np.abs(place))), LIMIT)
    judged.values(result, wanted, LIMIT)


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = judged.remark = str(rng.choice(KINDS))
    size = float(10.0 ** rng.uniform(-2, 2))
    if kind == "tackle":
        _tackle(rng, judged, size)
    else:
        _around(rng, judged, size, kind)
