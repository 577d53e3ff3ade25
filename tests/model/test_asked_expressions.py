"""What `r[...]` reads, `analyze([...])` may be asked for: components, expressions, named ones."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

FILE = """\
format: 1
units: {length: mm, angle: deg, force: N}
parameters: {r: 40 mm, n: 2}
links: {arm: {mass: 2, center_of_mass: [r, 0, 0], inertia: {xx: 9, yy: 9, zz: 9}}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
points: {tip: {link: arm, at: [n*r, 0, 0]}}
quantities:
  reach: tip.position.x/r
  power: O.effort*O.theta_dot
  gain: derivative(reach, O.theta)
motion: {inputs: {O.theta: {from: 0, to: 90, count: 4, rate: 2 rad/s, acceleration: 3 rad/s^2}}}
"""
TEXTS = [
    *("reach", "power", "gain", "2*power", "tip.position.y", "O.force.x", "norm(O.force)"),
    *("n*O.theta", "tip.position + 1 mm*tip.position/r", "row.status", "O.theta.effort", "3"),
]


@pytest.mark.parametrize("text", TEXTS)
def test_asked_for_or_read_is_the_same(text: str) -> None:
    asked = mk.loads(FILE).analyze([text], tables=[])
    read = mk.loads(FILE).analyze([], tables=[])
    np.testing.assert_array_equal(asked[text], read[text])


def test_they_are_computed_at_once() -> None:
    """x = 2 r cos(theta): reach = 2 cos(theta), its slope -2 sin(theta) per rad."""
    analysis = mk.loads(FILE).analyze(["reach", "gain"], tables=[])
    assert "tip.position" in analysis.result.columns
    theta = np.radians([0, 30, 60, 90])
    assert analysis["reach"] == pytest.approx(2 * np.cos(theta), abs=1e-15)
    assert analysis["gain"] == pytest.approx(-2 * np.sin(theta), abs=1e-15)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("2*O.thetta", "there is no quantity O.thetta; did you mean O.theta"),
        ("O.thetta", "there is no quantity O.thetta; did you mean O.theta"),
        ("reech", "there is no quantity reech"),
        ("2*", "there is no quantity 2"),
        ("tip.position.w", "there is no quantity tip.position.w"),
    ],
)
def test_what_there_is_not_is_named(text: str, words: str) -> None:
    with pytest.raises(mk.UsageError) as refused:
        mk.loads(FILE).analyze([text], tables=[])
    assert words in str(refused.value)
