"""Values with dimensions, always in SI (m, kg, s, rad).

A scalar is a float, or a float64 array of shape (rows,) with one value per row. A vector is three
scalars in one frame, in a plane two. The same operations serve all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.units import DIMENSIONLESS, Dimension

Rows = NDArray[np.float64]
Scalar = float | Rows


@dataclass(frozen=True, slots=True, eq=False)
class Vector:
    """Components along the axes of ground; a vector in a plane has no z."""

    x: Scalar
    y: Scalar
    z: Scalar | None = None

    @property
    def components(self) -> tuple[Scalar, ...]:
        """The components in order."""
        return (self.x, self.y) if self.z is None else (self.x, self.y, self.z)


Value = Scalar | Vector


@dataclass(frozen=True, slots=True, eq=False)
class Quantity:
    """A value in SI and its dimension; of an angle that has turned, `rest` is the same without
    whole turns, known more closely. A `truth` is 1 where something holds, 0 where it does not."""

    value: Value
    dimension: Dimension = DIMENSIONLESS
    rest: Scalar | None = None
    truth: bool = False

    @property
    def phrase(self) -> str:
        """What the quantity is, in words: `a length`, `a vector (a length)`."""
        if self.truth:
            return "a condition"
        phrase = self.dimension.phrase
        return f"a vector ({phrase})" if isinstance(self.value, Vector) else phrase
