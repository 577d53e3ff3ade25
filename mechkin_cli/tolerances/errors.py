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
