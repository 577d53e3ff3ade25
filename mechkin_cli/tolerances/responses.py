"""Responses: their steps, moments and ends."""

from __future__ import annotations

from typing import Final

RESPONSE_TOLERANCE: Final = 1e-10
"""Relative error of a step of a response where its file says none: seconds of motion then keep nine
digits, at twice the work of 1e-7."""

RESPONSE_TOLERANCES: Final = (1e-14, 1e-2)
"""Least and largest tolerance of a response: below, rounding of the accelerations decides; above,
error estimates mean nothing."""

MOST_RESPONSE_STEPS: Final = 1_000_000
"""Attempted steps of one response: minutes of work for one mechanism, and far more than any of the
kept ones needs (8 to 600)."""

DENSE_ROWS: Final = 10
"""Rows within one step of a response from which on they are interpolated instead of stepped to:
interpolation costs 18 to 50 times in energy, so it is for rows that are much denser than steps."""

SAME_MOMENT: Final = 1e-15
"""A stop so near to the last row, in parts of its moment, ends the response at that row: a few
roundings of the time, which would print as two rows of one moment."""

ENERGY_ROUNDING: Final = 2.0**-48
"""Parts of the largest potential energy below which nothing is missing of a response's energies: 16
roundings, as heights are sums of some. A pendulum that swings by 1e-6 deg moves 1e-16 of it."""

# --- why one ends early --------------------------------------------------------------------------

RUNAWAY: Final = 1e6
"""Accelerations in parts of the rates over the duration from which on rates run away: steps that
the tolerance refuses end at 1e8 to 1e12 of them."""

LOST_INERTIA: Final = 1e-3
"""Parts of the least inertia at the start below which rates that run away do so for want of it; it
is 1e-8 to 1e-10 where such steps end."""

KINK_ROUNDING: Final = 1e-12
"""What a load takes the sign of, in SI, is rounding if it never was above: loops are closed to
1e-14 of the size."""

MANY_KINKS: Final = 0.2
"""Parts of all steps that end at one kink from which on a response is said to run out of steps by
it."""
