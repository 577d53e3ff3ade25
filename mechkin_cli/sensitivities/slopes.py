"""Slope and curvature of one quantity with one parameter, and whether they mean anything.

With values f0 at p, f- and f+ at distances b below and a above, d- = (f0 - f-)/b and
d+ = (f+ - f0)/a, the parabola through the three has at p the slope (a d- + b d+)/(a + b) and the
curvature 2 (d+ - d-)/(a + b); all in double-double.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.errors import KernelRows, NotRepeated, Repeated, repetition, true_values
from mechkin_cli.exact import PI
from mechkin_cli.tape import DoubleDoubles, NotEnclosed, TraceLost
from mechkin_cli.units import ANGLE, LENGTH
from mechkin_cli.variants import with_parameters
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis, Solvable
    from mechkin_cli.expressions import Expression
    from mechkin_cli.session import ShiftingPrecise
    from mechkin_cli.show import Bools, Floats
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


# A run with one of its parameters a little less and a little more, in double-double.
#
# Where nothing that the building decides is decided otherwise, the converged rows are closed again
# with the tape of the file replayed for the shifted parameter. Else, and for responses, the model
# is made and run anew with both values, and each run is repeated.

ONE_SIDE = "its file holds no value next to this one on both sides"
OTHER_ROWS = "another value has other rows"


@dataclass(frozen=True, eq=False)
class Sides:
    """The rows for three values of a parameter.

    Attributes:
        below, above: how far the values next to it are away (), in the file's units, both positive.
        scale: of the parameter, of which the distances are small parts, in the file's units.
        rows: of the lower value, of its own, of the higher one.
        opened: (rows,) whether closure is lost with the parameter changed.
        lost: (rows,) whether a row has no position with the parameter changed.
    """

    below: DoubleDoubles
    above: DoubleDoubles
    scale: float
    rows: tuple[Repeated, Repeated, Repeated]
    opened: Callable[[], Bools]
    lost: Callable[[], Bools]


class Shifting:
    """What shifts the parameters of a run.

    Args:
        analysis: the run.
        chosen: rows that are wanted (rows,).
        asked: quantities that are wanted, so that a run of the model anew follows their loops.
    """

    def __init__(self, analysis: Analysis, chosen: Bools, asked: Sequence[str]) -> None:
        self.analysis = analysis
        self.asked = tuple(asked)
        self.model: Solvable = analysis.model
        self.result = analysis.result
        self.chosen = chosen
        self.is_sweep = analysis.run == SWEEP
        self._own: dict[bool, Repeated] = {}

    def sides(self, name: str, part: float = 1.0) -> Sides:
        """The rows for values next to a parameter's own, `part` of the usual shift away.

        Raises:
            NotRepeated: why there are none.
        """
        amount = self._amount(name) * Fraction(part)
        try:
            precise = self._precise(name, amount)
            if precise is not None:
                return self._replayed(precise, name, amount)
            return self._anew(name, amount)
        except (TraceLost, LookupError, NotEnclosed) as lost:
            raise NotRepeated(str(lost)) from None

    def _amount(self, name: str) -> Fraction:
        """The shift in SI."""
        part = tolerances.SHIFT if self.is_sweep else tolerances.SHIFT_OF_RESPONSE
        return Fraction(part) * Fraction(self._scale(name))

    def _scale(self, name: str) -> float:
        """The scale of a parameter in SI, see `tolerances.SHIFT`."""
        known = self.model.problem.parameters[name]
        if known.dimension == LENGTH:
            return self.result.session.layout.length
        if known.dimension == ANGLE:
            return 1.0
        one = float(self.model.problem.units.to_si(1.0, known.dimension))
        return abs(float(known.value)) or one  # type: ignore[arg-type]

    def scale_of(self, name: str) -> float:
        """The same in the file's units."""
        return float(self._in_file_units(name, Fraction(self._scale(name))).high)

    def _precise(self, name: str, amount: Fraction) -> ShiftingPrecise | None:
        """What replays the shift; None where the model has to be made anew."""
        if not self.is_sweep:
            return None
        try:
            precise = self.model.design.shifting
            return None if precise.is_turned(name, amount) else precise
        except (TraceLost, NotEnclosed):
            return None

    def _replayed(self, precise: ShiftingPrecise, name: str, amount: Fraction) -> Sides:
        def repeated(by: Fraction) -> Repeated:
            shifted = precise.shifted(name if by else None, by)
            return Repeated(self.result, KernelRows(self.result, shifted, self.chosen))

        if True not in self._own:
            self._own[True] = repeated(Fraction(0))
        rows = repeated(-amount), self._own[True], repeated(amount)
        away = self._in_file_units(name, amount)
        return Sides(away, away, self.scale_of(name), rows, *self._whether(rows))

    def _anew(self, name: str, amount: Fraction) -> Sides:
        problem = self.model.problem
        value = Fraction(float(problem.parameters[name].value))  # type: ignore[arg-type]
        if False not in self._own:
            self._own[False] = repetition(self.result)
        own = self._own[False]
        exact: Any = own.wide.parameters[name].value
        around, away = [], []
        for side in (-1, 1):
            wanted = float(value + side * amount)
            analysis = self._run(name, wanted)
            around.append(repetition(analysis.result))
            found = Fraction(float(analysis.model.problem.parameters[name].value))  # type: ignore[arg-type]
            gap = side * (found - Fraction(float(exact.high)) - Fraction(float(exact.low)))
            away.append(self._in_file_units(name, gap))
        rows = around[0], own, around[1]
        return Sides(away[0], away[1], self.scale_of(name), rows, *self._whether(rows))

    def _run(self, name: str, value: float) -> Analysis:
        """The run with another value in SI."""
        known = self.model.problem.parameters[name]
        given = float(self.model.problem.units.from_si(value, known.dimension))
        try:
            varied = with_parameters(self.model, {name: given})
            run = self.analysis.run
            if self.is_sweep:
                found = varied.analyze(self.asked, tables=[])
            else:
                found = varied.respond(run, tables=[])
        except (InvalidFile, UsageError):
            raise NotRepeated(ONE_SIDE) from None
        if found.result.rows != self.result.rows:
            raise NotRepeated(OTHER_ROWS)
        return found

    def _in_file_units(self, name: str, amount: Fraction) -> DoubleDoubles:
        dimension = self.model.problem.parameters[name].dimension
        factor = self.model.problem.units.unit(dimension).factor
        return DoubleDoubles.of_fraction(amount / factor)

    def _whether(self, rows: tuple[Repeated, ...]) -> tuple[Callable[[], Bools], ...]:
        """Questions to the rows that are closed for them at most once."""
        return cache(lambda: self._opened(rows)), cache(lambda: self._lost(rows))

    def _lost(self, rows: tuple[Repeated, ...]) -> Bools:
        """Rows with a position whose neighbours have none. An input has its value there, too."""
        if not self.is_sweep:
            return np.zeros(self.result.rows, dtype=np.bool_)
        below, own, above = (np.isfinite(one.wide.states.high).all(axis=0) for one in rows)
        lost: Bools = np.asarray(own & ~(below & above), dtype=np.bool_)
        return lost

    def _opened(self, rows: tuple[Repeated, ...]) -> Bools:
        """Rows whose residual grows with the shift: their loops do not close beside it."""
        if not self.is_sweep:
            return np.zeros(self.result.rows, dtype=np.bool_)
        below, own, above = (_residual(one) for one in rows)
        limit = tolerances.CLOSURE_LOST * tolerances.SHIFT
        with np.errstate(invalid="ignore"):
            grown: Bools = np.fmax(np.abs(below - own), np.abs(above - own)) > limit
        return grown


def _residual(repeated: Repeated) -> Floats:
    wide = repeated.wide
    assert isinstance(wide, KernelRows)
    _ = wide.states  # closes the rows where nothing else that was asked for did
    return wide.residual
