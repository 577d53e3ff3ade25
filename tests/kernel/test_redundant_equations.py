"""A plane four-bar anywhere in space: five closing equations for two unknowns.

Its pins stand at different heights along their axes. Motion and effort against plane geometry at 40
digits; three of the closing reactions are not unique.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from kernel.pairs import Z, derivative, mp, shifted, turned
from kernel.plans import EVERYTHING, TABLE, Chain, Run, TreeJoint, doubles, frame, random_pose, run

from mechkin_cli.kernel import _kernel
from mechkin_cli.plan.records import Demand, LoadCode, OutputCode

CRANK, COUPLER, ROCKER, GROUND = (mp.mpf(x) for x in ("0.375", "0.875", "0.75", "0.8125"))
ANGLES = [0.9, 1.7, 2.6, -1.1, 0.3]
LOAD_POINT, LOAD = (0.3, 0.4, -0.2), (4.0, -3.0, 2.0)
RATE, ACCELERATION = 1.25, -0.5


def angles(crank: Any) -> list[Any]:
    """Angles of the three pins before the closing one, by two circles about the coupler's ends."""
    b = CRANK * mp.cos(crank), CRANK * mp.sin(crank)
    across = GROUND - b[0], -b[1]
    distance = mp.hypot(*across)
    cosine = (COUPLER**2 + distance**2 - ROCKER**2) / (2 * COUPLER * distance)
    coupler = mp.atan2(across[1], across[0]) + mp.acos(cosine)
    c = b[0] + COUPLER * mp.cos(coupler), b[1] + COUPLER * mp.sin(coupler)
    rocker = mp.atan2(-c[1], GROUND - c[0])
    return [crank, coupler - crank, rocker - coupler]


class FourBar:
    """The plan and one row for each of ANGLES, from guesses that are a little off."""

    def __init__(self) -> None:
        self.base = random_pose(np.random.default_rng(7))
        frames = [self.base, shifted(CRANK, 0, 0.125), shifted(COUPLER, 0, -0.25)]
        joints = [TreeJoint("R", k - 1, at) for k, at in enumerate(frames)]
        self.chain = Chain.of(joints)
        plan = self.chain.builder
        on_ground = doubles(self.base * shifted(GROUND, 0, 0.375))
        ends = frame(on_ground), frame(shifted(ROCKER, 0, 0.5))
        loop = [(k, 1.0) for k in range(3)]
        plan.add_closing_joint(TABLE["R"]["code"], -1, 2, *ends, 0.0, loop)
        closing = plan.add_place(-1, -1, 2, 2, (float(ROCKER), 0.0, 0.5), 1.0)
        plan.add_block(1, [0, 1, 2], [1, 2])
        self.chain.drive(0)
        zero = (0.0, 0.0, 0.0)
        plan.add_load(int(LoadCode.FORCE_GROUND), 1, -1, 0, LOAD_POINT, zero, LOAD)
        self.chain.finish()
        output = self.chain.output
        self.effort = output(OutputCode.EFFORT, 0)
        self.force = output(OutputCode.JOINT_FORCE, closing)
        self.moment = output(OutputCode.JOINT_MOMENT, closing)
        self.pins = [output(OutputCode.JOINT_MOMENT, k) for k in (1, 2)]
        self.axis = output(OutputCode.VECTOR, 2, 0, Z)

    def run(self, shift: int = 0, lanes: int = 0) -> Run:
        states = np.array([[float(q) for q in angles(mp.mpf(a))] for a in ANGLES]).T
        states[1:] += np.random.default_rng(3).uniform(-1e-3, 1e-3, (2, len(ANGLES)))
        return run(
            self.chain,
            np.array([ANGLES]),
            np.ascontiguousarray(states),
            rates=np.full((1, len(ANGLES)), RATE),
            accelerations=np.full((1, len(ANGLES)), ACCELERATION),
            demand=EVERYTHING | Demand.CONDITION,
            shift=shift,
            lanes=lanes,
        )


@pytest.fixture(scope="module")
def four_bar() -> FourBar:
    return FourBar()


def crank_at(row: int, time: Any) -> Any:
    return mp.mpf(ANGLES[row]) + RATE * time + mp.mpf(ACCELERATION) * time**2 / 2


def test_all_equations_are_met(four_bar: FourBar) -> None:
    result = four_bar.run()
    assert not np.any(result.flags)
    assert np.all(result.residual <= 2e-15)
    assert np.all(result.condition < 100)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_motion_is_that_of_the_plane_linkage(four_bar: FourBar, order: int) -> None:
    result = four_bar.run()
    found = (result.states, result.first, result.second)[order]
    for row in range(len(ANGLES)):
        for joint in range(3):

            def angle(t: Any, row: int = row, joint: int = joint) -> Any:
                return angles(crank_at(row, t))[joint]

            expected = derivative(angle, order) if order else angle(mp.mpf(0))
            assert found[joint, row] == pytest.approx(float(expected), rel=1e-13, abs=1e-13)


def test_the_effort_balances_the_load_whatever_the_shift(four_bar: FourBar) -> None:
    """Virtual power: effort times the crank's rate is what the load takes."""
    for shift in range(3):
        result = four_bar.run(shift)
        for row in range(len(ANGLES)):

            def load_point(t: Any, row: int = row) -> Any:
                crank, pin, _ = angles(crank_at(row, t))
                bar = four_bar.base * turned(Z, crank) * shifted(CRANK, 0, 0.125)
                return bar * turned(Z, pin) * mp.matrix([*LOAD_POINT, 1])

            velocity = derivative(load_point, 1)
            power = sum(f * velocity[i] for i, f in enumerate(LOAD))
            effort = result.outputs[four_bar.effort, row][0]
            assert effort == pytest.approx(float(-power / RATE), rel=0, abs=1e-12)


def test_the_pins_take_no_moment_about_their_axis_whatever_the_shift(four_bar: FourBar) -> None:
    for shift in range(3):
        outputs = four_bar.run(shift).outputs
        for moment in (*four_bar.pins, four_bar.moment):
            about = (outputs[moment] * outputs[four_bar.axis]).sum(axis=0)
            assert np.all(np.abs(about) <= 1e-12 * (1 + np.abs(outputs[moment]).max()))


def test_only_forces_in_the_plane_are_unique(four_bar: FourBar) -> None:
    plain, *others = (four_bar.run(shift).outputs for shift in range(3))
    axis = plain[four_bar.axis]
    for shifted_outputs in others:
        change = shifted_outputs[four_bar.force] - plain[four_bar.force]
        along = (change * axis).sum(axis=0)
        assert np.all(np.abs(change - along * axis) <= 1e-12)
        assert np.all(np.abs(along) > 0.01)


def test_the_same_bits_for_every_width(four_bar: FourBar) -> None:
    for shift in range(3):
        expected = four_bar.run(shift, lanes=2)
        for lanes in (each for each in (4, 8) if each <= _kernel.widest):
            found = four_bar.run(shift, lanes=lanes)
            for name, array in vars(expected).items():
                assert getattr(found, name).tobytes() == array.tobytes(), name
