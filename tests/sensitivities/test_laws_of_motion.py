"""How a driven angle depends on the parameters of its law, against derivatives at 40 digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import pytest

import mechkin_cli as mk

FILE = """format: 1
parameters: {a: 1.25 rad, d: 2.2 s}
units: {angle: rad}
links: {arm: {}}
joints: {A: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
motion:
  time: {from: 0, to: 2, step: 0.125}
  inputs: {A.theta: LAW}
"""


def powers(u: Any) -> Any:
    return 35 * u**4 - 84 * u**5 + 70 * u**6 - 20 * u**7


def there_and_back(t: Any, a: Any, d: Any) -> Any:
    if t < d / 3:
        return a * powers(3 * t / d)
    back = t - d / 3 - mp.mpf("0.3")
    if back < 0:
        return a
    return a * (1 - powers(min(4 * back / d, mp.mpf(1))))


LAWS: dict[str, Callable[[Any, Any, Any], Any]] = {
    "{law: 3-4-5, from: 0, to: a, duration: d}": lambda t, a, d: (
        a * (10 * (t / d) ** 3 - 15 * (t / d) ** 4 + 6 * (t / d) ** 5)
    ),
    '{law: expression, value: "a*sin(1 rad/s*time)*exp(-time/d)"}': lambda t, a, d: (
        a * mp.sin(t) * mp.exp(-t / d)
    ),
    "{law: sine, amplitude: a, period: d, offset: a/2}": lambda t, a, d: (
        a * mp.sin(2 * mp.pi * t / d) + a / 2
    ),
    "{law: sequence, segments: [{for: d/3, to: a, law: 4-5-6-7}, {for: 0.3 s, law: dwell}, "
    "{for: d/4, to: 0, law: 4-5-6-7}]}": there_and_back,
}


@pytest.mark.parametrize("law", LAWS)
def test_parameters_of_laws(law: str) -> None:
    found = mk.loads(FILE.replace("LAW", law)).sensitivities(["A.theta"])
    with mp.workdps(40):
        a, d = mp.mpf("1.25"), mp.mpf("2.2")
        for k in range(17):
            t = mp.mpf(k) / 8
            by_a = mp.diff(lambda x, t=t: LAWS[law](t, x, d), a)
            by_d = mp.diff(lambda x, t=t: LAWS[law](t, a, x), d)
            assert found["A.theta", "a"][k] == pytest.approx(float(by_a), abs=1e-12)
            assert found["A.theta", "d"][k] == pytest.approx(float(by_d), abs=1e-12)


RISE = """format: 1
parameters: {d: 0.9 s, e: 1 s, a: 2 rad}
units: {angle: rad}
links: {arm: {}}
joints: {A: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
motion:
  time: {from: 0, to: e, count: 11}
  inputs: {A.theta: {law: LAW, from: 0, to: a, start: 0.1 s, duration: d}}
"""
ORDERS_OF_ENDS = {
    "harmonic": 2,
    "cycloidal": 3,
    "modified-sine": 3,
    "3-4-5": 3,
    "4-5-6-7": 4,
}
"""Of each rise the derivative by time that is not zero at its ends, and so jumps there."""


@pytest.mark.parametrize("law", ORDERS_OF_ENDS)
def test_rows_at_the_ends_of_a_rise_are_bent(law: str) -> None:
    """The last row is at the end of the rise at 0.1 s + d, and the second at its begin: what is one
    derivative lower than the one that jumps has a kink there, by whatever moves row or end."""
    jumps, steps = ORDERS_OF_ENDS[law], ["A.theta", "A.theta_dot", "A.theta_ddot"]
    found = mk.loads(RISE.replace("LAW", law)).sensitivities(steps)
    for order, quantity in enumerate(steps):
        is_bent = order >= jumps - 1
        for name, ends in (("d", [10]), ("e", [1, 10]), ("a", [])):
            expected = ["bent" if is_bent and k in ends else "ok" for k in range(11)]
            assert list(found.verdict(quantity, name)) == expected
