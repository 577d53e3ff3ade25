"""A pair of wheels that drives a spatial four-bar, said in other ways: the same motion and forces.

Its parts in another order, the wheels named the other way round or twice, by a sum, a function or
a crossed belt, through an idler, and the sweep run backwards. Teeth and strands pull differently at
the bearings of the wheels, which are not compared.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from random_families.driven_machines.judged import Judged, begun, numbers

WAYS = (
    *("in another order", "the other way round", "twice", "by a sum", "by a function"),
    *("by a crossed belt", "through an idler", "by two sums", "backwards"),
)
COMPARED = ("D.theta", "D.theta_dot", "D.theta_ddot", "M.effort", "D.force", "A.force")
LIMIT = 1e-8


def _data(rng: np.random.Generator) -> dict[str, Any]:
    """Without couplings."""
    offset, axis = rng.uniform(-0.2, 0.2, 3), rng.normal(size=3)
    end = numbers(np.array([1.4, 0.8, 0.3]) + offset)
    masses: dict[str, Any] = {
        name: {
            "mass": 1.0 + k,
            "center_of_mass": [0.1 * k, 0.2, -0.1],
            "inertia": {"xx": 0.1, "yy": 0.12, "zz": 0.15 + 0.01 * k},
        }
        for k, name in enumerate(("m", "c", "k"))
    }
    upright = {"type": "R", "axis": [0, 0, 1]}
    rocker = {"type": "R", "axis": numbers(axis), "point": [1.5, 0, 0], "links": ["ground", "k"]}
    return begun(plane=False) | {
        "links": masses | {"q": {}},
        "joints": {
            "M": upright | {"links": ["ground", "m"], "point": [-0.5, 0, 0]},
            "O": upright | {"links": ["ground", "c"], "point": [0, 0, 0]},
            "A": {"type": "S", "links": ["c", "q"], "point": [0.3, 0, 0.1]},
            "B": {"type": "S", "links": ["q", "k"], "point": end},
            "D": rocker,
        },
        "loads": [
            {"type": "gravity", "g": [0, 0, -9.81]},
            {"type": "torque", "joint": "D", "value": 3.0},
        ],
        "motion": {
            "inputs": {
                "M.theta": {"from": -0.2, "to": 0.4, "count": 7, "rate": 2, "acceleration": -1}
            }
        },
    }


def _said(data: dict[str, Any], way: str, one: int, other: int) -> dict[str, Any]:
    """The file with the coupling said in a way."""
    gear = {"type": "gear", "joints": ["M", "O"], "teeth": [one, other]}
    idler = {"type": "R", "links": ["ground", "i"], "point": [-0.2, 0.3, 0], "axis": [0, 0, -1]}
    couplings: dict[str, Any] = {"K": gear}
    if way == "in another order":
        turned = {key: dict(reversed(data[key].items())) for key in ("links", "joints")}
        data = data | turned
    elif way == "the other way round":
        couplings = {"K": gear | {"joints": ["O", "M"], "teeth": [other, one]}}
    elif way == "twice":
        couplings["again"] = gear | {"ideal": True}
    elif way == "by a sum":
        couplings = {"K": {"type": "linear", "terms": {"M.theta": one, "O.theta": other}}}
    elif way == "by a function":
        value = f"-theta*{one}/{other}"
        couplings = {"K": {"type": "function", "of": "M.theta", "gives": "O.theta", "value": value}}
    elif way == "by a crossed belt":
        belt = {"type": "belt", "crossed": True, "radii": [1e-3 * one, 1e-3 * other]}
        couplings = {"K": belt | {"joints": ["M", "O"]}}
    elif way == "backwards":
        swept = data["motion"]["inputs"]["M.theta"]
        swept = swept | {"from": swept["to"], "to": swept["from"]}
        data = data | {"motion": {"inputs": {"M.theta": swept}}}
    elif way in ("through an idler", "by two sums"):
        added = {"links": data["links"] | {"i": {}}, "joints": data["joints"] | {"I": idler}}
        data = data | added
        couplings = {
            "K": {"type": "linear", "terms": {"M.theta": one, "I.theta": -7}},
            "then": {"type": "linear", "terms": {"I.theta": 7, "O.theta": other}},
        }
        if way == "through an idler":  # whose axis points down
            couplings["K"] = gear | {"joints": ["M", "I"], "teeth": [one, 17]}
            wheel = {"type": "belt", "radii": [0.017, 1e-3 * other]}
            couplings["then"] = wheel | {"joints": ["I", "O"]}
    return data | {"couplings": couplings}


def judge(rng: np.random.Generator, judged: Judged) -> None:
    way = judged.remark = str(rng.choice(WAYS))
    one, other = (int(n) for n in rng.integers(10, 60, 2))
    data = _data(rng)
    first = judged.model(_said(data, "", one, other)).analyze()
    second = judged.model(_said(data, way, one, other)).analyze()
    words = [[str(word) for word in rows["row.status"]] for rows in (first, second)]
    judged.rows = len(words[0])
    order = slice(None, None, -1) if way == "backwards" else slice(None)
    solved = np.isfinite(np.asarray(first["D.theta"]))
    if way == "backwards" and not solved.all():
        return  # it begins elsewhere, where nothing may be assembled
    if words[0] != words[1][order]:
        judged.faults.append(f"rows are {words[1]}, by the gear {words[0]}")
        return
    for name in COMPARED:
        wanted, found = (np.asarray(rows[name], float) for rows in (first, second))
        wanted, found = wanted[solved], found[order][solved]
        sure = np.isfinite(wanted)
        if np.any(sure != np.isfinite(found)):
            judged.faults.append(f"{name} has other empty cells")
        elif sure.any():
            size = float(np.max(np.abs(wanted[sure])))
            judged.compare(name, found[sure], wanted[sure], size, LIMIT)
