"""Fields `from`, `to`, `step` or `count` to the values or moments of the rows.

n = floor(|to - from|/|step| + 1e-9) + 1 rows, x_i = from + i*step.
"""

from __future__ import annotations

from math import floor, isfinite

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.arrays import Floats
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.memory import RowLimit
from mechkin_cli.building.sequences import by_count, by_step
from mechkin_cli.schema.motion import SweptInput, TimeSection
from mechkin_cli.units import Dimension


def spaced(
    fields: Fields,
    path: Path,
    section: SweptInput | TimeSection,
    dimension: Dimension,
    limit: RowLimit,
) -> Floats:
    """The values in the file's units; what is wrong is noted in `fields`, one value stands in."""
    errors = fields.error_count
    first = fields.written((*path, "from"), section.first, dimension)
    last = fields.written((*path, "to"), section.last, dimension)
    if section.count is not None:
        if fields.error_count > errors or limit.is_exceeded(
            fields, (*path, "count"), section.count
        ):
            return np.array([first])
        return by_count(first, last, section.count)
    assert section.step is not None  # the schema wants one of the two
    step = abs(fields.written((*path, "step"), section.step, dimension))
    if fields.error_count > errors:
        return np.array([first])
    if step == 0.0:
        if first != last:
            text = "the step is zero"
            fields.error("zero-step", (*path, "step"), text, "give the distance of rows")
        return np.array([first])
    ratio = abs(last - first) / step + tolerances.LAST_ROW
    if limit.is_exceeded(fields, (*path, "step"), floor(ratio) + 1 if isfinite(ratio) else ratio):
        return np.array([first])
    return by_step(first, step if last >= first else -step, int(ratio) + 1)
