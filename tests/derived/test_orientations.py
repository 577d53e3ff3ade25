"""Quaternions and rotation vectors of S, Sp and Sg against rotations at 40 digits and composed
half-angle quaternions."""

from __future__ import annotations

import numpy as np
import pytest
from derived.exact_rows import solution
from mechanisms.runs import closings, edited, model, run
from oracle import mp
from oracle.vectors import product, transpose, turn

from mechkin_cli.derived.basis import angle, quaternion, rotation_vector

LIMIT = 4e-16
QUATERNION = ("q0", "q1", "q2", "q3")


def columns(rotation):
    return tuple(tuple(np.array([float(row[k])]) for row in rotation) for k in range(3))


AXES = ([1, 0, 0], [0, -1, 0], [0, 0, 1], [1, 2, 2], [-6, 3, 2], [2, -6, -3])


@pytest.mark.parametrize("degrees", ["0", "1e-9", "0.01", "60", "119.9", "179", "179.999999999"])
@pytest.mark.parametrize("axis", AXES)
def test_rotation_vector_at_every_angle(axis, degrees):
    """Absolute errors of some roundings near 0 and near 180 degrees alike."""
    length = mp.sqrt(sum(x * x for x in axis))
    phi = mp.mpf(degrees) * mp.pi / 180
    q = quaternion(columns(turn([x / length for x in axis], phi)))
    found = rotation_vector(q)
    assert all(abs(f[0] - x * phi / length) <= 2 * LIMIT for f, x in zip(found, axis, strict=True))
    assert abs(angle(q)[0] - phi) <= 2 * LIMIT
    expected = [mp.cos(phi / 2), *(x / length * mp.sin(phi / 2) for x in axis)]
    assert all(abs(f[0] - e) <= LIMIT for f, e in zip(q, expected, strict=True))


@pytest.mark.parametrize("axis", AXES)
def test_half_a_turn_has_a_positive_first_component(axis):
    length = mp.sqrt(sum(x * x for x in axis))
    found = rotation_vector(quaternion(columns(turn([x / length for x in axis], mp.pi))))
    sign = next(1 if x > 0 else -1 for x in axis if x)
    for f, x in zip(found, axis, strict=True):
        assert abs(f[0] - sign * x * mp.pi / length) <= 1e-15


def swash(start, to, step):
    names = [*(f"nose.{q}" for q in QUATERNION), "nose.turn"]
    motion = {"inputs": {"shaft_bearing.theta": {"from": start, "to": to, "step": step}}}
    return edited("swash_plate", names, motion=motion)


@pytest.mark.parametrize("step", [10, 100, 270])
def test_quaternion_is_continuous_over_two_turns(step):
    """The plunger only shifts, so the orientation at its nose is the shaft's turn."""
    found = swash(0, 720, step)
    half = [mp.radians(k * step) / 2 for k in range(found.rows)]
    assert np.max(np.abs(found["nose.q0"] - [float(mp.cos(h)) for h in half])) <= 2 * LIMIT
    assert np.max(np.abs(found["nose.q3"] - [float(mp.sin(h)) for h in half])) <= 2 * LIMIT
    assert np.max(np.abs(found["nose.q1"])) <= LIMIT


def test_rotation_vector_of_the_shaft():
    found = swash(-170, 350, 20)["nose.turn"]
    degrees = np.arange(-170, 351, 20)
    expected = np.where(degrees > 180, degrees - 360, degrees)
    assert np.max(np.abs(found[:, 2] - expected)) <= 1e-13
    assert np.max(np.abs(found[:, :2])) <= 1e-13


def test_rows_before_and_behind_the_drawing():
    """The path starts at the drawing; the first row decides the sign."""
    found = swash(-300, 60, 60)
    half = [mp.radians(d) / 2 for d in range(-300, 61, 60)]
    assert found["nose.q0"][0] > 0
    assert np.max(np.abs(found["nose.q0"] + [float(mp.cos(h)) for h in half])) <= LIMIT


def hamilton(p, q):
    return [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]


def about(axis, degrees):
    half = mp.radians(float(degrees)) / 2
    length = mp.sqrt(sum(x * x for x in axis))
    return [mp.cos(half), *(x / length * mp.sin(half) for x in axis)]


@pytest.mark.parametrize(
    ("name", "first", "second"), [("rspr", [2, 1, 0], [-3, 2, 0]), ("rsgc", [1, 2, 1], [1, 1, 0])]
)
def test_quaternion_is_composed_of_the_turns_of_both_axes(name, first, second):
    """conj(q_A) q_B with half of the continuous angles: the sign too."""
    found = run(name)
    expected = []
    for theta_a, theta_b in zip(found["A.theta"], found["B.theta"], strict=True):
        expected.append(hamilton(about(first, -theta_a), about(second, theta_b)))
    sign = 1 if expected[0][0] >= 0 else -1
    for k, q in enumerate(QUATERNION):
        wanted = [float(sign * e[k]) for e in expected]
        assert np.max(np.abs(found[f"S.{q}"] - wanted)) <= 1e-14


@pytest.mark.parametrize("row", [1, 13, 25])
def test_sphere_of_rcsr_against_the_oracle(row):
    its = solution("rcsr", row)
    rotation = product(transpose(its.rotation("coupler")[0]), its.rotation("rocker")[0])
    vector = [mp.radians(float(x)) for x in run("rcsr")["O3.turn"][row]]
    size = mp.sqrt(sum(x * x for x in vector))
    found = turn([x / size for x in vector], size)
    errors = [abs(found[i][k] - rotation[i][k]) for i in range(3) for k in range(3)]
    assert max(errors) <= 1e-14


def test_the_closing_joint_does_not_matter():
    names = [*(f"O3.{q}" for q in QUATERNION), "O3.turn"]
    wanted = run("rcsr")
    for cut in closings("rcsr"):
        found = model("rcsr").analyze(names, tables=[], closed_at=cut)
        for name in names:
            scale = 180 if name.endswith("turn") else 1
            assert np.max(np.abs(found[name] - wanted[name])) <= 1e-13 * scale, (cut, name)


def test_rows_without_solution_stay_empty():
    names = ["O3.q0", "O3.turn", "rocker.screw_axis", "coupler.finite_slide"]
    names += [f"O4.theta.{name}" for name in ("mechanical_advantage", "transmission_angle")]
    motion = {"inputs": {"O1.theta": {"from": 196, "to": 210, "step": 2}}}
    found = edited("rcsr", names, motion=motion)
    beyond = found["O1.theta"] > 205.2
    for name in names:
        empty = np.isnan(found[name]).reshape(beyond.size, -1)
        assert np.array_equal(empty.all(axis=1), beyond), name
        assert np.array_equal(empty.any(axis=1), beyond), name
