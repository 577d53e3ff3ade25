"""Random linkages with idle freedoms against the same with these fixed in an arbitrary way.

What is not conventional must agree: motion, forces, efforts. `MECHKIN_RANDOM` multiplies the number
of linkages.
"""

from __future__ import annotations

import os
from random import Random

import numpy as np
import pytest
from random_families.idle_links import KINDS, linkage

from mechkin_cli import loads

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
NEAR = 1e-9
"""Difference in parts of a column's largest value and of the row's condition."""


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_not_conventional_does_not_know_how_the_idle_freedom_is_fixed(kind: str) -> None:
    solved = 0
    for number in range(8 * TIMES):
        found = linkage(Random(f"{kind} {number}"), kind)
        idle = loads(found.idle).analyze([*found.quantities, "row.condition"])
        fixed = loads(found.fixed).analyze([*found.quantities, "row.condition"])
        both = (idle["row.status"] == "ok") & (fixed["row.status"] == "ok")
        assert both[0], (number, idle["row.status"], fixed["row.status"], idle.diagnostics)
        # fixed, a linkage may come to its own dead centres and end before
        assert (idle["row.status"] == "ok")[both].all()
        solved += int(both.sum())
        scale = NEAR * np.maximum(idle["row.condition"], fixed["row.condition"])[both]
        for name in found.quantities:
            one, other = (np.atleast_2d(run[name].T)[:, both] for run in (idle, fixed))
            size = np.nanmax(np.abs(other), initial=1e-3)
            known = np.isfinite(one) & np.isfinite(other)
            off = np.where(known, np.abs(one - other), 0.0) / size
            assert known.any() or np.isnan(one).all(), (number, name)
            assert np.all(off <= scale), (number, name, off.max())
    assert solved >= 20 * TIMES


@pytest.mark.parametrize("kind", KINDS)
def test_mobility_calls_idle_what_analysis_solves(kind: str) -> None:
    found = linkage(Random(f"{kind} of mobility"), kind)
    model = loads(found.idle)
    mobility = model.mobility()
    spinning = {link for freedom in mobility.idle for link in freedom.links}
    assert spinning & set(found.links), (mobility.verdict, mobility.idle)
    assert model.analyze([]).result.solved[0]
    assert not loads(found.fixed).mobility().diagnostics
