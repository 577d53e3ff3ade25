"""The home drawing as states of the kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout


def home_state(layout: Layout) -> Floats:
    """States of the home drawing: every coordinate zero."""
    state = np.zeros(layout.states)
    for carrier in layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state] = 1.0
    return state
