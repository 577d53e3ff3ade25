"""What laws of motion consist of: pieces, each a polynomial and a wave of the variable, and the
rises of the textbooks.

Everything that is asked of a law comes from a `PiecewiseLaw`:

- `orders(x)`: value and derivatives by the variable at any of its values, in doubles;
- `recorded(rows, x, at)`: the same on a recording of exact numbers;
- `value(x, constants)`, of numbers of any kind, with `constants(x)` of the piece in which x lies:
  one formula for all pieces, so that one tape holds for all of them, and its derivatives are those
  of the tape; it changes at `edges`, where the law has a kink.

A piece is a polynomial of w = (x - origin)/length - shift and a wave of w. Rises are measured from
their nearer end, so that they leave and reach it exactly. The first and the last value of a rise
belong to it; where two pieces meet that both move, the place belongs to the later one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import inf, pi, prod
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.exact import PI, Exact, nearest
from mechkin_cli.kernel.functions import total
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.tape import JetNumber, Recorded, TraceLost, as_recorded, cos, is_traced, sin
from mechkin_cli.tolerances import COURSE_JUMP, COURSE_SAME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats
    from mechkin_cli.tape import ExactRows

HALF_TURN = Exact(pi, PI)
"""Half a turn in rad."""
_ORDERS = range(4)

Orders = tuple[Any, Any, Any, Any]
"""Value and three derivatives."""


_NO_WAVES: Sequence[Any] = (0.0, 0.0, 0.0, 0.0)


class Piece(NamedTuple):
    """anchor + a polynomial of w = (x - origin)/length - shift + a wave of w, from `start` on.

    Attributes:
        start: the value of the variable from which it holds.
        anchor: as above, as `origin`, `length` and `shift`.
        polynomials: of each order the coefficients of w^0, w^1, ...
        waves: of each order the factor of sine, cosine, sine and cosine of pi (turns w + phase).
        moves: whether it is no rest.
        goes_on: whether it is the same function as the piece before, measured from elsewhere.
    """

    start: Any
    anchor: Any
    origin: Any = 0.0
    length: Any = 1.0
    shift: Any = 0.0
    polynomials: Sequence[Sequence[Any]] = ((), (), (), ())
    waves: Sequence[Any] = _NO_WAVES
    turns: Any = 0.0
    phase: Any = 0.0
    moves: bool = True
    goes_on: bool = False


def rest(at: Any, start: Any = -inf) -> Piece:
    """Stays at a value, from `start` on."""
    return Piece(start, at, moves=False)


class PiecewiseLaw:
    """A law of one or more pieces in rising order, of which the first has no start.

    With a `period` it repeats itself from the start of its second piece on, and before.
    """

    def __init__(self, pieces: Sequence[Piece], period: Any = None) -> None:
        self.pieces, self.period = tuple(pieces), period
        self._starts = np.array([as_recorded(piece.start) for piece in self.pieces[1:]])
        self._moves = np.array([piece.moves for piece in self.pieces])
        self._waves = any(not _is_zero(piece.turns) for piece in self.pieces)
        sizes = max(len(piece.polynomials[0]) for piece in self.pieces)
        self._sizes = [max(sizes - order, 1) for order in _ORDERS]
        rows = zip(*map(self._row, self.pieces), strict=True)
        self._columns: list[list[Any]] = [list(column) for column in rows]
        self._own = [k for k in range(self._of_value) if not _alike(self._columns[k])]
        if period is not None and 0 not in self._own:
            self._own.insert(0, 0)

    @property
    def edges(self) -> list[float]:
        """Values of the variable at which the constants change, of a period those of its first."""
        parts = zip(self._starts.tolist(), self.pieces[1:], strict=True)
        return [start for start, piece in parts if not piece.goes_on]

    @property
    def is_recorded(self) -> bool:
        """Whether some of its numbers are recorded ones."""
        return any(isinstance(number, Recorded) for column in self._columns for number in column)

    def jumps(self) -> list[tuple[float, Floats]]:
        """Where pieces meet that are not one function, and by how much each order (4,) jumps there;
        what is rounding is 0. Of a law that repeats itself its start is such a place, too."""
        first = 0 if self.period is None else len(self.pieces) - 1
        befores = [first, *range(1, len(self.pieces) - 1)]
        pairs = zip(befores, range(1, len(self.pieces)), self._starts.tolist(), strict=True)
        found = []
        for before, behind, at in pairs:
            if self.pieces[behind].goes_on:
                continue
            end = np.array([at + self._length if behind < before else at])
            one, other = (
                self._evaluated(x, [column[k] for column in self._columns], len(_ORDERS))
                for k, x in ((before, end), (behind, np.array([at])))
            )
            jump = np.array([float(np.ravel(b - a)[0]) for a, b in zip(one, other, strict=True)])
            found.append((at, np.where(np.abs(jump) <= COURSE_JUMP * self._largest(), 0.0, jump)))
        return found

    def _largest(self) -> Floats:
        """A bound of each order (4,) near the pieces' own parts of the variable."""
        anchors = self._columns[5]
        found, used = [], 6
        for size in self._sizes:
            columns = self._columns[used : used + 1 + size]
            found.append(max(total(map(abs, row)) for row in zip(*columns, strict=True)))
            used += 1 + size
        found[0] += max(map(abs, anchors))
        return np.array(found)

    def constants(self, x: float) -> list[float]:
        """Those of the piece in which a value of the variable lies."""
        at = np.array([x])
        turns = float(self._turns(at)[0])
        piece = int(self._piece_of(at - turns * self._length)[0])
        row = [self._columns[k][piece] for k in self._own]
        if turns:
            row[0] = row[0] + turns * self._length
        return row

    def value(self, x: Any, constants: Sequence[Any]) -> Any:
        """The value at x, a float or a recorded number, with the constants of its piece."""
        row = [column[0] for column in self._columns]
        for k, constant in zip(self._own, constants, strict=True):
            row[k] = constant
        return self._evaluated(x, row, 1)[0]

    def orders(self, x: Floats) -> Floats:
        """Value and three derivatives at x (rows,), shape (4, rows).

        Raises:
            TraceLost: the law depends on a parameter that is recorded.
        """
        columns = [c[0] if _alike(c) else np.array(c) for c in self._columns]
        if any(map(is_traced, columns)):
            raise TraceLost("a law of motion depends on a varied parameter")
        x = x - self._turns(x) * self._length if self._length else x
        piece = self._piece_of(x)
        row = [c[piece] if isinstance(c, np.ndarray) else c for c in columns]
        found = self._evaluated(x, row, len(_ORDERS))
        # + 0 makes zeros of either sign one
        return np.stack([np.broadcast_to(order, x.shape) for order in found]) + 0.0

    def at(self, x: JetNumber) -> Any:
        """The value at x, a number with its derivatives, in whichever piece it lies: those of all
        pieces, of which one is chosen."""
        if self.period is not None:
            start, period = x.beside(self.pieces[1].start), x.beside(self.period)
            x = x - period * ((x - start) / period - 0.5).apply("WHOLE")
        near = COURSE_SAME * float(self._starts[-1] - self._starts[0]) if self._starts.size else 0.0
        found = _of_piece(self.pieces[0], x)
        for piece in self.pieces[1:]:
            begin = x.beside(piece.start)
            begun = x >= begin - near if piece.moves else x > begin + near
            found = begun.choose(_of_piece(piece, x), found)
        return found

    def recorded(self, rows: ExactRows, x: Any, at: Floats) -> Orders:
        """As `orders`, of recorded moments x of the rows; doubles `at` (rows,) tell their pieces,
        but for rows at an edge while numbers are shifted: they are in the one piece or the other as
        shifts move them, or the edge."""
        assert self.period is None  # of angles alone
        piece = self._piece_of(at)
        crossed = self._crossing(rows, x, at, piece)
        row = [c[0] if _alike(c) else rows.picked(c, crossed) for c in self._columns]
        value, first, second, third = self._evaluated(x, row, len(_ORDERS))
        return value, first, second, third

    def _crossing(
        self, rows: ExactRows, x: Any, at: Floats, piece: NDArray[np.intp]
    ) -> Callable[[], NDArray[np.intp]]:
        """What gives the pieces of the rows by the shifts of the moment."""
        starts = self._starts
        if not starts.size:
            return lambda: piece
        edge = np.argmin(np.abs(at[:, None] - starts), axis=1)
        extent = max(starts[-1], at.max()) - min(starts[0], at.min())
        is_at = np.abs(at - starts[edge]) <= COURSE_SAME * extent
        if not is_at.any():
            return lambda: piece
        gap = x - rows.picked([piece.start for piece in self.pieces[1:]], edge)

        def crossed() -> NDArray[np.intp]:
            found = rows.changes(gap)
            if found is None:
                return piece
            own, change = found
            # exact numbers that do not change differ by less than a double-double's rounding
            moved = is_at & (np.abs(change) > np.maximum(np.abs(own), COURSE_SAME**2 * extent))
            return np.where(moved, edge + (own + change > 0.0), piece)

        return crossed

    @property
    def _length(self) -> float:
        """The period; 0 where there is none."""
        return 0.0 if self.period is None else as_recorded(self.period)

    def _turns(self, x: Floats) -> Floats:
        """How many periods lie before each x (rows,)."""
        length = self._length
        return np.floor((x - self._starts[0]) / length) if length else np.zeros(x.shape)

    def _piece_of(self, x: Floats) -> NDArray[np.intp]:
        """The number of the piece of each x (rows,)."""
        starts = self._starts
        if not starts.size:
            return np.zeros(x.shape, dtype=np.intp)
        near = COURSE_SAME * (max(starts[-1], x.max()) - min(starts[0], x.min()))
        piece = np.searchsorted(starts - near, x, side="right")
        before = piece - 1
        at_start = np.abs(x - starts[np.maximum(before, 0)]) <= near
        stays = ~self._moves[piece] & at_start & (piece > 0)
        return np.where(stays, before, piece)

    def _row(self, piece: Piece) -> list[Any]:
        """All numbers of a piece in the order in which `_evaluated` takes them."""
        row = [piece.origin, piece.length, piece.shift, piece.turns, piece.phase, piece.anchor]
        for size, wave, polynomial in zip(self._sizes, piece.waves, piece.polynomials, strict=True):
            row += [wave, *polynomial, *[0.0] * (size - len(polynomial))]
        return row

    @property
    def _of_value(self) -> int:
        """How many of them its value needs."""
        return 7 + self._sizes[0]

    def _evaluated(self, x: Any, row: Sequence[Any], count: int) -> list[Any]:
        """The first orders of a law at x, of a piece whose numbers are known."""
        origin, length, shift, turns, phase, anchor = row[:6]
        w = x if _is_zero(origin) else x - origin
        w = w if _is_one(length) else w / length
        w = w if _is_zero(shift) else w - shift
        sine, cosine = _half_turns(turns * w + phase) if self._waves else (0.0, 0.0)
        found, used = [], 6
        for order, size in enumerate(self._sizes[:count]):
            wave, *coefficients = row[used : used + 1 + size]
            total: Any = coefficients[-1]
            for coefficient in coefficients[-2::-1]:
                total = total * w
                total = total if _is_zero(coefficient) else total + coefficient
            if self._waves:
                total = total + wave * (cosine if order % 2 else sine)
            if order == 0 and not _is_zero(anchor):
                total = anchor + total
            found.append(total)
            used += 1 + size
        return found


