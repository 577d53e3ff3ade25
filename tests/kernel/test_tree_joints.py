"""Every joint type as a tree joint: displacement, twist, acceleration, transmitted wrench.

The joint under test is carried by a link that moves. Where its state is a quaternion its rates
cannot be prescribed, so a loop around it prescribes them.
"""

from __future__ import annotations

import numpy as np
import pytest
from kernel.pairs import PAIRS, PITCH, Z, derivative, mp, vector
from kernel.plans import (
    EVERYTHING,
    LENGTH,
    ORIGIN,
    TABLE,
    Chain,
    TreeJoint,
    doubles,
    frame,
    random_pose,
    run,
)

from mechkin_cli.kernel import _kernel
from mechkin_cli.solver.codes import LoadCode, OutputCode

LETTERS = list(TABLE)
SEEDS = 3
POINT, DIRECTION = (0.3, -0.7, 0.45), (0.6, 0.0, -0.8)


def helpers_for(letter: str) -> list[str]:
    """Joints that let a closing R prescribe all rates of a joint whose state is no list of
    scalars."""
    if TABLE[letter]["freedoms"] == TABLE[letter]["states"]:
        return []
    return ["R", "P"][: 5 - TABLE[letter]["freedoms"]]


def chain_with(letter: str, generator: np.random.Generator) -> tuple[Chain, int]:
    """R (driven), helpers, the joint under test; returns the chain and the tested joint's
    number."""
    letters = ["R", *helpers_for(letter), letter]
    joints = [TreeJoint(each, k - 1, random_pose(generator)) for k, each in enumerate(letters)]
    return Chain.of(joints), len(letters) - 1


def random_states(chain: Chain, generator: np.random.Generator) -> np.ndarray:
    states = generator.uniform(-1.5, 1.5, chain.plan.states)
    for number, joint in enumerate(chain.joints):
        if PAIRS[joint.letter].quaternion:
            own = chain.states_of(number)
            states[own] = states[own] / np.linalg.norm(states[own])
    return states


def close(
    chain: Chain,
    states: np.ndarray,
    generator: np.random.Generator,
    along_axis: bool | None = None,
) -> None:
    """Closes the chain by an R to ground where it stands; a chain of driven joints stays open."""
    last = len(chain.joints) - 1
    if len(chain.joints) == 2:
        for column in range(chain.plan.columns):
            chain.drive(column, along_axis=along_axis if column else None)
        chain.plan.set_rest([0, 1])
    else:
        on_link = random_pose(generator)
        on_ground = doubles(chain.poses(states)[last] * on_link)
        place = _kernel.Place(-1, last, vector_of(on_link, 3), vector_of(on_link, 2), 1.0)
        loop = [(k, 1.0) for k in range(last + 1)]
        closing = TABLE["R"]["code"]
        ends = frame(on_ground), frame(on_link)
        chain.plan.add_closing_joint(closing, -1, last, *ends, loop, place)
        chain.plan.add_block(1, list(range(last + 1)), list(range(1, chain.plan.columns)))
        chain.drive(0)
    chain.plan.finish()


def vector_of(m: object, column: int) -> tuple[float, ...]:
    return tuple(float(c) for c in vector(m, column))


class Moved:
    """A joint's chain, run once with random states, rates and accelerations."""

    def __init__(self, letter: str, seed: int, along_axis: bool | None = None) -> None:
        generator = np.random.default_rng(seed)
        self.chain, self.number = chain_with(letter, generator)
        states = random_states(self.chain, generator)
        centre, tensor = (0.2, 0.1, -0.3), (1.5, 1.2, 0.9, 0.1, -0.2, 0.05)
        for link in range(len(self.chain.joints)):
            self.chain.plan.set_inertia(link, 1.0 + link, centre, tensor)
        self.chain.plan.set_gravity((1.0, -2.0, 3.0))
        force = int(LoadCode.FORCE_LINK)
        self.chain.plan.add_load(force, self.number, -1, POINT, (0.0, 0.0, 0.0), (4.0, -3.0, 2.0))
        close(self.chain, states, generator, along_axis)
        output, number = self.chain.output, self.number
        self.points = [output(OutputCode.POINT, number, order, POINT) for order in range(3)]
        self.vector = output(OutputCode.VECTOR, number, 0, DIRECTION)
        self.turning = [output(OutputCode.OMEGA, number), output(OutputCode.ALPHA, number)]
        self.force = output(OutputCode.JOINT_FORCE, number)
        self.moment = output(OutputCode.JOINT_MOMENT, number)
        self.axis = output(OutputCode.VECTOR, number, 0, Z)
        columns = range(self.chain.plan.columns)
        driven = [c for c in columns if len(self.chain.joints) == 2 or c == 0]
        self.run = run(
            self.chain,
            np.ascontiguousarray(states[driven, None]),
            np.ascontiguousarray(states[:, None]),
            rates=generator.uniform(-1, 1, (len(driven), 1)),
            accelerations=generator.uniform(-1, 1, (len(driven), 1)),
            demand=EVERYTHING,
        )
        assert self.run.flags[0] == 0

    def pose(self, time: object) -> object:
        """Pose of the moved link by the product of exponentials."""
        r = self.run
        return self.chain.poses(r.states[:, 0], r.first[:, 0], r.second[:, 0], time)[self.number]

    def measured(self, slots: slice) -> np.ndarray:
        return self.run.outputs[slots, 0]


