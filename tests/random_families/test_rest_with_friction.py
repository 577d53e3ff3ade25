"""Where friction holds random loops with springs, against sweeps that are driven slowly there:
at the ends of an interval of rest a drive has nothing to do that moves the mechanism on."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from random_families.four_bars import cases
from random_families.sprung_loops import SprungLoop, plane_four_bar, rssr

import mechkin_cli as mk

SLOW = 1e-7
"""Of the drive, rad/s: inertia is below rounding."""


def rubbing(loop: SprungLoop, rng: random.Random, joints: str) -> str:
    """The loop with friction in some of its joints A to D."""
    rubs = [
        f"  - {{type: friction, joint: {name}, coefficient: {rng.uniform(0.05, 0.4)!r}, "
        f"radius: {rng.uniform(0.02, 0.1)!r}}}\n"
        for name in joints
    ]
    return loop.text + "".join(rubs)


def check_ends(text: str, window: str, other: str) -> int:
    """How many ends were driven over."""
    r = mk.loads(text).equilibrium(window={window: (-math.pi, math.pi)})
    if not r.result.solved.any():
        return 0
    ends = [None if one is None else one.ends for one in r.result.rests]
    checked = 0
    for k, why in enumerate(ends):
        assert why is not None
        at, beside = float(r[window][k]), float(r[other][k])
        for side, to in enumerate((r["row.rest_from"][k], r["row.rest_to"][k])):
            if why[side].name != "SLIPS":
                continue
            efforts = []
            for rate in (SLOW, -SLOW):
                # both ways through the end, to which the first rows lead
                motion = (
                    f"motion: {{inputs: {{{window}: {{from: {at!r}, to: {float(to)!r}, count: 9, "
                    f"rate: {rate!r}}}}}}}\nassembly: {{near: {{{other}: {beside!r}}}}}\n"
                )
                name = window.partition(".")[0]
                driven = mk.loads(text + motion).analyze([window, f"{name}.effort"])
                efforts.append(driven[f"{name}.effort"])
            forward, back = efforts
            if np.isnan(forward[-1]) or np.isnan(back[-1]):
                continue
            width = float(np.nanmax(np.abs(forward - back)))
            assert min(abs(forward[-1]), abs(back[-1])) < 1e-7 * width
            # within, the one pushes forward and the other back
            inner = slice(0, -1)
            assert (forward[inner] > -1e-9 * width).all() or np.isnan(forward[inner]).any()
            assert (back[inner] < 1e-9 * width).all() or np.isnan(back[inner]).any()
            checked += 1
    return checked


@pytest.mark.parametrize("rng", [*cases(811, 6)])
def test_plane_four_bars(rng: random.Random) -> None:
    text = rubbing(plane_four_bar(rng), rng, "ABCD")
    assert check_ends(text, "A.theta", "D.theta") + check_ends(text, "D.theta", "A.theta")


@pytest.mark.parametrize("rng", [*cases(812, 6)])
def test_spatial_four_bars(rng: random.Random) -> None:
    text = rubbing(rssr(rng), rng, "AD")
    assert check_ends(text, "A.theta", "D.theta") + check_ends(text, "D.theta", "A.theta")
