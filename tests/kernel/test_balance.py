"""Places at which loads balance, many in one call: against roots of the moments at 40 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths
from mechkin_cli.session import Packing, balance, turn_count
from mechkin_cli.show import Floats
from mechkin_cli.statics.places import Places, Statics
from mechkin_cli.tolerances import EQUILIBRIUM_STEP

PENDULUM = """
format: 1
units: {length: m, angle: rad}
links: {a: {mass: 2, center_of_mass: [0.5, 0, 0]}}
joints: {A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: spring, joint: A, coordinate: theta, stiffness: K}
motion: {rest: [A.theta]}
"""
CHAIN = """
format: 1
units: {length: m, angle: rad}
links: {a: {mass: 2, center_of_mass: [0.5, 0, 0]}, b: {mass: 1, center_of_mass: [1.6, 0, 0]}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [1, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: spring, joint: A, coordinate: theta, stiffness: 40}
  - {type: spring, joint: B, coordinate: theta, stiffness: 15}
motion: {rest: [A.theta, B.theta]}
"""
G = mpmath.mpf("9.81")
SOFT, STIFF = 2, 25
LEFT = EQUILIBRIUM_STEP
"""What the steps may leave."""
SLOPES = 1e-4
"""Slopes are those before the last step, which is as long as the root of what it leaves."""


def pendulum(stiffness: float) -> Statics:
    model = mk.loads(PENDULUM.replace("K}", f"{stiffness}}}"))
    return Statics(model.session, [0])


def moment(stiffness: float, x: mpmath.mpf) -> mpmath.mpf:
    return stiffness * x + G * mpmath.cos(x)


def root(stiffness: float, near: float) -> float:
    with mpmath.workdps(40):
        return float(mpmath.findroot(lambda x: moment(stiffness, x), mpmath.mpf(near)))


def chain_moments(x: mpmath.mpf, y: mpmath.mpf) -> list[mpmath.mpf]:
    last = mpmath.mpf("0.6") * mpmath.cos(x + y) * G + 15 * y
    return [40 * x + 2 * G * mpmath.cos(x) + last - 15 * y, last]


def guesses(statics: Statics, values: Floats) -> Places:
    """Places with the free coordinates (free, places) somewhere."""
    count = values.shape[1]
    plan = statics.session.plan
    turns = np.zeros((turn_count(plan), count))
    return Places(values, np.zeros((plan.states, count)), turns, np.zeros(count))


def test_each_guess_comes_to_the_root() -> None:
    statics = pendulum(STIFF)
    at, stiffness = statics.balanced(guesses(statics, np.linspace(-0.6, 0.0, 13)[None]))
    expected = root(STIFF, -0.4)
    assert at.times.size == 13
    assert np.abs(at.inputs - expected).max() < LEFT
    slope = STIFF - float(G) * np.sin(expected)
    assert np.abs(stiffness - slope).max() < SLOPES


def test_of_two_coordinates_each_comes_to_its_root() -> None:
    statics = Statics(mk.loads(CHAIN).session, [0, 1])
    near = np.array([[-0.5, -0.4, -0.6], [-0.2, -0.3, -0.1]])
    at, stiffness = statics.balanced(guesses(statics, near))
    with mpmath.workdps(40):
        x, y = mpmath.findroot(chain_moments, (-0.5, -0.3))
        last = -mpmath.mpf("0.6") * G * mpmath.sin(x + y)
        first = 40 - 2 * G * mpmath.sin(x) + last
        slopes = [[first, last], [last, last + 15]]
    assert at.times.size == 3
    assert np.abs(at.inputs - np.array([[float(x)], [float(y)]])).max() < LEFT
    expected = np.array(slopes, dtype=float)[:, :, None]
    assert np.abs(stiffness - expected).max() < SLOPES


def test_places_end_before_the_first_that_does_not_come_there() -> None:
    """Newton's steps from beside the top of the moment's curve grow."""
    statics = pendulum(STIFF)
    at, _ = statics.balanced(guesses(statics, np.array([[-0.4, -0.3, np.nan, -0.4]])))
    assert at.times.size == 2
    soft = pendulum(SOFT)
    flat = float(np.arcsin(SOFT / float(G)))
    at, _ = soft.balanced(guesses(soft, np.array([[-1.3, flat - 1e-3, -1.3]])))
    assert at.times.size == 1


def test_places_end_before_the_stiffness_changes_its_sign() -> None:
    """A soft spring leaves an unstable equilibrium above the axis beside the stable one below."""
    statics = pendulum(SOFT)
    stable, unstable = root(SOFT, -1.3), root(SOFT, 2.1)
    near = np.array([[stable + 0.05, unstable + 0.05, stable]])
    at, stiffness = statics.balanced(guesses(statics, near))
    assert at.inputs.tolist() == [[pytest.approx(stable, abs=LEFT)]]
    assert stiffness[0, 0, 0] > 0.0
    alone, slopes = statics.balanced(guesses(statics, near[:, 1:2]))
    assert alone.inputs.tolist() == [[pytest.approx(unstable, abs=LEFT)]]
    assert slopes[0, 0, 0] < 0.0


def test_a_known_place_stays() -> None:
    statics = pendulum(STIFF)
    near = np.array([[-0.3, -0.4]])
    at, stiffness = statics.balanced(guesses(statics, near), known=True)
    assert at.inputs[0, 0] == -0.3
    assert abs(at.inputs[0, 1] - root(STIFF, -0.4)) < LEFT
    assert abs(stiffness[0, 0, 0] - (STIFF - float(G) * np.sin(-0.3))) < 1e-6


def test_slopes_that_are_nearly_right_lead_there() -> None:
    statics = pendulum(STIFF)
    expected = root(STIFF, -0.4)
    slope = np.full((1, 1, 3), 0.99 * (STIFF - float(G) * np.sin(expected)))
    at, _ = statics.balanced(guesses(statics, np.array([[-0.39, -0.36, -0.34]])), slope)
    assert at.times.size == 3
    assert np.abs(at.inputs - expected).max() < LEFT


def test_slopes_that_are_wrong_lead_nowhere() -> None:
    statics = pendulum(STIFF)
    slope = np.full((1, 1, 1), 0.4 * STIFF)
    at, _ = statics.balanced(guesses(statics, np.array([[-0.3]])), slope)
    assert at.times.size == 0


@pytest.mark.parametrize(("lanes", "threads"), [*((lanes, 1) for lanes in widths()), (0, 3)])
def test_bits_depend_on_no_lanes_threads_or_other_places(lanes: int, threads: int) -> None:
    model = mk.loads(CHAIN)
    rng = np.random.default_rng(5)
    near = np.array([[-0.5], [-0.3]]) + rng.uniform(-0.1, 0.1, (2, 41))
    plain = Statics(model.session, [0, 1])
    at, stiffness = plain.balanced(guesses(plain, near))
    assert at.times.size == 41
    other = Statics(model.session.packed(Packing(lanes, threads)), [0, 1])
    again, slopes = other.balanced(guesses(other, near))
    assert at.inputs.tobytes() == again.inputs.tobytes()
    assert stiffness.tobytes() == slopes.tobytes()
    few, _ = plain.balanced(guesses(plain, near[:, 30:33]))
    assert at.inputs[:, 30:33].tobytes() == few.inputs.tobytes()


def test_what_does_not_fit_is_refused() -> None:
    statics = pendulum(STIFF)
    places = guesses(statics, np.array([[-0.4]]))
    session, readout = statics.session, statics.readout
    with pytest.raises(ValueError, match="free: no such input or slot"):
        balance(session.plan, statics.rows(*places), [(1, 0, 1.0)], [], readout)
    with pytest.raises(ValueError, match="cyclic: no such input"):
        balance(session.plan, statics.rows(*places), [(0, 0, 1.0)], [1], readout)
