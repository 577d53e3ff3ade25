"""Rows of a sweep: n = floor(|to - from|/|step| + 1e-9) + 1, x_i = from + i*step in decimals."""

from fractions import Fraction

import pytest
from hypothesis import given, strategies as st

import mechkin_cli as mk
from mechkin_cli.building.motion import by_count, by_step
from mechkin_cli.tables.csv import csv_bytes

CRANK = """\
format: 1
links: {crank: {}}
joints: {O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
tables: [{name: t, columns: [O.theta]}]
motion: {inputs: {O.theta: INPUT}}
"""


def cells(motion: str) -> list[str]:
    """The cells of the column that is just the input."""
    (table,) = mk.loads(CRANK.replace("INPUT", motion)).analyze().tables
    return csv_bytes(table).decode().split()[1:]


@pytest.mark.parametrize(
    ("motion", "expected"),
    [
        ("{from: 0, to: 0.3, step: 0.1}", "0 0.1 0.2 0.3"),
        ("{from: 0, to: 1, step: 0.3}", "0 0.3 0.6 0.9"),
        ("{from: 10, to: 0, step: 3}", "10 7 4 1"),
        ("{from: 10, to: 0, step: -3}", "10 7 4 1"),
        ("{from: 0, to: 10, step: -4}", "0 4 8"),
        ("{from: 5, to: 5, step: 1}", "5"),
        ("{from: 5, to: 5, step: 0}", "5"),
        ("{from: 0, to: 1, step: 7}", "0"),
        ("{from: -0.2, to: 0.2, count: 5}", "-0.2 -0.1 0 0.1 0.2"),
        ("{from: 0, to: 1, count: 4}", "0 0.3333333333333333 0.6666666666666666 1"),
        ("{from: 7, to: 9, count: 1}", "7"),
        ("{values: [1e-3, 150 deg, 1 rad, -0.0]}", "0.001 150 57.29577951308232 0"),
        ("{at: 192}", "192"),
    ],
)
def test_values_are_printed_as_meant(motion: str, expected: str) -> None:
    assert cells(motion) == expected.split()


SLIDE = (
    CRANK.replace("type: R", "type: P")
    .replace("O.theta", "O.s")
    .replace("columns: [O.s]", "columns: [O.s_dot, O.s_ddot]")
)


@pytest.mark.parametrize(
    ("rate", "acceleration", "expected"),
    [
        ("0.1", "-0.7", "0.1,-0.7"),
        ("1.5 in/s", "3 ft/s^2", "1.5,36"),
        ("1 m/s", "0.5 ft/s/s", "39.37007874015748,6"),
    ],
)
def test_constant_rates_are_printed_as_written(rate: str, acceleration: str, expected: str) -> None:
    motion = f"{{from: 0, to: 9, count: 3, rate: {rate}, acceleration: {acceleration}}}"
    text = SLIDE.replace("format: 1\n", "format: 1\nunits: {length: in}\n")
    (table,) = mk.loads(text.replace("INPUT", motion)).analyze().tables
    assert csv_bytes(table).decode().split()[1:] == [expected] * 3


def test_degrees_come_back_from_radians_as_written() -> None:
    assert cells("{from: 150, to: 202, step: 2}") == [str(x) for x in range(150, 203, 2)]


@pytest.mark.parametrize(("step", "rows"), [("0.1", 901), ("0.01", 9001), ("7", 13)])
def test_a_step_that_divides_the_range_reaches_its_end(step: str, rows: int) -> None:
    found = cells(f"{{from: 0, to: 90, step: {step}}}")
    assert len(found) == rows
    assert found[-1] == ("84" if step == "7" else "90")


@given(st.integers(-(10**6), 10**6), st.integers(1, 10**4), st.integers(0, 6), st.integers(1, 50))
def test_steps_of_decimals_are_rounded_once(start: int, step: int, digits: int, count: int) -> None:
    power = 10**digits
    expected = [float(Fraction(start + i * step, power)) for i in range(count)]
    assert by_step(start / power, step / power, count).tolist() == expected


@given(st.integers(-(10**6), 10**6), st.integers(-(10**6), 10**6), st.integers(2, 50))
def test_counted_values_are_rounded_once(start: int, end: int, count: int) -> None:
    first, last = Fraction(start, 1000), Fraction(end, 1000)
    expected = [float(first + i * (last - first) / (count - 1)) for i in range(count)]
    assert by_count(start / 1000, end / 1000, count).tolist() == expected


@pytest.mark.parametrize("value", [0.1 + 0.2, 1e300, 5e-324, -1.7976931348623157e308])
def test_numbers_with_many_digits_are_added_as_doubles(value: float) -> None:
    assert by_step(value, 1e-3 * abs(value), 2).tolist() == [value, value + 1e-3 * abs(value)]
    assert by_count(value, 0.0, 3).tolist()[::2] == [value, 0.0]
