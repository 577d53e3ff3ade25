"""Wheels, belts and chains on a carrier that turns itself, with a dyad that joins both, against
the equations of all five bodies in absolute coordinates with multipliers.

Right are the motion and the bearings that follow from the constraints alone, where the coupling is
a pair of moments on its wheels and their carrier; what its teeth or strands pull is added to them.
Derivatives of the constraints are complex steps, and differences of these.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from random_families.driven_machines.judged import Floats, Judged, begun, numbers

KINDS = ("gear", "ring", "belt", "crossed belt", "chain")
LIMIT = 1e-7
BODIES = ("c", "a", "b", "p", "q")
LINKS = {"O": "ground c", "A": "c a", "B": "c b", "E": "a p", "F": "b q", "D": "p q"}
PUSH = (2.0, -3.0)
"""Accelerations of the two inputs."""


class Drawn(NamedTuple):
    """A machine, by its file and what the equations need.

    Attributes:
        ratio: turns of the second wheel against the carrier that make one of the first.
        turned: joints whose links are written the other way round.
    """

    data: dict[str, Any]
    ratio: float
    turned: set[str]


def _drawn(rng: np.random.Generator, kind: str) -> Drawn:
    size = float(rng.uniform(0.3, 1.0) * 10.0 ** rng.uniform(-1, 1))

    def way(angle: float) -> Floats:
        return np.array([np.cos(angle), np.sin(angle)])

    angle, one, other = rng.uniform(0, 2 * np.pi, 3)
    at = {"O": rng.uniform(-1, 1, 2) * size, "A": rng.uniform(-1, 1, 2) * size}
    at["B"] = at["A"] + size * way(angle)
    at["E"] = at["A"] + size * rng.uniform(0.15, 0.4) * way(one)
    at["F"] = at["B"] + size * rng.uniform(0.15, 0.4) * way(other)
    out = size * rng.uniform(0.5, 1.0) * rng.choice([-1, 1])
    at["D"] = (at["E"] + at["F"]) / 2.0 + out * way(angle + np.pi / 2)
    turned = {name for name in LINKS if rng.random() < 0.5}
    teeth = [int(n) for n in rng.integers(12, 30, 2)]
    given: dict[str, Any] = {"joints": ["A", "B"], "type": kind.split()[-1]}
    ratio = teeth[0] / teeth[1]
    if kind in ("gear", "ring"):
        if kind == "ring":
            given["internal"], teeth = True, [teeth[0], teeth[0] + 7]
        given |= {"type": "gear", "teeth": teeth, "pressure_angle": float(rng.uniform(0, 0.5))}
        ratio = teeth[0] / teeth[1] * (1 if kind == "ring" else -1)
    elif kind == "chain":
        given |= {"teeth": teeth, "pitch": 0.06 * size}
    else:
        radii = numbers(rng.uniform(0.1, 0.45, 2) * size)
        given |= {"radii": radii, "crossed": kind != "belt"}
        ratio = radii[0] / radii[1] * (1 if kind == "belt" else -1)
    if kind not in ("gear", "ring") and rng.random() < 0.5:
        given["pretension"] = 1e5
    links = {
        name: {
            "mass": float(rng.uniform(0.1, 3)),
            "center_of_mass": numbers(rng.uniform(-1, 1, 2) * size),
            "inertia": float(rng.uniform(0.1, 1) * size**2),
        }
        for name in BODIES
    }
    joints = {
        name: {
            "type": "R",
            "links": pair.split()[:: -1 if name in turned else 1],
            "point": numbers(at[name]),
        }
        for name, pair in LINKS.items()
    }
    torques = {name: float(rng.uniform(-5, 5) * size) for name in ("b", "q", "c")}
    loads: list[dict[str, Any]] = [{"type": "gravity", "g": [0, -float(rng.uniform(0, 10))]}]
    loads += [{"type": "torque", "link": name, "torque": x} for name, x in torques.items()]
    swept = {
        f"{name}.theta": {"from": -far, "to": far, "count": 3, "rate": rate, "acceleration": push}
        for name, far, rate, push in zip(
            "OA", (0.02, 0.03), numbers(rng.uniform(-3, 3, 2)), PUSH, strict=True
        )
    }
    data = begun(plane=True) | {
        "links": links,
        "joints": joints,
        "couplings": {"K": given},
        "loads": loads,
        "motion": {"inputs": swept},
    }
    return Drawn(data, ratio, turned)


def _jacobian(function: Callable[[Floats], Floats], at: Floats) -> Floats:
    steps = at + 1e-30j * np.eye(at.size)
    return np.array([function(step).imag / 1e-30 for step in steps]).T


def _row(drawn: Drawn, turns: tuple[float, float]) -> dict[str, Any]:
    """The columns of a row by its inputs."""
    data, number = drawn.data, {name: 3 * k for k, name in enumerate(BODIES)}
    centre = {name: np.array(data["links"][name]["center_of_mass"]) for name in BODIES}
    point = {name: np.array(given["point"]) for name, given in data["joints"].items()}

    def placed(x: Floats, body: str, at: Floats) -> Floats:
        if body == "ground":
            return at.astype(x.dtype)
        k, arm = number[body], at - centre[body]
        cos, sin = np.cos(x[k + 2]), np.sin(x[k + 2])
        return x[k : k + 2] + np.array([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]])

    def angle(x: Floats, body: str) -> Any:
        return 0.0 if body == "ground" else x[number[body] + 2]

    def turn(x: Floats, joint: str) -> Any:
        first, second = data["joints"][joint]["links"]
        return angle(x, second) - angle(x, first)

    def constraints(x: Floats) -> Floats:
        gaps = []
        for joint, given in data["joints"].items():
            first, second = given["links"]
            gaps.append(placed(x, second, point[joint]) - placed(x, first, point[joint]))
        own = [angle(x, name) - angle(x, "c") for name in "ab"]
        rest = [own[0] - own[1] / drawn.ratio, turn(x, "O"), turn(x, "A")]
        return np.concatenate([*gaps, np.array(rest)])

    x = np.concatenate([[*centre[name], 0.0] for name in BODIES])
    wanted = np.zeros(15)
    for part in (0.5, 1.0):
        wanted[-2:] = part * np.array(turns)
        for _ in range(12):
            x = x - np.linalg.solve(_jacobian(constraints, x), constraints(x) - wanted)
    matrix, right = _jacobian(constraints, x), np.zeros(15)
    swept = data["motion"]["inputs"]
    right[-2:] = [swept[f"{name}.theta"]["rate"] for name in "OA"]
    rates = np.linalg.solve(matrix, right)
    step = 1e-5 / max(1.0, float(np.max(np.abs(rates[2::3]))))
    ahead = {k: _jacobian(constraints, x + k * step * rates) for k in (-2, -1, 1, 2)}
    moved = (8.0 * (ahead[1] - ahead[-1]) - (ahead[2] - ahead[-2])) / (12.0 * step)
    right[-2:] = PUSH
    masses, forces = np.zeros(15), np.zeros(15)
    for name, k in number.items():
        mass = data["links"][name]["mass"]
        masses[k : k + 3] = mass, mass, data["links"][name]["inertia"]
        forces[k + 1] = mass * data["loads"][0]["g"][1]
    for load in data["loads"][1:]:
        forces[number[load["link"]] + 2] += load["torque"]
    system = np.block([[np.diag(masses), -matrix.T], [matrix, np.zeros((15, 15))]])
    solved = np.linalg.solve(system, np.concatenate([forces, right - moved @ rates]))
    accelerations, pushes = solved[:15], solved[15:]

    bearing = {name: pushes[2 * k : 2 * k + 2] for k, name in enumerate(data["joints"])}
    pull = _pull(drawn, *(placed(x, name, point[name.upper()]) for name in "ab"), pushes[12])
    for name, own in (("A", pull), ("B", -pull)):
        bearing[name] = bearing[name] - own * (-1 if name in drawn.turned else 1)
    found: dict[str, Any] = {f"{name}.force": force for name, force in bearing.items()}
    for name in data["joints"]:
        found[f"{name}.theta"], found[f"{name}.theta_dot"] = turn(x, name), turn(rates, name)
        found[f"{name}.theta_ddot"] = turn(accelerations, name)
    return found | {"O.effort": pushes[13], "A.effort": pushes[14]}


def _pull(drawn: Drawn, first: Floats, second: Floats, moment: float) -> Floats:
    """What teeth or strands pull the first wheel with, which bears a moment about its axis."""
    given = drawn.data["couplings"]["K"]
    distance = float(np.hypot(*(second - first)))
    along = (second - first) / distance
    across = np.array([-along[1], along[0]])
    if given["type"] == "gear":
        one, other = given["teeth"]
        ring = given.get("internal", False)
        reach = distance * one / (one - other if ring else one + other)
        apart = abs(moment / reach) * np.tan(given["pressure_angle"])
        # off the pitch point; a wheel in a ring, here the first, lies off it the other way
        return across * (moment / reach) + along * (apart if ring else -apart)
    radii = given.get("radii") or [n * given["pitch"] / (2 * np.pi) for n in given["teeth"]]
    lean = (radii[0] + (radii[1] if given.get("crossed") else -radii[1])) / distance
    left, right = (np.sqrt(1 - lean**2) * along + side * lean * across for side in (-1, 1))
    share = moment / radii[0]
    if "pretension" in given:
        return (given["pretension"] - share / 2) * left + (given["pretension"] + share / 2) * right
    return max(-share, 0.0) * left + max(share, 0.0) * right


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = judged.remark = str(rng.choice(KINDS))
    drawn = _drawn(rng, kind)
    result = judged.model(drawn.data).analyze()
    if not judged.is_ok(result, ["slack"]):
        return
    ends = [drawn.data["motion"]["inputs"][f"{name}.theta"]["to"] for name in "OA"]
    rows = [_row(drawn, (part * ends[0], part * ends[1])) for part in (-1.0, 0.0, 1.0)]
    largest: dict[str, float] = {}
    for name, value in ((name, value) for row in rows for name, value in row.items()):
        word = name.partition(".")[2]
        largest[word] = max(largest.get(word, 0.0), float(np.max(np.abs(value))))
    for number, row in enumerate(rows):
        for name, value in row.items():
            size = largest[name.partition(".")[2]]
            judged.compare(name, np.asarray(result[name])[number], value, size, LIMIT)
