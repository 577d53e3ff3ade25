"""True errors, and the bound of a row's errors."""

from __future__ import annotations

from typing import Final

# --- true errors ---------------------------------------------------------------------------------

ZERO_BUT_FOR_ROUNDING: Final = 1e-8
"""A column whose numbers in double-double are all below this part of the largest of its cells is
zero: what doubles leave there is 1e-16 of what cancelled, what double-doubles leave 1e-32."""

# --- the bound of a row (analysis.sweep.error_bound) ---------------------------------------------

ERROR_PROBE: Final = 1e-13
"""Relative size of the changes with which a row's sensitivity is measured: a thousand roundings, so
that rounding is a thousandth of what is seen, and small enough that up to a condition of 1e6 a row
moves by less than a tenth of its distance to a dead centre."""

ERROR_PROBES: Final = 3
"""Samples of the sensitivity: the largest of three is a tenth of the true one once in a thousand
times, of two once in a hundred."""

ERROR_FACTOR: Final = 16.0
"""Roundings of a row's constants that count for all the roundings of closing it."""

ERROR_MOVE: Final = 1e-3
"""A row that such changes move farther (rad, length units) has no bound: it is nearer to a dead
centre than the sensitivity at its place tells."""

# --- a response repeated (analysis.errors.marching) ----------------------------------------------

REPEATED_STEP: Final = 1e-22
"""Last Legendre coefficients of a step of a response that is repeated in double-double, in parts of
the way and the rates so far. What such a step leaves is smaller by orders, as the coefficients
behind are (1e-30 of a pendulum), so that also errors that grow by 1e6 stay far below those of
doubles; how large they are is measured by repeating twice."""

ROUGHLY_REPEATED_STEP: Final = 1e-19
"""The same of the second repetition, from which the first one's own error is told: what both differ
by is the error of this one, which is larger."""

SWEPT: Final = 1e-2
"""What the last sweep of such a step may change, in parts of its tolerance: less than what is left
out after the last coefficient."""

MOST_SWEEPS: Final = 60
"""Sweeps of such a step: where a step bears its polynomial, a sweep takes away at least a digit."""

FIRST_REPEATED_STEP: Final = 1.0 / 64.0
"""Length of its first step in parts of the duration; it is cut until it is short enough."""

MOST_REPEATED_STEPS: Final = 2000
"""Steps that are tried, some 10 ms each: motions that need more are longer or stiffer than those
that a table is checked by."""

# --- what a repetition is known to (tables.cell_errors) ------------------------------------------

DOUBTFUL: Final = 0.01
"""What a repeated value may be off by in parts of the error that it tells: errors are read to one
or two digits."""

NO_DOUBT: Final = 1e-18
"""The same in parts of the column's largest: a hundredth of what the nearest double is off by."""

WIDE_ROUNDING: Final = float.fromhex("0x1p-98")
"""What an operation in double-double may be off by in parts of its value: sums, products and roots
2^-103, quotients 2^-102, elementary functions 2^-99."""

WIDE_UNDERFLOW: Final = float.fromhex("0x1p-1068")
"""What a product, quotient or function in double-double may be off by however small it is: a few of
the smallest numbers, 2^-1074, to which its parts are rounded."""
