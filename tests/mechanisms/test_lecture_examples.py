"""Examples of lecture notes on spatial mechanisms: one position each, solved at 50 digits.

Open chains with all coordinates driven, plane loops (overconstrained in space), a crank with a
slider through a ball; those with an idle freedom are left out. Names get a letter in front, since
the notes give the same name to a joint and to a point.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from oracle import to_text
from references import FOLDER

import mechkin_cli as mk

LIMIT = 1e-13

_DATA = json.loads((FOLDER / "exact" / "lecture_examples.json").read_text(encoding="utf-8"))
EXAMPLES = {e["name"]: e for e in _DATA["examples"] if not e["passive_freedoms"]}

_OF_POINTS = {"position": "position", "velocity": "velocity", "acceleration": "acceleration"}
_OF_LINKS = {"angular_velocity": "omega", "angular_acceleration": "alpha"}
_OF_JOINTS = {"joint_displacement": "", "joint_velocity": "_dot", "joint_acceleration": "_ddot"}
_AXES = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}


def _link(example: dict[str, Any], name: str) -> str:
    return "ground" if name == example["links"][0] else f"l_{name}"


def _joint(example: dict[str, Any], joint: dict[str, Any]) -> dict[str, Any]:
    known = {k: joint[k] for k in ("type", "point", "axis", "normal") if k in joint}
    if "lead" in joint:
        known["lead"] = joint["lead"]
    return known | {"links": [_link(example, name) for name in joint["links"]]}


def _inputs(example: dict[str, Any]) -> dict[str, Any]:
    found = {}
    for given in example["inputs"]:
        turns = given["position_unit"] == "deg"
        unit = " rad/s" if turns else ""
        found[f"j_{given['joint']}.{'theta' if turns else 's'}"] = {
            "at": given["position"],
            "rate": f"{given['velocity']!r}{unit}",
            "acceleration": f"{given['acceleration']!r}{unit and unit + '^2'}",
        }
    return found


def _text(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _text(each) for key, each in value.items()}
    return [_text(each) for each in value] if isinstance(value, list) else str(value)


def file_of(example: dict[str, Any]) -> str:
    links = [_link(example, name) for name in example["links"][1:]]
    points = {
        f"p_{p['name']}": {"link": _link(example, p["link"]), "at": p["at"]}
        for p in example["points"]
    }
    data = {
        "format": 1,
        "name": example["name"],
        "links": {name: {} for name in links},
        "joints": {f"j_{j['name']}": _joint(example, j) for j in example["joints"]},
        "points": points,
        "directions": {
            f"{axis}_{link}": {"link": link, "vector": vector}
            for link in links
            for axis, vector in _AXES.items()
        },
        "motion": {"inputs": _inputs(example)},
    }
    return to_text(_text({key: value for key, value in data.items() if value}))


def computed(example: dict[str, Any], wanted: dict[str, Any], analysis: mk.Analysis) -> Any:
    """The quantity that an expected value stands for."""
    quantity = wanted["quantity"]
    if "point" in wanted and quantity in _OF_POINTS:
        return analysis[f"p_{wanted['point']}.{_OF_POINTS[quantity]}"][0]
    if "link" in wanted and quantity in _OF_LINKS:
        return analysis[f"{_link(example, wanted['link'])}.{_OF_LINKS[quantity]}"][0]
    if "link" in wanted and quantity == "orientation":
        link = _link(example, wanted["link"])
        return np.stack([analysis[f"{axis}_{link}"][0] for axis in _AXES], axis=1)
    if quantity in _OF_JOINTS:
        kind = next(j["type"] for j in example["joints"] if j["name"] == wanted["joint"])
        name = f"j_{wanted['joint']}.{'theta' if kind == 'R' else 's'}{_OF_JOINTS[quantity]}"
        return analysis[name][0]
    raise ValueError(f"no quantity for {wanted}")


CASES = [
    pytest.param(example, wanted, id=f"{name}-{i}-{wanted['quantity']}")
    for name, example in EXAMPLES.items()
    for i, wanted in enumerate(example["expected"])
    if wanted["quantity"] in {*_OF_POINTS, *_OF_LINKS, *_OF_JOINTS, "orientation"}
]


@pytest.mark.parametrize(("example", "wanted"), CASES)
def test_expected_values(example, wanted):
    analysis = mk.loads(file_of(example), example["name"]).analyze(tables=[])
    assert not analysis.result.status.any()
    found, expected = np.asarray(computed(example, wanted, analysis)), np.array(wanted["value"])
    assert np.max(np.abs(found - expected)) <= LIMIT * max(1.0, np.max(np.abs(expected)))
