"""What small motions refuse, with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError

ENGINE = Path(__file__).parents[2] / "mechanisms" / "vibration" / "engine_mounts.yaml"

ALL = [f"pose.{name}" for name in ("rx", "ry", "rz", "x", "y", "z")]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"run": "fall"}, "fall"),
        ({"row": 7}, "5 rows"),
        ({"coordinates": ["pose.x"]}, "6 freedoms"),
        ({"coordinates": ["sump"]}, "no coordinate"),
        ({"held": ["pose.u"]}, "no input"),
        ({"held": ALL}, "all inputs are held"),
    ],
)
def test_what_is_refused(arguments: dict, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        mk.load(ENGINE).vibration(**arguments)


def test_what_inputs_and_outputs_are_refused() -> None:
    v = mk.load(ENGINE).vibration(row=2)
    for inputs, outputs in ((["front_left.force.x"], ["pose.x"]), (["pose.x"], ["pose.u"])):
        with pytest.raises(UsageError):
            v.state_space(inputs, outputs)
    with pytest.raises(UsageError, match="not known beside a row"):
        v.state_space(["pose.x"], ["row.condition"])
    with pytest.raises(UsageError, match="is a jerk"):
        v.state_space(["pose.x"], ["sump.jerk"])
    with pytest.raises(UsageError, match="no parameter"):
        v.sensitivity("stiff")


def test_an_effective_stiffness_is_of_what_a_force_moves() -> None:
    v = mk.load(ENGINE).vibration(row=2)
    for quantity in ("pose.x_dot", "sump.velocity.x", "sump.position", "row.condition"):
        with pytest.raises(UsageError):
            v.effective_stiffness(quantity)


@pytest.mark.parametrize("frequency", [-1.0, float("nan"), float("inf")])
def test_frequencies_of_a_response_are_numbers_of_hertz(frequency: float) -> None:
    v = mk.load(ENGINE).vibration(row=2)
    with pytest.raises(UsageError, match="Hz, 0 or more"):
        v.response([1.0, frequency], "pose.x", ["pose.x"])


def test_no_inertia_is_told() -> None:
    text = """format: 1
links: {a: {}}
joints: {A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
loads: [{type: spring, joint: A, coordinate: theta, stiffness: 3}]
motion: {inputs: {A.theta: {at: 0}}}
"""
    v = mk.loads(text).vibration()
    assert v.stiffness[0, 0] == pytest.approx(3.0)
    with pytest.raises(UsageError, match=r"A\.theta has no inertia"):
        _ = v.frequencies


@pytest.mark.parametrize("coordinates", [None, ["B.theta", "A.theta"]])
def test_loads_that_jump_with_a_rate_are_told(coordinates: list[str] | None) -> None:
    text = """format: 1
plane: xy
units: {length: m, force: N, angle: rad}
links: {a: {mass: 1, center_of_mass: [0, -1]}, b: {mass: 1, center_of_mass: [0, -2]}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [0, -1]}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: torque, joint: A, value: LAW}
motion: {inputs: {A.theta: {at: 0}, B.theta: {at: 0}}}
"""
    for law, told in (('"-2 N*m*sign(A.theta_dot)"', True), ('"-2 N*m*s/rad*A.theta_dot"', False)):
        v = mk.loads(text.replace("LAW", law)).vibration(coordinates=coordinates)
        assert any(one.code == "bent-loads" for one in v.diagnostics) == told
