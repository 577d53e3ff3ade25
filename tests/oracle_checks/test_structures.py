"""The oracle on several loops and all joints, and on legs that spin between two spheres."""

from __future__ import annotations

import random
from functools import cache

import pytest
from oracle import (
    UnsolvableError,
    assemble,
    mp,
    newton_euler,
    random_loop,
    random_structure,
    read,
    solve,
)
from oracle.bodies import Bodies
from oracle.idle import legs, line
from oracle.series import coefficient
from oracle.vectors import cross, dot, norm, subtract
from oracle_checks.balance import STEP, difference, external, length, momentum
from oracle_checks.legs import rssr, stewart, suspension
from references import FILE_OF

LOOPS = ("RRRRRRR", "PRSRR", "CSPR", "HCPHRR")
LEGS = {"RSSR": rssr, "suspension": suspension, "Stewart platform": stewart}
STRUCTURES = ("ternary", "riding", *LEGS)
LAW = tuple(map(mp.mpf, ("0.04", "0.9", "-0.7", "0.5")))
CLOSE = mp.mpf("1e-33")


def text(name: str) -> str:
    if name in LEGS:
        return LEGS[name]()
    return random_structure(random.Random(name), name, inputs=2, tail=True)


@cache
def case(name: str):
    """A mechanism and its solutions at the times -2, -1, 0, 1, 2 steps; inputs differ in speed."""
    mechanism = read(text(name))
    x, v, a, j = LAW
    solutions = []
    for k in (0, -2, -1, 1, 2):
        t = k * STEP
        law = (x + v * t + a * t**2 / 2 + j * t**3 / 6, v + a * t + j * t**2 / 2, a + j * t, j)
        inputs = {n: [value / (i + 1) for value in law] for i, n in enumerate(mechanism.inputs)}
        solutions.append(assemble(mechanism, inputs, solutions[0] if solutions else None))
    middle, *beside = solutions
    return mechanism, [beside[0], beside[1], middle, beside[2], beside[3]]


@pytest.mark.parametrize("types", LOOPS)
def test_two_formulations_agree(types):
    """Joint coordinates along a tree, and six unknowns per link."""
    mechanism = read(random_loop(random.Random(types), types))
    other, found = (f(mechanism, mechanism.row(0)) for f in (solve, assemble))
    names = [n for n in other.coordinates if not n.endswith(".rotation")]
    assert names == list(found.coordinates)
    assert all(abs(found[n] - other[n]) < CLOSE * max(1, abs(other[n])) for n in names)
    for link in mechanism.links:
        assert length(subtract(found.alpha(link), other.alpha(link))) < CLOSE * 100


@pytest.mark.parametrize("name", STRUCTURES)
def test_rates_are_differences(name):
    mechanism, solutions = case(name)
    for joint, its in mechanism.joints.items():
        for coordinate in its.coordinates:
            for lower, upper in (("", "_dot"), ("_dot", "_ddot"), ("_ddot", "_dddot")):
                slope = difference([x[f"{joint}.{coordinate}{lower}"] for x in solutions])
                assert abs(slope - solutions[2][f"{joint}.{coordinate}{upper}"]) < mp.mpf("1e-20")


@pytest.mark.parametrize("name", STRUCTURES)
def test_angular_accelerations_are_differences(name):
    """Also of legs, whose spin rate is zero along the whole path."""
    mechanism, solutions = case(name)
    for link in mechanism.links:
        slopes = [difference(c) for c in zip(*(s.omega(link) for s in solutions), strict=True)]
        assert length(subtract(slopes, solutions[2].alpha(link))) < mp.mpf("1e-20")


@pytest.mark.parametrize("name", STRUCTURES)
def test_momentum_balances(name):
    """The rates of momentum of all links, by differences, are what ground and the loads exert."""
    mechanism, solutions = case(name)
    reactions = newton_euler(mechanism, solutions[2])
    rates = [difference(column) for column in zip(*(momentum(s) for s in solutions), strict=True)]
    acting = external(solutions[2], reactions)
    assert length(subtract(rates, acting)) < mp.mpf("1e-20") * length(acting)


@pytest.mark.parametrize("name", STRUCTURES)
def test_power_balances(name):
    mechanism, solutions = case(name)
    reactions = newton_euler(mechanism, solutions[2])
    assert abs(reactions.power) < CLOSE * reactions.power_size


@pytest.mark.parametrize("name", LEGS)
def test_legs_do_not_spin(name):
    mechanism, solutions = case(name)
    bodies, found = Bodies(mechanism), solutions[2]
    for leg in legs(mechanism):
        direction = [coefficient(x, 0) for x in line(bodies, leg, found.poses)]
        for link in leg.links:
            assert abs(dot(found.omega(link), direction)) < CLOSE
            assert norm(cross(found.omega(link), direction)) > mp.mpf("1e-3")


@pytest.mark.parametrize(
    ("name", "count"), [("RSSR", 1), ("suspension", 6), ("Stewart platform", 6)]
)
def test_legs_are_as_long_as_drawn_or_driven(name, count):
    mechanism, solutions = case(name)
    bodies, found = Bodies(mechanism), solutions[2]
    every = legs(mechanism)
    assert len(every) == count
    drawn = bodies.poses(bodies.drawing(), {})
    for leg in every:
        before, now = (
            norm([coefficient(x, 0) for x in line(bodies, leg, poses)])
            for poses in (drawn, found.poses)
        )
        slides = [n for n, j in mechanism.joints.items() if j.type == "P" and j.first in leg.links]
        assert abs(now - before - mp.fsum(found[f"{n}.s"] for n in slides)) < CLOSE


@pytest.mark.parametrize("name", LEGS)
def test_symmetric_legs_need_no_holding(name):
    mechanism, solutions = case(name)
    holding = newton_euler(mechanism, solutions[2]).holding
    assert len(holding) == len(legs(mechanism))
    assert length(holding) < CLOSE


def test_a_lopsided_coupler_must_be_held():
    """At rest by the moment of its weight about the line."""
    mechanism = read(rssr(mass_centre="0.9"))
    found = assemble(mechanism, {"A.theta": (0,)})
    (holding,) = newton_euler(mechanism, found).holding
    b, c = (found.joint_point(name) for name in ("B", "C"))
    centre = found.motion("coupler", mechanism.links["coupler"].mass_centre)[0]
    weight = [mp.mpf(x) / 2 for x in (1, -2, -9)]
    along = subtract(c, b)
    moment = dot(cross(subtract(centre, b), weight), along) / norm(along)
    assert abs(abs(holding) - abs(moment)) < CLOSE
    assert abs(moment) > mp.mpf("0.1")


def test_hooke_joint():
    """tan(theta_B) = tan(theta_A) cos(angle); redundant constraints leave forces open."""
    mechanism = read(FILE_OF["hooke"])
    angle = mp.mpf("0.7")
    found = assemble(mechanism, {"A.theta": (angle, 1)})
    expected = mp.atan(mp.tan(angle) * mp.sqrt(3) / 2)
    assert abs(found["B.theta"] - expected) < CLOSE
    with pytest.raises(UnsolvableError):
        newton_euler(mechanism, found)


def test_a_missing_input():
    mechanism = read(suspension())
    with pytest.raises(UnsolvableError, match="do not determine"):
        assemble(mechanism, {})
