"""The oracle against `exact/rcsr.csv`, which other programs computed at 40 digits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from oracle import UnsolvableError, fold, mp, newton_euler, read, solve, sweep
from oracle.vectors import add, cross, dot, scale, subtract
from references import RCSR, exact

DEGREE = mp.pi / 180
ROUNDING = mp.mpf("1e-16")  # of 17 significant digits
COORDINATES = {
    "theta1": ("O1.theta", DEGREE),
    "theta2": ("O2.theta", DEGREE),
    "s2": ("O2.s", 1),
    "theta4": ("O4.theta", DEGREE),
    "omega2": ("O2.theta_dot", 1),
    "s2_dot": ("O2.s_dot", 1),
    "omega4": ("O4.theta_dot", 1),
    "alpha2": ("O2.theta_ddot", 1),
    "s2_ddot": ("O2.s_ddot", 1),
    "alpha4": ("O4.theta_ddot", 1),
}


@pytest.fixture(scope="module")
def mechanism():
    return read(RCSR)


@pytest.fixture(scope="module")
def rows(mechanism):
    return sweep(mechanism)


@pytest.fixture(scope="module")
def loads(mechanism, rows):
    return [newton_euler(mechanism, row) for row in rows]


def agrees(column: str, values: Sequence[Any]) -> None:
    expected = [mp.mpf(text) for text in exact("rcsr")[column]]
    errors = [abs(v - e) for v, e in zip(values, expected, strict=True)]
    limits = [ROUNDING * abs(e) + mp.mpf("1e-30") for e in expected]
    assert all(error <= limit for error, limit in zip(errors, limits, strict=True))


def vector_agrees(column: str, values: Sequence[Sequence[Any]]) -> None:
    for i, axis in enumerate("xyz"):
        agrees(f"{column}_{axis}", [value[i] for value in values])


@pytest.mark.parametrize("column", COORDINATES)
def test_coordinates(rows, column):
    coordinate, unit = COORDINATES[column]
    agrees(column, [row[coordinate] / unit for row in rows])


@pytest.mark.parametrize(("order", "prefix"), [(0, ""), (1, "v_"), (2, "a_")])
@pytest.mark.parametrize("point", ["pm1", "pm2", "pm3", "o2", "o3"])
def test_points(rows, point, order, prefix):
    vector_agrees(prefix + point, [row.point(point)[order] for row in rows])


@pytest.mark.parametrize(("joint", "axis", "link"), [("O1", "A1", "41"), ("O4", "A4", "43")])
def test_reactions_at_ground(mechanism, rows, loads, joint, axis, link):
    """The axial part of the force is split off, its moment about the origin with it."""
    direction = mechanism.directions[axis][1]
    axial = [dot(load.force[joint], direction) for load in loads]
    pushes = [scale(direction, value) for value in axial]
    levers = [row.joint_point(joint) for row in rows]
    forces = [subtract(load.force[joint], p) for load, p in zip(loads, pushes, strict=True)]
    moments = [
        subtract(load.moment_about_origin[joint], cross(lever, push))
        for load, lever, push in zip(loads, levers, pushes, strict=True)
    ]
    agrees(f"ne_F{axis}", axial)
    vector_agrees(f"ne_F{link}", forces)
    vector_agrees(f"ne_M{link}", moments)


def test_reaction_between_crank_and_coupler(loads):
    vector_agrees("ne_F21", [load.force["O2"] for load in loads])
    vector_agrees("ne_M21", [load.moment_about_origin["O2"] for load in loads])


def test_reaction_of_the_sphere(rows, loads):
    """FB B + FC C + FD (B x C), put together from the reference, is the force at O3."""
    columns = [[mp.mpf(x) for x in exact("rcsr")[f"ne_F{name}"]] for name in "BCD"]
    for row, load, *parts in zip(rows, loads, *columns, strict=True):
        b, c = row.direction("B"), row.direction("C")
        force = [mp.zero] * 3
        for vector, part in zip((b, c, cross(b, c)), parts, strict=True):
            force = add(force, scale(vector, part))
        error = subtract(force, load.force["O3"])
        assert max(map(abs, error)) <= ROUNDING * max(map(abs, parts)) * 3


def test_input_couple(loads):
    """MIN acts about A1, the effort about the joint's axis -A1."""
    agrees("ne_MIN", [-load.effort["O1.theta"] for load in loads])


@pytest.mark.parametrize(("row", "degrees"), [(0, "133.944"), (26, "205.144")])
def test_dead_centres(mechanism, rows, row, degrees):
    value, _ = fold(mechanism, "O1.theta", rows[row].coordinates)
    assert abs(value / DEGREE - mp.mpf(degrees)) < mp.mpf("0.0005")


def test_branches_meet_at_the_dead_centre(mechanism, rows):
    """A distance d before it two branches are c sqrt(d) to either side; beyond it is none."""
    limit, there = fold(mechanism, "O1.theta", rows[26].coordinates)

    def offset(distance: Any, side: int) -> Any:
        shrink = side * mp.sqrt(distance / (limit - rows[26]["O1.theta"]))
        names = ("O2.theta", "O2.s", "O4.theta")
        guess = {n: there[n] + shrink * (rows[26][n] - there[n]) for n in names}
        found = solve(mechanism, {"O1.theta": (limit - distance,)}, guess)
        return found["O4.theta"] - there["O4.theta"]

    coarse, fine = mp.mpf("1e-8"), mp.mpf("1e-10")
    for side in (1, -1):
        assert abs(offset(coarse, side) / offset(fine, side) - 10) < mp.mpf("0.002")
    assert abs(offset(fine, 1) / offset(fine, -1) + 1) < mp.mpf("0.001")
    with pytest.raises(UnsolvableError):
        solve(mechanism, {"O1.theta": (limit + coarse,)}, rows[26].coordinates)
