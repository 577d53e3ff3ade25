"""Numbers of a column as text with one number of decimals, for tables that people read.

Declared decimals hold as they are. Undeclared ones give six significant digits to the column's
largest value, less the zeros that would end every number; a column whose largest value is below
1e-6 or from 1e9 on is written with exponents. Every text is the exact binary value rounded once,
ties to even, so it is the same on every machine; zero has no sign.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

SIGNIFICANT_DIGITS = 6
PLAIN_EXPONENTS = range(-6, 9)

DecimalColumn = tuple["Floats", bool, int, bool]
"""A column as the kernel takes it: numbers, whether with exponents, decimals, and whether without
the zeros that end every one of them."""


def decimal_column(values: Floats, decimals: int | None = None) -> DecimalColumn:
    """The layout of an array of shape (rows,); `decimals` as declared, None to choose them."""
    values = number_column(values)
    if decimals is not None:
        return values, False, decimals, False
    largest = np.abs(values).max(initial=0.0, where=np.isfinite(values))
    # of the rounded value, which may have one digit more
    exponent = int(f"{float(largest):.{SIGNIFICANT_DIGITS - 1}e}".partition("e")[2])
    if exponent not in PLAIN_EXPONENTS:
        return values, True, SIGNIFICANT_DIGITS - 1, False
    return values, False, max(0, SIGNIFICANT_DIGITS - 1 - exponent), True


def column_texts(values: Floats, decimals: int | None = None) -> list[str]:
    """One text per value of an array of shape (rows,); a value that is not finite has none."""
    texts: list[str] = _kernel.decimal_texts(decimal_column(values, decimals))
    return texts


def number_column(values: Floats) -> Floats:
    """The numbers without gaps in memory, shape (rows,)."""
    return np.ascontiguousarray(values, np.float64)
