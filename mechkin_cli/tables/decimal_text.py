"""Numbers of a column as text with one number of decimals, for tables that people read.

Declared decimals hold as they are. Undeclared ones give six significant digits to the column's
largest value, less the zeros that would end every number; a column whose largest value is below
1e-6 or from 1e9 on is written with exponents. Every text is the exact binary value rounded once,
ties to even, so it is the same on every machine; zero has no sign.
"""

from __future__ import annotations

import numpy as np

from mechkin_cli.tables.source import FloatArray

SIGNIFICANT_DIGITS = 6
PLAIN_EXPONENTS = range(-6, 9)


def column_texts(values: FloatArray, decimals: int | None = None) -> list[str]:
    """One text per value of an array of shape (rows,); a value that is not finite has none."""
    if decimals is not None:
        return _fixed(values, decimals)
    magnitudes = np.abs(values[np.isfinite(values)])
    exponent = _decimal_exponent(float(magnitudes.max(initial=0.0)))
    if exponent not in PLAIN_EXPONENTS:
        return [_scientific(value) for value in values.tolist()]
    decimals = max(0, SIGNIFICANT_DIGITS - 1 - exponent)
    return _without_common_zeros(_fixed(values, decimals))


def _fixed(values: FloatArray, decimals: int) -> list[str]:
    from mechkin_cli.kernel import _kernel

    texts: list[str] = _kernel.fixed_texts(np.ascontiguousarray(values, np.float64), decimals)
    return texts


def _scientific(value: float) -> str:
    if value == 0.0:
        return "0"
    return f"{value:.{SIGNIFICANT_DIGITS - 1}e}" if np.isfinite(value) else ""


def _decimal_exponent(magnitude: float) -> int:
    """The exponent of ten in front of which the value, rounded, has one digit."""
    return int(f"{magnitude:.{SIGNIFICANT_DIGITS - 1}e}".partition("e")[2])


def _without_common_zeros(texts: list[str]) -> list[str]:
    """The texts, all of one number of decimals, without the zeros that end every one of them."""
    fractions = [text.partition(".")[2] for text in texts if text]
    decimals = max(map(len, fractions), default=0)
    kept = max((len(fraction.rstrip("0")) for fraction in fractions), default=0)
    if kept == decimals:
        return texts
    dropped = decimals - kept if kept else decimals + 1  # with the point
    return [text[: len(text) - dropped] if text else "" for text in texts]
