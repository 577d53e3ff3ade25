"""Every joint type that closes a loop: closing equations, side conditions, derivatives, wrenches.

A link moved by three slides and three turns (any pose can be given to it) is joined to a driven
link by the closing joint. Poses of the pair's own motion come from exponentials; how far a pose is
off that motion is measured as max |X D^-1 - 1|, D the pair's nearest displacement, never by the
kernel's equations.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from kernel.pairs import PAIRS, O, X, Y, Z, derivative, exponential, mp, vector
from kernel.plans import (
    EVERYTHING,
    LENGTH,
    TABLE,
    Chain,
    Run,
    TreeJoint,
    doubles,
    frame,
    random_pose,
    run,
)

from mechkin_cli.kernel import _kernel
from mechkin_cli.solver.codes import Demand, LoadCode, OutputCode, RowFlag

CLOSING = [letter for letter, entry in TABLE.items() if entry["equations"]]
NEXT_AXIS = mp.matrix([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
"""The frame whose z is x, whose x is y: three of them in a row turn back to the first."""
MOVED = 6
"""Number of the link that the six probing joints carry."""
LOAD_POINT = (0.4, 0.3, -0.2)


def held(letter: str) -> list[int]:
    """Probing joints that are driven: one slide per slide of the pair, one turn per turn."""
    slides = bin(TABLE[letter]["slides"]).count("1")
    turns = TABLE[letter]["freedoms"] - slides
    return [*range(1, 1 + slides), *range(4, 4 + turns)]


class Probe:
    """The plan: link 0 on a driven R, links 1 to 6 on P P P R R R, the closing joint between 0 and
    6."""

    def __init__(self, letter: str, seed: int) -> None:
        generator = np.random.default_rng([seed, TABLE[letter]["code"]])
        self.pair = PAIRS[letter]
        self.base = random_pose(generator)
        joints = [TreeJoint("R", -1, random_pose(generator))]
        for k, each in enumerate("PPPRRR"):
            at = NEXT_AXIS if k else doubles(self.base * NEXT_AXIS)
            joints.append(TreeJoint(each, k if k else -1, at))
        self.chain = chain = Chain.of(joints)
        self.on_first, self.on_second = random_pose(generator), random_pose(generator)
        place = _kernel.Place(
            0, MOVED, floats(vector(self.on_second, 3)), floats(vector(self.on_second, 2)), 1.0
        )
        loop = [(k, 1.0) for k in range(1, 7)] + [(0, -1.0)]
        ends = frame(self.on_first), frame(self.on_second)
        chain.plan.add_closing_joint(TABLE[letter]["code"], 0, MOVED, *ends, loop, place)
        self.driven = [0, *held(letter)]
        unknown = [c for c in range(7) if c not in self.driven]
        chain.plan.add_block(1, list(range(7)), unknown)
        for column in self.driven:
            chain.drive(column)
        self.carrier_angle = generator.uniform(-1.5, 1.5)
        state = generator.uniform(-1, 1, TABLE[letter]["states"])
        self.own = state / np.linalg.norm(state) if self.pair.quaternion else state
        self.generator = generator

    def finish(self) -> Probe:
        self.chain.plan.finish()
        return self

    def states(self, displacement: Any) -> np.ndarray:
        """States that displace the pair's second frame against its first as given."""
        carrier = self.chain.poses([self.carrier_angle, *[0] * 6])[0]
        target = carrier * self.on_first * displacement * mp.inverse(self.on_second)
        m = mp.inverse(self.base) * target
        angles = mp.atan2(-m[1, 2], m[2, 2]), mp.asin(m[0, 2]), mp.atan2(-m[0, 1], m[0, 0])
        return np.array([self.carrier_angle, *map(float, vector(m, 3)), *map(float, angles)])

    def run(self, states: np.ndarray, **options: Any) -> Run:
        """One row from a guess; its driven coordinates are the guess's."""
        guess = np.ascontiguousarray(states[:, None])
        return run(self.chain, np.ascontiguousarray(guess[self.driven]), guess, **options)

    def displacement(
        self, states: Any, first: Any = None, second: Any = None, time: Any = 0
    ) -> Any:
        """Displacement of the pair's second frame against its first."""
        poses = self.chain.poses(states, first, second, time)
        return mp.inverse(poses[0] * self.on_first) * poses[MOVED] * self.on_second

    def off_motion(self, displacement: Any) -> Any:
        """How far a displacement is off the pair's own motion, as a matrix."""
        return displacement * mp.inverse(self.pair.nearest(displacement)) - mp.eye(4)


def floats(values: Any) -> tuple[float, ...]:
    return tuple(float(v) for v in values)


def largest(m: Any) -> float:
    return float(max(abs(c) for c in m))


@pytest.fixture(params=[(letter, seed) for letter in CLOSING for seed in range(2)], ids=str)
def probe(request: pytest.FixtureRequest) -> Probe:
    return Probe(*request.param)


