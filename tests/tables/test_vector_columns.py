"""A vector in a column is the columns of its components."""

from math import cos, radians, sin

import numpy as np
import pytest

import mechkin_cli as mk

PLANE = """\
format: 1
plane: xy
links: {a: {}, b: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0]}
  B: {type: R, links: [a, b], point: [1, 0]}
points: {p: {link: b, at: [2, 0]}}
motion:
  inputs:
    A.theta: {from: 0, to: 90, count: 4}
    B.theta: {at: 30}
"""
SPACE = """\
format: 1
links: {a: {}}
joints: {A: {type: C, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
points: {p: {link: a, at: [2, 0, 0]}}
motion:
  inputs:
    A.theta: {from: 0, to: 90, count: 4}
    A.s: {at: 3}
"""
PLACES = {
    PLANE: lambda t: [cos(t) + cos(t + radians(30)), sin(t) + sin(t + radians(30))],
    SPACE: lambda t: [2.0 * cos(t), 2.0 * sin(t), 3.0],
}


@pytest.mark.parametrize("text", PLACES, ids=["plane", "space"])
@pytest.mark.parametrize(
    ("column", "stem", "factor"),
    [
        ("p.position", "p.position", 1.0),
        ("3*p.position", "(3*p.position)", 3.0),
        ("{label: tip of b, value: 2*p.position, decimals: 2}", "tip of b", 2.0),
    ],
)
def test_components_are_columns(text: str, column: str, stem: str, factor: float) -> None:
    table = f"tables: [{{name: t, columns: [A.theta, {column}]}}]\n"
    run = mk.loads(text + table).analyze()
    found = run.tables["t"]
    expected = np.array([PLACES[text](radians(angle)) for angle in (0, 30, 60, 90)]).T
    labels = [f"{stem}.{axis}" for axis in "xyz"[: len(expected)]]
    assert [one.label for one in found.columns] == ["A.theta", *labels]
    for one, values in zip(found.columns[1:], expected, strict=True):
        assert one.unit == "m"
        np.testing.assert_allclose(one.numbers, factor * values, rtol=1e-14, atol=1e-14)


def test_a_vector_is_drawn_and_remarked_by_its_components() -> None:
    table = "{name: t, columns: [A.theta, p.position], plot: {x: A.theta, y: [p.position]}}"
    (layout,) = mk.loads(f"{PLANE}tables: [{table}]\n").analyze().layouts
    assert layout.plot_y == ("p.position.x", "p.position.y")
