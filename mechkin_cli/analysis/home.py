"""The home drawing as an assembly: whether it closes, and its branch up to given inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.solver.batch import run
from mechkin_cli.solver.follow import Followed, follow
from mechkin_cli.solver.layout import Layout

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan


def home_state(layout: Layout) -> Floats:
    """States of the home drawing: every coordinate zero."""
    state = np.zeros(layout.states)
    for carrier in layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state] = 1.0
    return state


def is_home_assembled(layout: Layout, plan: Plan) -> bool:
    """Whether the home drawing closes all loops as drawn."""
    zeros = np.zeros((len(layout.graph.inputs), 1))
    tests = (0.0, 0.0, tolerances.HOME_ASSEMBLED)
    batch = run(plan, zeros, home_state(layout)[:, None], iterations=0, tests=tests)
    return bool(batch.good[0])


def nearest_to_home(path: Floats) -> int:
    """The row whose inputs (inputs, rows) are nearest to the drawing's, which are zero."""
    return int(np.argmin(np.max(np.abs(path), axis=0))) if path.size else 0


def follow_from_home(layout: Layout, plan: Plan, inputs: Floats) -> Followed:
    """The branch of an assembled drawing, straight to `inputs` (inputs,)."""
    path = np.stack([np.zeros_like(inputs), inputs], axis=1)
    return follow(plan, path, home_state(layout))
