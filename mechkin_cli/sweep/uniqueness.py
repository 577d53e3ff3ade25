"""What reactions may be besides those of least norm: others in equilibrium, and those that are off
by rounding.

Where constraints are redundant, a cell is unique if it changes no more with the former than with
the latter (`tables.unique_cells`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import REACTION_LEVEL
from mechkin_cli.sweep.rows import RunRows
from mechkin_cli.units import FORCE

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.show import Floats


SHIFTS = (1, 2)
"""Parts of the null space by which other reactions in equilibrium differ, where constraints are
redundant. Two: one alone may leave a cell unchanged by chance."""

DISTURBANCES = ((1.0, 0.829, -0.617), (-0.731, 1.0, 0.517))
"""Parts of a rounding by which components of reactions are off at once: two, of which one alone may
leave an expression unchanged by chance."""


def reaction_rounding(result: RunRows) -> Floats:
    """Rounding of reactions in each row (rows,): of forces in N, of moments in N by the length
    unit.

    It goes with the largest reaction of the run. A row without any load has none but those of the
    null space, whose rounding decides what is zero.
    """
    level = _level(result, 0)
    largest = float(np.max(level[np.isfinite(level)], initial=0.0))
    rounding = np.full(level.shape, largest)
    for shift in result.shifts if (level == 0.0).any() else ():
        rounding[level == 0.0] = np.fmax(rounding, _level(result, shift))[level == 0.0]
    return np.asarray(tolerances.REACTION_ROUNDING * rounding, dtype=np.float64)


def _level(result: RunRows, shift: int) -> Floats:
    """The largest reaction of each row (rows,), of those of a `shift`."""
    return np.asarray(result.evaluated([REACTION_LEVEL], shift=shift)[REACTION_LEVEL.name][0])


def disturbed(columns: Floats, wanted: Wanted, off: Floats, length: float, number: int) -> Floats:
    """A reaction (3, rows) whose components are `off` by rounding (rows,); `length` unit in m."""
    off = off if wanted.dimension == FORCE else off * length
    return np.asarray(columns + off * np.array(DISTURBANCES[number])[:, None])