@dataclass(frozen=True, eq=False)
class LawOfCoordinate:
    """A `PiecewiseLaw` of a coordinate, as data: those of variants have other numbers."""

    pieces: tuple[Piece, ...]
    period: Any

    def __call__(self, x: JetNumber) -> Any:
        """The value at x, a number with its derivatives, in whichever piece it lies."""
        return PiecewiseLaw(self.pieces, self.period).at(x)


def _of_piece(piece: Piece, x: JetNumber) -> Any:
    """The value of one piece at x."""
    anchor = x.beside(piece.anchor)
    if not piece.moves:
        return anchor
    w = (x - x.beside(piece.origin)) / x.beside(piece.length) - x.beside(piece.shift)
    *lower, total = map(x.beside, piece.polynomials[0] or (0.0,))
    for coefficient in lower[::-1]:
        total = total * w + coefficient
    if not _is_zero(piece.turns):
        sine, _ = _half_turns(x.beside(piece.turns) * w + x.beside(piece.phase))
        total = total + x.beside(piece.waves[0]) * sine
    return anchor + total


def _is_zero(number: Any) -> bool:
    return isinstance(number, float) and number == 0.0


def _is_one(number: Any) -> bool:
    return isinstance(number, float) and number == 1.0


def _alike(numbers: Sequence[Any]) -> bool:
    """Whether numbers are known to be one."""
    first = numbers[0]
    if isinstance(first, Recorded):
        return all(number is first for number in numbers)
    return all(not isinstance(number, Recorded) and number == first for number in numbers)


