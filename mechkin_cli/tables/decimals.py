"""Numbers of a column as text with one number of decimals, for tables that people read."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


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


def _decimal_exponent(magnitude: float) -> int:
    """The exponent of ten in front of which the value, rounded, has one digit."""
    return int(f"{magnitude:.{SIGNIFICANT_DIGITS - 1}e}".partition("e")[2])


def column_texts(values: Floats, decimals: int | None = None) -> list[str]:
    """One text per value of an array of shape (rows,); a value that is not finite has none."""
    from mechkin_cli.kernel import _kernel

    texts: list[str] = _kernel.decimal_texts(decimal_column(values, decimals))
    return texts


def number_column(values: Floats) -> Floats:
    """The numbers without gaps in memory, shape (rows,)."""
    return np.ascontiguousarray(values, np.float64)


SIGNIFICANT_DIGITS = 6


PLAIN_EXPONENTS = range(-6, 9)


class DecimalColumn(NamedTuple):
    """A column with the layout of its numbers, in the kernel's order; `trimmed` leaves out the
    zeros that end every one of them."""

    values: Floats
    scientific: bool
    decimals: int
    trimmed: bool = False
