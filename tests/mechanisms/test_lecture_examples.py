"""Examples of lecture notes on spatial mechanisms: one position each, solved at 50 digits.

Open chains with all coordinates driven, plane loops (overconstrained in space), cranks with a
slider or a second crank through balls; where a coupler spins freely its rates have no spin. The
mechanism files call a joint `joint_A` and a point `point_A`, since the notes give both the same
name.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from mechanisms.runs import LECTURES, run
from references import FOLDER, committed

import mechkin_cli as mk

LIMIT = 1e-13

_DATA = json.loads((FOLDER / "exact" / "lecture_examples.json").read_text(encoding="utf-8"))
EXAMPLES = {e["name"]: e for e in _DATA["examples"]}

_OF_POINTS = {"position": "position", "velocity": "velocity", "acceleration": "acceleration"}
_OF_LINKS = {
    "angular_velocity": "omega",
    "angular_acceleration": "alpha",
    "angular_velocity_zero_spin": "omega",
    "angular_acceleration_zero_spin": "alpha",
}
_OF_JOINTS = {"joint_displacement": "", "joint_velocity": "_dot", "joint_acceleration": "_ddot"}


def computed(example: dict[str, Any], wanted: dict[str, Any], analysis: mk.Analysis) -> Any:
    """The quantity that an expected value stands for."""
    quantity = wanted["quantity"]
    if "point" in wanted and quantity in _OF_POINTS:
        return analysis[f"point_{wanted['point']}.{_OF_POINTS[quantity]}"][0]
    if "link" in wanted and quantity in _OF_LINKS:
        return analysis[f"{wanted['link']}.{_OF_LINKS[quantity]}"][0]
    if "link" in wanted and quantity == "orientation":
        return np.stack([analysis[f"{axis}_{wanted['link']}"][0] for axis in "xyz"], axis=1)
    if quantity in _OF_JOINTS:
        kind = next(j["type"] for j in example["joints"] if j["name"] == wanted["joint"])
        name = f"joint_{wanted['joint']}.{'theta' if kind == 'R' else 's'}{_OF_JOINTS[quantity]}"
        found = analysis[name][0]
        return np.radians(found) if name.endswith(".theta") else found
    raise ValueError(f"no quantity for {wanted}")


CASES = [
    pytest.param(example, wanted, id=f"{name}-{i}-{wanted['quantity']}")
    for name, example in EXAMPLES.items()
    for i, wanted in enumerate(example["expected"])
    if wanted["quantity"] in {*_OF_POINTS, *_OF_LINKS, *_OF_JOINTS, "orientation"}
]


def test_every_example_has_its_file():
    assert sorted(f"lecture_{name}" for name in EXAMPLES) == LECTURES


@pytest.mark.parametrize(("example", "wanted"), CASES)
def test_expected_values(example, wanted):
    analysis = run(f"lecture_{example['name']}")
    assert not analysis.result.status.any()
    found, expected = np.asarray(computed(example, wanted, analysis)), np.array(wanted["value"])
    assert np.max(np.abs(found - expected)) <= LIMIT * max(1.0, np.max(np.abs(expected)))


@pytest.mark.parametrize("branch", ["plus", "minus"])
def test_equation_50_lacks_the_rate_of_the_input(branch):
    """As printed it is omega_o; it is the ratio of the rates."""
    (row,) = committed(f"lecture_rssr_eq50_{branch}", "result")
    expected = EXAMPLES[f"rssr_eq50_{branch}"]["expected"]
    psi = next(wanted["value"] for wanted in expected if wanted.get("name") == "psi [rad]")
    assert abs(float(row["psi"]) - np.degrees(psi)) <= 1e-9
    assert abs(float(row["eq_50"]) - float(row["ratio"])) <= 1e-11
    assert abs(float(row["Bo_theta_dot"]) - 4 * float(row["eq_50"])) <= 1e-11
