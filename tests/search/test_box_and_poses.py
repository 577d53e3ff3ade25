"""Starts taken from a box, and what tells poses apart, against plain loops."""

from __future__ import annotations

from math import cos, inf, isfinite, pi, sin

import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.search.clusters import pose_keys, randomise, same_poses, unknown_states

FILES = ("rcsr", "rchch", "stewart", "rprhrrr", "five_link_suspension")


def layout_of(name: str):

    return mk.load(FILE_OF[name]).session.layout


@pytest.mark.parametrize("name", FILES)
def test_a_box_bounds_its_states_and_leaves_all_others_as_without_one(name: str) -> None:
    layout, rng = layout_of(name), np.random.default_rng(4)
    middle = np.zeros(layout.states)
    for number in range(len(layout.graph.blocks)):
        own = unknown_states(layout, number)
        radius = np.full(layout.states, inf)
        balls = [c.state for c in layout.carriers if c.part.type.is_ball]
        scalars = [s for s in own if not any(b <= s < b + 4 for b in balls)]
        for state in scalars[::2]:
            radius[state] = rng.uniform(0.01, 0.3)
        centre = rng.uniform(-pi, pi, layout.states)
        free, boxed = (np.zeros((layout.states, 64)) for _ in range(2))
        randomise(layout, number, free, RandomStarts(), 1, middle)
        randomise(layout, number, boxed, RandomStarts(), 1, middle, (centre, radius))
        for state in range(layout.states):
            if isfinite(radius[state]):
                off = np.abs(boxed[state] - centre[state])
                assert 0.5 * radius[state] < off.max() <= radius[state]
            else:
                assert boxed[state].tolist() == free[state].tolist()


@pytest.mark.parametrize("name", FILES)
def test_poses_are_told_by_cosines_sines_slides_and_products(name: str) -> None:
    layout, rng = layout_of(name), np.random.default_rng(5)
    states = rng.uniform(-4.0, 4.0, (layout.states, 3))
    expected: list[list[float]] = []
    for carrier in layout.carriers:
        if carrier.part.type.is_ball:
            q = states[carrier.state : carrier.state + 4]
            expected += [list(q[i] * q[j]) for i in range(4) for j in range(i, 4)]
            continue
        for local, freedom in enumerate(carrier.part.type.freedoms):
            row = states[carrier.state + local]
            if freedom.motion == "turn":
                expected += [[cos(x) for x in row], [sin(x) for x in row]]
            else:
                expected.append(list(row))
    assert pose_keys(layout, states) == pytest.approx(np.array(expected), abs=1e-15)


@pytest.mark.parametrize(("known", "others"), [(1, 1), (2, 60), (30, 400)])
def test_the_same_poses_are_those_no_key_of_which_is_off(known: int, others: int) -> None:
    """Few are compared at once and many key by key."""
    rng = np.random.default_rng(known)
    one = rng.uniform(-1.0, 1.0, (7, known))
    other = one[:, rng.integers(0, known, others)] + rng.choice([0.0, 4e-7, 2e-6], (7, others))
    other[3, ::5] = np.nan
    expected = [
        [all(abs(a - b) < 1e-6 for a, b in zip(p, q, strict=True)) for q in other.T] for p in one.T
    ]
    assert same_poses(one, other, 1e-6).tolist() == expected
