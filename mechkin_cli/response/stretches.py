"""A motion in stretches: free ones, and rests at limits.

A stretch ends at an impact, or where a limit would have to pull, and the next one begins there.
Each is marched in blocks from its beginning, which are handed on and forgotten; of the whole motion
only its impacts are held. So rows that are held are those of the blocks, gathered.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import Span
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.response.impacts import (
    ImpactAt,
    gone_on,
    impact_notes,
    stopped_at_start,
    touched_limit,
)
from mechkin_cli.response.integration import integrate, with_loads
from mechkin_cli.response.jumps import at_jump, before_jump
from mechkin_cli.response.march import (
    RowTimes,
    beginning_of,
    first_row,
    joined,
    marched,
    with_columns,
)
from mechkin_cli.response.report import MotionEnd, under_way
from mechkin_cli.response.resting import RestingMotion, with_contacts
from mechkin_cli.response.rows import block_of, limits_of, run_end

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import Limit, ResponseProblem
    from mechkin_cli.response.integration import Beginning, Rebound
    from mechkin_cli.response.march import Taker
    from mechkin_cli.response.report import MotionReport, MotionRows
    from mechkin_cli.response.resting import Contact
    from mechkin_cli.response.result import ResponseResult
    from mechkin_cli.response.rows import Prepared, RunEnd
    from mechkin_cli.session import Packing
    from mechkin_cli.show import Floats
    from mechkin_cli.units import UnitSystem


class Block(NamedTuple):
    """Some rows of a motion, and the forces of limits at which something rests there."""

    motion: MotionRows
    contacts: Sequence[Contact] = ()


STRETCH_ROWS = 1024
"""Rows of a stretch behind an impact that are integrated before they are handed on: most are short,
and arrays of more rows would be filled for nothing."""


class _Stretch(NamedTuple):
    """A part of a motion that is integrated at once.

    Attributes:
        first: the number of its first row in the response.
        blocks: its rows, numbered from its own first one.
        turns: of cut joints where it begins (slots, 1); None: of the first stretch.
        work: what the impact before it put in and lost (2,).
        begin: its first moment, s.
        held: the stops at which it rests.
        left: those that the stretch before has left.
    """

    first: int
    blocks: Iterator[Block]
    turns: Floats | None = None
    work: tuple[float, float] = (0.0, 0.0)
    begin: float = 0.0
    held: Sequence[int] = ()
    left: Sequence[int] = ()

    def leaves(self, report: MotionReport) -> list[int]:
        """The stops that its coordinates are just leaving, where they have rested."""
        if report.end is not MotionEnd.STOPPED or report.stop not in self.held:
            return []
        return [*(self.left if report.time == self.begin else ()), report.stop]


def integrated_rows(
    together: Sequence[Prepared], packing: Packing, block: int = 0, taker: Taker | None = None
) -> list[MotionRows]:
    """The motions of variants that share what the kernel takes once, as they begin; the `taker` is
    that of `integrate`."""
    first = together[0]
    response = first.response
    times = RowTimes(response.moments, 0, response.rows)
    starts = []
    for one in together:
        assert one.begun is not None
        plan = first.free.plan
        if one is not first:
            # of the same structure: plans of one call share it
            plan = plan.with_constants(one.free.plan.constants).with_size(one.free.plan.size)
        starts.append((plan, one.begun))
    return integrate(
        starts,
        times.row(0),
        times,
        response,
        driven=first.driven,
        packing=packing,
        block=block,
        taker=taker,
    )


class Stretches:
    """A motion that is to be gone through once, from impact to impact.

    Args:
        one: the response.
        packing: how rows are packed.
        rows: of a block.
        moved: its first stretch, where that is known.

    Attributes, of what has been gone through:
        rebounds: the impacts, in order.
        resting: the limits at which something rested, in order, and how many forces are as good as
            theirs.
    """

    def __init__(
        self, one: Prepared, packing: Packing, rows: int, moved: MotionRows | None = None
    ) -> None:
        self._one, self._packing, self._rows, self._moved = one, packing, rows, moved
        self._block = min(rows, STRETCH_ROWS)
        self.rebounds: list[Rebound] = []
        self.resting: dict[Limit, int] = {}
        self._unresolved: ImpactAt | None = None
        self._at_last: tuple[Limit, ...] = ()
        self._met = 0

    def notes(self, units: UnitSystem) -> list[Diagnostic]:
        """What the impacts say."""
        impacts = [one.impact for one in self.rebounds]
        notes = impact_notes(units, impacts, self._at_last)
        if self._unresolved is not None:
            notes += self._unresolved.ends_the_motion(self._met)
        return notes

    def blocks(self) -> Iterator[Block]:
        """The motion in blocks of rows, as they are reached; the report of the last one is that of
        the motion, and the others are under way."""
        gathered = _Gathered(self._one.response, self._rows)
        for piece in self._pieces():
            for contact in piece.contacts:
                most = max(self.resting.get(contact.limit, 0), len(contact.others))
                self.resting[contact.limit] = most
            yield from gathered.add(piece)
        yield gathered.last()

    def _pieces(self) -> Iterator[Block]:
        """The rows of all stretches."""
        one, response = self._one, self._one.response
        stretch = _Stretch(0, self._first_blocks())
        before: MotionRows | None = None
        report: MotionReport | None = None
        turned = put = None
        while True:
            for moved, contacts in stretch.blocks:
                piece = _placed(moved, stretch.first, turned, put)
                if moved.report.is_over:
                    break
                yield Block(piece, contacts)
                before = with_columns(piece, slice(-1, None))
            piece = at_jump(one.chosen, response, piece)
            report = piece.report if report is None else gone_on(report, piece.report)
            piece = replace(piece, report=report)
            following = self._behind(piece, before, stretch.leaves(report))
            if following is None:
                yield Block(before_jump(response, piece), contacts)
                return
            place, rows = report.rows - report.first, following.first - report.first
            assert following.turns is not None
            turned = piece.turns[:, [place]] - following.turns
            put = np.array(following.work)[:, None] + piece.work[:, [place]]
            if rows:
                states = len(piece.states)
                ended = replace(
                    with_columns(piece, slice(rows)), report=under_way(report.first, rows, states)
                )
                yield Block(ended, contacts)
                before = with_columns(ended, slice(-1, None))
            else:
                yield Block(_none_of(piece), contacts)
            stretch = following

    def _first_blocks(self) -> Iterator[Block]:
        one, response = self._one, self._one.response

        def run(block: int, taker: Taker | None) -> MotionRows:
            return integrated_rows([one], self._packing, block, taker)[0]

        known = None if self._moved is None else iter([self._moved])
        for moved in known or marched(run, response.rows, self._rows):
            first = moved
            if not moved.report.first and limits_of(response):
                # it is over where it begins at a limit and goes beyond
                end = run_end(one, moved.report, moved.report.rows)
                row = block_of(one, moved, end, Span(0, 1, response.rows))
                first = stopped_at_start(row, moved)
            yield Block(first)
            if first.report.is_over:
                return

    def _behind(
        self, moved: MotionRows, before: MotionRows | None, left: list[int]
    ) -> _Stretch | None:
        """How it goes on from a limit that has ended a stretch; None where it does not.

        Args:
            moved: the last rows of the stretch.
            before: the row before these.
            left: stops of limits that coordinates are just leaving.
        """
        number = touched_limit(self._one.response, moved)
        if number is None:
            return None
        touch = ImpactAt(self._ended(moved, before), number)
        rows = moved.report.rows
        if rows == self._one.response.rows:
            return None
        self._unresolved = touch
        if self._met == tolerances.MOST_IMPACTS:
            return None
        self._met += 1
        # a limit that lets go gives no impulse
        begun, work = touch.onward, (0.0, 0.0)
        struck = None if left else touch.rebound()
        if struck is not None:
            begun, work = struck.begun, struck.work
        elif not left:
            return None
        start = self._start(begun, touch.time, rows)
        resting = touch.resting(start.chart, left)
        settled: list[int] = []
        while resting is not None and not set(resting.settles) <= set(settled):
            settled = list(dict.fromkeys([*settled, *resting.settles]))
            struck = touch.rebound(settled)
            if struck is None:
                break
            begun, work = struck.begun, struck.work
            start = self._start(begun, touch.time, rows)
            resting = touch.resting(start.chart, left)
        if resting is None or (struck is None and not left):
            return None
        if struck is not None:
            held = touch.limits([*resting.held, *resting.beside])
            impact = struck.impact._replace(held=held)
            self.rebounds.append(struck._replace(impact=impact))
        self._at_last, self._unresolved = touch.limits(resting.held), None
        if not resting.held:
            blocks = self._free_blocks(begun, touch.time, rows)
            return _Stretch(rows, blocks, start.turns, work, touch.time)
        # what began at rest does so in its first row, too
        first = rows - touch.began_resting
        rest = RestingMotion(
            self._one.free,
            self._one.response,
            resting.held,
            resting.beside,
            touch.time,
            begun,
            start.chart.friction[:, 0],
            self._packing,
        )
        moments = self._one.response.moments
        start = rest.start(moments)
        onward = rest.onward(moments, first, start, self._block)
        blocks = (Block(*each) for each in onward)
        return _Stretch(first, blocks, start.turns, work, touch.time, resting.held, left)

    def _ended(self, moved: MotionRows, before: MotionRows | None) -> ResponseResult:
        """The row at which a limit has ended a stretch."""
        end = run_end(self._one, moved.report, moved.count)
        row = end.rows - 1
        column = row - moved.report.first
        own = before if column < 0 else with_columns(moved, [column])
        assert own is not None
        return block_of(self._one, own, end, Span(row, 1, end.rows))

    def _begins(self, time: float, row: int) -> float:
        """The moment from which on a motion is integrated that begins so long before a row."""
        first = RowTimes(self._one.response.moments, row, 1).row(0)
        return time if first - time > tolerances.SAME_MOMENT * abs(first) else first

    def _start(self, begun: Beginning, time: float, row: int) -> MotionRows:
        """Where a free motion begins, of which a row comes next."""
        begin = self._begins(time, row)
        times = beginning_of(begin, self._one.response.moments)
        return first_row(lambda block, taker: self._onward(begun, begin, times, block, taker))

    def _free_blocks(self, begun: Beginning, time: float, row: int) -> Iterator[Block]:
        """The free motion from a moment on, over the rows from a number on. Where no step resolves
        the way to the first of them, as one of a few roundings of the time, it begins there."""
        moments = self._one.response.moments
        times = RowTimes(moments, row, moments.rows - row)
        begin, first = self._begins(time, row), times.row(0)

        def run(block: int, taker: Taker | None) -> MotionRows:
            return self._onward(begun, begin, times, block, taker)

        for moved in marched(run, times.rows, self._block):
            if begin < first and moved.report.end is MotionEnd.STUCK and not moved.report.rows:
                fastest = float(np.max(np.abs(begun.first), initial=0.0))
                if (first - begin) * fastest <= tolerances.IMPACT_PLACE:
                    begin = first
                    yield from map(Block, marched(run, times.rows, self._block))
                    return
            yield Block(moved)

    def _onward(
        self,
        begun: Beginning,
        begin: float,
        times: Floats | RowTimes,
        block: int,
        taker: Taker | None,
    ) -> MotionRows:
        one = self._one
        (found,) = integrate(
            [(one.free.plan, begun)],
            begin,
            times,
            one.response,
            driven=one.driven,
            packing=self._packing,
            block=block,
            taker=taker,
        )
        return found


def _placed(moved: MotionRows, first: int, turned: Floats | None, put: Floats | None) -> MotionRows:
    """Rows of a stretch by their numbers in the response, with the turns and the work up to its
    beginning."""
    report = moved.report._replace(first=moved.report.first + first, rows=moved.report.rows + first)
    if turned is None or put is None:
        return replace(moved, report=report)
    return replace(moved, report=report, turns=moved.turns + turned, work=moved.work + put)


def _none_of(moved: MotionRows) -> MotionRows:
    report = under_way(moved.report.first, 0, len(moved.states))
    return replace(with_columns(moved, slice(0)), report=report)


class _Gathered:
    """Rows of stretches as blocks of so many."""

    def __init__(self, response: ResponseProblem, rows: int) -> None:
        self._moments, self._rows = response.moments, rows
        self._pieces: list[MotionRows] = []
        self._contacts: list[Contact] = []
        self._first = self._count = 0
        self._over: MotionReport | None = None

    def add(self, piece: Block) -> Iterator[Block]:
        """Adds rows, and gives the blocks that are full."""
        moved, contacts = piece
        self._contacts += contacts
        report, at = moved.report, 0
        count = report.rows - report.first
        while self._count + count - at > self._rows:
            taken = self._rows - self._count
            if taken:
                self._pieces.append(with_columns(moved, slice(at, at + taken)))
            at += taken
            yield self._full()
        self._count += count - at
        if report.is_over:
            self._over = report
            self._pieces.append(with_columns(moved, slice(at, None)) if at else moved)
        elif count > at:
            self._pieces.append(with_columns(moved, slice(at, None)) if at else moved)
            if self._count == self._rows:
                yield self._full()

    def _full(self) -> Block:
        pieces, rows = self._pieces, self._rows
        found = joined(pieces, under_way(self._first, rows, len(pieces[0].states)))
        block = Block(found, tuple(self._contacts))
        self._first, self._count, self._pieces = self._first + rows, 0, []
        if self._contacts:
            last = RowTimes(self._moments, self._first, 0).row(-1)
            self._contacts = [one for one in self._contacts if one.times[-1] > last]
        return block

    def last(self) -> Block:
        """The rows behind the last full block."""
        assert self._over is not None
        report = self._over._replace(first=self._first)
        found = joined(self._pieces, report, self._rows + 1)
        return Block(found, tuple(self._contacts))


def result_of(
    one: Prepared, block: Block, end: RunEnd, place: Span, resting: dict[Limit, int]
) -> ResponseResult:
    """Some rows of a motion with their verdicts, before anything is read, under the forces of the
    limits at which something rests in the motion."""
    result = block_of(one, block.motion, end, place)
    if not resting:
        return result
    moving = result.problem.motion.time
    assert moving is not None
    result, *others = (
        block_of(
            _loaded(
                one,
                with_contacts(one.response, block.contacts, resting, moving.values, number),
            ),
            block.motion,
            end,
            place,
        )
        for number in (None, *range(max(resting.values())))
    )
    result.take_others([(each.session, each.response) for each in others])
    return result


def _loaded(one: Prepared, response: ResponseProblem) -> Prepared:
    """With the forces of limits that a response has among its efforts."""
    problem, mechanism = one.free.problem, one.free.problem.mechanism
    loads = (*mechanism.loads, *response.efforts[len(one.response.efforts) :])
    problem = replace(
        problem,
        mechanism=replace(mechanism, loads=loads),
        load_laws=response.load_laws,
        response=response,
    )
    return replace(one, response=response, free=with_loads(one.free, problem))


def gathered(one: Prepared, packing: Packing, moved: MotionRows | None = None) -> ResponseResult:
    """All rows of a response, before anything is read; `moved` is its first stretch, where that is
    known."""
    stretches = Stretches(one, packing, one.response.rows, moved)
    (block,) = stretches.blocks()
    end = run_end(one, block.motion.report, block.motion.count)
    result = result_of(one, block, end, Span(0, end.rows, end.rows), stretches.resting)
    result.rebounds = tuple(stretches.rebounds)
    result.row_states.diagnostics += stretches.notes(result.units)
    return result
