"""Every joint type in the tree: displacement, twist, acceleration, transmitted wrench.

The pair under test is carried by a link that moves. Where its state has a quaternion its rates
cannot be prescribed, so a loop around it prescribes them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from kernel.pairs import PAIRS, PITCH, O, Z, derivative, mp, vector
from kernel.plans import (
    EVERYTHING,
    LENGTH,
    ORIGIN,
    TABLE,
    Chain,
    TreeJoint,
    doubles,
    floats,
    frame,
    random_pose,
    run,
)

from mechkin_cli.plan.records import LoadCode, OutputCode

SEEDS = 3
POINT, DIRECTION = (0.3, -0.7, 0.45), (0.6, 0.0, -0.8)


class Subject:
    """The chain: R (driven), helpers, the pair under test.

    With the helpers a closing R prescribes all rates of a pair whose state is no list of scalars.
    """

    def __init__(self, letter: str, generator: np.random.Generator) -> None:
        self.pair = PAIRS[letter]
        self.open = self.pair.states == self.pair.freedoms
        helpers = "" if self.open else "RP"[: 5 - self.pair.freedoms]
        letters = ["R", *helpers]
        joints = [TreeJoint(each, k - 1, random_pose(generator)) for k, each in enumerate(letters)]
        self.carrier = len(joints) - 1
        self.on_carrier = random_pose(generator)
        before = self.on_carrier
        for each, at in self.pair.chain:
            home = doubles(before * at)
            joints.append(TreeJoint(each, len(joints) - 1, home))
            before = mp.inverse(at)
        self.on_last = before * self.pair.home
        self.last = len(joints) - 1
        self.chain = Chain.of(joints)
        point_on_first = self.pair.point_on_first
        self.place = self.chain.builder.add_place(
            self.last,
            self.carrier,
            self.last,
            self.carrier if point_on_first else self.last,
            floats(vector(self.on_carrier if point_on_first else self.on_last, 3)),
            1.0,
        )

    def random_states(self, generator: np.random.Generator) -> np.ndarray:
        helpers = generator.uniform(-1.5, 1.5, self.carrier + 1)
        return np.array([*helpers, *self.pair.random_state(generator)])

    def own_states(self, states: np.ndarray) -> list[float]:
        return states[self.carrier + 1 :].tolist()

    def drive(self, letter: str, *, along_thread: bool) -> None:
        """Drives all freedoms of the pair; of a pose without an axis to act along."""
        if self.pair.freedoms == 6:
            for column in range(self.carrier + 1, self.carrier + 7):
                self.chain.builder.add_input(column, -1, 1.0)
        for freedom, (slide, one, two) in enumerate(PAIRS[letter].drives):
            on_first = vector(self.on_carrier * mp.matrix([*one, 0]), 0)
            on_second = vector(self.on_last * mp.matrix([*two, 0]), 0)
            axis = self.chain.builder.add_axis(
                self.place,
                slide or along_thread,
                self.carrier,
                floats(on_first),
                self.last,
                floats(on_second),
            )
            scale = 1 / PITCH if along_thread else 1.0
            self.chain.builder.add_input(self.carrier + 1 + freedom, axis, scale)

    def close(self, states: np.ndarray, generator: np.random.Generator) -> None:
        """Closes the chain by an R to ground where it stands."""
        on_link = random_pose(generator)
        on_ground = doubles(self.chain.poses(states)[self.last] * on_link)
        loop = [(k, 1.0) for k in range(self.last + 1)]
        ends = frame(on_ground), frame(on_link)
        plan = self.chain.builder
        plan.add_closing_joint(TABLE["R"]["code"], -1, self.last, *ends, 0.0, loop)
        plan.add_block(1, list(range(self.last + 1)), list(range(1, plan.columns)))


class Moved:
    """A pair's chain, run once with random states, rates and accelerations."""

    def __init__(self, letter: str, seed: int, *, along_thread: bool = False) -> None:
        generator = np.random.default_rng(seed)
        self.tested = tested = Subject(letter, generator)
        self.chain, self.number = tested.chain, tested.last
        states = tested.random_states(generator)
        centre, tensor = (0.2, 0.1, -0.3), (1.5, 1.2, 0.9, 0.1, -0.2, 0.05)
        for link in [*range(tested.carrier + 1), tested.last]:  # none between a pair's parts
            self.chain.builder.set_inertia(link, 1.0 + link, centre, tensor)
        self.chain.builder.set_gravity((1.0, -2.0, 3.0))
        force = int(LoadCode.FORCE_LINK)
        self.chain.builder.add_load(force, self.number, -1, 0, POINT, floats(O), (4.0, -3.0, 2.0))
        self.chain.drive(0)
        if tested.open:
            tested.drive(letter, along_thread=along_thread)
            self.chain.builder.set_rest(list(range(len(self.chain.joints))))
        else:
            tested.close(states, generator)
        self.chain.finish()
        output, number = self.chain.output, self.number
        self.points = [output(OutputCode.POINT, number, order, POINT) for order in range(3)]
        self.vector = output(OutputCode.VECTOR, number, 0, DIRECTION)
        self.turning = [output(OutputCode.OMEGA, number), output(OutputCode.ALPHA, number)]
        self.slip = output(OutputCode.SLIP, tested.place, 0, POINT)
        self.force = output(OutputCode.JOINT_FORCE, tested.place)
        self.moment = output(OutputCode.JOINT_MOMENT, tested.place)
        self.axis = output(OutputCode.VECTOR, number, 0, Z)
        driven = list(range(self.chain.plan.columns)) if tested.open else [0]
        self.run = run(
            self.chain,
            np.ascontiguousarray(states[driven, None]),
            np.ascontiguousarray(states[:, None]),
            rates=generator.uniform(-1, 1, (len(driven), 1)),
            accelerations=generator.uniform(-1, 1, (len(driven), 1)),
            demand=EVERYTHING,
        )
        assert self.run.flags[0] == 0
        assert np.all(np.isfinite([*self.run.first, *self.run.second]))

    def pose(self, time: Any) -> Any:
        """Pose of the moved link by the product of exponentials."""
        r = self.run
        return self.chain.poses(r.states[:, 0], r.first[:, 0], r.second[:, 0], time)[self.number]

    def measured(self, slots: slice) -> np.ndarray:
        return self.run.outputs[slots, 0]


