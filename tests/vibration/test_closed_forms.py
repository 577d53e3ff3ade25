"""Small motions against closed forms."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy import signal
from scipy.optimize import brentq

import mechkin_cli as mk

G = 9.81


def chain(count: int, damping: float = 0.0) -> str:
    """Masses of 2 kg in a row on springs of 50 N/m, the first on the wall; coordinates of joints
    are distances from neighbour to neighbour."""
    lines = ["format: 1", "links:"]
    lines += [f"  m{k}: {{mass: 2, center_of_mass: [{k}, 0, 0]}}" for k in range(count)]
    lines.append("joints:")
    for k in range(count):
        before = "ground" if k == 0 else f"m{k - 1}"
        lines.append(
            f"  J{k}: {{type: P, links: [{before}, m{k}], point: [{k}, 0, 0], axis: [1, 0, 0]}}"
        )
    lines.append("loads:")
    for k in range(count):
        at = f"joint: J{k}, coordinate: s"
        lines.append(f"  - {{type: spring, {at}, stiffness: 50}}")
        lines.append(f"  - {{type: damper, {at}, damping: {damping}}}")
    starts = ", ".join(f"J{k}.s: 0" for k in range(count))
    lines.append(f"responses: {{rest: {{start: {{{starts}}}, time: {{values: [0, 1e-3]}}}}}}")
    return "\n".join(lines)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20])
def test_a_chain_of_masses(count: int) -> None:
    """2 sqrt(k/m) sin((2 j - 1) pi / (4 n + 2))."""
    v = mk.loads(chain(count)).vibration("rest")
    j = np.arange(1, count + 1)
    omega = 2 * np.sqrt(25.0) * np.sin((2 * j - 1) * pi / (4 * count + 2))
    assert v.frequencies == pytest.approx(omega / (2 * pi), rel=1e-11)
    assert v.damping_ratios == pytest.approx(np.zeros(count), abs=1e-12)
    assert v.participation.sum(axis=0) == pytest.approx(np.ones(count), rel=1e-12)
    assert v.shapes.T @ v.mass @ v.shapes == pytest.approx(np.eye(count), abs=1e-10)
    # the ends' stiffness to ground: springs in a row
    last = f"J{count - 1}.s"
    assert v.effective_stiffness(last) == pytest.approx(50.0, rel=1e-11)


def test_a_damped_chain() -> None:
    """Damping in proportion to the stiffness: zeta = omega c / (2 k), to beyond critical."""
    v = mk.loads(chain(4, damping=8.0)).vibration("rest")
    j = np.arange(1, 5)
    omega = 10.0 * np.sin((2 * j - 1) * pi / 18)
    zeta = omega * 8.0 / 100.0
    assert (zeta < 1).all()
    order = np.argsort(omega)
    assert v.frequencies == pytest.approx(omega[order] / (2 * pi), rel=1e-10)
    assert v.damping_ratios == pytest.approx(zeta[order], rel=1e-9)
    heavy = mk.loads(chain(1, damping=50.0)).vibration("rest")
    roots = np.sort(np.abs(np.roots([2, 50, 50])))
    assert np.abs(heavy.eigenvalues) == pytest.approx(roots, rel=1e-12)
    assert heavy.damping_ratios == pytest.approx([1, 1])


DOUBLE = f"""format: 1
units: {{angle: rad}}
links:
  a: {{mass: 2, center_of_mass: [0, -0.3, 0], inertia: {{zz: 0.05}}}}
  b: {{mass: 1.5, center_of_mass: [0, -0.7, 0], inertia: {{zz: 0.02}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [a, b], point: [0, -0.5, 0], axis: [0, 0, 1]}}
points: {{tip: {{link: b, at: [0, -1, 0]}}}}
loads: [{{type: gravity, g: [0, -{G}, 0]}}]
motion: {{inputs: {{A.theta: {{values: [0, 0.6]}}, B.theta: {{values: [0, -1.1]}}}}}}
"""


def double_pendulum(a: float, b: float) -> tuple[np.ndarray, np.ndarray]:
    """M and K in the joint angles at any place, held there by constant moments at the joints."""
    own = 0.02 + 1.5 * 0.2**2
    mixed = own + 1.5 * 0.5 * 0.2 * np.cos(b)
    first = 0.05 + 2 * 0.3**2 + 1.5 * 0.5**2 + own + 2 * 1.5 * 0.5 * 0.2 * np.cos(b)
    inertia = np.array([[first, mixed], [mixed, own]])
    both = 1.5 * G * 0.2 * np.cos(a + b)
    alone = (2 * 0.3 + 1.5 * 0.5) * G * np.cos(a)
    return inertia, np.array([[alone + both, both], [both, both]])


@pytest.mark.parametrize("row", [0, 1])
def test_a_double_pendulum(row: int) -> None:
    """The exact quartic: det(K - omega^2 M) = 0."""
    model = mk.loads(DOUBLE)
    v = model.vibration(row=row)
    a, b = [(0.0, 0.0), (0.6, -1.1)][row]
    inertia, stiffness = double_pendulum(a, b)
    assert v.mass == pytest.approx(inertia, rel=1e-12)
    assert v.stiffness == pytest.approx(stiffness, rel=1e-11)
    (m11, m12), (_, m22) = inertia
    (k11, k12), (_, k22) = stiffness
    quartic = [
        m11 * m22 - m12 * m12,
        -(m11 * k22 + m22 * k11 - 2 * m12 * k12),
        k11 * k22 - k12 * k12,
    ]
    omega = np.sort(np.sqrt(np.roots(quartic)))
    assert v.frequencies == pytest.approx(omega / (2 * pi), rel=1e-11)
    # Rayleigh's quotient of any motion lies between the squares
    rng = np.random.default_rng(3)
    for x in rng.normal(size=(20, 2)):
        quotient = (x @ v.stiffness @ x) / (x @ v.mass @ x)
        assert omega[0] ** 2 * (1 - 1e-12) <= quotient <= omega[1] ** 2 * (1 + 1e-12)


def test_other_coordinates_tell_the_same_motion() -> None:
    """At a place in balance the frequencies do not depend on what is named."""
    text = DOUBLE.replace(
        "joints:\n", "joints:\n  P: {type: F, links: [ground, b], point: [0, -1, 0]}\n"
    )
    model = mk.loads(text)
    one = model.vibration()
    other = model.vibration(coordinates=["P.x", "P.rz"])
    assert other.coordinates == ("P.x", "P.rz")
    assert other.frequencies == pytest.approx(one.frequencies, rel=1e-11)
    third = model.vibration(coordinates=["A.theta", "P.rz"])
    assert third.frequencies == pytest.approx(one.frequencies, rel=1e-11)


ROTATING = """format: 1
links:
  disc: {}
  slide: {}
  mass: {mass: 2, center_of_mass: [0, 0, 0]}
joints:
  O: {type: R, links: [ground, disc], point: [0, 0, 0], axis: [0, 0, 1]}
  X: {type: P, links: [disc, slide], point: [0, 0, 0], axis: [1, 0, 0]}
  Y: {type: P, links: [slide, mass], point: [0, 0, 0], axis: [0, 1, 0]}
loads:
  - {type: spring, joint: X, coordinate: s, stiffness: 72}
  - {type: spring, joint: Y, coordinate: s, stiffness: 72}
motion:
  time: {from: 0, to: 1, step: 0.5}
  inputs:
    O.theta: {law: polynomial, coefficients: [0, "2 rad/s"]}
    X.s: {at: 0}
    Y.s: {at: 0}
"""


@pytest.mark.parametrize("row", [0, 1])
def test_a_mass_on_a_turning_disc(row: int) -> None:
    """x'' - 2 W y' + (w^2 - W^2) x = 0: it swings with w + W and w - W, seen from the disc."""
    v = mk.loads(ROTATING).vibration(row=row, held=["O.theta"])
    assert v.driven == ("O.theta",)
    assert v.stiffness == pytest.approx(2 * (36 - 4) * np.eye(2), rel=1e-11)
    assert v.damping == pytest.approx(2 * np.array([[0, -4.0], [4, 0]]), rel=1e-11, abs=1e-11)
    assert v.frequencies == pytest.approx(np.array([4, 8]) / (2 * pi), rel=1e-11)
    assert v.damping_ratios == pytest.approx([0, 0], abs=1e-11)


def test_a_pendulum_on_a_rotating_arm() -> None:
    """A physical pendulum (mass m, centre at l, moments A and C about its hinge and line) on an arm
    of radius r that turns at W about the vertical: it hangs outwards where m g l sin = W^2 (m r l
    cos + (A - C) sin cos), and swings about that by the derivative of the difference."""
    m, length, r, W = 3.0, 0.4, 0.5, 3.0
    own = 0.03
    A, C = own + m * length**2, own

    def moment(t: float) -> float:
        return m * G * length * np.sin(t) - W**2 * (
            m * r * length * np.cos(t) + (A - C) * np.sin(t) * np.cos(t)
        )

    t = brentq(moment, 0, 1.5, xtol=1e-15)
    slope = m * G * length * np.cos(t) - W**2 * (
        -m * r * length * np.sin(t) + (A - C) * np.cos(2 * t)
    )
    text = f"""format: 1
units: {{angle: rad}}
links:
  arm: {{}}
  bob: {{mass: {m}, center_of_mass: [{r}, 0, -{length}],
        inertia: {{xx: {own}, yy: {own}, zz: {own}}}}}
joints:
  O: {{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [arm, bob], point: [{r}, 0, 0], axis: [0, -1, 0]}}
loads: [{{type: gravity, g: [0, 0, -{G}]}}]
motion: {{inputs: {{O.theta: {{at: 0.7, rate: {W}}}, B.theta: {{at: {float(t)!r}}}}}}}
"""
    v = mk.loads(text).vibration(held=["O.theta"])
    assert v.holding == pytest.approx([0], abs=1e-11)
    assert v.mass == pytest.approx(np.array([[A]]), rel=1e-12)
    assert v.stiffness == pytest.approx(np.array([[slope]]), rel=1e-10)
    assert v.frequencies == pytest.approx([np.sqrt(slope / A) / (2 * pi)], rel=1e-10)


BASE = """format: 1
links:
  base: {}
  mass: {mass: 2, center_of_mass: [0, 0, 0]}
joints:
  B: {type: P, links: [ground, base], point: [0, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [base, mass], point: [0, 0, 0], axis: [0, 0, 1]}
points: {m: {link: mass, at: [0, 0, 0]}}
loads:
  - {type: spring, joint: S, coordinate: s, stiffness: 800}
  - {type: damper, joint: S, coordinate: s, damping: 12}
motion: {inputs: {B.s: {at: 0}, S.s: {at: 0}}}
"""


def test_frequency_responses_of_a_mass_on_a_moving_base() -> None:
    v = mk.loads(BASE).vibration(held=["B.s"])
    f = np.array([0.0, 0.5, 3.0, 3.18, 10.0, 200.0])
    s = 2j * pi * f
    below = 2 * s**2 + 12 * s + 800
    by_force = v.response(f, "S.s", ["S.s", "m.velocity.z", "S.s_ddot"])
    assert by_force.values[0] == pytest.approx(1 / below, rel=1e-11)
    assert by_force.values[1] == pytest.approx(s / below, rel=1e-11)
    assert by_force.values[2] == pytest.approx(s**2 / below, rel=1e-11, abs=1e-16)
    by_base = v.response(f, "B.s", ["m.position.z", "m.acceleration.z"])
    assert by_base.values[0] == pytest.approx((12 * s + 800) / below, rel=1e-10)
    assert by_base.values[1] == pytest.approx(s**2 * (12 * s + 800) / below, rel=1e-10, abs=1e-12)
    assert by_base.phase[0, 0] == pytest.approx(0, abs=1e-9)
    # the drive of the base carries what accelerates the mass
    effort = v.response(f, "B.s", "B.effort")
    assert effort.values[0] == pytest.approx(2 * s**2 * (12 * s + 800) / below, rel=1e-9, abs=1e-9)


def test_state_space_is_that_of_programs_for_control() -> None:
    model = mk.loads(BASE)
    v = model.vibration(held=["B.s"])
    s = v.state_space(["S.s", "B.s"], ["S.s", "m.acceleration.z", "B.effort"])
    assert s.states == ("S.s", "B.s", "S.s_dot", "B.s_dot")
    system = signal.StateSpace(*s.matrices)
    f = np.array([0.3, 3.0, 10.0])
    for k, name in enumerate(("S.s", "B.s")):
        for j, output in enumerate(s.outputs):
            # of one input and one output
            one = signal.StateSpace(s.A, s.B[:, [k]], s.C[[j]], s.D[[j]][:, [k]])
            _, told = signal.freqresp(one, 2 * pi * f)
            own = v.response(f, name, output).values[0]
            if name == "B.s":  # there by its place, here by its acceleration
                own = own / (2j * pi * f) ** 2
            assert told == pytest.approx(own, rel=1e-9), (name, output)
    assert system.A.shape == (4, 4)
    plain = v.state_space(["S.s"])
    assert plain.outputs == ("S.s", "S.s_dot")
    assert np.linalg.eigvals(plain.A) == pytest.approx(
        np.array([v.eigenvalues[0], np.conj(v.eigenvalues[0])]), rel=1e-10
    )


def test_a_force_reaches_reactions_before_anything_moves() -> None:
    """Of a pendulum pushed at its tip: what the hinge feels at rest and at high frequency."""
    text = f"""format: 1
links: {{bar: {{mass: 2, center_of_mass: [0, 0, -0.5], inertia: {{yy: 0.1}}}}}}
joints: {{A: {{type: R, links: [ground, bar], point: [0, 0, 0], axis: [0, 1, 0]}}}}
points: {{tip: {{link: bar, at: [0, 0, -1]}}}}
loads: [{{type: gravity, g: [0, 0, -{G}]}}]
motion: {{inputs: {{A.theta: {{at: 0}}}}}}
"""
    v = mk.loads(text).vibration()
    inertia, f = 0.1 + 2 * 0.25, np.array([0.0, 1e4])
    found = v.response(f, "tip.position.x", ["A.force", "tip.position.x"])
    # at rest the bar leans until its weight balances the tip's force, and the hinge takes all of it
    assert found.values[0, 0] == pytest.approx(-1.0, rel=1e-10)
    # fast, it is a free bar: m a - 1 with a = 0.5 * 1 / I
    assert found.values[0, 1] == pytest.approx(2 * 0.5 / inertia - 1.0, rel=1e-6)
    assert found.values[3, 0] == pytest.approx(1 / (2 * G * 0.5), rel=1e-10)
    assert v.effective_stiffness("tip.position.x") == pytest.approx(2 * G * 0.5, rel=1e-11)
    assert found.outputs == ("A.force.x", "A.force.y", "A.force.z", "tip.position.x")
    s = v.state_space(["tip.position.x"], ["A.force.x"])
    assert s.D[0, 0] == pytest.approx(2 * 0.5 / inertia - 1.0, rel=1e-10)


def test_sensitivities() -> None:
    """Of a pendulum on a torsion spring, by spring, length and mass."""
    text = f"""format: 1
parameters: {{k: 3 N*m/rad, l: 0.4 m, mass: 2 kg}}
links: {{bob: {{mass: mass, center_of_mass: [0, 0, -l]}}}}
joints: {{A: {{type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 1, 0]}}}}
loads:
  - {{type: gravity, g: [0, 0, -{G}]}}
  - {{type: spring, joint: A, coordinate: theta, stiffness: k}}
motion: {{inputs: {{A.theta: {{at: 0}}}}}}
"""
    v = mk.loads(text).vibration()
    k, length, m = 3.0, 0.4, 2.0
    square = k / (m * length**2) + G / length
    f = np.sqrt(square) / (2 * pi)
    assert v.frequencies == pytest.approx([f], rel=1e-12)
    slopes = {
        "k": 1 / (m * length**2),
        "l": -2 * k / (m * length**3) - G / length**2,
        "mass": -k / (m**2 * length**2),
    }
    for name, slope in slopes.items():
        assert v.sensitivity(name) == pytest.approx([slope * f / (2 * square)], rel=1e-9), name


def test_a_small_response_swings_with_the_told_frequency() -> None:
    """A four-bar on a spring: the period of 1e-5 rad is that told, to 1e-8."""
    start = """format: 1
units: {angle: rad}
links:
  a: {mass: 1, center_of_mass: [0, 0.4, 0], inertia: {zz: 0.02}}
  b: {mass: 2, center_of_mass: [0.6, 1.1, 0], inertia: {zz: 0.1}}
  c: {mass: 1, center_of_mass: [1.4, 0.7, 0], inertia: {zz: 0.03}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [0, 1, 0], axis: [0, 0, 1]}
  C: {type: R, links: [b, c], point: [1.2, 1.4, 0], axis: [0, 0, 1]}
  D: {type: R, links: [c, ground], point: [1.6, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: spring, joint: A, coordinate: theta, stiffness: 40}
  - {type: spring, joint: D, coordinate: theta, stiffness: 30}
responses:
  swing:
    start: {A.theta: SIZE}
    time: {from: 0, to: 20, step: 0.001}
    stop: [{value: A.theta, at: 0, direction: down, count: 11}]
    tolerance: 1e-12
  rest:
    start: {A.theta: 0}
    time: {values: [0, 1e-3]}
"""
    model = mk.loads(start.replace("SIZE", "1e-5"))
    (period,) = 1.0 / model.vibration("rest").frequencies
    first, last = (
        mk.loads(start.replace("SIZE", "1e-5").replace("count: 11", f"count: {count}")).respond(
            "swing"
        )["time"][-1]
        for count in (1, 11)
    )
    assert (last - first) / 10 == pytest.approx(period, rel=1e-8)