@pytest.fixture(params=[(letter, seed) for letter in LETTERS for seed in range(SEEDS)], ids=str)
def moved(request: pytest.FixtureRequest) -> Moved:
    return Moved(*request.param)


def in_metres(position: object) -> list[float]:
    return [float(LENGTH * c + o) for c, o in zip(position, ORIGIN, strict=True)]


def test_body_points_and_directions_move_by_the_exponentials(moved: Moved) -> None:
    pose = moved.pose(0)
    at = vector(pose * mp.matrix([*POINT, 1]), 0)
    np.testing.assert_allclose(moved.measured(moved.points[0]), in_metres(at), rtol=0, atol=1e-14)
    direction = vector(pose * mp.matrix([*DIRECTION, 0]), 0)
    expected = [float(c) for c in direction]
    np.testing.assert_allclose(moved.measured(moved.vector), expected, rtol=0, atol=4e-15)


@pytest.mark.parametrize("order", [1, 2])
def test_points_have_the_derivatives_of_the_displacement(moved: Moved, order: int) -> None:
    path = derivative(lambda t: moved.pose(t) * mp.matrix([*POINT, 1]), order)
    expected = [float(LENGTH * c) for c in vector(path, 0)]
    scale = 1 + np.abs(expected).max()
    measured = moved.measured(moved.points[order])
    np.testing.assert_allclose(measured, expected, rtol=0, atol=2e-14 * scale)


@pytest.mark.parametrize("order", [1, 2])
def test_omega_and_alpha_are_the_derivatives_of_the_rotation(moved: Moved, order: int) -> None:
    """R' R^T = [omega]; the skew part of R'' R^T is [alpha]."""
    rate = derivative(moved.pose, order)[:3, :3] * moved.pose(0)[:3, :3].T
    skew = (rate - rate.T) / 2
    expected = [float(skew[2, 1]), float(skew[0, 2]), float(skew[1, 0])]
    scale = 1 + np.abs(expected).max()
    measured = moved.measured(moved.turning[order - 1])
    np.testing.assert_allclose(measured, expected, rtol=0, atol=2e-14 * scale)


def test_the_transmitted_wrench_does_no_work_on_the_freedoms(moved: Moved) -> None:
    """Drives and joint loads set aside; moments in N m about the joint's point, as screws are."""
    force = LENGTH * moved.measured(moved.force)
    moment = LENGTH**2 * moved.measured(moved.moment)
    joint = moved.chain.joints[moved.number]
    carrier = moved.chain.poses(moved.run.states[:, 0])[joint.parent] * joint.at
    axes = np.array([[float(carrier[i, j]) for j in range(3)] for i in range(3)])
    scale = np.abs(force).max() * LENGTH + np.abs(moment).max()
    assert scale > 1
    for angular, linear in PAIRS[joint.letter].screws:
        power = (axes @ angular) @ moment + LENGTH * (axes @ linear) @ force
        assert abs(power) <= 1e-13 * scale


@pytest.mark.parametrize("seed", range(SEEDS))
def test_a_screw_may_be_driven_by_a_torque_or_by_a_force(seed: int) -> None:
    """Either drive is set aside as what it is; force times pitch is torque."""
    turned, pushed = (Moved("H", seed, along_axis) for along_axis in (False, True))
    axis = turned.measured(turned.axis)
    torque = pushed.measured(pushed.moment) - turned.measured(turned.moment)
    force = turned.measured(turned.force) - pushed.measured(pushed.force)
    size = np.abs(torque @ axis)
    assert size > 0.1
    np.testing.assert_allclose(torque, (torque @ axis) * axis, rtol=0, atol=1e-13 * size)
    np.testing.assert_allclose(force * PITCH, torque, rtol=0, atol=1e-13 * size)
