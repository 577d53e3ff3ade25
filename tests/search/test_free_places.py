"""Places of a free motion at which random starts end."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.kernel.functions import RandomStarts
from mechkin_cli.plan import Demand
from mechkin_cli.search import free_places
from mechkin_cli.statics.newton import Balancing

FILES = Path("mechanisms/dissertation")


@pytest.mark.parametrize("name", ["rcsr", "rcsr_csr"])
def test_places_are_closed_all_along_the_coordinate_that_is_free(name: str) -> None:
    session = mk.load(FILES / f"{name}.yaml").session.part(0, 0)
    item = session.problem.motion.inputs[0]
    free = Balancing.of(session, [(item.joint, item.coordinate)]).forces.session
    everywhere = np.zeros(free.layout.states), np.full(free.layout.states, np.inf)
    states = free_places(free, everywhere, RandomStarts(), 256)
    assert states.shape[1] > 100
    slot = session.layout.state(*session.graph.inputs[0])
    values = states[slot]
    # the driven session closes where they are, with hardly a step
    inputs = np.repeat(session.inputs.reduced[:, :1], values.size, axis=1)
    inputs[0] = values
    batch = session.close(inputs, states, Demand.POSITION)
    assert batch.good.mean() > 0.9
    assert np.median(batch.correction[batch.good]) < 1e-6
    # each ends near where it starts
    assert np.std(values) > 0.3
    assert len(np.unique(np.round(values, 6))) > 0.9 * values.size
