"""Whole numbers next to a scalar: a staircase whose steps are those of `rint` and of signs, so that
they are found as these are.
"""

from __future__ import annotations

from math import nan
from typing import Any

import numpy as np

from mechkin_cli.expressions import truths
from mechkin_cli.expressions.quantity import Scalar
from mechkin_cli.expressions.scalar_functions import branch
from mechkin_cli.tape.scalars import Recorded

LARGEST = float(2**51)
"""From here on a double has no room for quarters, and its nearest whole number is not computed."""


def nearest(value: Scalar) -> Scalar:
    """The nearest whole number, of two the even one; nan from 2^51 on."""
    given: Any = value
    is_small = given * given < LARGEST * LARGEST
    if not isinstance(given, Recorded):
        return branch(is_small, np.rint(given), nan)
    whole = given.apply("WHOLE")
    # a recorded nan is a quotient of zeros
    found: Scalar = whole + (whole - whole) / branch(is_small, 1.0, 0.0)
    return found


def below(value: Scalar) -> Scalar:
    """The largest whole number that is not more than the value."""
    whole = nearest(value)
    return whole - truths.less(value, whole)


def above(value: Scalar) -> Scalar:
    """The smallest whole number that is not less than the value."""
    whole = nearest(value)
    return whole + truths.more(value, whole)


def remainder(value: Scalar, period: Scalar) -> Scalar:
    """What is left of the value above a whole number of periods: from 0 up to the period."""
    return value - period * below(value / period)
