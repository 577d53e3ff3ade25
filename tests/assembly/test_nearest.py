"""`assembly: {near: ...}` takes the nearest of all assemblies, whether it is found by Newton's
method alone, by a search about what is named, or by a search everywhere."""

from __future__ import annotations

import math
import os
import random
import re

import pytest
from modes.test_modes import rcsr
from mpmath import mp

import mechkin_cli as mk

SEEDS = int(os.environ.get("MECHKIN_RANDOM", "25"))


def near(file: str, place: dict[str, float]) -> mk.Analysis:
    named = ", ".join(f"{name}: {value!r}" for name, value in place.items())
    return mk.loads(f"{file}assembly: {{near: {{{named}}}}}\n").analyze([], tables=[])


def distance(one: dict[str, float], other: dict[str, float], size: float) -> float:
    """Root of the squares: angles the shorter way round in rad, slides in sizes."""
    total = 0.0
    for name, value in one.items():
        miss = value - other[name]
        if name.endswith("theta"):
            miss = math.remainder(math.radians(miss), math.tau)
        else:
            miss /= size
        total += miss * miss
    return math.sqrt(total)


def unknowns(coordinates: dict[str, float]) -> dict[str, float]:
    return {name: value for name, value in coordinates.items() if name != "A.theta"}


@pytest.mark.parametrize("seed", range(SEEDS))
def test_the_nearest_of_all_roots_is_taken(seed: int) -> None:
    file, roots = rcsr(seed)
    model = mk.loads(file)
    modes = [unknowns(mode.coordinates) for mode in model.modes().modes]
    assert sorted(m["D.theta"] for m in modes) == pytest.approx(
        [float(mp.degrees(root)) for root in roots], abs=1e-9
    )
    if not modes:
        return
    size = model.problem.mechanism.box_diagonal()
    rng = random.Random(seed)
    for _ in range(8):
        one, other = rng.choice(modes), rng.choice(modes)
        t, spread = rng.choice([0.0, 0.05, 0.3, 0.45]), 10.0 ** rng.uniform(-6, 0)
        place = {
            name: value + t * (other[name] - value) + spread * rng.gauss(0, 1)
            for name, value in one.items()
        }
        distances = [distance(place, mode, size) for mode in modes]
        order = sorted(range(len(modes)), key=lambda i: distances[i])
        found = near(file, place)
        best = modes[order[0]]
        turned = math.remainder(found["D.theta"][0] - best["D.theta"], 360.0)
        unclear = any(d.code == "nearest-unclear" for d in found.diagnostics)
        assert turned == pytest.approx(0.0, abs=1e-6), (place, found.result.how)
        close = len(order) > 1 and distances[order[1]] < 1.2 * distances[order[0]]
        assert unclear == close, (place, found.result.how)
        claim = re.search(r"no other within ([0-9.e+-]+)", found.result.how)
        if claim:  # true of all other roots
            for mode in modes:
                apart = distance(best, mode, size)
                assert apart == 0.0 or apart > 0.99 * float(claim[1])
        assert found["row.mode"][0] in "ABCD"


def test_a_close_name_needs_no_search_and_a_coarse_one_says_how_it_was_found() -> None:
    file, _ = rcsr(3)
    mode = unknowns(mk.loads(file).modes().modes[0].coordinates)
    exact = near(file, {name: value + 1e-4 for name, value in mode.items()})
    assert "by Newton's method; no other within" in exact.result.how
    there = {name: value + (10.0 if "theta" in name else 0.1) for name, value in mode.items()}
    coarse = near(file, there)
    assert "starts found within" in coarse.result.how
