"""`assembly: near` takes the nearest of all assemblies, which stand here in closed form."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from random_families.four_bars import FAMILIES, TURN, FourBar, cases, distance, head

from mechkin_cli import loads

# a second assembly this many times as far is told of; between the two numbers either is right
SURELY, HARDLY = 1.19, 1.21


def asked(rng: random.Random, bar: FourBar, base: dict[str, float]) -> dict[str, float]:
    """Some or all coordinates near an assembly, by whole turns off it or at half a turn."""
    names = sorted(rng.sample(sorted(bar.scales), rng.randint(1, len(bar.scales))))
    spread = rng.choice([0.01, 0.1, 0.5, 2.0, 5.0])
    near = {}
    for name in names:
        scale = bar.scales[name]
        near[name] = base[name] + rng.uniform(-1, 1) * spread * scale
        if scale == 1.0 and rng.random() < 0.4:
            near[name] += TURN * rng.randint(-3, 3)
        if scale == 1.0 and rng.random() < 0.1:
            near[name] = rng.choice([-math.pi, math.pi])
    return near


@pytest.mark.parametrize("family", ["RSSR", "RSSP", "RCSR", "RSUR"])
def test_nearest_of_all_assemblies(family: str) -> None:
    tried = 0
    for rng in cases(5, 60):
        bar = FAMILIES[family](rng)
        value = round(rng.uniform(-3, 3), 3)
        found = bar.assemblies(value)
        if not found:
            continue
        near = asked(rng, bar, rng.choice(found))
        places = ", ".join(f"{name}: {place!r}" for name, place in near.items())
        text = head(bar.driver, value) + bar.text + f"assembly: {{near: {{{places}}}}}\n"
        result = loads(text).analyze(list(bar.scales))
        got = {name: float(result[name][0]) for name in bar.scales}
        assert np.isfinite(list(got.values())).all(), text
        everything = list(bar.scales)
        assert min(distance(bar, one, got, everything) for one in found) < 1e-5, text
        ranked = sorted(distance(bar, one, near, list(near)) for one in found)
        assert distance(bar, got, near, list(near)) < ranked[0] + 1e-6, text
        told = any(d.code == "nearest-unclear" for d in result.diagnostics)
        if len(ranked) > 1 and ranked[0] > 1e-9:
            ratio = ranked[1] / ranked[0]
            assert told or ratio > SURELY, text
            assert not told or ratio < HARDLY, text
        tried += 1
    assert tried > 5
