"""All equilibria of random mechanisms with springs against a dense search; MECHKIN_RANDOM=10 takes
two hundred."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from random_families.four_bars import TURN, cases
from random_families.sprung_loops import (
    SprungLoop,
    arm,
    five_bar,
    plane_four_bar,
    rssr,
    stationary,
    stationary_of_arm,
    stationary_of_five_bar,
)

import mechkin_cli as mk

FOUND = 1e-6


def compare(loop: SprungLoop, window: str) -> None:
    wanted = stationary(loop)
    r = mk.loads(loop.text).equilibrium(window={window: (-math.pi, math.pi)})
    found = []
    if r.result.solved.any():
        energies = r["row.potential_energy"]
        found = [
            (math.remainder(x, TURN), energy)
            for x, energy in zip(r["A.theta"], energies, strict=True)
        ]
    missed = [
        x for x, _ in wanted if not any(abs(math.remainder(x - y, TURN)) < FOUND for y, _ in found)
    ]
    more = [
        y for y, _ in found if not any(abs(math.remainder(x - y, TURN)) < FOUND for x, _ in wanted)
    ]
    assert not missed
    assert not more
    assert len(found) == len(wanted)


@pytest.mark.parametrize("rng", [*cases(801, 8)])
@pytest.mark.parametrize("window", ["A.theta", "D.theta"])
def test_plane_four_bars(rng: random.Random, window: str) -> None:
    state = rng.getstate()
    compare(plane_four_bar(rng), window)
    rng.setstate(state)


@pytest.mark.parametrize("rng", [*cases(802, 6)])
@pytest.mark.parametrize("window", ["A.theta", "D.theta"])
def test_spatial_four_bars(rng: random.Random, window: str) -> None:
    state = rng.getstate()
    compare(rssr(rng), window)
    rng.setstate(state)


@pytest.mark.parametrize("rng", [*cases(803, 6)])
def test_arms_of_two_freedoms(rng: random.Random) -> None:
    own = arm(rng)
    wanted = stationary_of_arm(own)
    window = dict.fromkeys(("A.theta", "B.theta"), (-math.pi, math.pi))
    r = mk.loads(own.text).equilibrium(window=window)
    found = np.stack([r["A.theta"], r["B.theta"]], axis=1)

    def apart(x: np.ndarray, y: np.ndarray) -> float:
        return float(np.abs(np.remainder(x - y + math.pi, TURN) - math.pi).max())

    assert all(any(apart(x, y) < FOUND for y in found) for x in wanted)
    # each is a place at which the energy is stationary, and stable where it is least
    for place, event in zip(found, r["row.event"], strict=True):
        h = 1e-3
        hessian = np.empty((2, 2))
        for i, e in enumerate(np.eye(2) * h):
            for j, f in enumerate(np.eye(2) * h):
                corners = [own.energy(place + s * e + t * f) for s in (1, -1) for t in (1, -1)]
                hessian[i, j] = (corners[0] - corners[1] - corners[2] + corners[3]) / (4 * h * h)
        least = np.linalg.eigvalsh(hessian)[0]
        if abs(least) > 1e-3:
            assert event == ("stable" if least > 0 else "unstable")


@pytest.mark.parametrize("rng", [*cases(804, 4)])
def test_loops_of_two_freedoms(rng: random.Random) -> None:
    written, energies = five_bar(rng)
    window = dict.fromkeys(("A.theta", "E.theta"), (-math.pi, math.pi))
    r = mk.loads(written).equilibrium(window=window)
    found = np.stack([r["A.theta"], r["E.theta"]], axis=1)
    levels = r["row.potential_energy"]
    for x, level in stationary_of_five_bar(energies):
        away = np.abs(np.remainder(found - x + math.pi, TURN) - math.pi).max(axis=1)
        assert ((away < 1e-5) & (np.abs(levels - level) < 1e-5)).any()
    for x, level in zip(found, levels, strict=True):
        assert any(abs(energy(x) - level) < 1e-6 for energy in energies)
    # the Euler characteristic of a closed surface is even
    assert len(found) % 2 == 0
    assert "window-missing" not in [note.code for note in r.diagnostics]