def _half_turns(m: Any) -> tuple[Any, Any]:
    """Sine and cosine of pi m; of rows exact where m is a multiple of 1/2."""
    if not isinstance(m, np.ndarray):
        return sin(m * HALF_TURN), cos(m * HALF_TURN)
    m = m - 2.0 * np.rint(0.5 * m)
    size = np.abs(m)
    sine = sin(pi * np.minimum(size, 1.0 - size))
    return np.where(m < 0.0, -sine, sine), sin(pi * (0.5 - size))


class _Part(NamedTuple):
    """A stretch of a rise from 0 to 1, with w = u - shift: c0 + c1 w + c2 w^2 + ...
    + amplitude sin(pi (turns w + phase)), above 0, 1/2 or 1 as the shift is below, at or
    above 1/2."""

    start: Fraction
    shift: Fraction
    coefficients: tuple[Fraction, ...]
    amplitude: Fraction = Fraction(0)
    turns: Fraction = Fraction(0)
    phase: Fraction = Fraction(0)
    goes_on: bool = False


_HALF = Fraction(1, 2)


def _rise_of(*first: _Part) -> tuple[_Part, ...]:
    """A rise with s(1 - u) = 1 - s(u) from its parts to the middle, or around it."""
    found = list(first)
    ends = [*(part.start for part in first[1:]), _HALF]
    for part, end in zip(first[::-1], ends[::-1], strict=True):
        if part.shift != _HALF:
            turned = tuple(c if k % 2 else -c for k, c in enumerate(part.coefficients))
            start, shift, phase = 1 - end, 1 - part.shift, -part.phase
            goes_on = end == _HALF
            found.append(_Part(start, shift, turned, part.amplitude, part.turns, phase, goes_on))
    return tuple(found)


