"""Lengths (m) in the file's unit, for data of a page."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.units import LENGTH

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.units import UnitSystem


class Lengths:
    """Converts lengths of one file."""

    def __init__(self, units: UnitSystem) -> None:
        self._units = units

    def one(self, value: float) -> float:
        """A length."""
        return float(self._units.from_si(float(value), LENGTH))

    def vector(self, point: Iterable[float]) -> list[float]:
        """A point or shift."""
        return [self.one(value) for value in point]

    def array(self, values: Floats) -> Floats:
        """An array, not the one that was given."""
        found: Floats = np.array(self._units.from_si(np.array(values), LENGTH), dtype=np.float64)
        return found
