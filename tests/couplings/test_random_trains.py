"""Random trains of wheels and four-bars, any joint of which may be coupled: one freedom by the
independent count, powers that balance, and energy that is kept."""

from __future__ import annotations

import random

import numpy as np
import pytest

import mechkin_cli as mk

HEAD = "format: 1\nplane: xy\nunits: {length: m, angle: rad, mass: kg, force: N}\n"


def train(seed: int) -> tuple[str, str]:
    """The text of a mechanism with as many couplings as leave one freedom, and a joint that is
    not coupled to be moved by others alone."""
    rng = random.Random(seed)
    joints: dict[str, tuple[str, str, float, float]] = {}
    bars, wheels = rng.choice([1, 2, 3]), rng.choice([1, 2, 3])
    for k in range(bars):
        x = 10.0 * k
        joints[f"A{k}"] = ("ground", f"a{k}", x, 0.0)
        joints[f"B{k}"] = (f"a{k}", f"b{k}", x, 1.0)
        joints[f"C{k}"] = (f"d{k}", f"b{k}", x + 3.6, 2.1)
        joints[f"D{k}"] = ("ground", f"d{k}", x + 4.0, 0.0)
    for k in range(wheels):
        joints[f"W{k}"] = ("ground", f"w{k}", 3.0 * k, 9.0)
    text = HEAD + "links:\n"
    for link in dict.fromkeys(end for joint in joints.values() for end in joint[:2]):
        if link != "ground":
            mass, x, y, inertia = (rng.uniform(0.5, 2.0) for _ in range(4))
            text += f"  {link}: {{mass: {mass}, center_of_mass: [{x}, {y}], inertia: {inertia}}}\n"
    text += "joints:\n"
    for name, (one, other, x, y) in joints.items():
        ends = (one, other) if rng.random() < 0.5 else (other, one)
        text += f"  {name}: {{type: R, links: [{', '.join(ends)}], point: [{x}, {y}]}}\n"
    trees = [[f"{letter}{k}" for letter in "ABD"] for k in range(bars)]
    trees += [[f"W{k}"] for k in range(wheels)]
    rng.shuffle(trees)
    text += "couplings:\n"
    for number in range(1, len(trees)):
        one, other = rng.choice(trees[number]), rng.choice(rng.choice(trees[:number]))
        ratio = rng.choice([-0.5, 0.37, -0.8, 0.25])
        text += (
            f"  K{number}: {{type: linear, terms: {{{one}.theta: 1, {other}.theta: {ratio}}}}}\n"
        )
    return f"{text}loads: [{{type: gravity, g: [0, -9.81]}}]\n", trees[0][0]


@pytest.mark.parametrize("seed", range(10))
def test_one_freedom_and_powers_in_balance(seed: int) -> None:
    text, driven = train(seed)
    law = "{from: 0, to: 0.3, count: 5, rate: 1 rad/s, acceleration: 0.7 rad/s^2}"
    model = mk.loads(f"{text}motion: {{inputs: {{{driven}.theta: {law}}}}}")
    found = model.mobility()
    assert (found.count, found.mobility, found.first_order) == (1, 1, 1)
    result = model.analyze()
    assert set(result["row.status"]) == {"ok"}
    assert np.max(result["row.power_error"]) < 1e-13


@pytest.mark.parametrize("seed", range(4))
def test_energy_is_kept(seed: int) -> None:
    text, driven = train(seed)
    times = "time: {from: 0, to: 0.1, step: 0.05}"
    motion = f"responses: {{r: {{start: {{{driven}.theta: 0}}, {times}}}}}"
    result = mk.loads(text + motion).respond("r")
    assert set(result["row.status"]) == {"ok"}
    assert np.max(result["row.power_error"][1:]) < 1e-12  # at rest there is no power
    assert np.max(np.abs(result["row.energy_error"][1:])) < 1e-9
