"""`quantities:` and `derivative(...)`: a name is what it stands for, derivatives are those of
closed forms, and what is wrong is told once, at its place."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import mp

import mechkin_cli as mk

R, L = 40, 120
SLIDER_CRANK = """\
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
parameters: {r: 40 mm, l: 120 mm}
quantities:
  stroke: pin.position.x - l
  gain: derivative(stroke, O.theta)
  lean: atan2(along.y, along.x)
  lean_gain: derivative(lean, O.theta)
  arm: pin.position - knee.position
  swing: derivative(angle_between(arm, [1, 0, 0]), O.theta)
  reach: derivative(norm(knee.position - post.position), O.theta)
  wave: derivative(sin(2*pi*stroke/(40 mm)) + cos(-pi*stroke/l), O.theta)
  slope: derivative(tan(pi*(0.1 + 0.2*cos(O.theta))), O.theta)
  part: derivative(sin(pi*O.theta) + cos(O.theta/pi), O.theta)
  bent: derivative(if(O.theta > 90 deg, 2*stroke, -stroke), O.theta)
links:
  crank: {mass: 1, center_of_mass: [0, 0, 0]}
  rod: {mass: 1, center_of_mass: [80, 0, 0]}
  block: {mass: 1, center_of_mass: [160, 0, 0]}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: R, links: [crank, rod], point: [r, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [rod, block], point: [r + l, 0, 0], axis: [0, 0, 1]}
  S: {type: P, links: [ground, block], point: [r + l, 0, 0], axis: [1, 0, 0]}
points:
  pin: {link: block, at: [r + l, 0, 0]}
  knee: {link: rod, at: [r, 0, 0]}
  post: {link: ground, at: [20, 100, 5]}
directions:
  along: {link: rod, vector: [1, 0, 0]}
motion:
  inputs: {O.theta: {from: 10, to: 350, step: 20}}
tables:
  - {name: t, columns: [O.theta, stroke, gain, lean_gain, arm.x]}
