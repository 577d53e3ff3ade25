"""Messages about rows of a run, while it is not known yet which rows they are about: a long run is
solved in parts (`sweep.parts`), and says what it would say if it were solved at once.

A part has a `RowNote` with what it found in each of its rows. `Notes` adds up those of all parts in
memory that does not go with their rows: which they are (`RowSet`), and what the worst of them has.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from operator import itemgetter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.diagnostics import Diagnostic, Severity
    from mechkin_cli.show import Bools, Floats

SHOWN = 6
"""Ranges of rows that a message names."""


class RowSet(NamedTuple):
    """Some rows of a run, as messages name them: the first ranges of their numbers from 1, how many
    they are, the last one, and how many rows the run has."""

    ranges: tuple[tuple[int, int], ...]
    size: int
    last: int
    run_rows: int

    @classmethod
    def of(cls, rows: Sequence[int] | NDArray[np.intp], run_rows: int = 0) -> RowSet:
        """Rows by rising numbers from 0."""
        numbers = np.asarray(rows) + 1
        breaks = np.flatnonzero(np.diff(numbers) != 1)[:SHOWN]
        firsts = [numbers[0], *numbers[breaks + 1]]
        lasts = [*numbers[breaks], numbers[-1]]
        ranges = [(int(a), int(b)) for a, b in zip(firsts, lasts, strict=True)][:SHOWN]
        return cls(tuple(ranges), numbers.size, int(numbers[-1]), run_rows)

    @property
    def first(self) -> int:
        """The number of the first one from 1."""
        return self.ranges[0][0]

    def joined(self, later: RowSet) -> RowSet:
        """These rows and others behind all of them."""
        ranges, behind = list(self.ranges), list(later.ranges)
        if ranges[-1][1] == self.last == behind[0][0] - 1:
            ranges[-1] = ranges[-1][0], behind.pop(0)[1]
        # where some are not named, none behind them is
        named = sum(last - first + 1 for first, last in self.ranges) == self.size
        ranges = [*ranges, *behind][:SHOWN] if named else ranges
        return RowSet(tuple(ranges), self.size + later.size, later.last, self.run_rows)

    def __str__(self) -> str:
        """Their ranges.

        Example:
            >>> str(RowSet.of([3, 4, 5, 8]))
            'rows 4 to 6 and 9'
        """
        words = [f"{a} to {b}" if b > a else f"{a}" for a, b in self.ranges]
        left = self.size - sum(b - a + 1 for a, b in self.ranges)
        if left:
            words.append(f"{left} more up to row {self.last}")
        first = "row" if self.size == 1 else "rows"
        return f"{first} {' and '.join(filter(None, (', '.join(words[:-1]), words[-1])))}"

    @property
    def counted(self) -> str:
        """How many they are, and which is the first."""
        if self.size == 1:
            return f"row {self.first}"
        if self.size == self.run_rows:
            return "all rows"
        return f"{self.size} rows, first in row {self.first}"


MOST_PLACES = 4
"""Places between rows that a message shows."""


class Found(NamedTuple):
    """What was found in some rows of a run: which they are, what the worst of them has, which of
    the things that a message names are meant; the first places (row, place) that it shows, and how
    many there are. There may be places, or things that count in all rows, and no rows."""

    some_rows: RowSet | None
    told: Any
    marks: frozenset[Any]
    places: tuple[tuple[int, Any], ...]
    place_count: int

    @property
    def rows(self) -> RowSet:
        """The rows, of which there are some."""
        assert self.some_rows is not None
        return self.some_rows

    def joined(self, later: Found, *, worse: bool) -> Found:
        """With what was found in rows behind these, of which one may be `worse`."""
        rows = self.some_rows or later.some_rows
        if self.some_rows and later.some_rows:
            rows = self.some_rows.joined(later.some_rows)
        places = sorted([*self.places, *later.places], key=itemgetter(0))[:MOST_PLACES]
        return Found(
            rows,
            later.told if worse else self.told,
            self.marks | later.marks,
            tuple(places),
            self.place_count + later.place_count,
        )


class RowNote(NamedTuple):
    """A message about some rows of a part of a run.

    Attributes:
        code, severity: as of a diagnostic.
        about: what of several things with this code it is about.
        where: the rows (rows,).
        words: the message on what was found in all parts; it must not hold rows.
        badness: of each row (rows,), of which the largest is told; None: the first row's.
        told: what is told of a row; None: its badness.
        marks: things and the rows (rows,) in which they count; None: in all, and without any.
        places: where the run comes to something on the way to a row: that row, and what is told.
    """

    code: str
    severity: Severity
    about: Hashable
    where: Bools
    words: Callable[[Found], Diagnostic]
    badness: Floats | None = None
    told: Callable[[int], Any] | None = None
    marks: Sequence[tuple[Hashable, Bools | None]] = ()
    places: Sequence[tuple[int, Any]] = ()


Note: TypeAlias = "Diagnostic | RowNote"
"""What a part of a run has to say."""


class _Sum(NamedTuple):
    """What was found so far of a message, and how bad the worst row is."""

    found: Found
    badness: float
    words: Callable[[Found], Diagnostic]

    def joined(self, later: _Sum) -> _Sum:
        worse = later.badness > self.badness
        found = self.found.joined(later.found, worse=worse)
        return _Sum(found, later.badness if worse else self.badness, self.words)


MOST_ALIKE = 4
"""Messages of one kind, each about a place of its own, beyond which parts of a run add none: those
of its first part, which has what is said of the mechanism, are all told."""


class Notes:
    """The messages of all parts of a run, each once.

    Those about rows are about the rows of all parts; of others those that are alike count once, and
    of each kind those of the first part are told, and the first few.
    """

    def __init__(self, run_rows: int) -> None:
        self._run_rows = run_rows
        self._found: dict[Hashable, _Sum | Diagnostic] = {}
        self._parts = 0
        self._left_out: dict[str, int] = {}
        self._told: dict[str, list[Diagnostic]] = {}

    def add(self, notes: Iterable[Note], first: int = 0, own: slice = slice(None)) -> None:
        """Adds those of a part whose first row has the number `first` from 0 and of which the rows
        `own` are in no part before it."""
        for one in notes:
            if isinstance(one, RowNote):
                self._add_rows(one, first, own)
            elif one not in self._found:
                alike = self._told.setdefault(one.code, [])
                if self._parts == 0 or len(alike) < MOST_ALIKE:
                    self._found[one] = one
                    alike.append(one)
                else:
                    self._left_out[one.code] = self._left_out.get(one.code, 0) + 1
        self._parts += 1

    def _add_rows(self, one: RowNote, first: int, own: slice) -> None:
        is_own = np.zeros(one.where.size, dtype=bool)
        is_own[own] = True
        numbers = np.flatnonzero(one.where & is_own)
        always = any(rows is None for _, rows in one.marks)
        places = [(row + first, place) for row, place in one.places if is_own[row]]
        if not (numbers.size or places or always):
            return
        rows, told, badness = None, None, -np.inf
        if numbers.size:
            rows, row = RowSet.of(numbers + first, self._run_rows), int(numbers[0])
            if one.badness is not None:
                row = int(numbers[np.argmax(one.badness[numbers])])
                badness = float(one.badness[row])
            told = badness if one.told is None else one.told(row)
        marks = [key for key, where in one.marks if where is None or (where & is_own).any()]
        places.sort(key=itemgetter(0))
        shown = tuple(places[:MOST_PLACES])
        found = Found(rows, told, frozenset(marks), shown, len(places))
        here = _Sum(found, badness, one.words)
        key = one.code, one.severity, one.about
        before = self._found.get(key)
        self._found[key] = before.joined(here) if isinstance(before, _Sum) else here

    def found(self) -> list[Diagnostic]:
        """All that are told."""
        return [
            one.words(one.found) if isinstance(one, _Sum) else self._counted(one)
            for one in self._found.values()
        ]

    def _counted(self, one: Diagnostic) -> Diagnostic:
        more = self._left_out.get(one.code, 0)
        if not more or one is not self._told[one.code][-1]:
            return one
        return one._replace(message=f"{one.message} (and {more} more such messages)")


def told(notes: Sequence[Note], first: int, run_rows: int) -> Sequence[Diagnostic]:
    """The messages of a part alone, or of a run that has no others: its first row has the number
    `first` from 0."""
    alone = [one for one in notes if not isinstance(one, RowNote)]
    if len(alone) == len(notes):
        return alone
    every = Notes(run_rows)
    every.add(notes, first)
    return every.found()
