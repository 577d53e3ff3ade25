"""Numbers of a column as text with one number of decimals, for tables that people read.

Declared decimals hold as they are. Undeclared ones give six significant digits to the column's
largest value, less the zeros that would end every number; a column whose largest value is below
1e-6 or from 1e9 on is written with exponents. Every text is the exact binary value rounded once,
ties to even, so it is the same on every machine; zero has no sign.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.tables.native_columns import number_column

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

SIGNIFICANT_DIGITS = 6
PLAIN_EXPONENTS = range(-6, 9)


class DecimalColumn(NamedTuple):
    """A column with the layout of its numbers, in the kernel's order; `trimmed` leaves out the
    zeros that end every one of them."""

    values: Floats
    scientific: bool
    decimals: int
    trimmed: bool = False


def decimal_column(values: Floats, decimals: int | None = None) -> DecimalColumn:
    """The layout of an array of shape (rows,); `decimals` as declared, None to choose them."""
    values = number_column(values)
    if decimals is not None:
        return DecimalColumn(values, False, decimals)
    largest = np.abs(values).max(initial=0.0, where=np.isfinite(values))
    exponent = _decimal_exponent(float(largest))
    if exponent not in PLAIN_EXPONENTS:
        return DecimalColumn(values, True, SIGNIFICANT_DIGITS - 1)
    return DecimalColumn(values, False, max(0, SIGNIFICANT_DIGITS - 1 - exponent), True)


def column_texts(values: Floats, decimals: int | None = None) -> list[str]:
    """One text per value of an array of shape (rows,); a value that is not finite has none."""
    from mechkin_cli.kernel import _kernel

    texts: list[str] = _kernel.decimal_texts(decimal_column(values, decimals))
    return texts


def _decimal_exponent(magnitude: float) -> int:
    """The exponent of ten in front of which the value, rounded, has one digit."""
    return int(f"{magnitude:.{SIGNIFICANT_DIGITS - 1}e}".partition("e")[2])
