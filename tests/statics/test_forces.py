"""Generalised forces about a place against closed forms."""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.response import prepare
from mechkin_cli.session import turn_count
from mechkin_cli.statics import DrivenAt, Forces, FreePlace

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

G = 9.81
TWO_PENDULUMS = """
format: 1
name: two_pendulums
units: {length: m, force: N, angle: rad}
links:
  a: {mass: 2, center_of_mass: [0, -0.25, 0], inertia: {zz: 0.01}}
  b: {mass: 1, center_of_mass: [0, -0.7, 0], inertia: {zz: 0.02}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [0, -0.5, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: damper, joint: B, coordinate: theta, damping: 0.3}
  - {type: spring, joint: A, coordinate: theta, stiffness: 4, free: 0.1}
responses:
  swing:
    start: {A.theta: %r, B.theta: %r}
    time: {from: 0, to: 1, step: 0.1}
"""


def _forces(text: str) -> tuple[Forces, FreePlace]:
    model = mk.loads(text)
    one = prepare(model.problem, model.response("swing"))
    assert one.begun is not None
    nothing = np.zeros(0)
    forces = Forces(one.free, DrivenAt(nothing, nothing, nothing, nothing, nothing))
    turns = np.zeros(turn_count(one.free.plan))
    return forces, forces.place(one.begun.state, turns, one.begun.tangents)


def _stiffness(a: float, b: float) -> Floats:
    """Second derivatives of the potential energy, with b against a."""
    first = 2.0 * G * 0.25 * cos(a) + G * 0.5 * cos(a)
    both = G * 0.2 * cos(a + b)
    return np.array([[first + both + 4.0, both], [both, both]])


def _inertia(b: float) -> Floats:
    own = 0.02 + 0.2**2
    mixed = own + 0.5 * 0.2 * cos(b)
    first = 0.01 + 2.0 * 0.25**2 + 0.5**2 + own + 2.0 * 0.5 * 0.2 * cos(b)
    return np.array([[first, mixed], [mixed, own]])


def _named(forces: Forces, place: FreePlace, matrix: Floats) -> Floats:
    """A matrix in the pendulums' angles, N*m: the chart's columns are these angles."""
    length = forces.session.layout.length
    found: Floats = length**2 * place.tangents.T @ matrix @ place.tangents
    return found


@pytest.mark.parametrize(("a", "b"), [(0.0, 0.0), (0.4, -1.1), (3.0, 2.0)])
def test_matrices_of_two_pendulums(a: float, b: float) -> None:
    forces, place = _forces(TWO_PENDULUMS % (a, b))
    stiffness, damping = forces.stiffness(place), forces.damping(place)
    for matrix, expected in (
        (forces.inertia(place), _inertia(b)),
        (stiffness.matrix, _stiffness(a, b)),
        (damping.matrix, [[0.0, 0.0], [0.0, 0.3]]),
    ):
        np.testing.assert_allclose(_named(forces, place, matrix), expected, rtol=1e-12, atol=1e-12)
    assert stiffness.error < 1e-10


FOUR_BAR = """
format: 1
name: four_bar
units: {length: m, force: N, angle: rad}
links:
  crank: {mass: 1, center_of_mass: [0.0, 0.5, 0]}
  coupler: {}
  rocker: {}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [crank, coupler], point: [0, 1, 0]}
  C: {type: S, links: [coupler, rocker], point: [2, 1, 0]}
  D: {type: R, links: [ground, rocker], point: [2, 0, 0], axis: [0, 0, 1]}
points:
  hook: {link: rocker, at: [2, 1, 0]}
  eye: {link: ground, at: [3.5, 0.3, 0]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: spring, between: [hook, eye], stiffness: 30, free: 0.4}
responses:
  swing:
    start: {A.theta: %r}
    time: {from: 0, to: 1, step: 0.1}
"""


@pytest.mark.parametrize("turn", [0.0, 0.5, -0.8])
def test_stiffness_of_a_parallelogram(turn: float) -> None:
    # both bars turn alike, so the potential energy is a function of the crank's angle
    forces, place = _forces(FOUR_BAR % turn)
    x, y = 1.5, 0.3

    def stretched(angle: float) -> float:
        return sqrt((x + sin(angle)) ** 2 + (y - cos(angle)) ** 2)

    # d^2 = const + 2 (x sin - y cos), so d d' = x cos + y sin
    d = stretched(turn)
    first = (x * cos(turn) + y * sin(turn)) / d
    second = ((-x * sin(turn) + y * cos(turn)) - first * first) / d
    moment = -G * 0.5 * sin(turn) + 30.0 * (d - 0.4) * first
    slope = -G * 0.5 * cos(turn) + 30.0 * (first * first + (d - 0.4) * second)
    unit = float(forces.session.layout.length) ** 2
    # all four angles move with the crank's; the chart's coordinate has length one
    ratio = _rate_of_crank(forces, place)
    at = forces.at(place, np.zeros((forces.freedoms, 1)))
    crank = [k for k in range(forces.freedoms) if abs(ratio[k]) > 1e-6]
    assert len(crank) == 1
    (k,) = crank
    assert unit * at.forces[k, 0] == pytest.approx(moment * ratio[k], rel=1e-12)
    found = forces.stiffness(place).matrix[k, k]
    assert unit * found == pytest.approx(slope * ratio[k] ** 2, rel=1e-11)


def _rate_of_crank(forces: Forces, place: FreePlace) -> Floats:
    layout = forces.session.layout
    edge = next(e for e, one in enumerate(layout.graph.edges) if one.joint.name == "A")
    return place.tangents[:, layout.column(edge, 0)]
