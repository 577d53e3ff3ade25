"""Double-double numbers as the kernel takes them: high and low parts beside each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.tape.double_doubles import DoubleDoubles, exactly

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def as_number(parts: Floats) -> DoubleDoubles:
    """(numbers, 2, rows) as double-doubles (numbers, rows)."""
    return DoubleDoubles(parts[:, 0], parts[:, 1])


def as_parts(numbers: Any) -> Floats:
    """Double-doubles (numbers, rows) as (numbers, 2, rows)."""
    given = exactly(numbers)
    return np.stack([given.high, given.low], axis=1)
