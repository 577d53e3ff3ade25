"""Efforts at actuators: random mechanisms against free-body equations with the efforts there.

The motion stays prescribed at the inputs; as many coordinates elsewhere, chosen at random, carry
the efforts. Every reaction, total wrench and what ground feels must follow.
"""

from __future__ import annotations

import itertools
import random

import numpy as np
import pytest
from oracle import UnsolvableError, newton_euler
from properties.answers import Values, answers, at_row, errors, scales, within
from properties.case import Case
from properties.cases import LOOPS, STRUCTURES, case, original
from properties.expected import expected

import mechkin_cli as mk

SOME = [*LOOPS[::3], *STRUCTURES]
MOST_LEVERAGE = 30.0
"""Of actuators that are next to singular nothing is asked here: their loads are so much larger."""


def coordinates(its: Case) -> list[str]:
    """All coordinates but one of two that are one freedom, and turns past half a turn."""
    return [
        f"{name}.{coordinate}"
        for name, joint in its.mechanism.joints.items()
        for coordinate in joint.coordinates
    ]


def chosen(name: str) -> tuple[tuple[str, ...], dict[str, np.ndarray]]:
    """Actuators beside the inputs, and what the oracle says of them."""
    its = case(name)
    inputs = its.solution.inputs
    free = [each for each in coordinates(its) if each not in inputs]
    plain = scales(expected(its.mechanism, its.solution, its.reactions), its.size)["load"]
    sets = list(itertools.combinations(free, len(inputs)))
    random.Random(name).shuffle(sets)
    for actuators in sets[:40]:
        if len({a.partition(".")[0] for a in actuators}) < len(actuators):
            continue  # theta and s of a screw are one freedom
        try:
            reactions = newton_euler(its.mechanism, its.solution, actuators)
        except UnsolvableError:
            continue
        wanted = expected(its.mechanism, its.solution, reactions)
        if scales(wanted, its.size)["load"] <= MOST_LEVERAGE * plain:
            return actuators, wanted
    pytest.skip("no other coordinates can carry the efforts well")


def with_actuators(text: str, actuators: tuple[str, ...]) -> str:
    return f"{text}\nactuators: [{', '.join(actuators)}]\n"


def found_at(its: Case, actuators: tuple[str, ...]) -> Values:
    return at_row(answers(with_actuators(its.text, actuators)), its.row)


@pytest.mark.parametrize("name", SOME)
def test_all_quantities_with_the_efforts_elsewhere(name: str) -> None:
    its = case(name)
    actuators, wanted = chosen(name)
    found = found_at(its, actuators)
    assert found.keys() == wanted.keys()
    assert within(errors(found, wanted, its.size, its.condition), MOST_LEVERAGE)


@pytest.mark.parametrize("name", SOME[::4])
def test_the_power_balance_counts_the_actuators(name: str) -> None:
    actuators, _ = chosen(name)
    analysis = mk.loads(with_actuators(case(name).text, actuators)).analyze()
    assert (analysis["row.power_error"] <= 1e-11).all()


@pytest.mark.parametrize("name", SOME[::2])
def test_actuators_at_the_inputs_change_nothing(name: str) -> None:
    its = case(name)
    found = found_at(its, its.solution.inputs)
    assert within(errors(found, at_row(original(name), its.row), its.size, its.condition), 2.0)


@pytest.mark.parametrize("name", STRUCTURES[::3])
def test_the_order_of_the_actuators_does_not_matter(name: str) -> None:
    its = case(name)
    actuators, _ = chosen(name)
    one, other = found_at(its, actuators), found_at(its, actuators[::-1])
    assert within(errors(one, other, its.size, its.condition), MOST_LEVERAGE)


def test_a_wrong_effort_is_seen() -> None:
    """The check can fail: the efforts at the inputs are not those at other joints."""
    its = case(STRUCTURES[0])
    _, wanted = chosen(STRUCTURES[0])
    reactions = newton_euler(its.mechanism, its.solution)
    at_inputs = expected(its.mechanism, its.solution, reactions)
    shared = at_inputs.keys() & wanted.keys()
    one = {k: np.asarray(at_inputs[k], dtype=float) for k in shared}
    assert not within(errors(one, {k: wanted[k] for k in shared}, its.size, its.condition), 1e6)
