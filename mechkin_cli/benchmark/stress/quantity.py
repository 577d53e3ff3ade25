"""What a closed form says of the rows of many mechanisms at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.benchmark.stress.numbers.series import Number

Rows = NDArray[np.float64]
Mask = NDArray[np.bool_]
Kind = Literal["angle", "whole turns", "length"]
"""An angle is compared modulo a turn, unless its whole turns are known, too."""


@dataclass(frozen=True)
class Quantity:
    """A coordinate (mechanisms, rows) in rad or m, with its rates; `other` is its value in the
    nearest other assembly."""

    name: str
    kind: Kind
    value: Number
    other: Number | None = None


@dataclass(frozen=True)
class Truth:
    """Of every row: its coordinates, and whether the branch of the drawing gets there.

    `exists` (mechanisms, rows); where rounding of the written numbers alone could change that,
    the row is not `decided`. `size` (mechanisms, 1) is what lengths are taken by, in m.
    """

    quantities: tuple[Quantity, ...]
    exists: Mask
    decided: Mask
    size: Rows