@pytest.fixture(params=[(letter, seed) for letter in PAIRS for seed in range(SEEDS)], ids=str)
def moved(request: pytest.FixtureRequest) -> Moved:
    return Moved(*request.param)


def in_metres(position: Any) -> list[float]:
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


def test_a_chain_displaces_as_its_pair(moved: Moved) -> None:
    """The second frame against the first, whatever bodies lie between."""
    tested = moved.tested
    poses = moved.chain.poses(moved.run.states[:, 0])
    first = poses[tested.carrier] * tested.on_carrier
    second = first * tested.pair.displacement(tested.own_states(moved.run.states[:, 0]))
    at = vector(second * mp.inverse(tested.on_last) * mp.matrix([*POINT, 1]), 0)
    np.testing.assert_allclose(moved.measured(moved.points[0]), in_metres(at), rtol=0, atol=1e-14)


def test_slip_is_the_joint_point_seen_from_a_point_of_the_second_link(moved: Moved) -> None:
    tested = moved.tested
    poses = moved.chain.poses(moved.run.states[:, 0])
    first, last = poses[tested.carrier] * tested.on_carrier, poses[tested.last]
    point = first if tested.pair.point_on_first else last * tested.on_last
    contact = vector(last * mp.matrix([*POINT, 1]), 0)
    expected = [float(c - b) for c, b in zip(vector(point, 3), contact, strict=True)]
    np.testing.assert_allclose(moved.measured(moved.slip), expected, rtol=0, atol=1e-14)


def test_the_transmitted_wrench_does_no_work_on_the_freedoms(moved: Moved) -> None:
    """Drives and joint loads set aside; about the joint's point."""
    tested, states = moved.tested, moved.run.states[:, 0]
    if tested.pair.freedoms == 6:
        return  # it transmits what its drives exert and nothing else
    carrier = moved.chain.poses(states)[tested.carrier] * tested.on_carrier
    axes = np.array([[float(carrier[i, j]) for i in range(3)] for j in range(3)])
    force, moment = axes @ moved.measured(moved.force), axes @ moved.measured(moved.moment)
    scale = np.abs(force).max() + np.abs(moment).max()
    assert scale > 0.1
    for power in tested.pair.powers(tested.own_states(states), force, moment):
        assert abs(power) <= 1e-13 * scale


@pytest.mark.parametrize("seed", range(SEEDS))
def test_a_screw_may_be_driven_by_a_torque_or_by_a_force(seed: int) -> None:
    """Either drive is set aside as what it is; force times pitch is torque."""
    turned, pushed = (Moved("H", seed, along_thread=along_thread) for along_thread in (False, True))
    axis = turned.measured(turned.axis)
    torque = pushed.measured(pushed.moment) - turned.measured(turned.moment)
    force = turned.measured(turned.force) - pushed.measured(pushed.force)
    size = np.abs(torque @ axis)
    assert size > 0.1
    np.testing.assert_allclose(torque, (torque @ axis) * axis, rtol=0, atol=1e-13 * size)
    np.testing.assert_allclose(force * PITCH, torque, rtol=0, atol=1e-13 * size)
