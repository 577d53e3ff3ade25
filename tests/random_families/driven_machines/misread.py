"""Values that do not belong there, in every field of couplings, laws, limits and cylinders.

A sound file gets one of its values, or a whole part, replaced. Either it is a mechanism, whose rows
are finite or have a status, or it is refused with places; nothing else is raised and no warning of
NumPy escapes. Only what the package promises is looked at, so that no reference is needed.
"""

from __future__ import annotations

import copy
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
from random_families.driven_machines.judged import Judged, begun

import mechkin_cli as mk

STRANGE: tuple[Any, ...] = (
    *(None, True, "", " ", [], {}, [[1]], {"a": 1}, {"from": 0}, b"x", 3 + 0j),
    *(0, -1, 1, 1e308, -1e308, 1e-308, 5e-324, 10**30, float("nan"), float("inf")),
    *("nan", "inf", "1e999", "1e400 mm", "0/0", "1/0", "sqrt(-1)", "log(0)", "theta/0"),
    *("20 kg", "20 deg", "20 mm", "1e3 mm", "90 deg", "-90 deg", "100000 deg", "1 rad/theta"),
    *("A", "ground", "K", "time", "theta", "A.theta", "A.s", "B.theta", "C.s", "__import__"),
    *("sin(", "(" * 400, "a" * 300, "théta"),
    *([1], [0, 0], [-1, 2], [1, -2], [1e300, 1e-300], ["x", "y"], [float("nan"), 1], [20, 20.5]),
    *(["A", "A"], ["A", "C"], ["A", "ground"], [["A"], "B"], [1] * 1000),
)
RISE = {"law": "cycloidal", "from": 0, "to": 0.02, "start": 0, "duration": "60 deg"}
SEGMENTS = [
    {"for": "60 deg", "to": 0.02, "law": "3-4-5"},
    {"for": "100 deg", "law": "dwell"},
    {"for": "200 deg", "to": 0, "law": "modified-sine"},
]
FOLLOWER = {"type": "translating", "contact": "roller", "base_radius": 0.04, "radius": 0.01}
LIFT = {"type": "function", "of": "A.theta", "gives": "C.s"}
COUPLINGS: dict[str, dict[str, Any]] = {
    "gear": {
        "type": "gear",
        "joints": ["A", "B"],
        "teeth": [20, 40],
        "radii": [0.02, 0.04],
        "module": "2 mm",
        "internal": False,
        "pressure_angle": "20 deg",
        "helix": 0,
        "ideal": False,
        "efficiency": 0.9,
    },
    "belt": {
        "type": "belt",
        "joints": ["A", "B"],
        "radii": [0.02, 0.03],
        "crossed": False,
        "pretension": "5 N",
        "efficiency": 0.9,
    },
    "chain": {"type": "chain", "joints": ["A", "B"], "teeth": [17, 38], "pitch": "5 mm"},
    "linear": {"type": "linear", "terms": {"A.theta": 1, "B.theta": -2}, "sum": 0},
    "rack": {"type": "rack", "joints": ["A", "C"], "radius": 0.02, "at": "Q", "ideal": False},
    "function": {**LIFT, "value": "20 mm*(1 - cos(theta))", "follower": FOLLOWER},
    "law": {**LIFT, "law": RISE},
    "sequence": {**LIFT, "law": {"law": "sequence", "from": 0, "start": 0, "segments": SEGMENTS}},
    "cable": {
        "type": "cable",
        "path": [
            {"drum": "A", "radius": 0.02, "side": "left"},
            {"pulley": "M", "radius": 0.01, "side": "left"},
            "Q",
        ],
    },
}
RISEN = {"law": "3-4-5", "from": 0, "to": 0.3, "start": 0, "duration": 0.5}
LAWS: dict[str, dict[str, Any]] = {
    "sine": {"law": "sine", "amplitude": 0.3, "frequency": "2 Hz", "phase": 0.1, "offset": 0},
    "expression": {"law": "expression", "value": "0.3 rad*sin(6 rad/s*time)"},
    "3-4-5": RISEN,
    "polynomial": {"law": "polynomial", "coefficients": [0, "1 rad/s"]},
    "segments": {
        "law": "sequence",
        "from": 0,
        "start": 0,
        "segments": [
            {"for": "0.2 s", "to": 0.3, "law": "modified-sine"},
            {"for": "0.1 s", "law": "dwell"},
        ],
    },
}
LIMIT = {"A.theta": {"min": -0.5, "max": 0.5, "restitution": 0.5}, "C.s": [-1, 1]}
CYLINDER = {"D": {"from": "P", "to": "Q", "stroke": [0.1, 2.0], "bore": 0.05, "rod": 0.028}}
KINDS = (*COUPLINGS, *LAWS, "limits", "cylinders")


