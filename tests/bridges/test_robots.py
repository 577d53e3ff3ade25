"""Robot files become mechanisms that move, weigh and resist as MuJoCo says."""

from __future__ import annotations

import os

import pytest

mujoco = pytest.importorskip("mujoco")
from bridges import robots  # noqa: E402

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(4 * TIMES))
def test_urdf_trees_move_as_in_mujoco(seed: int) -> None:
    assert robots.check(robots.urdf(seed), seed) == 5


@pytest.mark.parametrize("seed", range(8 * TIMES))
def test_mjcf_trees_move_as_in_mujoco(seed: int) -> None:
    robots.check(robots.mjcf(seed), seed)
