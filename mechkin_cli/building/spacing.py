"""Fields `from`, `to`, `step` or `count` to the values or moments of the rows.

n = floor(|to - from|/|step| + 1e-9) + 1 rows, x_i = from + i*step.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.arrays import Floats
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.sequences import by_count, by_step
from mechkin_cli.units import Dimension

MOST_ROWS = 10_000_000
"""More rows than this are a slip of the pen: their tables would not fit into memory."""


def spaced(fields: Fields, path: Path, section: Any, dimension: Dimension) -> Floats:
    """The values in the file's units; what is wrong is noted in `fields`, one value stands in."""
    first = fields.written((*path, "from"), section.first, dimension)
    last = fields.written((*path, "to"), section.last, dimension)
    if section.count is not None:
        if _too_many(fields, (*path, "count"), section.count):
            return np.array([first])
        return by_count(first, last, section.count)
    errors = fields.error_count
    step = abs(fields.written((*path, "step"), section.step, dimension))
    if fields.error_count > errors:
        return np.array([first])
    if step == 0.0:
        if first != last:
            text = "the step is zero"
            fields.error("zero-step", (*path, "step"), text, "give the distance of rows")
        return np.array([first])
    ratio = abs(last - first) / step + tolerances.LAST_ROW
    if _too_many(fields, (*path, "step"), ratio + 1.0):
        return np.array([first])
    return by_step(first, step if last >= first else -step, int(ratio) + 1)


def _too_many(fields: Fields, path: Path, count: float) -> bool:
    if count <= MOST_ROWS:
        return False
    fields.error(
        "too-many-rows",
        path,
        "this sweep has more rows than any table can use",
        "take a larger step",
        measured=f"{count:.4g} rows",
        limit=f"{MOST_ROWS} rows",
    )
    return True
