"""Moments that are not held are those of the text, and the kernel makes the same."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import SpacedMoments

PENDULUM = """format: 1
plane: xy
units: {{length: m, angle: rad, time: {unit}}}
links: {{bob: {{mass: 1, center_of_mass: [0, -1]}}}}
joints: {{O: {{type: R, links: [ground, bob], point: [0, 0]}}}}
responses: {{swing: {{start: {{O.theta: 1}}, time: {{{time}}}}}}}
"""
ROWS = 200_000
TIMES = [
    f"from: 0, to: 10, count: {ROWS}",
    f"from: 0.1, to: 7.3, count: {ROWS + 1}",
    "from: 0, to: 2, step: 0.00001",
    "from: -0.3, to: 1.7, step: 0.0000123",
    "from: sqrt(2), to: 7, step: 0.00001",  # no decimals: added as doubles
    f"from: 1 / 3, to: sqrt(50), count: {ROWS}",
]


def moments_of(time: str, unit: str) -> SpacedMoments:
    text = PENDULUM.format(unit=unit, time=time.replace("1 / 3", f"1 {unit} / 3"))
    for root in ("sqrt(2)", "sqrt(50)"):
        text = text.replace(root, f"{root} * 1 {unit}")
    found = mk.loads(text).problem.responses["swing"].moments
    assert isinstance(found, SpacedMoments)
    return found


@pytest.mark.parametrize("unit", ["s", "ms", "min"])
@pytest.mark.parametrize("time", TIMES)
def test_the_kernel_makes_the_same_moments(time: str, unit: str) -> None:
    found = moments_of(time, unit)
    every = found.values
    assert every.size == found.rows > tolerances.LONG_RUN
    picked = [0, 1, 2, found.rows // 3, found.rows // 2, found.rows - 2, found.rows - 1]
    rows = [*picked, *np.random.default_rng(1).integers(0, found.rows, 500).tolist()]
    for row in rows:
        assert found.steps.at(row) == every[row], row
        part = found.part(slice(row, row + 1))
        assert (part.values[0], part.written[0]) == (every[row], found.written[row])
    assert found.duration == every[-1] - every[0]


def test_they_are_the_doubles_next_to_the_decimals() -> None:
    found = moments_of("from: -0.3, to: 1.7, step: 0.0000123", "s")
    for row in (0, 1, 7, 1000, 99_999, found.rows - 1):
        exact = Fraction(Decimal("-0.3")) + row * Fraction(Decimal("0.0000123"))
        assert found.steps.at(row) == float(exact)


def test_few_moments_are_held() -> None:
    model = mk.loads(PENDULUM.format(unit="s", time="from: 0, to: 10, count: 1000"))
    assert not isinstance(model.problem.responses["swing"].moments, SpacedMoments)


@pytest.mark.parametrize(
    "numbers",
    [
        (0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0),
        (5, float("nan"), 1.0, 0.0, 1.0, 1.0, 1.0),
        (5, 0.0, 1e300, 3.0, 1.0, 1.0, 1.0),
        (5, 0.0, 1.0, -1.0, 1.0, 1.0, 1.0),
        (5, 0.0, 1.0, 1.0, 1.0, 1.0, 0.0),
    ],
)
def test_the_kernel_refuses_what_are_no_moments(numbers: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="moments"):
        _kernel.SpacedTimes(*numbers)  # type: ignore[arg-type]


def test_moments_that_do_not_rise_are_refused() -> None:
    """As those that are held: so many do not fit between two doubles."""
    text = PENDULUM.format(unit="s", time="from: 1e15 s, to: 1e15 s + 1 s, count: 100000")
    with pytest.raises(ValueError, match="rise"):
        for _ in mk.loads(text).stream(run="swing"):
            pass
