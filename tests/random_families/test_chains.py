"""Chains of planar four-bars in any order of writing: the angles of a fold over the loops."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from random_families.four_bars import cases, circle_roots

from mechkin_cli import loads

AXIS = "axis: [0, 0, 1]"
ROWS = range(-5, 6)


def chain(count: int) -> tuple[list[str], list[str]]:
    """Links and joints; the rocker of a four-bar is the crank of the next."""
    links = ["K0"]
    joints = [f"J0: {{type: R, links: [ground, K0], point: [0, 0, 0], {AXIS}}}"]
    for k in range(count):
        x, bar, rocker = 3.0 * k, f"C{k}", f"K{k + 1}"
        links += [bar, rocker]
        joints += [
            f"A{k}: {{type: R, links: [K{k}, {bar}], point: [{x}, 1, 0], {AXIS}}}",
            f"B{k}: {{type: R, links: [{bar}, {rocker}], point: [{x + 3}, 1.3, 0], {AXIS}}}",
            f"P{k}: {{type: R, links: [ground, {rocker}], point: [{x + 3}, 0, 0], {AXIS}}}",
        ]
    return links, joints


def folded(count: int, first: float) -> list[float]:
    """Rocker angles in degrees, four-bar by four-bar."""
    out, angle = [], math.radians(first)
    for _ in range(count):
        tip = np.array([-math.sin(angle), math.cos(angle)])

        def gap(t: float, tip: np.ndarray = tip) -> float:
            d = np.array([3 - 1.3 * math.sin(t), 1.3 * math.cos(t)]) - tip
            return float(d @ d) - 9.09

        angle = min(circle_roots(gap, 1), key=lambda t, near=angle: abs(t - near))
        out.append(math.degrees(angle))
    return out


@pytest.mark.parametrize("count", [1, 2, 8, 40])
def test_order_of_writing_changes_nothing(count: int) -> None:
    want = np.array([folded(count, first) for first in ROWS]).T
    for rng in cases(3, 3):
        links, joints = chain(count)
        style = rng.choice(["windows", "shuffled", "by kind"])
        if style == "shuffled":
            rng.shuffle(links)
            random.Random(rng.random()).shuffle(joints)
        elif style == "by kind":
            joints.sort(key=lambda joint: joint[0])
        text = (
            "format: 1\nname: chain\nunits: {length: m, angle: deg, mass: kg, force: N}\nlinks:\n"
            + "".join(f"  {link}: {{}}\n" for link in links)
            + "joints:\n"
            + "".join(f"  {joint}\n" for joint in joints)
            + "motion: {inputs: {J0.theta: {from: -5, to: 5, step: 1}}}\n"
        )
        model = loads(text)
        assert [len(block.unknowns) for block in model.graph.blocks] == [2] * count
        names = [f"P{k}.theta" for k in range(count)]
        result = model.analyze(names)
        assert set(result["row.status"].tolist()) == {"ok"}
        tolerance = 1e-9 * max(1.0, float(result["row.condition"].max()))
        assert np.abs(np.array([result[name] for name in names]) - want).max() < tolerance
