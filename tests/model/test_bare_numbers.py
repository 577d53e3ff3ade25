"""A number that replaces a parameter is in the file's unit, by whatever way it comes."""

from __future__ import annotations

import pytest

import mechkin_cli as mk

FILE = """\
format: 1
units: {length: in, angle: deg, force: lbf}
parameters: {r: 2 in, k: 3 lbf/in, start: 5 deg, n: 2, slow: 1 rpm, twice: 2*r}
links: {arm: {}}
joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
points: {tip: {link: arm, at: [twice, 0, 0]}}
motion: {inputs: {O.theta: {from: start, to: 90, count: 3, rate: n*slow}}}
loads: [{type: spring, joint: O, coordinate: theta, stiffness: k*r*r/(1 rad)}]
"""


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("r", 3, "3 in"),
        ("k", 0.25, "0.25 lbf/in"),
        ("start", -7.5, "-7.5 deg"),
        ("n", 3, "3"),
        ("slow", 0.2, "0.2 rad/s"),
        ("twice", 5, "5 in"),
    ],
)
def test_all_ways_give_the_same(name: str, value: float, text: str) -> None:
    wanted = mk.loads(FILE, parameters={name: text})
    ways = [
        mk.loads(FILE, parameters={name: value}),
        mk.loads(FILE, parameters={name: repr(value)}),
        mk.loads(FILE).with_parameters({name: value}),
    ]
    names = ["O.theta", "O.theta_dot", "tip.position", "O.effort"]
    for model in ways:
        assert dict(model.parameters) == pytest.approx(dict(wanted.parameters), rel=1e-15)
        for quantity in names:
            found, expected = model.analyze()[quantity], wanted.analyze()[quantity]
            assert found == pytest.approx(expected, rel=1e-14), quantity


def test_an_expression_of_numbers_has_no_unit() -> None:
    with pytest.raises(mk.InvalidFile, match="this is a dimensionless number"):
        mk.loads(FILE, parameters={"r": "1 + 2"})