"""


def crank(t: Any) -> tuple[Any, Any]:
    return R * mp.cos(t), R * mp.sin(t)


def slider(t: Any) -> Any:
    x, y = crank(t)
    return x + mp.sqrt(L * L - y * y)


def lean(t: Any) -> Any:
    return -mp.asin(crank(t)[1] / L)


CLOSED = {
    "gain": slider,
    "lean_gain": lean,
    "swing": lambda t: abs(lean(t)),
    "reach": lambda t: mp.sqrt((crank(t)[0] - 20) ** 2 + (crank(t)[1] - 100) ** 2 + 25),
    # numbers in parts of pi are in radians, angles in parts of pi are angles
    "wave": lambda t: (
        mp.sin(2 * mp.pi * (slider(t) - L) / 40) + mp.cos(mp.pi * (slider(t) - L) / L)
    ),
    "slope": lambda t: mp.tan(mp.pi * (1 + 2 * mp.cos(t)) / 10),
    "part": lambda t: mp.sin(mp.pi * t) + mp.cos(t / mp.pi),
    "bent": lambda t: (2 if t > mp.pi / 2 else -1) * (slider(t) - L),
}


@pytest.fixture(scope="module")
def rows() -> Any:
    return mk.loads(SLIDER_CRANK).analyze()


@pytest.mark.parametrize("name", CLOSED)
def test_derivatives_of_closed_forms_at_40_digits(rows: Any, name: str) -> None:
    with mp.workdps(40):
        turns = [mp.radians(mp.mpf(one)) for one in rows["O.theta"]]
        expected = np.array([float(mp.diff(CLOSED[name], t)) for t in turns])
    assert np.abs(rows[name] - expected).max() < 1e-12 * np.abs(expected).max() + 1e-13


def test_a_name_is_what_it_stands_for(rows: Any) -> None:
    np.testing.assert_array_equal(rows["stroke"], rows["pin.position.x - l"])
    np.testing.assert_array_equal(rows["arm.y"], rows["(pin.position - knee.position).y"])
    np.testing.assert_array_equal(rows["gain"], rows["derivative(pin.position.x - l, O.theta)"])
    np.testing.assert_array_equal(rows.tables[0].columns[1].values, rows["stroke"])
    written_out = SLIDER_CRANK.replace("derivative(stroke,", "derivative(pin.position.x - l,")
    np.testing.assert_array_equal(mk.loads(written_out).analyze()["gain"], rows["gain"])


def test_order_and_names_do_not_matter(rows: Any) -> None:
    head, _, rest = SLIDER_CRANK.partition("quantities:\n")
    own, _, tail = rest.partition("links:\n")
    turned = "".join(f"{line}\n" for line in reversed(own.splitlines()))
    other = mk.loads(f"{head}quantities:\n{turned}links:\n{tail}").analyze()
    renamed = mk.loads(SLIDER_CRANK.replace("stroke", "travel")).analyze()
    for name in CLOSED:
        np.testing.assert_array_equal(other[name], rows[name])
        np.testing.assert_array_equal(renamed[name], rows[name])


def test_a_number_in_parts_of_minus_pi_is_an_angle(rows: Any) -> None:
    expected = np.cos(np.pi * rows["stroke"] / L)
    np.testing.assert_allclose(rows["cos(-pi*stroke/l)"], expected, rtol=0, atol=1e-13)
    assert rows.errors["cos(-pi*stroke/l)"].max() < 1e-14


def test_derivatives_have_errors_and_variants(rows: Any) -> None:
    assert rows.errors["gain"].max() < 1e-12
    assert rows.errors["wave"].max() < 1e-12
    varied = mk.loads(SLIDER_CRANK).vary({"l": [100.0, 120.0]}, ["gain"])
    np.testing.assert_allclose(varied["gain"][1], rows["gain"], rtol=1e-12, atol=1e-12)
    alone = mk.loads(SLIDER_CRANK, parameters={"l": "100 mm"}).analyze()["gain"]
    np.testing.assert_allclose(varied["gain"][0], alone, rtol=1e-12, atol=1e-12)


def test_loads_and_stops_read_quantities() -> None:
    text = SLIDER_CRANK.replace("tables:", "loads: [{type: force, joint: S, value: LOAD}]\ntables:")
    named = mk.loads(text.replace("LOAD", '"-2 N/mm*stroke"')).analyze()["O.effort"]
    plain = mk.loads(text.replace("LOAD", '"-2 N/mm*(pin.position.x - l)"')).analyze()["O.effort"]
    np.testing.assert_array_equal(named, plain)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("a: b\n  b: a", "6:6: error: quantities depend on themselves: a -> b -> a"),
        ("a: derivative(A.point.x, O.theta)", "A.point has no derivative by an input; name the"),
        (
            "a: derivative(stroke, B.theta)",
            "B.theta is no input of the motion; did you mean O.theta?",
        ),
        ("a: derivative(stroke, 2)", "a derivative is taken by an input"),
        ("a: derivative(O.effort, O.theta)", "O.effort has no derivative by an input"),
        ("a: derivative(gain, O.theta)", "has no derivative by an input"),
        ("a: 3 mm + 2", "cannot add a length and a dimensionless number"),
        ("a: pin.positio", "there is nothing named pin.positio; did you mean pin.position"),
        ("pin: 3", "the name pin is already used in"),
        ("sin: 3", "the name sin is reserved"),
        ("a: row.mode", "row.mode is a text"),
        ("a: stroke.x", ".x takes a component of a vector, not of a length"),
        ("a: arm.w", "there is no component .w"),
        ("a: '1 +'\n  b: 2*a", "the expression ends where"),
    ],
)
def test_what_is_wrong_is_told_once_at_its_place(line: str, words: str) -> None:
    text = SLIDER_CRANK.replace("quantities:\n", f"quantities:\n  {line}\n")
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(text)
    assert words in str(caught.value)
    assert str(caught.value).count("error:") == 1


def test_a_derivative_stands_in_no_parameter_and_no_load() -> None:
    text = SLIDER_CRANK.replace("l: 120 mm", "l: 120 mm, q: 'derivative(r, O.theta)'")
    with pytest.raises(
        mk.InvalidFile, match=r"derivatives are known in columns and quantities|O.theta"
    ):
        mk.loads(text)
    load = "loads: [{type: force, joint: S, value: 1 N*gain}]\ntables:"
    with pytest.raises(mk.InvalidFile, match="derivatives are known in columns and quantities"):
        mk.loads(SLIDER_CRANK.replace("tables:", load))


def test_a_name_has_the_unit_of_what_it_stands_for(rows: Any) -> None:
    assert rows.unit("stroke") == "mm"


def test_what_is_per_angle_is_per_rad(rows: Any) -> None:
    """Of lengths, angles and plain numbers alike, whatever unit angles have."""
    slope = "derivative(stroke/(1 mm), O.theta)"
    assert rows.unit(slope) == "1/rad"
    assert rows.unit("gain") == "mm/rad"
    assert rows.unit("lean_gain") == ""
    assert np.allclose(rows[slope], rows["gain"], rtol=1e-15)
    assert rows.unit("derivative(3, O.theta)") == "1/rad"
    assert (rows["derivative(3, O.theta)"] == 0.0).all()


@pytest.mark.parametrize("wrong", ["", " + 1 kg"], ids=["right", "one wrong"])
def test_a_long_chain_of_names_is_read(wrong: str) -> None:
    """Each is looked at once; where one is wrong, what uses it gets no message of its own."""
    links = "".join(f"  q{i}: {i % 7} mm + q{i - 1}{wrong * (i == 1)}\n" for i in range(1, 1500))
    text = SLIDER_CRANK.replace("quantities:\n", f"quantities:\n  q0: stroke\n{links}")
    if wrong:
        with pytest.raises(mk.InvalidFile) as refused:
            mk.loads(text)
        (message,) = refused.value.diagnostics
        assert message.message.startswith("cannot add a length and a mass")
        return
    analysis = mk.loads(text).analyze()
    total = sum(i % 7 for i in range(1, 1500))
    assert np.abs(analysis["q1499"] - analysis["stroke"] - total).max() < 1e-9
