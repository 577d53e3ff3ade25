"""The choice of the closing joint never changes an answer."""

from __future__ import annotations

import pytest
from properties.answers import answers, at_row, errors, within
from properties.loops import SEEDS, loop

TWICE = 2.0


def closable(seed: int) -> list[str]:
    """Joints with closing equations that are not driven."""
    joints = loop(seed).mechanism.joints.items()
    return [name for name, joint in joints if joint.type != "H" and name != "J1"]


@pytest.mark.parametrize("seed", SEEDS)
def test_every_other_closing_joint(seed):
    case = loop(seed)
    wanted = at_row(answers(case.text), case.row)
    for joint in closable(seed):
        found = at_row(answers(case.text, closed_at=[joint]), case.row)
        assert found.keys() == wanted.keys()
        assert within(errors(found, wanted, case.size, case.condition), TWICE), joint


def test_all_closing_types_occur():
    types = {loop(s).mechanism.joints[name].type for s in SEEDS for name in closable(s)}
    assert types == set("RPCS")
