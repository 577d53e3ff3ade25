"""What reactions may be besides those of least norm: others in equilibrium, and those that are off
by rounding.

Where constraints are redundant, a cell is unique if it changes no more with the former than with
the latter (tables/uniqueness.py).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism.quantities import REACTION_LEVEL
from mechkin_cli.units import FORCE

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep.result import Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.quantities import Wanted

SHIFTS = (1, 2)
"""Parts of the null space by which other reactions in equilibrium differ, where constraints are
redundant. Two: one alone may leave a cell unchanged by chance."""

DISTURBANCES = ((1.0, 0.829, -0.617), (-0.731, 1.0, 0.517))
"""Parts of a rounding by which components of reactions are off at once: two, of which one alone may
leave an expression unchanged by chance."""


def told_anew(result: Result, name: str, count: int) -> tuple[Result, ...]:
    """The same rows with other reactions, told apart by the numbers in an attribute."""
    found = []
    for number in range(count):
        other = object.__new__(type(result))
        other.__dict__.update(result.__dict__, alternatives=(), disturbed=(), **{name: number})
        found.append(other)
    return tuple(found)


def reaction_rounding(result: Result) -> float:
    """Rounding of reactions in a run: of forces in N, of moments in N by the length unit."""
    level = result.evaluated([REACTION_LEVEL])[REACTION_LEVEL.name][0]
    largest = float(np.max(level[np.isfinite(level)], initial=0.0))
    return tolerances.REACTION_ROUNDING * largest


def disturbed(columns: Floats, wanted: Wanted, off: float, length: float, number: int) -> Floats:
    """A reaction (3, rows) whose components are off by rounding; `length` unit in m."""
    off = off if wanted.dimension == FORCE else off * length
    found: Floats = columns + off * np.array(DISTURBANCES[number])[:, None]
    return found
