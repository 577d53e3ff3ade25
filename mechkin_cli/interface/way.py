"""What a sweep goes along: the way over which means are taken and that places are values of."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.problem import Problem


class Way(NamedTuple):
    """A quantity, and its values over the rows (rows,), in the file's units as written."""

    name: str
    values: Floats


def way_of(problem: Problem) -> Way | None:
    """Time where the sweep has one, else its first input that moves; None where nothing moves."""
    motion = problem.motion
    if motion.time is not None:
        return Way("time", motion.time.written)
    for driven in motion.inputs:
        if np.ptp(driven.written) > 0.0:
            return Way(driven.name, driven.written)
    return None
