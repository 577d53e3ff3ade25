"""Uniqueness of cells: with redundant constraints some reactions are arbitrary, others are not.

A cell is evaluated for the reactions of least norm and for two others that are in equilibrium too;
where it changes it is not unique and becomes nan. So sums of reactions that are unique stay,
though each part is not.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tolerances import UNIQUE_CELL

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def unique_cells(
    values: Floats, others: Sequence[Floats], disturbed: Sequence[Floats] = ()
) -> Floats:
    """The values with nan where another admissible value differs; all of shape (rows,).

    `disturbed` are the values for reactions that are off by their rounding: what they change is
    the rounding of the cell, whatever the size of its column is.
    """
    if not others:
        return values
    # a row without any load is zero whatever the others, which are of no size there
    loaded = values != 0.0
    sizes = [np.abs(v[np.isfinite(v) & loaded]).max(initial=0.0) for v in (values, *others)]
    limit = np.full(values.shape, UNIQUE_CELL * max(sizes))
    settled = values.copy()
    with np.errstate(invalid="ignore"):
        for other in disturbed:
            limit = np.fmax(limit, np.abs(other - values))
        for other in others:
            alike = np.abs(other - values) <= limit
            # infinite at a dead centre, whatever the arbitrary part is
            alike |= np.isinf(values) & (other == values)
            settled[~alike] = np.nan
    return settled
