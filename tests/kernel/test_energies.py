"""Kinetic and potential energy, and the powers of loads, of rows: closed forms, and derivatives of
energies along Taylor series at 40 digits."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

import mechkin_cli as mk

PENDULUM = """
format: 1
links: {bob: {mass: 2, center_of_mass: [0.3, 0, 0], inertia: {xx: .01, yy: .02, zz: .03}}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}
motion: {inputs: {A.theta: {from: 0, to: 720, step: 30, rate: 1.5 rad/s}}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: spring, joint: A, coordinate: theta, stiffness: 4, free: 90, preload: 0.5}
"""

SPRINGS = """
format: 1
links: {bob: {mass: 2, center_of_mass: [0.3, 0, 0]}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}
points: {p: {link: ground, at: [0.1, 0.5, 0]}, q: {link: bob, at: [0.4, 0, 0]}}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 40}}}
loads: [{type: spring, between: [p, q], stiffness: 200, free: 0.1, preload: 3}]
"""


def test_a_pendulum_with_a_spring_on_its_angle():
    r = mk.loads(PENDULUM).analyze(["row.kinetic_energy", "row.potential_energy"])
    with mp.workdps(40):
        for row, degrees in enumerate(range(0, 721, 30)):
            theta = mp.radians(degrees)
            stretch = theta - mp.pi / 2
            potential = 2 * mpf("9.81") * mpf("0.3") * mp.sin(theta)
            potential += 2 * stretch**2 + stretch / 2
            kinetic = (2 * mpf("0.09") + mpf("0.03")) * mpf("1.5") ** 2 / 2
            assert abs(r["row.kinetic_energy"][row] - kinetic) < 1e-15
            assert abs(r["row.potential_energy"][row] - potential) < 1e-13 * abs(potential)


def test_a_spring_between_points():
    r = mk.loads(SPRINGS).analyze(["row.kinetic_energy", "row.potential_energy"])
    with mp.workdps(40):
        for row, degrees in enumerate(range(0, 361, 40)):
            c, s = mp.cos(mp.radians(degrees)), mp.sin(mp.radians(degrees))
            length = mp.hypot(mpf("0.4") * c - mpf("0.1"), mpf("0.4") * s - mpf("0.5"))
            stretch = length - mpf("0.1")
            wanted = 100 * stretch**2 + 3 * stretch
            assert abs(r["row.potential_energy"][row] - wanted) < 1e-13 * wanted
    assert not r["row.kinetic_energy"].any()


@pytest.mark.parametrize("units", ["{length: mm}", "{length: in, mass: lbm, force: lbf}"])
def test_energies_are_in_the_units_of_moments(units):
    text = PENDULUM.replace("format: 1\n", f"format: 1\nunits: {units}\n")
    for old, new in (
        ("mass: 2", "mass: 2 kg"),
        ("[0.3, 0, 0]", "[0.3 m, 0, 0]"),
        ("xx: .01, yy: .02, zz: .03", "xx: .01 kg*m^2, yy: .02 kg*m^2, zz: .03 kg*m^2"),
        ("[0, -9.81, 0]", "[0, -9.81 m/s^2, 0]"),
        ("stiffness: 4", "stiffness: 4 N*m/rad"),
        ("preload: 0.5", "preload: 0.5 N*m"),
    ):
        text = text.replace(old, new)
    joule = {"{length: mm}": 1e3}.get(units, 1 / (4.4482216152605 * 0.0254))
    names = ["row.kinetic_energy", "row.potential_energy"]
    found, wanted = mk.loads(text).analyze(names), mk.loads(PENDULUM).analyze(names)
    for name in names:
        assert np.allclose(found[name], joule * wanted[name], rtol=1e-13, atol=0)


def test_loops_left_out_of_the_rows_are_followed_for_energies():
    text = PENDULUM + "follow: []\n"
    r = mk.loads(text).analyze(["row.kinetic_energy"])
    assert (r["row.kinetic_energy"] > 0.2).all()


def test_energies_are_columns_of_tables(tmp_path):
    table = "tables: [{name: t, columns: [A.theta, row.kinetic_energy, row.potential_energy]}]\n"
    m = mk.loads(PENDULUM + table)
    assert np.isfinite(m.analyze()["row.kinetic_energy + row.potential_energy"]).all()
    assert m.solve({"A.theta": 30.0}, ["row.kinetic_energy"])["row.kinetic_energy"] > 0.2
