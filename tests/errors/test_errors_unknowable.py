"""Expressions of which double-double knows nothing are not called right."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

TEXT = """
format: 1
units: {length: mm, angle: deg}
links: {slide: {}}
joints: {A: {type: P, links: [ground, slide], point: [0, 0, 0], axis: [1, 0, 0]}}
motion: {inputs: {A.s: {values: [42.7, 0.19]}}}
tables: [{name: t, columns: [{label: k, value: "EXPRESSION"}]}]
"""


def errors(expression: str) -> mk.Analysis:
    return mk.loads(TEXT.replace("EXPRESSION", expression)).analyze()


@pytest.mark.parametrize(
    "expression",
    [
        "(A.s + 1e36 mm) - 1e36 mm",
        "1e60 mm + A.s - 1e60 mm",
        "A.s*1e-300*1e-20*1e300*1e20",
        "sqrt((A.s*1e-200)^2)*1e200",
        "A.s*1e-200*1e-150*1e200*1e150",
    ],
)
def test_what_double_double_cannot_know_has_no_digits(expression: str) -> None:
    """Each is A.s or zero on paper, and another number in doubles and in double-double."""
    found = errors(expression).errors
    (column,) = found.columns
    assert np.isnan(column.error).all()
    assert found.digits is None
    assert column.lost == 2


@pytest.mark.parametrize(
    ("expression", "digits"),
    [
        ("(A.s + 1e3 mm) - 1e3 mm", 14),
        ("A.s*1e-100*1e100", 15),
        ("sqrt((A.s*1e-20)^2)*1e20", 15),
        ("A.s - A.s", 16),
        ("(A.s + 1e20 mm) - 1e20 mm", 0),
    ],
)
def test_what_it_knows_has_the_digits_that_doubles_have(expression: str, digits: int) -> None:
    (column,) = errors(expression).errors.columns
    assert not column.is_bound.any()
    assert column.digits.min() >= min(digits, 14)
    assert digits > 0 or column.digits.max() == 0
