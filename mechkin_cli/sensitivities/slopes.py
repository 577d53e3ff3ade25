"""Slope and curvature of one quantity with one parameter, and whether they mean anything.

With values f0 at p, f- and f+ at distances b below and a above, d- = (f0 - f-)/b and
d+ = (f+ - f0)/a, the parabola through the three has at p the slope (a d- + b d+)/(a + b) and the
curvature 2 (d+ - d-)/(a + b); all in double-double.

Where the building decides nothing otherwise, the converged rows are closed again with the tape of
the file replayed for the shifted parameter. Else, and for responses, the model is made and run
again with both values, and each run is repeated (`Shifting`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import InvalidFile, UsageError
from mechkin_cli.errors import KernelRows, NotRepeated, Repeated, repetition, true_values
from mechkin_cli.exact import PI
from mechkin_cli.record import NamedTuple, dataclass
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


def slope_of(
    expression: Expression,
    name: str,
    sides: Sides,
    shifting: Shifting,
    turned: bool,
    sizes: tuple[float, float],
) -> Slope:
    """Slope and curvature of an expression.

    Args:
        turned: it is an angle, known up to whole turns.
        sizes: in the file's units: the largest of its numbers in doubles, and what is large for
            anything of its dimension in this mechanism; 0 where not known.

    Raises:
        NotRepeated: why there are none.
    """
    parts = _values(expression, sides)
    finite = (part[1].high[np.isfinite(part[1].high)] for part in parts)
    size = max(float(np.abs(values).max(initial=0.0)) for values in finite)
    units: UnitSystem = shifting.model.problem.units
    turn = DoubleDoubles.of_fraction(2 * PI / units.unit(ANGLE).factor) if turned else None
    rows = [_of_part(*part, sides, turn, size, sizes) for part in parts]
    slopes, curvatures, lost, bent, leaping = (np.stack(part) for part in zip(*rows, strict=True))
    opened = sides.opened()
    lost |= sides.lost()
    if leaping.any():
        nearer = shifting.sides(name, 0.25)
        others = np.stack(
            [_of_part(*part, nearer, turn, size, sizes)[0] for part in _values(expression, nearer)]
        )
        with np.errstate(invalid="ignore"):
            limit = tolerances.LEAP_AGREES * np.fmax(np.abs(slopes), np.abs(others))
            bent |= leaping & ~(np.abs(slopes - others) <= limit)
    return Slope(slopes, curvatures, lost, opened, bent)


def _values(
    expression: Expression, sides: Sides
) -> list[tuple[DoubleDoubles, DoubleDoubles, DoubleDoubles]]:
    """The components of an expression, each for the three values of the parameter."""
    below, own, above = (true_values(expression, rows) for rows in sides.rows)
    return list(zip(below, own, above, strict=True))


def _of_part(
    below: DoubleDoubles,
    own: DoubleDoubles,
    above: DoubleDoubles,
    sides: Sides,
    turn: DoubleDoubles | None,
    size: float,
    sizes: tuple[float, float],
) -> tuple[Any, ...]:
    """Slope, curvature, and where rows are lost, bent, or change by much."""
    cells, large = sizes
    with np.errstate(all="ignore"):
        down, up = _within_a_turn(own - below, turn), _within_a_turn(above - own, turn)
        left, right = down / sides.below, up / sides.above
        both = sides.below + sides.above
        slope = ((left * sides.above + right * sides.below) / both).high
        curvature = ((right - left) * 2.0 / both).high
        bend = np.abs((right - left).high)
        is_zero = size <= tolerances.ZERO_BUT_FOR_ROUNDING * cells
        noise = tolerances.ZERO_ROUNDING * cells if is_zero else 0.0
        # a position that is zero throughout is known as well as those that are not
        noise = max(noise, tolerances.BENT_ROUNDING * max(size, large))
        rounding = noise / float(sides.below.high)
        usual = _usual(slope)
        steep = np.fmax(np.abs(slope), max(usual, size / sides.scale))
        bent = bend > tolerances.BENT * steep + rounding
        change = np.fmax(np.abs(down.high), np.abs(up.high))
        leaping = (change > max(tolerances.LEAP * max(size, cells), noise)) & ~bent
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
    sizes = np.abs(values[np.isfinite(values)])
    return float(np.median(sizes)) if sizes.size else 0.0


ONE_SIDE = "its file holds no value next to this one on both sides"
OTHER_ROWS = "another value has other rows"


@dataclass(frozen=True, eq=False)
class Sides:
    """The rows for three values of a parameter.

    Attributes:
        below, above: how far away the values next to it are, in the file's units, both positive.
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
    """Runs with one of the parameters a little less and a little more, in double-double.

    Args:
        analysis: the run.
        chosen: rows that are wanted (rows,).
        asked: quantities that are wanted, so that another run of the model follows their loops.
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
            return self._run_again(name, amount)
        except (TraceLost, LookupError, NotEnclosed) as lost:
            raise NotRepeated(str(lost)) from None

    def _amount(self, name: str) -> Fraction:
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
        """What replays the shift; None where the model has to be made again."""
        if not self.is_sweep or self.result.problem.motion.rest is not None:
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
        return Sides(away, away, self.scale_of(name), rows, *self._checks(rows))

    def _run_again(self, name: str, amount: Fraction) -> Sides:
        problem = self.model.problem
        value = Fraction(float(problem.parameters[name].value))  # type: ignore[arg-type]
        if False not in self._own:
            self._own[False] = repetition(self.result)
        own = self._own[False]
        exact: Any = own.wide.parameters[name].value
        around, away = [], []
        for side in (-1, 1):
            analysis = self._run(name, float(value + side * amount))
            around.append(repetition(analysis.result))
            shifted = Fraction(float(analysis.model.problem.parameters[name].value))  # type: ignore[arg-type]
            gap = side * (shifted - Fraction(float(exact.high)) - Fraction(float(exact.low)))
            away.append(self._in_file_units(name, gap))
        rows = around[0], own, around[1]
        return Sides(away[0], away[1], self.scale_of(name), rows, *self._checks(rows))

    def _run(self, name: str, value: float) -> Analysis:
        """The run with another value in SI."""
        known = self.model.problem.parameters[name]
        in_units = float(self.model.problem.units.from_si(value, known.dimension))
        try:
            varied = with_parameters(self.model, {name: in_units})
            if self.is_sweep:
                analysis = varied.analyze(self.asked, tables=[])
            else:
                analysis = varied.run_free(self.analysis.run, tables=[])
        except (InvalidFile, UsageError):
            raise NotRepeated(ONE_SIDE) from None
        if analysis.result.rows != self.result.rows:
            raise NotRepeated(OTHER_ROWS)
        return analysis

    def _in_file_units(self, name: str, amount: Fraction) -> DoubleDoubles:
        dimension = self.model.problem.parameters[name].dimension
        factor = self.model.problem.units.unit(dimension).factor
        return DoubleDoubles.of_fraction(amount / factor)

    def _checks(self, rows: tuple[Repeated, ...]) -> tuple[Callable[[], Bools], ...]:
        """`Sides.opened` and `Sides.lost`: the rows are closed for them at most once."""
        return cache(lambda: self._opened(rows)), cache(lambda: self._lost(rows))

    def _lost(self, rows: tuple[Repeated, ...]) -> Bools:
        """Rows with a position whose neighbours have none. An input has its value there, too."""
        if not self.is_sweep:
            return np.zeros(self.result.rows, dtype=np.bool_)
        below, own, above = (np.isfinite(one.wide.states.high).all(axis=0) for one in rows)
        return np.asarray(own & ~(below & above), dtype=np.bool_)

    def _opened(self, rows: tuple[Repeated, ...]) -> Bools:
        """Rows whose residual grows with the shift: their loops do not close beside it."""
        if not self.is_sweep:
            return np.zeros(self.result.rows, dtype=np.bool_)
        below, own, above = (_residual(one) for one in rows)
        limit = tolerances.CLOSURE_LOST * tolerances.SHIFT
        with np.errstate(invalid="ignore"):
            return np.asarray(np.fmax(np.abs(below - own), np.abs(above - own)) > limit)


def _residual(repeated: Repeated) -> Floats:
    wide = repeated.wide
    assert isinstance(wide, KernelRows)
    _ = wide.states  # closes the rows where nothing else that was asked for did
    return wide.residual
