"""Derivatives of expressions against Taylor series at 40 digits, and where they do not exist."""

import mpmath as mp
import numpy as np
import pytest

from mechkin_cli.expressions.differentiation import RULES, Jet, derivatives
from mechkin_cli.expressions.expression import parse
from mechkin_cli.expressions.functions import FUNCTIONS

MOMENTS = (0.0, 0.3, 1.1)
PATHS = {
    "x": (0.4, 0.3, -0.7, 0.5),
    "y": (1.7, -0.2, 0.3, -0.4),
    "z": (0.1, 0.2, 0.1, -0.2),
    "c": (1.25, 0.0, 0.0, 0.0),
}
"""Coefficients of polynomials in t; the angles stay inside every function's domain."""


def polynomial(name: str, t: mp.mpf) -> mp.mpf:
    c0, c1, c2, c3 = PATHS[name]
    return c0 + t * (c1 + t * (c2 + t * c3))


def moving() -> dict[str, Jet]:
    """Value and derivatives of the names at all moments."""
    jets = {}
    for name in PATHS:
        rows = [mp.taylor(lambda t, name=name: polynomial(name, t), t, 3) for t in MOMENTS]
        jets[name] = np.array(
            [[float(c * mp.factorial(k)) for k, c in enumerate(r)] for r in rows]
        ).T
    return jets


def inner(a: np.ndarray, b: np.ndarray) -> mp.mpf:
    return sum(p * q for p, q in zip(a, b, strict=True))


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.array([a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)])


WORDS = {name: getattr(mp, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2")}
WORDS |= {
    "sqrt": mp.sqrt,
    "exp": mp.exp,
    "log": mp.log,
    "pow": mp.power,
    "abs": abs,
    "sign": mp.sign,
}
WORDS |= {
    name: getattr(mp, name)
    for name in ("sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "floor", "ceil")
}
WORDS |= {
    "round": mp.nint,
    "mod": lambda a, b: a - b * mp.floor(a / b),
    "clip": lambda x, low, high: min(max(x, low), high),
    "hypot": lambda *sides: mp.sqrt(sum(side * side for side in sides)),
    "choice": lambda truth, a, b: a if truth else b,
    "unit_vector": lambda a: a / mp.sqrt(inner(a, a)),
    "angle_between": lambda a, b: mp.acos(
        inner(a, b) / mp.sqrt(inner(a, a)) / mp.sqrt(inner(b, b))
    ),
    "min": min,
    "max": max,
    "wrap": lambda a: a - 2 * mp.pi * mp.nint(a / (2 * mp.pi)),
}
WORDS |= {"dot": inner, "cross": cross, "det": lambda a, b, c: inner(a, cross(b, c))}
WORDS |= {"norm": lambda a: mp.sqrt(inner(a, a)), "array": np.array}

SAMPLES = [
    *("x + y - 2", "-x*y", "x/y", "x*y*z/(x + c)", "x^2", "y^3", "(x - 1)^4", "x^0", "y^-2"),
    *("pow(y, 1.5)", "y^x", "2^x", "c^c*x", "sin(x)", "cos(2*x*y)", "tan(x)", "asin(x)"),
    *("acos(x*x)", "atan(y)", "atan2(x, y)", "atan2(-y, x - 1)", "atan2(c, c)", "sqrt(y)"),
    *("sqrt(c - c) + x", "exp(x)", "log(y)", "abs(x - y)", "abs(c - c)*x", "min(x, y, 3)"),
    *("max(x, y, -3)", "max(y, y)", "wrap(5*y)", "norm([x, y, z])", "dot([x, y, 1], [z, 2, x])"),
    *(
        "det([x, y, 1], [z, 2, x], [1, x*y, y])",
        "norm(cross([x, y, 1], 2*[z, 2, x]/y - [1, 2, x]))",
    ),
    *("2*asin(sin(x)/2)*exp(-y)/sqrt(1 + z^2)", "sign(x - y)*z"),
    *("sinh(x)", "sinh(y*y)", "cosh(x)", "tanh(x)", "tanh(2*y)", "asinh(z)", "asinh(-3*y)"),
    *(
        "acosh(y)",
        "atanh(z)",
        "atanh(x/2)",
        "hypot(x, y, 2)",
        "clip(x, y, 3)",
        "clip(y, -2, x + 5)",
    ),
    *("floor(3*y)*x", "ceil(3*y)*x", "round(3*y)*x", "mod(5*y, 2)", "mod(y, x)"),
    *("if(x < y, x^2, y)", "if(x > y or y >= 9, x^2, y)", "if(not x <= y, x^2, z)*y"),
    *("if(x == y, x, z^2)", "if(x != y and z < 5, z^3, x)", "angle_between([x, y, 1], [z, 2, x])"),
    "dot(unit_vector([x, y, z]), [1, x, 2])",
]


@pytest.mark.parametrize("text", SAMPLES)
def test_derivatives_are_those_of_a_taylor_series(text: str) -> None:
    found = np.broadcast_to(derivatives(parse(text), moving()), (4, len(MOMENTS)))
    source = (
        text.replace("^", "**").replace("if(", "choice(").replace("[", "array([").replace("]", "])")
    )
    with mp.workdps(40):

        def along(t: mp.mpf) -> mp.mpf:
            names = {name: polynomial(name, t) for name in PATHS}
            return mp.mpf(eval(source, {"__builtins__": {}}, {**WORDS, **names}))

        for row, moment in enumerate(MOMENTS):
            series = mp.taylor(along, moment, 3)
            expected = [float(c * mp.factorial(k)) for k, c in enumerate(series)]
            np.testing.assert_allclose(found[:, row], expected, rtol=2e-13, atol=2e-13)


@pytest.mark.parametrize(
    ("text", "order"), [(".x", "x"), (".y", "y*2"), (".z", "z")], ids=["x", "y", "z"]
)
def test_a_component_moves_as_what_it_was_made_of(text: str, order: str) -> None:
    names = moving()
    component = derivatives(parse(f"(-[-x, -y*2, -z]){text}"), names)
    np.testing.assert_array_equal(component, derivatives(parse(order), names))


def test_every_operation_and_function_has_a_rule_and_is_tried() -> None:
    signs = {"+", "-", "*", "/", "^", "negate", "[]", ".x", ".y", ".z"}
    truths = {"<", "<=", ">", ">=", "==", "!=", "and", "or", "not"}
    assert set(RULES) == signs | truths | set(FUNCTIONS)
    assert all(
        any(f" {sign} " in text or f"{sign} " in text for text in SAMPLES) for sign in truths
    )
    assert all(any(f"{name}(" in text for text in SAMPLES) for name in FUNCTIONS)


@pytest.mark.parametrize(
    "text",
    [
        "abs(x)",
        "sign(x)",
        "sqrt(x)",
        "log(x)",
        "1/x",
        "min(x, 2*x)",
        "max(x, 0)",
        "asin(1 + x)",
        "if(x > 0, x, 2*x)",
        "floor(1 + x)",
        "ceil(x)",
        "round(x + 0.5)",
        "mod(x, 1)",
        "clip(x, 0, 1)",
        "hypot(x, 2*x)",
        "acosh(1 + x)",
        "atanh(1 + x)",
        "x^0.5",
    ],
)
def test_a_rate_that_does_not_exist_is_not_finite(text: str) -> None:
    x = np.array([[0.0], [1.0], [0.0], [0.0]])
    assert not np.isfinite(derivatives(parse(text), {"x": x})[1]).any()
