"""Slope and curvature of one quantity with one parameter, and whether they mean anything.

With values f0 at p, f- and f+ at distances b below and a above, d- = (f0 - f-)/b and
d+ = (f+ - f0)/a, the parabola through the three has at p the slope (a d- + b d+)/(a + b) and the
curvature 2 (d+ - d-)/(a + b); all in double-double.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.tables.true_columns import true_values
from mechkin_cli.tape.double_doubles import DoubleDoubles
from mechkin_cli.units import ANGLE
from mechkin_cli.units.table import PI

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.expressions import Expression
    from mechkin_cli.interface.shifts import Shifting, Sides
    from mechkin_cli.units import UnitSystem


class Slope(NamedTuple):
    """Over all rows of a run, for each component of a quantity (components, rows).

    Attributes:
        slope, curvature: in the file's units; nan where there are none.
        lost: no position with the parameter changed.
        opened: (rows,) the loops do not close with the parameter changed.
        bent: a kink, a jump or a dead centre next to the parameter's value.
    """

    slope: Floats
    curvature: Floats
    lost: Bools
    opened: Bools
    bent: Bools


class Sizes(NamedTuple):
    """What a column is judged by, in the file's units.

    Attributes:
        cells: the largest of its numbers in doubles.
        usual: what is large for anything of its dimension in this mechanism; 0 where not known.
    """

    cells: float
    usual: float


def slope_of(
    expression: Expression, name: str, sides: Sides, shifting: Shifting, turned: bool, sizes: Sizes
) -> Slope:
    """Slope and curvature of an expression; `turned`: it is an angle, told up to whole turns.

    Raises:
        NotRepeated: why there are none.
    """
    parts = _values(expression, sides)
    size = max(_largest(part[1].high) for part in parts)
    turn = _turn(shifting, turned)
    found = [_of_part(*part, sides, turn, size, sizes) for part in parts]
    slopes, curvatures, lost, bent, leaping = (np.stack(part) for part in zip(*found, strict=True))
    opened = sides.opened()
    lost |= sides.lost()
    if leaping.any():
        nearer = shifting.sides(name, 0.25)
        others = [
            _of_part(*part, nearer, turn, size, sizes)[0] for part in _values(expression, nearer)
        ]
        bent |= leaping & ~_agree(slopes, np.stack(others))
    return Slope(slopes, curvatures, lost, opened, bent)


def _values(
    expression: Expression, sides: Sides
) -> list[tuple[DoubleDoubles, DoubleDoubles, DoubleDoubles]]:
    """The components of an expression, each for the three values of the parameter."""
    below, own, above = (true_values(expression, rows) for rows in sides.rows)
    return list(zip(below, own, above, strict=True))


def _turn(shifting: Shifting, turned: bool) -> DoubleDoubles | None:
    units: UnitSystem = shifting.model.problem.units
    return DoubleDoubles.of_fraction(2 * PI / units.unit(ANGLE).factor) if turned else None


def _of_part(
    below: DoubleDoubles,
    own: DoubleDoubles,
    above: DoubleDoubles,
    sides: Sides,
    turn: DoubleDoubles | None,
    size: float,
    sizes: Sizes,
) -> tuple[Any, ...]:
    """Slope, curvature, and where rows are lost, bent, or change by much."""
    with np.errstate(all="ignore"):
        down, up = _within_a_turn(own - below, turn), _within_a_turn(above - own, turn)
        left, right = down / sides.below, up / sides.above
        both = sides.below + sides.above
        slope = ((left * sides.above + right * sides.below) / both).high
        curvature = ((right - left) * 2.0 / both).high
        bend = np.abs((right - left).high)
        is_zero = size <= tolerances.ZERO_BUT_FOR_ROUNDING * sizes.cells
        noise = tolerances.ZERO_ROUNDING * sizes.cells if is_zero else 0.0
        # a position that is zero throughout is known as well as those that are not
        noise = max(noise, tolerances.BENT_ROUNDING * max(size, sizes.usual))
        rounding = noise / float(sides.below.high)
        usual = _usual(slope)
        steep = np.fmax(np.abs(slope), max(usual, size / sides.scale))
        bent = bend > tolerances.BENT * steep + rounding
        change = np.fmax(np.abs(down.high), np.abs(up.high))
        leaping = (change > max(tolerances.LEAP * max(size, sizes.cells), noise)) & ~bent
    is_lost = np.isfinite(own.high) & ~(np.isfinite(below.high) & np.isfinite(above.high))
    return slope, curvature, is_lost, bent, leaping


def _within_a_turn(change: DoubleDoubles, turn: DoubleDoubles | None) -> DoubleDoubles:
    if turn is None:
        return change
    whole = np.rint(change.high / float(turn.high))
    whole = np.where(np.isfinite(whole), whole, 0.0)
    return change - turn * whole if whole.any() else change


def _usual(values: Floats) -> float:
    """The median of the magnitudes, which one steep row does not move."""
    found = np.abs(values[np.isfinite(values)])
    return float(np.median(found)) if found.size else 0.0


def _largest(values: Floats) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _agree(slopes: Floats, others: Floats) -> Bools:
    sizes = np.fmax(np.abs(slopes), np.abs(others))
    with np.errstate(invalid="ignore"):
        found: Bools = np.abs(slopes - others) <= tolerances.LEAP_AGREES * sizes
    return found