def test_equations_vanish_on_the_own_motion(probe: Probe) -> None:
    states = probe.finish().states(probe.pair.displacement(probe.own))
    result = probe.run(states, iterations=0)
    assert result.residual[0] <= 2e-15
    assert result.flags[0] == RowFlag.GOOD


def test_equations_measure_the_distance_off_the_own_motion(probe: Probe) -> None:
    probe.finish()
    on_it = probe.pair.displacement(probe.own)
    for twist in probe.generator.standard_normal((10, 6)).tolist():
        displacement = on_it * exponential(twist[:3], twist[3:], 0.02)
        off = largest(probe.off_motion(displacement))
        residual = probe.run(probe.states(displacement), iterations=0).residual[0]
        assert off / 4 <= residual <= 4 * off


def test_the_equations_are_independent(probe: Probe) -> None:
    """A square block of all equations has full rank, so its condition is a moderate number."""
    states = probe.finish().states(probe.pair.displacement(probe.own))
    condition = probe.run(states, demand=Demand.CONDITION).condition[0]
    assert 0.1 < condition < 1e4


def test_a_sphere_moved_by_three_square_slides_has_condition_one() -> None:
    """Its equations are the slides themselves, whatever the unit of length."""
    probe = Probe("S", 0).finish()
    states = probe.states(probe.pair.displacement(probe.own))
    result = probe.run(states, demand=Demand.CONDITION)
    assert result.condition[0] == pytest.approx(1, rel=1e-14)


@pytest.mark.parametrize("axis", [X, Y, Z], ids=["x", "y", "z"])
def test_half_turns_pass_only_where_they_are_the_own_motion(probe: Probe, axis: Any) -> None:
    """Parallel axes that point opposite ways, or a body upside down, are no assembly."""
    displacement = probe.pair.displacement(probe.own) * exponential(axis, O, mp.pi)
    own = largest(probe.off_motion(displacement)) < 1e-30
    result = probe.finish().run(probe.states(displacement), iterations=0)
    assert (result.flags[0] == RowFlag.GOOD) == own


@pytest.mark.parametrize("letter", [each for each in "RC" if each in CLOSING])
def test_reversed_axes_fulfil_the_equations_and_fail_the_side_condition(letter: str) -> None:
    probe = Probe(letter, 0).finish()
    displacement = probe.pair.displacement(probe.own) * exponential(X, O, mp.pi)
    result = probe.run(probe.states(displacement), iterations=0)
    assert result.residual[0] <= 2e-15
    assert result.flags[0] == RowFlag.SIDE_CONDITION


def test_a_half_turned_slide_keeps_its_error_at_half_a_turn() -> None:
    """The skew part of the rotation error vanishes here; the rotation vector has length pi."""
    probe = Probe("P", 0).finish()
    for axis in (X, Y, Z):
        displacement = probe.pair.displacement(probe.own) * exponential(axis, O, mp.pi)
        residual = probe.run(probe.states(displacement), iterations=0).residual[0]
        assert np.pi / np.sqrt(3) - 1e-9 <= residual <= np.pi + 1e-9


def test_newton_ends_on_the_own_motion(probe: Probe) -> None:
    probe.finish()
    states = probe.states(probe.pair.displacement(probe.own))
    unknown = [k for k in range(7) if k not in probe.driven]
    states[unknown] += probe.generator.uniform(-0.02, 0.02, len(unknown))
    result = probe.run(states)
    assert result.flags[0] == RowFlag.GOOD
    assert largest(probe.off_motion(probe.displacement(result.states[:, 0]))) <= 1e-14


@pytest.mark.parametrize("order", [1, 2])
def test_rates_stay_on_the_own_motion(probe: Probe, order: int) -> None:
    """Derivatives of the columns keep the pair closed to the same order."""
    found = moving(probe.finish())
    state, first, second = found.states[:, 0], found.first[:, 0], found.second[:, 0]
    off = derivative(lambda t: probe.off_motion(probe.displacement(state, first, second, t)), order)
    scale = 1 + max(np.abs(first).max() ** order, np.abs(second).max())
    assert largest(off) <= 2e-14 * scale


def moving(probe: Probe) -> Run:
    """A closed row with random rates, accelerations and everything else demanded."""
    count = len(probe.driven)
    result = probe.run(
        probe.states(probe.pair.displacement(probe.own)),
        rates=probe.generator.uniform(-1, 1, (count, 1)),
        accelerations=probe.generator.uniform(-1, 1, (count, 1)),
        demand=EVERYTHING,
    )
    assert result.flags[0] == RowFlag.GOOD
    return result


COORDINATES = [
    (letter, name) for letter in CLOSING for name in ("theta", "s") if TABLE[letter][name]
]


