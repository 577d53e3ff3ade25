"""Exact numbers that differ from row to row: a tape over the rows, its constants those of a
recording of exact numbers (`exact_recorder`).

Rows enter as doubles that are exact as they are (numbers of rows, choices) or picked from a list of
recorded numbers. Unlike constants, rows are chosen by the double-doubles themselves.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import nan
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli.exact import fraction_of
from mechkin_cli.tape.decimal_replay import Near, of_fraction, parts, replay, run
from mechkin_cli.tape.native import compiled, replay_precise
from mechkin_cli.tape.recorder import renumbered
from mechkin_cli.tape.row_numbers import RowNumber, RowRecorder
from mechkin_cli.tape.tape import Tape
from mechkin_cli.tape.traced import Traced, register

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.tape.exact_recorder import ExactRecorder


class Picked(NamedTuple):
    """Recorded numbers or floats, and which of them each row has (rows,)."""

    numbers: Sequence[Any]
    which: NDArray[np.intp]


class _Given(NamedTuple):
    """An input over the rows: doubles (rows,), or which of some numbers each row has."""

    rows: NDArray[Any]
    near: list[Near] | None

    @property
    def parts(self) -> Floats:
        """In double-double (2, rows)."""
        if self.near is None:
            return np.stack([self.rows, np.zeros(self.rows.size)])
        pairs: Floats = np.array([parts(one)[:2] for one in self.near])
        over_rows: Floats = pairs[self.rows].T
        return over_rows

    def at(self, row: int) -> Near:
        """The number of a row, not rounded."""
        place = self.rows[row]
        return of_fraction(Fraction(float(place))) if self.near is None else self.near[place]


class RowsTape(NamedTuple):
    """A tape over rows.

    Attributes:
        tape: from the rows' inputs; `constants` are high parts.
        constants: the constants, not rounded.
        given: every input.
    """

    tape: Tape
    constants: list[Near]
    given: list[_Given]


class ExactRows(RowRecorder):
    """Records what is computed over `rows` rows.

    Args:
        recorder: holds the numbers that are the same in all rows.
        rows: their number.
    """

    def __init__(self, recorder: ExactRecorder, rows: int) -> None:
        super().__init__(0)
        self.recorder, self.rows = recorder, rows
        self._given: dict[int, Floats | Picked] = {}

    def given(self, values: Floats | Picked) -> RowNumber:
        """A number of each row: doubles (rows,) that are exact, or picked recorded numbers."""
        number = self._register(nan)
        self._given[number] = values
        return self.number(number)

    def double_doubles(self, numbers: Sequence[Any], lanes: int = 0) -> Floats:
        """Some numbers in double-double (numbers, 2, rows), high and low."""
        made = self._tape(numbers)
        constants = np.array([parts(one)[:2] for one in made.constants]).reshape(-1, 2)
        rows = np.stack([given.parts for given in made.given])
        found = replay_precise(compiled(made.tape), rows, constants[:, 1], lanes)[0]
        return np.ascontiguousarray(found.transpose(1, 2, 0))

    def enclosures(self, numbers: Sequence[Any]) -> Floats:
        """Some numbers enclosed (numbers, 3, rows): as in double-double, and radii about that.

        Raises:
            NotEnclosed: one is not defined in some row.
        """
        return self._by_decimals(numbers)

    def rounded(self, numbers: Sequence[Any]) -> Floats:
        """As `double_doubles`, by decimals: slower, and both parts the nearest."""
        return np.ascontiguousarray(self._by_decimals(numbers)[:, :2])

    def _by_decimals(self, numbers: Sequence[Any]) -> Floats:
        made = self._tape(numbers)
        rows = (
            [*(given.at(row) for given in made.given), *made.constants] for row in range(self.rows)
        )
        found = [[parts(near) for near in row] for row in run(made.tape, rows)]
        return np.ascontiguousarray(np.array(found).transpose(1, 2, 0))

    def _tape(self, numbers: Sequence[Any]) -> RowsTape:
        outputs = [register(self, number) for number in numbers]
        needed = self._needed(list(outputs))
        given = [r for r in needed if r in self._given]
        if not given:
            # rows are counted by an input
            given = [self.given(np.zeros(self.rows)).register]
        constants = [r for r in needed if r in self.constants]
        computed = [r for r in needed if r in self._written]
        number = {r: k for k, r in enumerate((*given, *constants, *computed))}
        near = self._near([self.constants[r] for r in constants])
        written = [self._written[r] for r in computed]
        operands = [renumbered(instruction, number) for instruction in written]
        tape = Tape(
            tuple(f"r{k}" for k in range(len(given))),
            np.array([float(one.value) for one in near], dtype=np.float64),
            np.array([instruction[0] for instruction in written], dtype=np.uint8),
            np.array(operands, dtype=np.int32).reshape(-1, 3),
            np.array([number[r] for r in outputs], dtype=np.int32),
            np.zeros((0, 3), dtype=np.int32),
            np.zeros(0, dtype=np.bool_),
            np.zeros(0, dtype=np.bool_),
        )
        return RowsTape(tape, near, [self._over_rows(self._given[r]) for r in given])

    def _over_rows(self, given: Floats | Picked) -> _Given:
        if isinstance(given, Picked):
            return _Given(given.which, self._near(given.numbers))
        return _Given(given, None)

    def _near(self, numbers: Sequence[Any]) -> list[Near]:
        """Floats, and numbers of the recording, to all their digits."""
        registers = [register(self.recorder, n) for n in numbers if isinstance(n, Traced)]
        traced = iter(replay(self.recorder.exact_tape(registers)))
        return [
            next(traced) if isinstance(n, Traced) else of_fraction(fraction_of(n)) for n in numbers
        ]
