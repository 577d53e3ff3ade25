"""Spheres and pins on curves and surfaces, helical grooves, and cylinders under booms.

What rides on a curve or surface hangs on a cross slide: its height is a closed form of the slide's
place, and it is borne along the normal there. A cylinder's length follows from the law of cosines,
its force from virtual work.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from random_families.driven_machines.judged import Floats, Judged, begun, numbers

PLANE = ("ellipse", "circle", "arc", "line")
SURFACES = ("sphere", "cylinder surface", "torus")
KINDS = (*PLANE, *SURFACES, "helix", "boom")
LIMIT = 1e-9


class Height(NamedTuple):
    """How high a track is over places x along the slide, and how it leans.

    Attributes:
        slope: of the height by x.
        bend: of the slope by x.
        lean: slope of the height across x.
    """

    value: Floats
    slope: Floats
    bend: Floats
    lean: Floats


def _by_square(square: Floats, first: Floats, second: Floats, lean: Any = 0.0) -> Height:
    """A height by its square and the two derivatives of that."""
    value = np.sqrt(square)
    slope = first / (2.0 * value)
    return Height(value, slope, (second / 2.0 - slope**2) / value, lean / value + 0.0 * value)


def _curve(
    rng: np.random.Generator, kind: str, size: float, places: Floats
) -> tuple[dict[str, Any], Height]:
    """The form in the file, and the height over some places."""
    wide, high = (float(v) for v in rng.uniform(0.5, 2.0, 2) * size)
    if kind == "line":
        slope = float(rng.uniform(-2, 2))
        ends = [[-3.0 * size, -3.0 * size * slope], [3.0 * size, 3.0 * size * slope]]
        rest = 0.0 * places
        return {"line": ends}, Height(slope * places, slope + rest, rest, rest)
    if kind == "ellipse":
        at = [f"{wide!r} m*cos(u)", f"{high!r} m*sin(u)"]
        given: dict[str, Any] = {"at": at, "from": "0 deg", "to": "360 deg", "closed": True}
    else:
        wide = high = size
        given = {"center": [0, 0]}
        if kind == "arc":
            angles = [3.1, float(rng.uniform(1.0, 2.0)), 0.04]
            given = {"arc": [numbers(size * np.array([np.cos(a), np.sin(a)])) for a in angles]}
    flat = (high / wide) ** 2
    return given, _by_square(high**2 - flat * places**2, -2 * flat * places, -2 * flat + 0 * places)


def _surface(
    rng: np.random.Generator, kind: str, size: float, y: float, places: Floats
) -> tuple[dict[str, Any], Height]:
    """The same over places beside the slide by y."""
    if kind == "sphere":
        square = size**2 - places**2 - y**2
        return {"sphere": [0, 0, 0], "radius": size}, _by_square(
            square, -2 * places, -2 + 0 * places, -y
        )
    if kind == "torus":
        far = float(rng.uniform(1.5, 3.0) * size)
        out = np.hypot(places, far + y)  # y is beside the circle in the tube
        along = places / out
        square = size**2 - (out - far) ** 2
        second = -2 * along**2 - 2 * (out - far) * (1 - along**2) / out
        lean = -(out - far) * (far + y) / out
        given = {"torus": [0, -far, 0], "radius": far, "tube": size}
        return given, _by_square(square, -2 * (out - far) * along, second, lean)
    tilt = float(rng.uniform(-1, 1))
    round_ = _by_square(size**2 - places**2, -2 * places, -2 + 0 * places)
    axis = numbers([0, np.cos(tilt), np.sin(tilt)])
    given = {"cylinder": [0, 0, 0], "radius": size, "axis": axis}
    value = (round_.value + y * np.sin(tilt)) / np.cos(tilt)
    over = round_.slope / np.cos(tilt), round_.bend / np.cos(tilt)
    return given, Height(value, *over, np.tan(tilt) + 0 * places)


def _ridden(rng: np.random.Generator, judged: Judged, kind: str) -> None:
    flat, size = kind in PLANE, float(10.0 ** rng.uniform(-2, 2))
    x, y = (float(v) for v in rng.uniform(-0.15, 0.15, 2) * size)
    moves = np.array([-0.2, -0.1, 0.0, 0.05, 0.2]) * size
    places = x + moves
    given, height = (
        _curve(rng, kind, size, places) if flat else _surface(rng, kind, size, y, places)
    )
    rate, acceleration = (float(v) for v in rng.uniform(-3, 3, 2) * size)
    load, up = float(rng.uniform(-5, 5)), [0, 1] if flat else [0, 0, 1]
    point = [x, float(height.value[2])] if flat else [x, y, float(height.value[2])]
    contact = {"type": "Ps" if flat else "Sp", "links": ["rider", "ground"], "point": point}
    along = {"type": "P", "links": ["ground", "slide"], "point": [0] * len(up), "axis": up[::-1]}
    data = begun(plane=flat) | {
        "links": {"slide": {}, "rider": {}},
        "joints": {
            "X": along,
            "Z": along | {"links": ["slide", "rider"], "axis": up},
            "D": contact | {"curve" if flat else "surface": given},
        },
        "loads": [{"type": "force", "joint": "Z", "value": load}],
    }
    swept = {"values": numbers(moves), "rate": rate, "acceleration": acceleration}
    data["motion"] = {"inputs": {"X.s": swept}}
    result = judged.model(data).analyze()
    if not judged.is_ok(result):
        return
    normal = (
        [-height.slope, 1 + 0 * moves] if flat else [-height.slope, -height.lean, 1 + 0 * moves]
    )
    force = load * np.stack(normal, axis=1)
    wanted = {
        "Z.s_dot": height.slope * rate,
        "Z.s_ddot": height.bend * rate**2 + height.slope * acceleration,
        "D.force": force,
        "X.effort": force[:, 0],
    }
    judged.compare("Z.s", result["Z.s"], height.value - height.value[2], size, LIMIT)
    judged.values(result, wanted, LIMIT)


def _helix(rng: np.random.Generator, judged: Judged, kind: str) -> None:
    size = float(10.0 ** rng.uniform(-2, 2))
    radius, rise = (float(v) * size for v in (rng.uniform(0.3, 2), rng.uniform(-2, 2)))
    rate, acceleration, load = (float(v) for v in rng.uniform(-3, 3, 3))
    at = [f"{radius!r} m*cos(u)", f"{radius!r} m*sin(u)", f"{rise!r} m*u/(1 rad)"]
    turns = np.array([-7.0, -3.0, 0.0, 2.0, 9.0])
    upright = {"type": "C", "links": ["ground", "c"], "point": [0, 0, 0], "axis": [0, 0, 1]}
    groove = {"type": "Sg", "links": ["c", "ground"], "point": [radius, 0, 0]}
    groove["curve"] = {"at": at, "from": "-720 deg", "to": "720 deg"}
    swept = {"values": numbers(turns), "rate": rate, "acceleration": acceleration}
    data = begun(plane=False) | {
        "links": {"c": {}},
        "joints": {"C": upright, "G": groove},
        "motion": {"inputs": {"C.theta": swept}},
        "loads": [{"type": "force", "link": "c", "point": [0, 0, 0], "force": [0, 0, load]}],
    }
    result = judged.model(data).analyze()
    if not judged.is_ok(result):
        return
    still, length = np.zeros(5), float(np.hypot(radius, rise))
    wanted = {
        "G.u": turns,
        "G.s": length * turns,
        "G.s_dot": length * rate + still,
        "C.s": rise * turns,
        "C.s_dot": rise * rate + still,
        "C.s_ddot": rise * acceleration + still,
        "C.theta.effort": -load * rise + still,
    }
    judged.values(result, wanted, LIMIT)


def _boom(rng: np.random.Generator, judged: Judged, kind: str) -> None:
    size = float(10.0 ** rng.uniform(-2, 2))
    foot, eye = rng.uniform(-1, 1, 2) * size, np.array([1.0, 0.2]) * rng.uniform(0.5, 1) * size
    torque = float(rng.uniform(-5, 5) * size)
    bore, rod = 0.05 * size, 0.03 * size
    turns = np.array([-0.3, 0.0, 0.25, 0.5])
    rate, acceleration = (float(v) for v in rng.uniform(-3, 3, 2))
    cos, sin = np.cos(turns), np.sin(turns)
    turned = np.stack([eye[0] * cos - eye[1] * sin, eye[0] * sin + eye[1] * cos])
    ahead = np.stack([-turned[1], turned[0]])
    length = np.hypot(*(turned - foot[:, None]))
    lever = -foot @ ahead / length  # of the length by the turn
    bend = (foot @ turned - lever**2) / length
    ends = [0.9 * float(length[1]), 1.1 * float(length[1])]
    swept = {"values": numbers(turns), "rate": rate, "acceleration": acceleration}
    cylinder = {"from": "P", "to": "Q", "bore": bore, "rod": rod, "stroke": ends}
    data = begun(plane=True) | {
        "links": {"b": {}},
        "joints": {"A": {"type": "R", "links": ["ground", "b"], "point": [0, 0]}},
        "points": {
            "P": {"link": "ground", "at": numbers(foot)},
            "Q": {"link": "b", "at": numbers(eye)},
        },
        "cylinders": {"C": cylinder},
        "actuators": ["C.s"],
        "loads": [{"type": "torque", "joint": "A", "value": torque}],
        "motion": {"inputs": {"A.theta": swept}},
    }
    result = judged.model(data).analyze()
    if not judged.is_ok(result, ["beyond-limit"]):
        return
    beyond = [str(word) == "beyond-limit" for word in result["row.status"]]
    if np.any(beyond != ((length < ends[0]) | (length > ends[1]))):
        judged.faults.append(f"lengths {length} beyond {ends} are {beyond}")
    judged.compare("C.length", result["C.length"], length, size, LIMIT)
    judged.compare("C.s_dot", result["C.s_dot"], lever * rate, size * abs(rate), LIMIT)
    second = lever * acceleration + bend * rate**2
    judged.compare("C.s_ddot", result["C.s_ddot"], second, float(np.max(np.abs(second))), LIMIT)
    if np.min(np.abs(lever)) < 0.05 * size:
        return
    force = -torque / lever
    area = np.where(force > 0.0, bore**2, bore**2 - rod**2) * np.pi / 4.0
    judged.values(result, {"C.force": force, "C.pressure": force / area}, LIMIT)


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = judged.remark = str(rng.choice(KINDS))
    {"helix": _helix, "boom": _boom}.get(kind, _ridden)(rng, judged, kind)