@pytest.mark.parametrize(("letter", "name"), COORDINATES)
def test_coordinates_of_the_closing_joint_and_their_derivatives(letter: str, name: str) -> None:
    probe = Probe(letter, 1)
    code = OutputCode.CLOSING_THETA if name == "theta" else OutputCode.CLOSING_S
    slots = [probe.chain.output(code, 0, order) for order in range(3)]
    found = moving(probe.finish())
    state, first, second = found.states[:, 0], found.first[:, 0], found.second[:, 0]

    def coordinate(t: Any) -> Any:
        m = probe.displacement(state, first, second, t)
        return mp.atan2(m[1, 0], m[0, 0]) if name == "theta" else m[2, 3]

    expected = [coordinate(0), derivative(coordinate, 1), derivative(coordinate, 2)]
    scale = 1 + np.abs(found.second).max()
    for slot, value in zip(slots, expected, strict=True):
        assert found.outputs[slot, 0][0] == pytest.approx(float(value), rel=0, abs=2e-14 * scale)


def load(probe: Probe) -> None:
    """Masses on the way and a force and a torque on the moved link, which has no mass."""
    for link in range(MOVED):
        tensor = (1.5, 1.2, 0.9, 0.1, -0.2, 0.05)
        probe.chain.plan.set_inertia(link, 1.0 + link, (0.2, 0.1, -0.3), tensor)
    probe.chain.plan.set_gravity((1.0, -2.0, 3.0))
    add = probe.chain.plan.add_load
    add(int(LoadCode.FORCE_GROUND), MOVED, -1, LOAD_POINT, O, (4.0, -3.0, 2.0))
    add(int(LoadCode.TORQUE_GROUND), MOVED, -1, O, O, (1.0, 2.0, -5.0))


def test_the_closing_wrench_does_no_work_on_the_freedoms(probe: Probe) -> None:
    load(probe)
    force_at = probe.chain.output(OutputCode.JOINT_FORCE, -1)
    moment_at = probe.chain.output(OutputCode.JOINT_MOMENT, -1)
    result = moving(probe.finish())
    force, moment = LENGTH * result.outputs[force_at, 0], LENGTH**2 * result.outputs[moment_at, 0]
    pose = probe.chain.poses(result.states[:, 0])[0] * probe.on_first
    axes = np.array([[float(pose[i, j]) for j in range(3)] for i in range(3)])
    scale = np.abs(force).max() * LENGTH + np.abs(moment).max()
    assert scale > 0.1
    for angular, linear in probe.pair.screws:
        power = (axes @ angular) @ moment + LENGTH * (axes @ linear) @ force
        assert abs(power) <= 1e-13 * scale


def test_undriven_joints_of_the_loop_feel_no_power(probe: Probe) -> None:
    """Only the right closing wrench leaves nothing along the slides and about the turns."""
    load(probe)
    undriven = [k for k in range(7) if k not in probe.driven]
    output = probe.chain.output
    wrenches = {
        k: output(OutputCode.JOINT_FORCE if k <= 3 else OutputCode.JOINT_MOMENT, k)
        for k in undriven
    }
    closing = output(OutputCode.JOINT_FORCE, -1)
    axes = {k: output(OutputCode.VECTOR, k, 0, Z) for k in undriven}
    out = moving(probe.finish()).outputs[:, 0]
    scale = np.abs(out[closing]).max() + max(np.abs(out[slot]).max() for slot in wrenches.values())
    assert scale > 1
    for k in undriven:
        assert abs(out[wrenches[k]] @ out[axes[k]]) <= 1e-13 * scale


def test_the_moved_link_is_in_equilibrium(probe: Probe) -> None:
    """Its tree joint, the drive there, the closing joint and the loads: forces and moments about
    ground."""
    load(probe)
    output = probe.chain.output
    forces = [output(OutputCode.JOINT_FORCE, MOVED), output(OutputCode.JOINT_FORCE, -1)]
    code = OutputCode.JOINT_MOMENT_ORIGIN
    moments = [output(code, MOVED), output(code, -1)]
    point = output(OutputCode.POINT, MOVED, 0, LOAD_POINT)
    axis = output(OutputCode.VECTOR, MOVED, 0, Z)
    drive = output(OutputCode.EFFORT, probe.driven.index(MOVED)) if MOVED in probe.driven else None
    out = moving(probe.finish()).outputs[:, 0]
    applied = LENGTH * np.array([4.0, -3.0, 2.0])
    force = sum(LENGTH * out[slot] for slot in forces) + applied
    moment = sum(LENGTH**2 * out[slot] for slot in moments) + LENGTH**2 * np.array([1.0, 2.0, -5.0])
    moment = moment + np.cross(out[point], applied)
    if drive is not None:
        moment = moment + LENGTH**2 * out[drive] * out[axis]
    scale = sum(np.abs(LENGTH**2 * out[slot]).max() for slot in moments) + 10
    np.testing.assert_allclose(force, 0, atol=1e-14 * scale)
    np.testing.assert_allclose(moment, 0, atol=1e-14 * scale)
