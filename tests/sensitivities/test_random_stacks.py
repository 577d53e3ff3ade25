"""Monte Carlo against stacks to first order on random four-bars and slider-cranks with bands so
narrow that they are linear; `MECHKIN_RANDOM` multiplies them."""

from __future__ import annotations

import os

import numpy as np
import pytest

import mechkin_cli as mk

FAMILY = 6 * int(os.environ.get("MECHKIN_RANDOM", "1"))
SAMPLES = 400
SIGMAS = 5.0
"""Standard errors; of 6 x 2 x 5 numbers none is beyond, but for one family in 30 000."""

FOUR_BAR = """
format: 1
plane: xy
units: {{length: mm, angle: deg, mass: kg, force: N}}
parameters: {{a: {a} mm, b: {b} mm, c: {c} mm, d: {d} mm, m: {m} kg}}
links:
  crank: {{}}
  coupler: {{mass: m, center_of_mass: [a + b/2, 0], inertia: 500}}
  rocker: {{}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0]}}
  A: {{type: R, links: [crank, coupler], point: [a, 0]}}
  B: {{type: R, links: [coupler, rocker], point: {{coupler: [a + b, 0], rocker: [d, c]}}}}
  C: {{type: R, links: [ground, rocker], point: [d, 0]}}
motion: {{inputs: {{O.theta: {{from: 30, to: 330, step: 75, rate: 10 rad/s}}}}}}
assembly: {{near: {{C.theta: 0}}}}
"""
SLIDER_CRANK = """
format: 1
plane: xy
units: {{length: mm, angle: deg, mass: kg, force: N}}
parameters: {{a: {a} mm, b: {b} mm, c: {c} mm, m: {m} kg}}
links: {{crank: {{}}, rod: {{}}, slider: {{mass: m, center_of_mass: [a + b, c]}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0]}}
  A: {{type: R, links: [crank, rod], point: [a, 0]}}
  B: {{type: R, links: [rod, slider], point: {{rod: [a + b, 0], slider: [a + b, c]}}}}
  C: {{type: P, links: [ground, slider], point: [a + b, c], axis: [1, 0]}}
motion: {{inputs: {{O.theta: {{from: 30, to: 330, step: 75, rate: 10 rad/s}}}}}}
"""


def linkage(random: np.random.Generator, kind: int) -> tuple[mk.Model, str]:
    """A random one whose crank turns well within its dead centres, and what it puts out."""
    a = random.uniform(20, 40)
    if kind:
        b, c = random.uniform(3, 5) * a, random.uniform(-0.5, 0.5) * a
        numbers = {"a": a, "b": b, "c": c, "m": random.uniform(0.5, 3)}
        return mk.loads(SLIDER_CRANK.format(**numbers)), "C.s"
    b, c, d = (random.uniform(2.6, 3.6) * a for _ in range(3))
    numbers = {"a": a, "b": b, "c": c, "d": d, "m": random.uniform(0.5, 3)}
    return mk.loads(FOUR_BAR.format(**numbers)), "C.theta"


@pytest.mark.parametrize("seed", range(FAMILY))
def test_samples_scatter_as_slopes_say(seed: int) -> None:
    random = np.random.default_rng(seed)
    model, output = linkage(random, seed % 2)
    bands = {}
    for name, value in model.problem.parameters.items():
        size = float(value.value) * (1e3 if name != "m" else 1.0)
        bands[name] = abs(size) * 10 ** random.uniform(-5, -4)
    distribution = ("uniform", "normal")[seed // 2 % 2]
    quantities = [output, "O.effort"]
    t = model.tolerances(
        bands, quantities, samples=SAMPLES, method="random", seed=seed, distribution=distribution
    )
    for quantity in quantities:
        sampled, scatter = t.sampled(quantity), t.scatter(quantity)
        assert (scatter > 0.0).all()
        nominal = t.nominal(quantity)
        # what is left out shifts the mean by less than itself
        left = t.left_out(quantity) * (t.worst(quantity)[1] - nominal)
        assert (np.abs(sampled.mean - nominal) < SIGMAS * sampled.mean_error + left).all()
        assert (np.abs(sampled.deviation - scatter) < SIGMAS * sampled.deviation_error + left).all()
        assert not t.inaccurate(quantity).any()
        if distribution == "uniform":
            low, high = t.worst(quantity)
            room = left + 1e-9 * np.abs(nominal)
            drawn = t.drawn(quantity)
            assert ((drawn > low - room) & (drawn < high + room)).all()
        shares = np.sum(list(t.shares(quantity).values()), axis=0)
        assert np.abs(shares - 1.0).max() < 1e-12


def test_a_tenth_too_much_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """A scatter that is wrong by a fifth fails the test above."""
    from mechkin_cli.sensitivities.tolerance_stack import Tolerances

    own = Tolerances.scatter
    monkeypatch.setattr(Tolerances, "scatter", lambda t, quantity: 1.2 * own(t, quantity))
    with pytest.raises(AssertionError):
        test_samples_scatter_as_slopes_say(0)


def test_to_pandas() -> None:
    pytest.importorskip("pandas")
    model, output = linkage(np.random.default_rng(0), 0)
    t = model.tolerances({"a": 0.01, "b": 0.02}, [output], samples=16)
    frame = t.to_pandas()
    assert len(frame) == 5
    assert frame["O.theta"].tolist() == t.slopes.place.tolist()
    assert (frame["C.theta least"] == t.worst(output)[0]).all()
    assert (frame["C.theta scatter"] == t.scatter(output)).all()
    assert (frame["C.theta share of a"] + frame["C.theta share of b"] - 1.0).abs().max() < 1e-12
    assert frame.attrs["units"]["C.theta scatter"] == "deg"
    assert not frame["C.theta inaccurate"].any()
