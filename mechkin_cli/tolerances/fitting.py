"""Where a search for dimensions steps, and what it takes as held or reached."""

from __future__ import annotations

from typing import Final

FIT_STEP: Final = 1e-3
"""Of a parameter's bounds: steps of the four-point differences. Their error is a thirtieth of its
fourth power, 3e-14 of the fifth derivative; rounding leaves 1e-15 divided by it."""

FIT_NARROW_STEP: Final = 1e-6
"""Of a parameter's bounds: the step where the wider ones leave what assembles."""

FIT_ENDED: Final = 1e-14
"""Relative change of cost, of dimensions and of the gradient at which a local search ends: what
rounding leaves of sums of squares."""

FIT_HELD: Final = 1e-6
"""Of a bound's scale: how far a constraint may be exceeded and still be called held. The
constrained search leaves 1e-8; a millionth of a transmission angle is no angle to build."""

FIT_AT_BOUND: Final = 1e-6
"""Of a parameter's bounds: nearer than this to one of them, it is at the bound."""
