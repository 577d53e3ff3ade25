"""Long sweeps in parts: each is followed from a row of the part before it, closed and judged by
itself, so that a run of any length needs the memory of one part.

Neighbouring parts share one row, the border. It is one that is clear of singular places, so that
where the inputs turn back at a dead centre both sides of it lie in one part; and where the branch
ends, the part goes on until the inputs have left that place, behind which nothing leads back. Rows
before the one of the first assembly are followed back first, from border to border; each of their
parts is then followed once more from its later border, in the order of the rows.

How a run is cut depends on its rows and on the mechanism alone, never on what is asked for, nor on
how many rows are taken at a time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import LongRun
from mechkin_cli.memo import remembered
from mechkin_cli.plan import Demand
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.row_notes import Notes
from mechkin_cli.session import Ask, RowInputs, turn_count
from mechkin_cli.sweep.following import follow_rows, turns_before
from mechkin_cli.sweep.retracing import closed
from mechkin_cli.verdict import Status, are

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.row_notes import Note
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep.result import Result
    from mechkin_cli.sweep.rows import SweepRows

Judge = Callable[["Session", "AssemblyStart", "SweepRows | None"], "Result"]
"""Closes and judges the rows of a session; they are followed from the assembly if they are None."""

SAMPLES = 33
"""Rows of the second half of a part among which a border is looked for."""


class Part(NamedTuple):
    """A part of a run: its rows, closed and judged, and which of them are in no part before it."""

    result: Result
    own: slice


class _Border(NamedTuple):
    """A row of the run at which parts meet: states (states,), turns (turn slots,) and signs of
    quaternions there."""

    row: int
    state: Floats
    turn: Floats | None = None
    signs: Mapping[str, float] = {}


class _Followed(NamedTuple):
    """A part before it is closed: the row at which it ends, and whether the branch is lost before
    that for good."""

    session: Session
    start: AssemblyStart
    rows: SweepRows
    end: int
    lost: bool


@remembered
def part_rows(session: Session) -> int:
    """Rows of a part at most: fewer of large mechanisms, so that parts need about one memory."""
    numbers = session.layout.states + turn_count(session.plan)
    rows = tolerances.PART_ROWS
    while rows > tolerances.LEAST_PART_ROWS and rows * numbers > tolerances.PART_NUMBERS:
        rows //= 2
    return rows


def has_parts(session: Session) -> bool:
    """Whether a run has several parts: it is long, and the numbers of its rows are made as they are
    wanted where they are the pairs of a grid."""
    motion = session.problem.motion
    if motion.grid is not None and not isinstance(motion, LongRun):
        return False
    return motion.rows > tolerances.WHOLE_PARTS * part_rows(session) + 1


def parts_of(session: Session, start: AssemblyStart, judge: Judge) -> Iterator[Part]:
    """The parts of a long run in the order of its rows."""
    if session.problem.motion.grid is None:
        return _Walk(session, start, part_rows(session), judge).parts()
    return _WalkOfLines(session, start, part_rows(session), judge).parts()


class _Walk:
    """Goes along the rows of a run from border to border."""

    def __init__(self, session: Session, start: AssemblyStart, size: int, judge: Judge) -> None:
        self.session, self.start, self.size, self.judge = session, start, size, judge
        self.last = session.problem.motion.rows - 1

    def parts(self) -> Iterator[Part]:
        """All parts."""
        start = self.start
        if start.state is None:
            yield from self._empty(0, self.last, start.status)
            return
        border = _Border(start.row, start.state)
        if start.row > 0:
            borders, first, lost = self._back(border)
            if lost is not None:
                yield from self._empty(0, first - 1, lost)
            signs: Mapping[str, float] = {}
            for border in reversed(borders):
                part, begin = self._between(border._replace(signs=signs), first)
                result = self.judge(part, begin, None)
                yield Part(result, slice(0, result.rows - 1))
                signs, first = _signs(result, result.rows - 1), border.row
                del part, result
            border = border._replace(signs=signs)
        yield from self._onward(border)

    def _onward(self, border: _Border) -> Iterator[Part]:
        """The parts from a border to the end of the run."""
        done = border.row - 1  # the last row that some part has
        while done < self.last:
            found = self._followed(border, max(done, border.row), 1)
            result = self.judge(found.session, found.start, found.rows)
            yield Part(result, slice(done + 1 - border.row, result.rows))
            done = found.end
            if found.lost:
                status = Status(int(found.rows.status[-1]))
                yield from self._empty(done + 1, self.last, status)
                return
            # a row that did not close is no border
            place = int(np.flatnonzero(result.row_states.reached)[-1])
            rows = result.row_states
            state, turn = rows.states[:, place].copy(), rows.turns[:, place].copy()
            border = _Border(border.row + place, state, turn, _signs(result, place))
            del found, result, rows  # one part at a time is in memory

    def _back(self, border: _Border) -> tuple[list[_Border], int, Status | None]:
        """The borders from the row of the first assembly back, with turns that count from the first
        row; the row at which the part behind the last of them begins, and the status of rows before
        it, if the branch is lost there."""
        borders: list[_Border] = []
        while True:
            found = self._followed(border, border.row, -1)
            rows = found.rows
            if border.turn is None:
                border = border._replace(turn=np.ascontiguousarray(rows.turns[:, -1]))
            borders.append(border)
            if found.lost or found.end == 0:
                break
            state = closed(found.session, rows, 0)
            border = _Border(found.end, state, np.ascontiguousarray(rows.turns[:, 0]))
        off = turns_before(found.session, rows, int(np.argmax(rows.reached)))
        counted = [one._replace(turn=np.asarray(one.turn) - off) for one in borders]
        return counted, found.end, Status(int(rows.status[0])) if found.lost else None

    def _followed(self, border: _Border, done: int, step: int) -> _Followed:
        """The rows from a border to the next one, or to the end of the run; beyond a row that is
        `done`."""
        size, ended = self.size, None
        while True:
            end = done + step * size if ended is None else ended
            end = min(max(end, 0), self.last)
            found = self._along(border, end)
            if end in (0, self.last) or ended is not None:
                return found._replace(end=end)
            ordered = found.rows.part(slice(None, None, step))
            if not ordered.reached[-1]:
                if _is_lost(found.session, ordered):
                    return found._replace(lost=True)
                size *= 2
                continue
            # rows that other parts have are no border
            place = _border(found.session, ordered, abs(done - border.row) + 1)
            ended = border.row + step * place
            if ended == end:
                return found

    def _along(self, border: _Border, end: int) -> _Followed:
        part, start = self._between(border, end)
        return _Followed(part, start, follow_rows(part, start), end, False)

    def _between(self, border: _Border, end: int) -> tuple[Session, AssemblyStart]:
        """The rows from a border to another row, and the border as their first assembly."""
        first, last = sorted((border.row, end))
        return self._from(border, first, last)

    def _from(self, border: _Border, first: int, last: int) -> tuple[Session, AssemblyStart]:
        """Rows from one to another, both included, and a border among them as their first
        assembly."""
        start = replace(
            self.start,
            state=border.state,
            row=border.row - first,
            turn=border.turn,
            signs=border.signs,
            diagnostics=[],
        )
        return self.session.part(first, last), start

    def _empty(self, first: int, last: int, status: Status) -> Iterator[Part]:
        """The parts of rows that are not reached."""
        start = replace(self.start, state=None, status=status, diagnostics=[], row=0)
        for row in range(first, last + 1, self.size):
            part = self.session.part(row, min(row + self.size - 1, last))
            result = self.judge(part, start, None)
            yield Part(result, slice(0, result.rows))


class _WalkOfLines(_Walk):
    """Goes along the lines of a grid: parts are some of them, and neighbouring parts share one."""

    def __init__(self, session: Session, start: AssemblyStart, size: int, judge: Judge) -> None:
        grid = session.problem.motion.grid
        assert grid is not None
        self.lines, self.width = grid
        self.ahead = max(size // self.width, 1)  # lines of a part behind its first
        super().__init__(session, start, self.ahead * self.width, judge)

    def parts(self) -> Iterator[Part]:
        """All parts."""
        start = self.start
        if start.state is None:
            yield from self._empty(0, self.last, start.status)
            return
        border = _Border(start.row, start.state)
        line = start.row // self.width
        if line > 0:
            borders, lost = self._back_from(border)
            first = self._first_of(borders[-1])
            if lost is not None and first > 0:
                yield from self._empty(0, first * self.width - 1, lost)
            signs: Mapping[str, float] = {}
            for one in reversed(borders):
                last = one.row // self.width
                part, begin = self._of_lines(one._replace(signs=signs), first, last)
                result = self.judge(part, begin, None)
                yield Part(result, slice(0, result.rows - self.width))
                signs, first = self._signs_of_line(result, last - first), last
                del part, result
            border = borders[0]._replace(signs=signs)
        yield from self._onward(border)

    def _onward(self, border: _Border) -> Iterator[Part]:
        """The parts from the line of a border to the last line."""
        line = border.row // self.width
        done = line * self.width - 1
        while done < self.last:
            end = min(line + self.ahead, self.lines - 1)
            part, begin = self._of_lines(border, line, end)
            result = self.judge(part, begin, None)
            yield Part(result, slice(done + 1 - line * self.width, result.rows))
            done = (end + 1) * self.width - 1
            found = self._border_in(result, line, end)
            if found is None:
                yield from self._empty(done + 1, self.last, Status(int(result.status[-1])))
                return
            border, line = found, end
            del part, result

    def _back_from(self, border: _Border) -> tuple[list[_Border], Status | None]:
        """The borders from that of the first assembly back, with turns that count from the first
        row; the status of the lines before those of the last border, if these are not reached."""
        borders: list[_Border] = []
        while True:
            line = border.row // self.width
            first = self._first_of(border)
            part, begin = self._of_lines(border, first, line)
            rows = follow_rows(part, begin)
            if border.turn is None:
                place = border.row - first * self.width
                border = border._replace(turn=np.ascontiguousarray(rows.turns[:, place]))
            borders.append(border)
            near = rows.reached[: self.width]
            if first == 0 or not near.any():
                break
            place = self._arrival(near, rows.arrivals[0])
            turn = np.ascontiguousarray(rows.turns[:, place])
            border = _Border(first * self.width + place, closed(part, rows, place), turn)
        off = turns_before(part, rows, int(np.argmax(rows.reached)))
        counted = [one._replace(turn=np.asarray(one.turn) - off) for one in borders]
        return counted, None if near.any() else Status(int(rows.status[0]))

    def _first_of(self, border: _Border) -> int:
        """The first line of the part that ends with that of a border."""
        return max(border.row // self.width - self.ahead, 0)

    def _of_lines(self, border: _Border, first: int, last: int) -> tuple[Session, AssemblyStart]:
        """Lines from one to another, both included, and the border as their first assembly."""
        return self._from(border, first * self.width, (last + 1) * self.width - 1)

    def _border_in(self, result: Result, first: int, last: int) -> _Border | None:
        """The row of the last line of a part from which the next one goes on; None where none is
        reached."""
        rows, begin = result.row_states, (last - first) * self.width
        reached = rows.reached[begin:]
        if not reached.any():
            return None
        place = begin + self._arrival(reached, rows.arrivals[1])
        state, turn = rows.states[:, place].copy(), rows.turns[:, place].copy()
        signs = self._signs_of_line(result, last - first)
        return _Border(first * self.width + place, state, turn, signs)

    def _signs_of_line(self, result: Result, line: int) -> dict[str, float]:
        """The signs of quaternions in the first row of a line that is reached."""
        begin = line * self.width
        reached = result.row_states.reached[begin : begin + self.width]
        return _signs(result, begin + int(np.argmax(reached)))

    def _arrival(self, reached: NDArray[np.bool_], row: int) -> int:
        """The place in a line of the row at which it was come to, or what is reached next to it."""
        places = np.flatnonzero(reached)
        return int(places[np.argmin(np.abs(places - row % self.width))])


def _signs(result: Result, row: int) -> dict[str, float]:
    """The signs of quaternions in a row."""
    return {name: float(signs[row]) for name, signs in result.row_states.signs.items()}


def _is_lost(session: Session, rows: SweepRows) -> bool:
    """Whether the branch has ended for good: the inputs have gone farther from its end than a place
    at which they may turn back. `rows` are in the order in which they were followed."""
    values = session.inputs.values[:, rows.numbers]
    place = int(np.flatnonzero(rows.reached)[-1])
    off = np.abs(values[:, place + 1 :] - values[:, place : place + 1]).max(axis=0, initial=0.0)
    return bool((off > off[0] + tolerances.BEFORE_DEAD_CENTRE[0]).any())


def _border(session: Session, rows: SweepRows, least: int) -> int:
    """The row at which a part ends: the last one, or where that is next to a singular place another
    of the second half, from the row `least` on. `rows` are in the order in which they were
    followed."""
    last = rows.reached.size - 1
    if not session.graph.blocks:
        return last
    sample = np.unique(np.linspace(max(least, last // 2), last, SAMPLES).astype(np.intp))
    sample = sample[rows.reached[sample]]
    inputs = np.ascontiguousarray(session.inputs.reduced[:, rows.numbers[sample]])
    states = np.ascontiguousarray(rows.states[:, sample])
    condition = session.run(RowInputs(inputs, states), Ask(Demand.CONDITION)).condition
    assert condition is not None
    condition = np.nan_to_num(condition, nan=np.inf)
    best = int(np.argmin(condition))
    if condition[-1] <= tolerances.BORDER_CONDITION * condition[best]:
        return last
    return int(sample[best])


# What parts have, as the run has it.


class RunVerdicts:
    """The verdicts on the rows of a run, added part by part: how many there are, and how many of
    each status in the order in which they come first; the worst measures; whether all rows have a
    solution with all that it needs, and whether all are `ok`."""

    def __init__(self) -> None:
        self.rows = self.solved = 0
        self.counts: dict[Status, int] = {}
        self.worst: dict[str, float] = {}
        self.complete = self.sound = True

    @classmethod
    def of(cls, result: Result) -> RunVerdicts:
        """Of a run whose rows are held."""
        found = cls()
        found.add(result, slice(0, result.rows))
        return found

    def add(self, result: Result, own: slice) -> None:
        """Adds the rows of a part."""
        status = result.status[own]
        self.rows += status.size
        self.solved += int(np.count_nonzero(result.solved[own]))
        # most parts have one status; to sort them takes as long as to close a tenth of their rows
        while status.size:
            code = Status(int(status[0]))
            others = status[~are(status, code)]
            self.counts[code] = self.counts.get(code, 0) + status.size - others.size
            status = others
        self.complete &= result.complete
        self.sound &= result.sound
        self.measure("residual", result.residual[own])
        self.measure("power error", result.power_error[own])
        self.measure("condition", result.condition[own])

    def measure(self, name: str, values: Floats) -> None:
        """Adds a measure of some rows (rows,)."""
        cells, infinite, largest, _ = _kernel.extremes(np.ascontiguousarray(values))
        if infinite:
            cells, _, largest, _ = _kernel.extremes(values[np.isfinite(values)])
        if cells:
            self.worst[name] = max(self.worst.get(name, 0.0), largest)


def joined_rows(parts: Sequence[Part], session: Session) -> SweepRows:
    """The rows of all parts as those of one run."""
    from mechkin_cli.sweep.rows import SweepRows

    found = [(part.result.row_states, part.own) for part in parts]
    motion = session.problem.motion
    rows = SweepRows(
        states=_joined([each.states[:, own] for each, own in found]),
        limit=_joined([each.limit[own] for each, own in found]),
        reached=_joined([each.reached[own] for each, own in found]),
        status=_joined([each.status[own] for each, own in found]),
        nodes=sum(each.nodes for each, _ in found),
        diagnostics=_merged(found, motion.rows),
        numbers=np.arange(motion.rows),
        turns=_joined([each.turns[:, own] for each, own in found]),
        section=_joined([each.section[own] for each, own in found]),
        ends=[],
        span=found[0][0].span._replace(first=0, rows=motion.rows),
    )
    for each, own in found:
        first = each.span.first
        rows.ends += [(row + first, ending) for row, ending in each.ends]
        begin = own.indices(each.reached.size)[0]
        rows.dead_centres += [
            place._replace(row=place.row + first)
            for place in each.dead_centres
            if begin <= place.row
        ]
    return rows


def _merged(parts: Sequence[tuple[SweepRows, slice]], run_rows: int) -> list[Note]:
    merged = Notes(run_rows)
    for rows, own in parts:
        merged.add(rows.diagnostics, rows.span.first, own)
    return [*merged.found()]


Scalar = TypeVar("Scalar", bound=np.generic)


def _joined(arrays: Sequence[NDArray[Scalar]]) -> NDArray[Scalar]:
    return np.ascontiguousarray(np.concatenate(arrays, axis=-1))