_ZERO, _ONE, _EIGHTH, _FOUR_PI = Fraction(0), Fraction(1), Fraction(1, 8), 4 * PI
# The largest accelerations of a modified sine and of a modified trapezoid over 4 pi; in the first
# eighth the acceleration is that times sin(4 pi u), and the rate behind it is this.
_SINE, _TRAPEZOID = PI / (4 + PI), 2 / (2 + PI)


def _waving(rate: Fraction, turns: int) -> _Part:
    """The part from the start on whose acceleration is a sine, with its mean rate."""
    return _Part(_ZERO, _ZERO, (_ZERO, rate), -rate / (PI * turns), Fraction(turns))


def _powers(*coefficients: int) -> _Part:
    return _Part(_ZERO, _ZERO, tuple(map(Fraction, coefficients)))


SHAPES: dict[str, tuple[_Part, ...]] = {
    "constant-rate": _rise_of(_powers(0, 1)),
    "harmonic": _rise_of(_Part(_ZERO, _ZERO, (_HALF,), _HALF, _ONE, -_HALF)),
    "cycloidal": _rise_of(_waving(_ONE, 2)),
    "3-4-5": _rise_of(_powers(0, 0, 0, 10, -15, 6)),
    "4-5-6-7": _rise_of(_powers(0, 0, 0, 0, 35, -84, 70, -20)),
    # R. L. Norton, Cam Design and Manufacturing Handbook, chapter 3
    "modified-sine": _rise_of(
        _waving(_SINE, 4),
        _Part(_EIGHTH, _HALF, (_ZERO, _SINE), 9 * _SINE / _FOUR_PI, Fraction(4, 3)),
    ),
    "modified-trapezoid": _rise_of(
        _waving(_TRAPEZOID, 4),
        _Part(
            _EIGHTH,
            _EIGHTH,
            (_TRAPEZOID * (_EIGHTH - 1 / _FOUR_PI), _TRAPEZOID, 2 * PI * _TRAPEZOID),
        ),
        _Part(3 * _EIGHTH, _HALF, (_ZERO, 2 - _TRAPEZOID), _TRAPEZOID / _FOUR_PI, 4 * _ONE),
    ),
}
"""The rises from 0 to 1 by the word of their law."""


def waves_of(scales: Sequence[Any], amplitude: Fraction, turns: Fraction) -> list[Any]:
    """The factors of a wave in each order, by what one unit of that is, as of `Piece`."""
    by_turns = PI * turns
    factors = [amplitude]
    for sign in (1, -1, 1):
        factors.append(sign * by_turns * factors[-1])
    return [scale * nearest(factor) for scale, factor in zip(scales, factors, strict=True)]


def risen(
    law: str, start: Any, length: Any, first: Any, last: Any, scales: Sequence[Any]
) -> list[Piece]:
    """The pieces of a rise.

    Args:
        law: its word, one of `SHAPES`.
        start: the value of the variable at which it begins.
        length: how far it reaches.
        first: the value at its begin.
        last: the value at its end.
        scales: what one unit of each order of a function of w from 0 to 1 is.
    """
    pieces = []
    for part in SHAPES[law]:
        anchor = (
            first if part.shift < _HALF else last if part.shift > _HALF else (first + last) / 2.0
        )
        polynomials = [
            [
                scale * nearest(c * prod(range(k - order + 1, k + 1)))
                for k, c in enumerate(part.coefficients)
                if k >= order
            ]
            for order, scale in enumerate(scales)
        ]
        waves = waves_of(scales, part.amplitude, part.turns) if part.turns else _NO_WAVES
        pieces.append(
            Piece(
                start + length * nearest(part.start) if part.start else start,
                anchor,
                start,
                length,
                nearest(part.shift),
                polynomials,
                waves,
                nearest(part.turns),
                nearest(part.phase),
                goes_on=part.goes_on,
            )
        )
    return pieces
