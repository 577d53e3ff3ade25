"""A linkage in a plane that is turned, mirrored, renamed, reordered, doubled, split, driven
elsewhere or closed elsewhere has the same answers."""

from __future__ import annotations

import copy
import json
from math import cos, sin
from typing import Any

import numpy as np
import pytest
from random_families.planar.judge import COORDINATES
from random_families.planar.linkages import Linkage

import mechkin_cli as mk

SEEDS = (3, 5, 8, 11, 17, 23)
NEAR = 2e-13
Data = dict[str, Any]


@pytest.fixture(params=SEEDS)
def data(request: pytest.FixtureRequest) -> Data:
    return Linkage(request.param).file()


def run(data: Data) -> mk.Analysis:
    return mk.loads(json.dumps(data)).analyze()


def scalars(data: Data) -> list[str]:
    """What no turn of the plane changes."""
    names = [
        f"{name}.{coordinate}{order}"
        for name, joint in data["joints"].items()
        for coordinate in COORDINATES[joint["type"]]
        for order in ("", "_dot", "_ddot")
    ]
    return [*names, *(f"norm({name}.force)" for name in data["joints"]), "J0.effort"]


def same(one: Any, other: Any, near: float = NEAR) -> None:
    assert np.isfinite(one).any()
    assert (np.isfinite(one) == np.isfinite(other)).all()
    known = np.isfinite(one)
    size = max(1.0, float(np.max(np.abs(one[known]))))
    assert np.max(np.abs(one[known] - other[known])) <= near * size


def near(before: mk.Analysis) -> float:
    return NEAR * max(1.0, float(np.nanmax(before["row.condition"]))) ** 2


def moved(value: Any, by: Any) -> Any:
    """The data with every vector of two numbers moved; names of links and points stay."""
    if isinstance(value, dict):
        return {key: moved(item, by) for key, item in value.items()}
    if isinstance(value, list):
        if len(value) == 2 and all(isinstance(item, (int, float)) for item in value):
            return by(value)
        return [moved(item, by) for item in value]
    return value


def test_turned_in_the_plane(data: Data) -> None:
    c, s = cos(0.7), sin(0.7)
    turned = moved(data, lambda v: [c * v[0] - s * v[1], s * v[0] + c * v[1]])
    before, after = run(data), run(turned)
    for name in scalars(data):
        same(before[name], after[name], near(before))
    for joint in data["joints"]:
        x, y = before[f"{joint}.force"].T
        back = np.stack([c * x - s * y, s * x + c * y], axis=1)
        same(back, after[f"{joint}.force"], near(before))


def test_mirrored(data: Data) -> None:
    """Across the x axis: angles and torques change sign, lengths do not."""
    other = moved(copy.deepcopy(data), lambda v: [v[0], -v[1]])
    ((name, drive),) = other["motion"]["inputs"].items()
    if name.endswith("theta"):
        number, unit = drive["rate"].split()
        drive |= {"from": -drive["from"], "to": -drive["to"], "rate": f"{-float(number)} {unit}"}
    for load in other["loads"]:
        if load["type"] == "torque":
            load["torque"] = -load["torque"]
        elif load["type"] == "spring" and load.get("coordinate") == "theta":
            load["free"] = -load["free"]
    before, after = run(data), run(other)
    for quantity in scalars(data):
        odd = ".theta" in quantity or (quantity == "J0.effort" and name.endswith("theta"))
        same(before[quantity], (-1 if odd else 1) * after[quantity], near(before))


def test_renamed_and_reordered(data: Data) -> None:
    """Nothing but the names' order changes, which other closing joints may follow from."""
    words = {name: f"z{99 - k}" for k, name in enumerate([*data["links"], *data["joints"]])}
    text = json.dumps(data)
    for old in sorted(words, key=len, reverse=True):
        text = text.replace(f'"{old}"', f'"{words[old]}"').replace(f'"{old}.', f'"{words[old]}.')
    other = json.loads(text)
    for key in ("links", "joints", "points"):
        other[key] = dict(reversed(other[key].items()))
    before, after = run(data), run(other)
    for name in scalars(data):
        renamed = name
        for old in sorted(words, key=len, reverse=True):
            renamed = renamed.replace(f"{old}.", f"{words[old]}.")
        same(before[name], after[renamed], near(before))


def test_doubled(data: Data) -> None:
    """A second one beside it, on an input of its own."""
    both = copy.deepcopy(data)
    own = {name: f"{name}_b" for name in (*data["links"], *data["joints"], *data["points"])}
    text = json.dumps({k: data[k] for k in ("links", "joints", "points", "loads", "motion")})
    for old in sorted(own, key=len, reverse=True):
        text = text.replace(f'"{old}"', f'"{own[old]}"').replace(f'"{old}.', f'"{own[old]}.')
    other = json.loads(text)
    for key in ("links", "joints", "points"):
        both[key] |= other[key]
    ((name, _),) = other["motion"]["inputs"].items()
    ((first, _),) = data["motion"]["inputs"].items()
    both["motion"]["inputs"][name] = {"with": first}
    both["loads"] += [load for load in other["loads"] if load["type"] != "gravity"]
    before, after = run(data), run(both)
    for quantity in [name for name in scalars(data) if "effort" not in name]:
        same(before[quantity], after[quantity], near(before))
        same(before[quantity], after[quantity.replace(".", "_b.", 1)], near(before))


def test_a_link_in_two_welded_halves(data: Data) -> None:
    """What hangs on the first joint of a link goes to a half of its own; the weld carries it."""
    split = copy.deepcopy(data)
    link, half = "L1", "half"
    split["links"][half] = {}
    own = [name for name, joint in split["joints"].items() if link in joint["links"]][-1]
    joint = split["joints"][own]
    for key in ("links", "point", "axis"):
        if isinstance(joint.get(key), dict):
            joint[key] = {half if k == link else k: v for k, v in joint[key].items()}
    joint["links"] = [half if name == link else name for name in joint["links"]]
    split["joints"]["weld"] = {"type": "W", "links": [link, half]}
    before, after = run(data), run(split)
    for quantity in scalars(data):
        same(before[quantity], after[quantity], near(before))


def test_the_other_way_round(data: Data) -> None:
    """The rows from the last to the first."""
    back = copy.deepcopy(data)
    (drive,) = back["motion"]["inputs"].values()
    drive["from"], drive["to"] = drive["to"], drive["from"]
    before, after = run(data), run(back)
    for quantity in scalars(data):
        same(before[quantity], after[quantity][::-1], near(before))


def test_joints_the_other_way_round(data: Data) -> None:
    """The links of every R and P exchanged: coordinates change sign, and so do forces."""
    other = copy.deepcopy(data)
    swapped = {name for name, joint in data["joints"].items() if joint["type"] in ("R", "P")}
    for name in swapped:
        other["joints"][name]["links"].reverse()
    for load in other["loads"]:
        if load.get("joint") in swapped and load["type"] == "spring":
            load["free"] = -load["free"]
    ((name, drive),) = other["motion"]["inputs"].items()
    number, unit = drive["rate"].split()
    drive |= {"from": -drive["from"], "to": -drive["to"], "rate": f"{-float(number)} {unit}"}
    before, after = run(data), run(other)
    for quantity in scalars(data):
        owner = quantity.removeprefix("norm(").partition(".")[0]
        odd = owner in swapped and not quantity.startswith("norm")
        same(before[quantity], (-1 if odd else 1) * after[quantity], near(before))
