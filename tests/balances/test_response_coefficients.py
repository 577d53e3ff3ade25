"""Coefficients of the equations of motion along a response, and what a response does not have."""

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.expressions.quantity import ExpressionError

PENDULUM = """\
format: 1
name: double pendulum
units: {length: m, angle: rad, mass: kg, force: N}
links:
  one: {mass: 2, center_of_mass: [0, -0.5, 0], inertia: {xx: .1, yy: .1, zz: .1}}
  two: {mass: 3, center_of_mass: [0, -1.4, 0], inertia: {xx: .2, yy: .2, zz: .2}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [one, two], point: [0, -1, 0], axis: [0, 0, 1]}
loads: [{type: gravity, g: [0, -9.81, 0]}]
responses:
  fall:
    start: {A.theta: 1, B.theta: 0.5, A.theta_dot: 0.3}
    time: {from: 0, to: 1, step: 0.25}
"""


@pytest.fixture(scope="module")
def fall(tmp_path_factory: pytest.TempPathFactory) -> mk.Analysis:
    path: Path = tmp_path_factory.mktemp("coefficients") / "double.yaml"
    path.write_text(PENDULUM)
    return mk.load(path).respond("fall", tables=[])


def test_the_reduced_inertia_is_lagranges(fall: mk.Analysis) -> None:
    c = np.cos(fall["B.theta"])
    # m1 a1^2 + I1 + I2 + m2 (l^2 + a2^2 + 2 l a2 cos), l = 1, a1 = 0.5, a2 = 0.4
    of_a = 2 * 0.25 + 0.1 + 0.2 + 3 * (1 + 0.16 + 0.8 * c)
    np.testing.assert_allclose(fall["A.theta.reduced_inertia"], of_a, rtol=1e-13)
    np.testing.assert_allclose(fall["B.theta.reduced_inertia"], 0.2 + 3 * 0.16, rtol=1e-13)


def test_accelerations_and_reactions_are_linear_in_those_of_the_start(fall: mk.Analysis) -> None:
    for name in ("two.alpha", "B.force"):
        total = fall[f"{name}.without_acceleration"]
        for coordinate in ("A.theta", "B.theta"):
            total = (
                total + fall[f"{name}.per.{coordinate}_ddot"] * fall[f"{coordinate}_ddot"][:, None]
            )
        np.testing.assert_allclose(total, fall[name], rtol=0, atol=1e-12 * np.abs(fall[name]).max())


@pytest.mark.parametrize("name", ["A.theta_dddot", "B.theta_dddot"])
def test_a_response_has_no_jerks(fall: mk.Analysis, name: str) -> None:
    with pytest.raises(ExpressionError) as error:
        fall[name]
    assert "a response has none" in str(error.value) + str(error.value.hint)
