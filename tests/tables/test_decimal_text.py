"""Decimals of a column, declared or chosen."""

import numpy as np
import pytest

from mechkin_cli.tables.columns import column_texts

NAN, INFINITY = float("nan"), float("inf")


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [
        (1.0, 0, "1"),
        (2.5, 0, "2"),
        (-0.0, 2, "0.00"),
        (-0.0004, 3, "0.000"),
        (-0.0005, 3, "-0.001"),
        (-103.8824, 3, "-103.882"),
        (1e22, 1, "10000000000000000000000.0"),
        (-10.0, 0, "-10"),
        (NAN, 2, ""),
        (-INFINITY, 2, ""),
    ],
)
def test_declared(value, decimals, text):
    assert column_texts(np.array([value]), decimals) == [text]


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ([150, 152, 154], ["150", "152", "154"]),
        ([150, 150.5, 151], ["150.0", "150.5", "151.0"]),
        ([123456.789, 1], ["123457", "1"]),
        ([-1.23456789, 0.1], ["-1.23457", "0.10000"]),
        ([0.5, NAN], ["0.5", ""]),
        ([0.0, -0.0], ["0", "0"]),
        ([100.0], ["100"]),
        ([999999.9], ["1000000"]),
        ([2.5e-6], ["0.0000025"]),
        ([2.5e-7, 0.0], ["2.50000e-07", "0"]),
        ([-1.5e9, 20.0], ["-1.50000e+09", "2.00000e+01"]),
        ([NAN, NAN], ["", ""]),
        ([], []),
    ],
)
def test_chosen_for_six_significant_digits_of_the_largest(values, texts):
    assert column_texts(np.array(values, dtype=float)) == texts
