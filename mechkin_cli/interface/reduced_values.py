"""What is kept of the values of variants: all rows, or what reductions make of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError
from mechkin_cli.reductions import OVER_THE_WAY, Reduction, mean, root_mean_square

Reductions = tuple[Reduction, ...] | Reduction | None
"""Several, one, or none: all rows."""


def need_places(reductions: Mapping[str, Reductions]) -> bool:
    """Whether one of them is taken over the way."""
    own = (each if isinstance(each, tuple) else (each,) for each in reductions.values())
    return any(one in OVER_THE_WAY for several in own for one in several)


def reduced(
    text: str, values: Floats, reduction: Reductions, places: Floats | None = None
) -> Floats:
    """What is kept of (variants, rows) or (variants, rows, components), the reductions last where
    there are several; `places` of the rows (variants, rows), None where nothing moves.

    Raises:
        UsageError: a function of the caller fails, or gives something else.
    """
    if reduction is None:
        return values
    if isinstance(reduction, tuple):
        return np.stack([_by(each, text, values, places) for each in reduction], axis=-1)
    return _by(reduction, text, values, places)


def _by(reduction: Reduction, text: str, values: Floats, places: Floats | None) -> Floats:
    if values.ndim == 3:
        parts = [_by(reduction, text, c, places) for c in np.moveaxis(values, 2, 0)]
        return np.stack(parts, axis=1)
    if reduction is mean or reduction is root_mean_square:
        return reduction(values, places)
    given = values.view()
    given.flags.writeable = False  # the next reduction reads the same
    try:
        found = np.asarray(reduction(given), dtype=np.float64)
    except Exception as error:
        raise UsageError(
            f"the reduction of {text} failed with {type(error).__name__}: "
            f"{str(error)[:LONGEST_NAME]}; it takes (variants, rows) = {values.shape}"
        ) from error
    if found.shape[:1] != values.shape[:1]:
        raise UsageError(
            f"the reduction of {text} gives an array of shape {found.shape}; it takes "
            f"(variants, rows) = {values.shape} and gives one value a variant"
        )
    return found
