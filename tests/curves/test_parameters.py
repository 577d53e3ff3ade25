"""Numbers of curves and functions that are parameters: what a variant, a model with another value
and the slopes tell is what a file with that value tells."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk

HEAD = "format: 1\nplane: xy\nunits: {length: m, angle: rad}\nlinks: {one: {}, other: {}}\n"
ON_CURVE = (
    HEAD
    + """parameters: {a: 0.1 m, b: 0 m, n: 2}
joints:
  A: {type: R, links: [ground, other], point: [.3, 0]}
  B: {type: R, links: [ground, one], point: [0, 0]}
  G: {type: Ps, links: [one, other], point: POINT, curve: CURVE}
motion: {inputs: {A.theta: {from: -.02, to: .02, count: 3, rate: 2 rad/s}}}
"""
)
CURVES = {
    "formula": (
        '["0.3 m + a*cos(0.5 rad)", "0.07 m*sin(0.5 rad)"]',
        '{at: ["0.3 m + a*cos(u)", "0.07 m*sin(u) + b*sin(2*u)"], from: 0 deg, to: 90 deg}',
    ),
    "power": (
        '["0.3 m + a*0.5", "0.07 m*0.5^n"]',
        '{at: ["0.3 m + a*u", "0.07 m*u^n + b*u"], from: 0.1, to: 1}',
    ),
    "points": (
        "[.4, .02]",
        "{points: [[0.3 m + a, -.08 m + b], [.4, .02], [.35, .08], [.3, .11]]}",
    ),
    "arc": ("[0.3 m + a, .02]", "{arc: [[0.3 m + a, -.08], [0.3 m + a, .02 m], [.3 m + b, .1]]}"),
}
AS_FUNCTION = (
    HEAD
    + """parameters: {a: 0.1 rad, b: 0 rad, n: 2}
joints:
  A: {type: R, links: [ground, other], point: [.3, 0]}
  B: {type: R, links: [ground, one], point: [0, 0]}
couplings:
  K: {type: function, of: A.theta, gives: B.theta, value: "VALUE"}
motion: {inputs: {A.theta: {from: 0, to: .2, count: 3, rate: 2 rad/s}}}
"""
)
FUNCTIONS = ("a*sin(theta) + b*(theta/(1 rad))^3", "a*(theta/(1 rad))^n + b*sin(theta)")
FILES = {
    **{
        word: (ON_CURVE.replace("POINT", point).replace("CURVE", curve), ("B.theta", "G.u", "G.s"))
        for word, (point, curve) in CURVES.items()
    },
    **{
        text: (AS_FUNCTION.replace("VALUE", text), ("B.theta", "B.theta_dot")) for text in FUNCTIONS
    },
}
VALUES: dict[str, tuple[Any, ...]] = {"a": (0.1, 0.11), "b": (0.0, 0.003), "n": (2.0, 3.0, 2.5)}


@pytest.mark.parametrize("name", VALUES)
@pytest.mark.parametrize("word", FILES)
def test_other_values_are_those_of_another_file(word: str, name: str) -> None:
    """Also of a parameter that is zero in the file, or an exponent."""
    text, quantities = FILES[word]
    model = mk.loads(text)
    varied = model.vary({name: VALUES[name]}, quantities)
    for number, value in enumerate(VALUES[name]):
        fresh = mk.loads(text, parameters={name: value}).analyze()
        assert set(fresh["row.status"]) == {"ok"}
        again = model.with_parameters({name: value}).analyze()
        for quantity in quantities:
            known = fresh[quantity]
            np.testing.assert_allclose(varied[quantity][number], known, rtol=1e-13, atol=1e-13)
            np.testing.assert_allclose(again[quantity], known, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("word", FILES)
def test_slopes_are_differences_of_other_files(word: str) -> None:
    text, _ = FILES[word]
    names = [name for name in ("a", "b") if name in text.partition("joints")[2]]
    slopes = mk.loads(text).sensitivities(["B.theta"], names)
    for name in names:
        step = 1e-5
        low, high = (
            mk.loads(text, parameters={name: VALUES[name][0] + sign * step}).analyze()["B.theta"]
            for sign in (-1.0, 1.0)
        )
        known = (np.asarray(high) - np.asarray(low)) / (2.0 * step)
        np.testing.assert_allclose(slopes["B.theta", name], known, rtol=1e-6, atol=1e-6)


def test_a_power_that_is_no_whole_number_has_its_slopes_at_zero() -> None:
    """B = x^2.5 has the rates 2.5 x^1.5 x. and so on, all zero at x = 0."""
    text = AS_FUNCTION.replace("VALUE", "(theta/(1 rad))^n*(1 rad)").replace("n: 2", "n: 2.5")
    result = mk.loads(text).analyze()
    x, w = np.asarray(result["A.theta"]), 2.0
    np.testing.assert_allclose(result["B.theta"], x**2.5, atol=1e-15)
    np.testing.assert_allclose(result["B.theta_dot"], 2.5 * x**1.5 * w, atol=1e-14)
    np.testing.assert_allclose(result["B.theta_ddot"], 3.75 * x**0.5 * w * w, atol=1e-14)


ON_LINE = (
    HEAD.replace(", other: {}", "")
    + """parameters: {e: 0.5}
