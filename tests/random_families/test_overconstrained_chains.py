"""What holds a part twice changes no answer: chains of dyads against closed forms.

Blocks are as small as without what is held twice. `MECHKIN_RANDOM` multiplies the number of chains
(1000 with 25).
"""

from __future__ import annotations

import math
import os
import random

import numpy as np
import pytest
from random_families.overconstrained_chains import (
    Chain,
    NotAssembled,
    Written,
    copies,
    random_chain,
    write,
)

import mechkin_cli as mk

COUNT = 40 * int(os.environ.get("MECHKIN_RANDOM", "1"))
REGULAR = 0.02
"""Least sine of the angle between two assemblies of a row that is asked for."""


def regular_chain(seed: int) -> tuple[Chain, np.ndarray, np.ndarray] | None:
    """A chain far from dead centres on its way, its rockers' angles and rates (rows, parts)."""
    chain = random_chain(random.Random(seed))
    if chain is None:
        return None
    first, last, step = chain.rows
    count = int((last - first) / step + 1e-9) + 1
    rows = np.radians(first + step * np.arange(count))
    try:
        way = [*np.linspace(0.0, rows[0], 40), *np.linspace(rows[0], rows[-1], 200)]
        if min(chain.solve(angle).margin for angle in way) < REGULAR:
            return None
        angles = np.array([chain.solve(angle).angles for angle in rows])
        rates = np.array([chain.solve(angle).rates for angle in rows])
    except NotAssembled:
        return None
    return chain, angles, rates


def check(
    chain: Chain, angles: np.ndarray, rates: np.ndarray, written: Written, where: str
) -> None:
    closings = written.closed_at if where == "closed anywhere" else None
    rate_names = [f"{name}_dot" for name in written.angles]
    model = mk.loads(written.text)
    found = model.analyze([*written.angles, *rate_names, "A0.effort"], closed_at=closings)
    said = f"{where} {written.closed_at}\n{written.text}"
    assert set(found["row.status"].tolist()) == {"ok"}, said
    condition = max(1.0, float(found["row.condition"].max()))
    got = np.radians(np.array([found[name] for name in written.angles]).T)
    off = np.remainder(got - angles + math.pi, 2 * math.pi) - math.pi
    assert np.abs(off).max() < 1e-9 * condition, said
    got_rates = np.array([found[name] for name in rate_names]).T
    assert np.abs(got_rates - rates).max() < 1e-8 * condition * (1 + np.abs(rates).max()), said
    effort = -rates @ np.array(chain.loads)
    most = 1 + np.abs(rates).max()
    assert np.abs(found["A0.effort"] - effort).max() < 1e-7 * condition * most, said
    if closings is None:
        sizes = [len(block.unknowns) for block in model.graph.blocks]
        # what holds a part twice is solved with it, and with no other part
        assert len(sizes) >= len(chain.parts), said
        assert max(sizes) <= 3 or "doubled" in where, said


@pytest.mark.parametrize("part", range(10))
def test_what_is_held_twice_changes_nothing(part: int) -> None:
    tried = 0
    seed = 100_000 * part
    while tried < COUNT // 10:
        seed += 1
        known = regular_chain(seed)
        if known is None:
            continue
        tried += 1
        rng = random.Random(seed)
        chain = known[0]
        written = {
            "as it is": write(chain, rng),
            "closed anywhere": write(chain, rng),
            "doubled": write(chain, rng, copies(rng, chain)),
            "doubled and shuffled": write(chain, rng, copies(rng, chain), shuffled=True),
        }
        for where, file in written.items():
            check(*known, file, where)
        again = write(chain, rng, copies(rng, chain), shuffled=True)
        check(*known, again, "closed anywhere")