def sound(kind: str) -> tuple[dict[str, Any], dict[str, Any], str]:
    """A file that is right; the part of it, with its key there, whose values are replaced."""
    data = begun(plane=True) | {
        "links": {"a": {}, "b": {}, "s": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
            "B": {"type": "R", "links": ["ground", "b"], "point": [0.06, 0]},
            "C": {"type": "P", "links": ["ground", "s"], "point": [0, 0.02], "axis": [1, 0]},
        },
        "points": {
            "P": {"link": "ground", "at": [-0.1, 0.1]},
            "Q": {"link": "s", "at": [0.2, 0.02]},
            "M": {"link": "ground", "at": [0.06, 0]},
        },
    }
    turning: dict[str, Any] = {"from": 0, "to": 1, "count": 3, "rate": 1}
    coupling = copy.deepcopy(COUPLINGS.get(kind, COUPLINGS["gear"]))
    data["couplings"] = {"K": coupling}
    inputs: dict[str, Any] = {"A.theta": turning, "B.theta": {"at": 0}, "C.s": {"at": 0.01}}
    del inputs["B.theta"]
    if kind in ("rack", "law", "sequence", "function", "cable"):
        inputs = {"A.theta": turning, "B.theta": {"at": 0}}
    data["motion"] = {"inputs": inputs}
    if kind in LAWS:
        resting = {"law": "constant-rate", "at": 0.01, "rate": 0}
        inputs = {"A.theta": copy.deepcopy(LAWS[kind]), "C.s": resting}
        data["motion"] = {"time": {"from": 0, "to": 1, "count": 5}, "inputs": inputs}
        return data, inputs, "A.theta"
    if kind in ("limits", "cylinders"):
        data[kind] = copy.deepcopy(LIMIT if kind == "limits" else CYLINDER)
        return data, data, kind
    return data, data["couplings"], "K"


def places(value: Any, way: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """The ways to a value and to all within it."""
    yield way
    if isinstance(value, dict | list):
        for key, inner in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places(inner, (*way, key))


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = str(rng.choice(KINDS))
    data, part, key = sound(kind)
    ways = list(places(part[key]))
    way = (key, *ways[int(rng.integers(len(ways)))])
    strange = STRANGE[int(rng.integers(len(STRANGE)))]
    for step in way[:-1]:
        part = part[step]
    part[way[-1]] = copy.deepcopy(strange)
    judged.remark, judged.rows = "refused", 1
    told = f"{kind}: {'.'.join(map(str, way))}: {strange!r}"[:120]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            model = judged.model(data)
            result = model.analyze()
            if getattr(model.built.file.couplings.get("K"), "follower", None) is not None:
                model.cam("K")
    except mk.InvalidFile as invalid:
        if not all(one.place is not None for one in invalid.diagnostics if one.severity == "error"):
            judged.faults.append(f"{told}: refused without a place: {invalid}"[:300])
        return
    except mk.MechkinError as error:
        judged.remark = type(error).__name__
        return
    except Exception as error:
        judged.faults.append(f"{told}: {type(error).__name__}: {error}"[:300])
        return
    judged.remark = "a mechanism"
    for name in ("A.theta", "B.theta", "C.s", "A.theta_dot", "C.s_dot"):
        values = np.asarray(result[name], float)
        bare = ~np.isfinite(values)
        if np.any(np.isinf(values)) or any(
            str(word) == "ok" for word in np.asarray(result["row.status"])[bare]
        ):
            judged.faults.append(f"{told}: {name} is {values}")