joints:
  B: {type: P, links: [ground, one], point: [0, 0], axis: [1, 0]}
  G: {type: Ps, links: [one, ground], point: [0, 0], curve: {line: [[-1, 0], ["1 m*e", 0]]}}
motion: {inputs: {B.s: {from: 0, to: .4, count: 3}}}
"""
)
ON_CIRCLE = (
    HEAD
    + """parameters: {e: 0.5}
joints:
  B: {type: R, links: [ground, one], point: [0, 0]}
  S: {type: P, links: [one, other], point: [1, 0], axis: [1, 0]}
  G: {type: Ps, links: [other, ground], point: [1, 0], curve: CURVE}
motion: {inputs: {B.theta: {from: 0, to: .4, count: 3}}}
"""
)
ENDED = {
    "line": ON_LINE,
    "arc": ON_CIRCLE.replace(
        "CURVE",
        '{arc: [[1, 0], ["1 m*cos(e*0.5 rad)", "1 m*sin(e*0.5 rad)"], '
        '["1 m*cos(e*1 rad)", "1 m*sin(e*1 rad)"]]}',
    ),
    "formula": ON_CIRCLE.replace(
        "CURVE", '{at: ["1 m*cos(u)", "1 m*sin(u)"], from: 0 rad, to: "e*1 rad"}'
    ),
}


@pytest.mark.parametrize("word", ENDED)
def test_the_ends_of_a_curve_move_with_a_parameter(word: str) -> None:
    """It goes on to e, in m or rad: rows at 0, 0.2 and 0.4 beyond it have no place on it."""
    model = mk.loads(ENDED[word])
    ends = (0.5, 0.3, 0.1)
    inside = [[at < end for at in (0.0, 0.2, 0.4)] for end in ends]
    varied = model.vary({"e": ends}).status
    for number, end in enumerate(ends):
        again = model.with_parameters({"e": end}).analyze()["row.status"]
        known = ["ok" if is_inside else "beyond-limit" for is_inside in inside[number]]
        assert list(varied[number]) == known
        assert list(again) == known


TORUS = """
format: 1
units: {length: m, angle: rad}
parameters: {ra: 0.1 m, tu: 0.05 m}
links: {arm: {}, pin: {}}
joints:
  A: {type: P, links: [ground, arm], point: [0, 0, 0], axis: [1, 0, 0]}
  B: {type: P, links: [arm, pin], point: [0, 0, 0], axis: [0, 0, 1]}
  G:
    type: Sp
    links: [pin, ground]
    point: [0.13, 0, 0.04]
    surface: {torus: [0, 0, 0], radius: ra, tube: tu}
motion: {inputs: {A.s: {from: 0, to: 0.005, count: 2}}}
"""
TURN = (
    HEAD
    + """parameters: {p: 2 rad, h: 0 rad}
joints:
  A: {type: R, links: [ground, other], point: [.3, 0]}
  B: {type: R, links: [ground, one], point: [0, 0]}
couplings:
  K:
    type: function
    of: A.theta
    gives: B.theta
    law:
      law: sequence
      segments:
        - {for: p, to: 0.5 rad, law: cycloidal}
        - {for: 2*pi*(1 rad) - 2 rad, to: h, law: cycloidal}
motion: {inputs: {A.theta: {from: 0, to: .2, count: 3}}}
"""
)
REFUSED = {
    "a thick tube": (TORUS, {"tu": 0.12}, "the tube of a torus is thinner"),
    "a small circle": (TORUS, {"ra": 0.04}, "the tube of a torus is thinner"),
    "an arc that is straight": (
        ON_CIRCLE.replace("CURVE", "{arc: [[1, 0], [1 m + 0.1 m*(e - 1), .2], [1, .5]]}"),
        {"e": 1.0},
        "lie on a line",
    ),
    "more than a turn": (TURN, {"p": 2.5}, "span more than a turn"),
    "a turn that does not come back": (TURN, {"h": 0.2}, "does not end where it began"),
}


@pytest.mark.parametrize("word", REFUSED)
def test_a_variant_is_refused_as_its_file_is(word: str) -> None:
    text, values, said = REFUSED[word]
    model = mk.loads(text)
    assert set(model.analyze()["row.status"]) == {"ok"}
    with pytest.raises(mk.InvalidFile, match=said):
        mk.loads(text, parameters=values)
    with pytest.raises(mk.InvalidFile, match=said):
        model.with_parameters(values).analyze()
    assert said in str(model.vary({name: [value] for name, value in values.items()}).errors[0])
