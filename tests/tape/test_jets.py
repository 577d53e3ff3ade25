"""The replay of a tape with derivatives against Taylor coefficients at 40 digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from mechkin_cli.expressions.expression import parse, scalar
from mechkin_cli.expressions.quantity import Quantity
from mechkin_cli.tape.recorder import Recorder, Traced, register
from mechkin_cli.tape.tape import compiled
from mechkin_cli.units.dimension import DIMENSIONLESS
from mechkin_cli.units.units import UnitSystem

CASES: list[tuple[str, Callable[[Any], Any]]] = [
    ("3*x*x - 2*x/(1 + x*x) + 1", lambda x: 3 * x * x - 2 * x / (1 + x * x) + 1),
    (
        "sin(x*1rad)*cos(2rad*x) - tan(x*0.3rad)",
        lambda x: mp.sin(x) * mp.cos(2 * x) - mp.tan(0.3 * x),
    ),
    (
        "(asin(0.3*x) - acos(0.2*x) + atan(2*x))/1rad",
        lambda x: mp.asin(mp.mpf(0.3) * x) - mp.acos(mp.mpf(0.2) * x) + mp.atan(2 * x),
    ),
    ("atan2(sin(x*1rad), 2 + cos(x*3rad))/1rad", lambda x: mp.atan2(mp.sin(x), 2 + mp.cos(3 * x))),
    (
        "exp(-x*x) + log(2 + x) + sqrt(2 + x)",
        lambda x: mp.exp(-x * x) + mp.log(2 + x) + mp.sqrt(2 + x),
    ),
    (
        "x^3 + (x + 2)^0.5 + pow(x + 2, x) + x^0 + x^1 + (x + 3)^-2",
        lambda x: x**3 + mp.sqrt(x + 2) + (x + 2) ** x + 1 + x + (x + 3) ** -2,
    ),
    ("sqrt(2) + exp(1) + 0^2 + x", lambda x: mp.sqrt(2) + mp.e + x),
    (
        "norm([x, 1, 2*x]) + dot([1, x, 3], cross([x, 0, 1], [0, x, 1]))",
        lambda x: mp.sqrt(5 * x * x + 1) - x - x * x + 3 * x * x,
    ),
    ("abs(x)*x", lambda x: x * abs(x)),
    ("sign(x)*x*x", lambda x: mp.sign(x) * x * x),
    ("max(x, x*x) - min(x, 0.5)", lambda x: max(x, x * x) - min(x, mp.mpf(0.5))),
    ("wrap(x*1rad + 7rad)/1rad", lambda x: x + 7 - 2 * mp.pi),
]


def recorded(text: str, x: float) -> Any:
    recorder = Recorder(["x"], [x])
    names = {"x": Quantity(Traced(recorder, 0), DIMENSIONLESS)}  # type: ignore[arg-type]
    units = UnitSystem.from_mapping({})
    value = scalar(parse(text), DIMENSIONLESS, units, lambda name: names[name])
    return compiled(recorder.tape([register(recorder, value)], guarded=False))


@pytest.mark.parametrize(("text", "function"), CASES, ids=[case[0] for case in CASES])
@pytest.mark.parametrize("x", [-0.7, 0.31, 1.3])
def test_derivatives_of_every_operation(
    text: str, function: Callable[[Any], Any], x: float
) -> None:
    tape = recorded(text, x)
    ways = ways_at(text, x)
    value, first, second = tape.jets(np.array([[x]]), ways)[0, 0]
    with mp.workdps(40):
        c0, c1, c2 = mp.taylor(function, mp.mpf(x), 2)
    assert value == pytest.approx(float(c0), rel=1e-14, abs=1e-14)
    assert first == pytest.approx(float(c1), rel=1e-13, abs=1e-13)
    assert second == pytest.approx(float(2 * c2), rel=1e-12, abs=1e-12)


def ways_at(text: str, x: float) -> np.ndarray:
    """The ways of the switches, in the order of the tape."""
    if "abs" in text or "sign" in text:
        return np.array([-1.0 if x < 0 else 1.0])
    if "max" in text:
        return np.array([float(x * x > x), float(x > 0.5)])
    if "wrap" in text:
        return wrap_ways(x)
    return np.zeros(0)


def wrap_ways(x: float) -> np.ndarray:
    from mechkin_cli.session.cells import Formula
    from mechkin_cli.tape.tape import Tape

    recorder = Recorder(["x"], [x])
    names = {"x": Quantity(Traced(recorder, 0), DIMENSIONLESS)}  # type: ignore[arg-type]
    units = UnitSystem.from_mapping({})
    value = scalar(parse("wrap(x*1rad + 7rad)/1rad"), DIMENSIONLESS, units, lambda n: names[n])
    tape: Tape = recorder.tape([register(recorder, value)], guarded=False)
    return Formula(tape, [], lambda _: []).ways(np.array([x]), [])[0]


def test_at_a_kink_the_way_that_is_given_counts() -> None:
    tape = recorded("abs(x)", 0.3)
    assert tape.jets(np.array([[0.0]]), np.array([1.0]))[0, 0].tolist() == [0.0, 1.0, 0.0]
    assert tape.jets(np.array([[0.0]]), np.array([-1.0]))[0, 0].tolist() == [0.0, -1.0, 0.0]


def test_bad_calls_are_refused() -> None:
    tape = recorded("abs(x)", 0.3)
    with pytest.raises(ValueError, match="one way for each switch"):
        tape.jets(np.array([[0.0]]), np.zeros(2))
    with pytest.raises(ValueError, match="one row of numbers"):
        tape.jets(np.zeros((2, 1)), np.zeros(1))
