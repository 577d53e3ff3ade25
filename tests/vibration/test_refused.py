"""What small motions refuse, with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

import mechkin_cli as mk
from mechkin_cli.diagnostics import UsageError

ENGINE = Path(__file__).parents[2] / "mechanisms" / "vibration" / "engine_mounts.yaml"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"run": "fall"}, "fall"),
        ({"row": 7}, "5 rows"),
        ({"coordinates": ["pose.x"]}, "6 freedoms"),
        ({"coordinates": ["sump"]}, "no coordinate"),
        ({"held": ["pose.u"]}, "no input"),
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
    with pytest.raises(UsageError, match="no parameter"):
        v.sensitivity("stiff")


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
