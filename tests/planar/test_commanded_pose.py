"""A commanded pose in a plane: P along x, P along y and R through two links without mass."""

from __future__ import annotations

import mpmath as mp
import pytest

import mechkin_cli as mk

TEXT = """
format: 1
name: one leg of a platform
plane: xy
units: {length: mm, angle: deg, force: N}
links: {along: {}, across: {}, platform: {mass: 2, center_of_mass: [80, 60]}, lower: {}, upper: {}}
joints:
  X: {type: P, links: [ground, along], point: [80, 60], axis: [1, 0]}
  Y: {type: P, links: [along, across], point: [80, 60], axis: [0, 1]}
  T: {type: R, links: [across, platform], point: [80, 60]}
  A: {type: R, links: [ground, lower], point: [0, 0]}
  B: {type: R, links: [lower, upper], point: [0, 70]}
  C: {type: R, links: [upper, platform], point: [60, 70]}
motion:
  inputs:
    X.s: {values: [0, 5, 10]}
    Y.s: {values: [0, -8, 3]}
    T.theta: {values: [0, 20, -15]}
loads: [{type: gravity, g: standard}]
"""


def test_a_leg_follows_the_pose() -> None:
    r = mk.loads(TEXT).analyze(["A.theta", "Y.effort", "X.effort"])
    assert set(r["row.status"]) == {"ok"}
    with mp.workdps(30):
        for row, (x, y, turn) in enumerate([(0, 0, 0), (5, -8, 20), (10, 3, -15)]):
            end = mp.mpc(80 + x, 60 + y) + mp.mpc(-20, 10) * mp.expj(mp.radians(turn))
            reach = abs(end)
            # 70 and 60 long; the elbow lies to the left of the line to the end
            elbow = mp.acos((70**2 + reach**2 - 60**2) / (2 * 70 * reach))
            angle = mp.degrees(mp.arg(end) + elbow) - 90
            assert r["A.theta"][row] == pytest.approx(float(angle), abs=1e-9)
            # the leg has no weight: the drives carry the platform alone
            assert r["Y.effort"][row] == pytest.approx(2 * 9.80665, rel=1e-12)
            assert abs(r["X.effort"][row]) < 1e-9
