"""The course of the inputs: their laws and ties between the rows, as data.

A course is a function of one parameter (the time, the one input that others follow, or the number
of the row where several are swept together), recorded as a tape. It is smooth on each *cell*
between two kinks; `places` are the rows and, between them, the ends of cells that the motion
passes.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.tape.tape import Tape
    from mechkin_cli.units import Dimension


class CellKind(IntEnum):
    """What moves on a cell: nothing or one input, so that it is straight, or several."""

    STRAIGHT = 0
    CURVED = 1


class Parameter(NamedTuple):
    """What the course is a function of: `time`, an input by its name, or `row`."""

    name: str
    dimension: Dimension | None = None


@dataclass(frozen=True, eq=False)
class Course:
    """Inputs as a function of a parameter in the file's units.

    Attributes:
        parameter: what the tape's first input is.
        tape: from the parameter and the constants of a cell to the inputs in SI.
        edges: (cells + 1,) values of the parameter, rising.
        kinds: (cells,) of `CellKind`.
        constants: (cells, tape inputs - 1).
        ways: (cells, switches) which way each choice of the tape goes.
        powers: (cells, 2) order in which the inputs leave the lower and the upper end: 1, or more
            where all of them rest.
        rows: (places,) number of the row, -1 between rows.
        at: (places,) the parameter.
        values: (inputs, places) in SI.
        cells: (places - 1,) the cell between a place and the next; -1 where the motion jumps.
    """

    parameter: Parameter
    tape: Tape
    edges: Floats
    kinds: NDArray[np.int8]
    constants: Floats
    ways: Floats
    powers: NDArray[np.int64]
    rows: NDArray[np.int64]
    at: Floats
    values: Floats
    cells: NDArray[np.int64]
