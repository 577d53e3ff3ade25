"""What a closed form says of the rows of many mechanisms at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.stress.numbers.series import Number, Series

Rows = NDArray[np.float64]
Mask = NDArray[np.bool_]
SUFFIXES = ("", "_dot", "_ddot")
"""Of a coordinate's name, by the order of the derivative."""
OF_POINTS = (".position", ".velocity", ".acceleration")
"""The same of a point's name."""
Kind = Literal["angle", "whole turns", "length"]
"""An angle is compared modulo a turn, unless its whole turns are known, too."""


@dataclass(frozen=True)
class Quantity:
    """A coordinate (mechanisms, rows) in rad or m, or with `component` (0, 1 or 2) that of a point,
    with its rates; `other` is its value in the nearest other assembly."""

    name: str
    kind: Kind
    value: Number
    other: Number | None = None
    component: int | None = None

    @property
    def columns(self) -> list[str]:
        """The names of value, rate and acceleration."""
        ends = SUFFIXES if self.component is None else OF_POINTS
        return [self.name + end for end in ends]

    @property
    def keys(self) -> list[str]:
        """The same with the component."""
        return [_key(name, self.component) for name in self.columns]

    @property
    def levels(self) -> tuple[Number, ...]:
        """The value, and where it is a series its rate and acceleration."""
        value = self.value
        if isinstance(value, Series):
            return value.value, value.rate, value.acceleration
        return (value,)


@dataclass(frozen=True)
class Force:
    """What a joint transmits (mechanisms, rows) in N, or with `is_moment` in N m; `component` of a
    vector is 0, 1 or 2."""

    name: str
    value: Number
    component: int | None = None
    is_moment: bool = False

    @property
    def key(self) -> str:
        """The name with its component."""
        return _key(self.name, self.component)


class Cell(NamedTuple):
    """A column of cells that a closed form knows: a quantity of the solver or a component of it.

    `is_angle` tells of cells in degrees, `is_whole` of those whose whole turns are known; errors go
    by the condition to the power `order` + 1; `scale` is what values are taken by that are small
    beside it.
    """

    key: str
    quantity: str
    component: int | None
    value: Number
    is_angle: bool
    is_whole: bool
    order: int
    scale: Rows | float

    def column(self, of: Rows) -> Rows:
        """This one of the quantity's rows."""
        return of if self.component is None else of[:, self.component]


@dataclass(frozen=True)
class Truth:
    """Of every row: its coordinates and forces, and whether the branch of the drawing gets there.

    `exists` (mechanisms, rows); where rounding of the written numbers alone could change that,
    the row is not `decided`. `size` (mechanisms, 1) is what lengths are taken by, in m; `heaviest`
    (mechanisms, rows) the largest load, in N, that the forces come from.
    """

    quantities: tuple[Quantity, ...]
    exists: Mask
    decided: Mask
    size: Rows
    forces: tuple[Force, ...] = ()
    heaviest: Rows | float = 0.0

    def cells(self) -> list[Cell]:
        """Of coordinates, those whose truth is a series with their rates and accelerations, and of
        forces."""
        found = []
        for quantity in self.quantities:
            turns, whole = quantity.kind != "length", quantity.kind == "whole turns"
            scale = 1.0 if turns else self.size
            names = zip(quantity.keys, quantity.columns, quantity.levels, strict=False)
            for order, (key, name, level) in enumerate(names):
                degrees, part = turns and not order, quantity.component
                found.append(Cell(key, name, part, level, degrees, whole, order, scale))
        for force in self.forces:
            scale = self.heaviest * (self.size if force.is_moment else 1.0)
            name, part = force.name, force.component
            found.append(Cell(force.key, name, part, force.value, False, False, 2, scale))
        return found


def _key(name: str, component: int | None) -> str:
    return name if component is None else f"{name}.{'xyz'[component]}"
