"""The choice of the closing joints never changes an answer."""

from __future__ import annotations

import random
from itertools import combinations

import pytest
from oracle import Mechanism
from properties.answers import answers, at_row, errors, within
from properties.cases import CASES, LOOPS, STRUCTURES, case, original

TWICE = 2.0
MOST = 8


def closings(mechanism: Mechanism) -> list[tuple[str, ...]]:
    """Joints with closing equations that are not driven and whose cut leaves a tree."""
    joints = mechanism.joints
    driven = {name.split(".")[0] for name in mechanism.inputs}
    able = [name for name, joint in joints.items() if joint.type != "H" and name not in driven]
    loops = len(joints) - len(mechanism.links)
    return [cut for cut in combinations(able, loops) if _leaves_a_tree(mechanism, cut)]


def _leaves_a_tree(mechanism: Mechanism, cut: tuple[str, ...]) -> bool:
    reached, count = {"ground"}, 0
    edges = [{j.first, j.second} for name, j in mechanism.joints.items() if name not in cut]
    while len(reached) > count:
        count = len(reached)
        reached |= {link for edge in edges if edge & reached for link in edge}
    return len(reached) == len(mechanism.links) + 1


def some_closings(name: str) -> list[tuple[str, ...]]:
    every = closings(case(name).mechanism)
    return random.Random(name).sample(every, min(len(every), MOST))


@pytest.mark.parametrize("name", CASES)
def test_every_other_closing(name):
    its = case(name)
    wanted = at_row(original(name), its.row)
    for joints in some_closings(name):
        found = at_row(answers(its.text, closed_at=list(joints)), its.row)
        assert found.keys() == wanted.keys()
        assert within(errors(found, wanted, its.size, its.condition), TWICE), joints


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (LOOPS, set("RPCS")),
        (STRUCTURES, {"R", "P", "C", "S", "Sp", "Sg", "U", "E", "W"}),
    ],
    ids=["loops", "structures"],
)
def test_all_closing_types_occur(names, expected):
    found = {
        case(name).mechanism.joints[joint].type
        for name in names
        for joints in some_closings(name)
        for joint in joints
    }
    assert found == expected
