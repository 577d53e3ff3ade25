"""The home drawing as states of the kernel: every coordinate is zero there but those of guided
points (`building.point_inputs`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout


def home_state(layout: Layout) -> Floats:
    """States of the home drawing (states,)."""
    state = np.zeros(layout.states)
    for carrier in layout.carriers:
        if carrier.part.type.is_ball:
            state[carrier.state] = 1.0
        elif carrier.part.drawn != 0.0:
            state[carrier.state] = carrier.part.drawn / layout.length
    return state


def home_inputs(layout: Layout) -> Floats:
    """The inputs of the home drawing (inputs,)."""
    state = home_state(layout)
    found = [
        state[layout.state(edge, freedom)] if edge >= 0 else 0.0
        for edge, freedom in layout.graph.inputs
    ]
    return np.array(found, dtype=np.float64)
