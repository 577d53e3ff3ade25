"""The oracle on random loops: joints hold together, rates are differences, momentum balances."""

from __future__ import annotations

import random
from functools import cache

import pytest
from oracle import mp, newton_euler, random_loop, read, solve
from oracle.vectors import apply, product, scale, subtract, transpose
from oracle_checks.balance import STEP, difference, external, length, momentum

LOOPS = ("RRRRRRR", "PRSRR", "CSPR", "HCPHRR")
LAW = tuple(map(mp.mpf, ("0.04", "0.9", "-0.7", "0.5")))


@cache
def case(types: str):
    """A mechanism and its solutions at the times -2, -1, 0, 1, 2 steps."""
    mechanism = read(random_loop(random.Random(types), types))
    (driven,) = mechanism.inputs
    x, v, a, j = LAW
    solutions = []
    guess: dict = {}
    for k in (0, -2, -1, 1, 2):
        t = k * STEP
        law = (x + v * t + a * t**2 / 2 + j * t**3 / 6, v + a * t + j * t**2 / 2, a + j * t, j)
        solutions.append(solve(mechanism, {driven: law}, guess))
        guess = solutions[0].coordinates
    middle, *beside = solutions
    return mechanism, [beside[0], beside[1], middle, beside[2], beside[3]]


@pytest.mark.parametrize("types", LOOPS)
def test_joints_hold_together(types):
    """What the two links of a joint have in common, looked at from both."""
    mechanism, solutions = case(types)
    for name, joint in mechanism.joints.items():
        found = solutions[2]
        first, second = (
            found.motion(link, point)[0]
            for link, point in zip((joint.first, joint.second), joint.points, strict=True)
        )
        gap = subtract(second, first)
        if joint.axes:
            axis, other = (
                apply(found.rotation(link)[0], a)
                for link, a in zip((joint.first, joint.second), joint.axes, strict=True)
            )
            assert length(subtract(axis, other)) < mp.mpf("1e-35")
            slide = found[f"{name}.s"] if "s" in joint.coordinates else mp.zero
            gap = subtract(gap, scale(axis, slide))
        assert length(gap) < mp.mpf("1e-35")


@pytest.mark.parametrize("types", LOOPS)
def test_angles_are_those_between_the_links(types):
    """The relative rotation's trace is 1 + 2 cos(theta)."""
    mechanism, solutions = case(types)
    found = solutions[2]
    for name, joint in mechanism.joints.items():
        if joint.type == "S":
            continue
        first, second = (found.rotation(link)[0] for link in (joint.first, joint.second))
        relative = product(transpose(first), second)
        trace = relative[0][0] + relative[1][1] + relative[2][2]
        theta = found[f"{name}.theta"] if "theta" in joint.coordinates else mp.zero
        assert abs(trace - 1 - 2 * mp.cos(theta)) < mp.mpf("1e-35")


@pytest.mark.parametrize("types", LOOPS)
def test_rates_are_differences(types):
    mechanism, solutions = case(types)
    for name, joint in mechanism.joints.items():
        for coordinate in joint.coordinates:
            for lower, upper in (("", "_dot"), ("_dot", "_ddot"), ("_ddot", "_dddot")):
                slope = difference([x[f"{name}.{coordinate}{lower}"] for x in solutions])
                assert abs(slope - solutions[2][f"{name}.{coordinate}{upper}"]) < mp.mpf("1e-22")


@pytest.mark.parametrize("types", LOOPS)
def test_momentum_balances(types):
    """The rates of momentum of all links, by differences, are what ground and the loads exert."""
    mechanism, solutions = case(types)
    reactions = newton_euler(mechanism, solutions[2])
    rates = [difference(column) for column in zip(*(momentum(s) for s in solutions), strict=True)]
    acting = external(solutions[2], reactions)
    assert length(subtract(rates, acting)) < mp.mpf("1e-22") * length(acting)


@pytest.mark.parametrize("types", LOOPS)
def test_power_balances(types):
    mechanism, solutions = case(types)
    reactions = newton_euler(mechanism, solutions[2])
    assert abs(reactions.power) < mp.mpf("1e-33") * reactions.power_size
