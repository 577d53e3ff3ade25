"""Every joint type that closes a loop: closing equations, side conditions, derivatives, wrenches.

Poses of the pair's own motion come from exponentials; how far a pose is
off that motion is measured as max |X D^-1 - 1|, D the pair's nearest displacement, never by the
kernel's equations.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from kernel.pairs import PAIRS, O, X, Y, Z, derivative, exponential, mp, twist_matrix
from kernel.plans import LENGTH, TABLE
from kernel.probe import MOVED, Probe, largest

from mechkin_cli.plan.records import Demand, LoadCode, OutputCode, RowFlag

CLOSING = list(TABLE)
LOAD_POINT = (0.4, 0.3, -0.2)


@pytest.fixture(params=[(letter, seed) for letter in CLOSING for seed in range(2)], ids=str)
def probe(request: pytest.FixtureRequest) -> Probe:
    return Probe(*request.param)


@pytest.mark.parametrize("size", [0.0, 1e-30, 1e-9, 0.7, 3.0, 20.0])
def test_exponentials_are_the_series_of_their_twists(size: float) -> None:
    twist = np.random.default_rng(7).standard_normal(6).tolist()
    angular, linear = [size * x for x in twist[:3]], twist[3:]
    with mp.workdps(60):
        series = mp.expm(twist_matrix(angular, linear) * mp.mpf("0.3"))
    assert largest(exponential(angular, linear, mp.mpf("0.3")) - series) < 1e-37


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
    result = probe.run(states, demand=Demand.CONDITION | Demand.SINGULAR)
    assert result.condition[0] == pytest.approx(1, rel=1e-14)
    result = probe.run(states, demand=Demand.CONDITION)
    assert result.condition[0] == pytest.approx(1, rel=0.01)


@pytest.mark.parametrize("axis", [X, Y, Z], ids=["x", "y", "z"])
def test_half_turns_pass_only_where_they_are_the_own_motion(probe: Probe, axis: Any) -> None:
    """Parallel axes that point opposite ways, or a body upside down, are no assembly."""
    displacement = probe.pair.displacement(probe.own) * exponential(axis, O, mp.pi)
    own = largest(probe.off_motion(displacement)) < 1e-30
    result = probe.finish().run(probe.states(displacement), iterations=0)
    assert (result.flags[0] == RowFlag.GOOD) == own


@pytest.mark.parametrize("letter", ["R", "C", "E"])
def test_reversed_axes_fulfil_the_equations_and_fail_the_side_condition(letter: str) -> None:
    probe = Probe(letter, 0).finish()
    displacement = probe.pair.displacement(probe.own) * exponential(X, O, mp.pi)
    result = probe.run(probe.states(displacement), iterations=0)
    assert result.residual[0] <= 2e-15
    assert result.flags[0] == RowFlag.SIDE_CONDITION


@pytest.mark.parametrize("letter", ["P", "W"])
def test_a_half_turned_body_keeps_its_error_at_half_a_turn(letter: str) -> None:
    """The skew part of the rotation error vanishes here; the rotation vector has length pi."""
    probe = Probe(letter, 0).finish()
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
    found = probe.finish().moving()
    state, first, second = found.states[:, 0], found.first[:, 0], found.second[:, 0]
    off = derivative(lambda t: probe.off_motion(probe.displacement(state, first, second, t)), order)
    scale = 1 + max(np.abs(first).max() ** order, np.abs(second).max())
    assert largest(off) <= 2e-14 * scale


COORDINATES = [(letter, name) for letter in CLOSING for name in PAIRS[letter].coordinates]


@pytest.mark.parametrize(("letter", "name"), COORDINATES)
def test_coordinates_of_the_closing_joint_and_their_derivatives(letter: str, name: str) -> None:
    probe = Probe(letter, 1)
    freedom, value = probe.pair.coordinates[name]
    slots = [
        probe.chain.output(OutputCode.CLOSING, 0, order, freedom=freedom) for order in range(3)
    ]
    found = probe.finish().moving()
    state, first, second = found.states[:, 0], found.first[:, 0], found.second[:, 0]

    def coordinate(t: Any) -> Any:
        return value(probe.displacement(state, first, second, t))

    own = probe.own[freedom - probe.pair.freedoms]  # states of turns and slides stand last
    expected = [own, derivative(coordinate, 1), derivative(coordinate, 2)]
    scale = 1 + np.abs(found.second).max()
    for slot, exact in zip(slots, expected, strict=True):
        assert found.outputs[slot, 0][0] == pytest.approx(float(exact), rel=0, abs=2e-14 * scale)


def load(probe: Probe) -> None:
    """Masses on the way and a force and a torque on the moved link, which has no mass."""
    for link in range(MOVED):
        tensor = (1.5, 1.2, 0.9, 0.1, -0.2, 0.05)
        probe.chain.builder.set_inertia(link, 1.0 + link, (0.2, 0.1, -0.3), tensor)
    probe.chain.builder.set_gravity((1.0, -2.0, 3.0))
    add, zero = probe.chain.builder.add_load, (0.0, 0.0, 0.0)
    add(int(LoadCode.FORCE_GROUND), MOVED, -1, 0, LOAD_POINT, zero, (4.0, -3.0, 2.0))
    add(int(LoadCode.TORQUE_GROUND), MOVED, -1, 0, zero, zero, (1.0, 2.0, -5.0))


def test_the_closing_wrench_does_no_work_on_the_freedoms(probe: Probe) -> None:
    load(probe)
    force_at = probe.chain.output(OutputCode.JOINT_FORCE, probe.place)
    moment_at = probe.chain.output(OutputCode.JOINT_MOMENT, probe.place)
    result = probe.finish().moving()
    pose = probe.chain.poses(result.states[:, 0])[0] * probe.on_first
    axes = np.array([[float(pose[i, j]) for i in range(3)] for j in range(3)])
    force, moment = axes @ result.outputs[force_at, 0], axes @ result.outputs[moment_at, 0]
    scale = np.abs(force).max() + np.abs(moment).max()
    assert scale > 0.1
    for power in probe.pair.powers(probe.own, force, moment):
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
    closing = output(OutputCode.JOINT_FORCE, probe.place)
    axes = {k: output(OutputCode.VECTOR, k, 0, Z) for k in undriven}
    out = probe.finish().moving().outputs[:, 0]
    scale = np.abs(out[closing]).max() + max(np.abs(out[slot]).max() for slot in wrenches.values())
    assert scale > 1
    for k in undriven:
        assert abs(out[wrenches[k]] @ out[axes[k]]) <= 1e-13 * scale


def test_the_moved_link_is_in_equilibrium(probe: Probe) -> None:
    """Its tree joint, the drive there, the closing joint and the loads: forces and moments about
    ground."""
    load(probe)
    output = probe.chain.output
    forces = [output(OutputCode.JOINT_FORCE, MOVED), output(OutputCode.JOINT_FORCE, probe.place)]
    code = OutputCode.JOINT_MOMENT_ORIGIN
    moments = [output(code, MOVED), output(code, probe.place)]
    point = output(OutputCode.POINT, MOVED, 0, LOAD_POINT)
    axis = output(OutputCode.VECTOR, MOVED, 0, Z)
    drive = output(OutputCode.EFFORT, probe.driven.index(MOVED)) if MOVED in probe.driven else None
    out = probe.finish().moving().outputs[:, 0]
    applied = LENGTH * np.array([4.0, -3.0, 2.0])
    force = sum(LENGTH * out[slot] for slot in forces) + applied
    moment = sum(LENGTH**2 * out[slot] for slot in moments) + LENGTH**2 * np.array([1.0, 2.0, -5.0])
    moment = moment + np.cross(out[point], applied)
    if drive is not None:
        moment = moment + LENGTH**2 * out[drive] * out[axis]
    scale = sum(np.abs(LENGTH**2 * out[slot]).max() for slot in moments) + 10
    np.testing.assert_allclose(force, 0, atol=1e-14 * scale)
    np.testing.assert_allclose(moment, 0, atol=1e-14 * scale)
