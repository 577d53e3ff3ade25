"""The same fit asked otherwise has the same answer: order, names, units, weights, mixed targets."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fit.test_fit import BOUNDS, FOUR_BAR, KNOWN, NINE

import mechkin_cli as mk

LINKAGE = """
format: 1
plane: xy
units: {{length: {unit}, angle: deg}}
parameters: {{{a}: {40}, {b}: {120}, {c}: {90}, {d}: {130}}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0]}}
  A: {{type: R, links: [crank, coupler], point: [{a}, 0]}}
  B: {{type: R, links: [coupler, rocker], point: {{coupler: [{a} + {b}, 0], rocker: [{d}, {c}]}}}}
  C: {{type: R, links: [ground, rocker], point: [{d}, 0]}}
points:
  pen: {{link: coupler, at: [{100}, {80}]}}
motion:
  inputs: {{O.theta: {{from: 0, to: 360, step: 15}}}}
assembly: {{near: {{C.theta: 0}}}}
"""


def linkage(names: str, unit: str = "mm", per: float = 1.0) -> mk.Model:
    """The kinematics of the kept four-bar with other names, in another unit of `per` mm."""
    text = LINKAGE
    for number in (40, 120, 90, 130, 100, 80):
        text = text.replace(f"{{{number}}}", f"{number / per!r} {unit}")
    return mk.loads(text.format(unit=unit, **dict(zip("abcd", names.split(), strict=True))))


# beside the curve, so that something is left
POINTS = (NINE + np.random.default_rng(5).uniform(-2, 2, NINE.shape)).tolist()
TARGET = {"of": "pen.position", "is": POINTS}
TURNED = FOUR_BAR.with_parameters(KNOWN).analyze(["C.theta"])["C.theta"][[4, 8, 16]] + [2, -1, 3]
OTHER = {"of": "C.theta", "at": [60, 120, 240], "is": TURNED.tolist(), "within": "4 deg"}


def found(f: mk.Fit) -> np.ndarray:
    return np.array(list(f.parameters.values()))


@pytest.fixture(scope="module")
def mixed() -> mk.Fit:
    return FOUR_BAR.fit([{**TARGET, "within": 1}, OTHER], BOUNDS, starts=1)


def test_the_order_of_targets_and_points(mixed: mk.Fit) -> None:
    other = FOUR_BAR.fit(
        [
            {**OTHER, "at": [240, 60, 120], "is": TURNED[[2, 0, 1]].tolist()},
            {**TARGET, "is": POINTS[4:], "within": "1 mm"},
            {**TARGET, "is": POINTS[:4], "within": "0.1 cm"},
        ],
        BOUNDS,
        starts=1,
    )
    assert mixed.status == other.status == "fitted"
    assert mixed.cost > 0.1
    assert np.abs(found(mixed) - found(other)).max() < 1e-6
    assert other.cost == pytest.approx(mixed.cost, rel=1e-12)


def test_the_order_of_parameters_and_units_of_bounds(mixed: mk.Fit) -> None:
    bounds = {
        name: (f"{low / 25.4!r} in", f"{high / 10} cm") for name, (low, high) in BOUNDS.items()
    }
    turned = dict(reversed(bounds.items()))
    other = FOUR_BAR.fit([{**TARGET, "within": 1}, OTHER], turned, starts=1)
    assert set(other.parameters) == set(mixed.parameters)
    for name, value in mixed.parameters.items():
        assert other.parameters[name] == pytest.approx(value, abs=1e-6)


def test_twice_the_weight_of_all_is_four_times_the_cost(mixed: mk.Fit) -> None:
    half = FOUR_BAR.fit([{**TARGET, "within": 0.5}, {**OTHER, "within": "2 deg"}], BOUNDS, starts=1)
    assert half.cost == pytest.approx(4 * mixed.cost, rel=1e-10)
    assert np.abs(found(half) - found(mixed)).max() < 1e-5


def test_a_target_given_twice_counts_as_root_two(mixed: mk.Fit) -> None:
    twice = FOUR_BAR.fit([{**TARGET, "within": 1}, OTHER, OTHER], BOUNDS, starts=1)
    root = {**OTHER, "within": f"{4 / 2**0.5!r} deg"}
    once = FOUR_BAR.fit([{**TARGET, "within": 1}, root], BOUNDS, starts=1)
    assert np.abs(found(twice) - found(once)).max() < 1e-6
    assert np.abs(found(twice) - found(mixed)).max() > 1e-3


def test_other_names_and_a_file_in_inches() -> None:
    plain = linkage("a b c d").fit(TARGET, BOUNDS, starts=1)
    longer = linkage("crank_length rod arm base")
    names = dict(zip(longer.problem.parameters, BOUNDS.values(), strict=True))
    renamed = longer.fit(TARGET, names, starts=1)
    assert np.abs(found(renamed) - found(plain)).max() < 1e-6
    inches = linkage("a b c d", "in", 25.4)
    small: dict[str, Any] = {n: (low / 25.4, high / 25.4) for n, (low, high) in BOUNDS.items()}
    in_inches = inches.fit({**TARGET, "is": (np.array(POINTS) / 25.4).tolist()}, small, starts=1)
    assert np.abs(25.4 * found(in_inches) - found(plain)).max() < 1e-5
    assert in_inches.cost * 25.4**2 == pytest.approx(plain.cost, rel=1e-10)
