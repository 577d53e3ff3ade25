"""Vector equations in any numbers that numpy can hold, rows of a batch at once."""

from __future__ import annotations

from typing import Any

import numpy as np
from benchmark.matrices import Vector

from mechkin_cli.tape.double_double import eliminate


def solve_columns(columns: list[Vector], right: Vector, dtype: Any) -> Vector:
    """x with x0 columns[0] + x1 columns[1] + ... = right; entries are numbers or arrays (rows)."""
    entries = [[np.atleast_1d(x) for x in column] for column in columns]
    matrix = np.array(entries, dtype=dtype).transpose(2, 1, 0)
    found = eliminate(matrix, np.array([np.atleast_1d(x) for x in right], dtype=dtype).T)
    return list(found.T) if np.ndim(right[0]) else list(found[0])
