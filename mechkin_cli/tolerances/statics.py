"""Limits of forces about a place: their derivatives and where they balance."""

from __future__ import annotations

from typing import Final

FORCE_STEPS: Final = (2.0**-8, 2.0**-13, 2.0**-18)
"""Steps by which forces are differentiated (rad, parts of the length unit): of a smooth force the
first leaves 1e-18 by its ninth derivative and 4e-14 by rounding; what bends sharply beside the
place, as a spring that is nearly slack, needs the next ones."""

FORCE_DIFFERENCE: Final = 1e-9
"""Difference of orders six and eight, in parts of the largest derivative, above which a shorter
step is tried: that of order eight is then 1e-12 right."""
