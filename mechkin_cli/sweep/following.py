"""The rows of a sweep followed along the inputs from the first assembly, and why they end."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import GROUND_NAME, Mechanism, Problem, Wanted
from mechkin_cli.memo import remembered
from mechkin_cli.plan import TrackEnd, needs_all_links
from mechkin_cli.record import replace
from mechkin_cli.session import ORIENTATION, turn_count
from mechkin_cli.structure import SolverGraph
from mechkin_cli.sweep.retracing import (
    BranchPlace,
    SingularPlace,
    closed,
    retraced,
    straight_to,
    unclear_rows,
)
from mechkin_cli.sweep.rows import SweepRows
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.mechanism import Rest
    from mechkin_cli.session import Followed, Session
    from mechkin_cli.show import Floats

_LINE_SECTIONS = 1 << 20
"""Sections of a line of a grid at most."""


def follow_rows(session: Session, start: AssemblyStart, *, every_row: bool = False) -> SweepRows:
    """Guesses for the rows on the branch through the start, onward and backward from its row; of a
    grid line by line.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    motion = session.problem.motion
    grid, span = motion.grid, motion.span
    if start.state is None:
        rows = _unknown_rows(session)
        rows.status[:] = start.status
        return rows
    first = None if grid is not None else _first_row(session, start, every_row)
    turn = start.turn
    if grid is not None:
        rows = _Lines(session, grid[1], every_row).follow(start)
    elif first is not None:
        followed = session.follow_rows(first, every_row=every_row, turn=turn)
        rows = SweepRows.followed(followed, span)
        explain_way(session, followed, rows, every_row)
    else:
        rows = _unknown_rows(session)
        for step in (-1, 1):
            followed = session.follow_rows(
                start.state, start.row, step, every_row=every_row, turn=turn
            )
            part = rows.part(slice(start.row, None, step))
            part.take(followed, 0)
            part.section *= step
            explain_way(session, followed, part, every_row)
            rows.nodes += part.nodes + followed.steps
    if turn is None:
        count_from_first(session, rows)
    rows.signs_before = start.signs
    if motion.rest is not None:
        _end_rest(rows, motion.rest)
    return rows


def _end_rest(rows: SweepRows, rest: Rest) -> None:
    """Leaves out the rows in which no place was found at which the loads balance."""
    rows.diagnostics += rest.notes
    count = rows.reached.size
    sides = slice(0, rest.first), slice(rest.last + 1, count)
    for beyond, (status, why) in zip(sides, rest.ends, strict=False):
        if status != Status.ok and rows.reached[beyond].any():
            rows.reached[beyond] = False
            rows.status[beyond] = status
            rows.diagnostics.append(why)


def _unknown_rows(session: Session) -> SweepRows:
    """The rows of a session before they are followed."""
    motion = session.problem.motion
    sizes = (session.layout.states, turn_count(session.plan), session.inputs.values.shape[1])
    return SweepRows.without_guesses(*sizes, motion.span)


class _Lines:
    """The rows of a grid while they are followed: lines of a width, on which only the fast of two
    inputs moves.

    One line after the other is followed both ways from a row that is reached straight from the line
    before, so that the end of the branch on one line does not end the others.
    """

    def __init__(self, session: Session, width: int, every_row: bool) -> None:
        self.session, self.width, self.every_row = session, width, every_row
        self.lines = session.inputs.values.shape[1] // width
        self.rows = _unknown_rows(session)

    def follow(self, start: AssemblyStart) -> SweepRows:
        """All rows, from the assembly at its row on."""
        assert start.state is not None
        self._along(start.row, start.state, start.turn)
        first = start.row // self.width
        onward = self._from_line(start.row, range(first + 1, self.lines), 1)
        back = self._from_line(start.row, range(first - 1, -1, -1), -1)
        self.rows.arrivals = back, onward
        from mechkin_cli.sweep.branch_end import without_repeats

        span = self.rows.span
        ends = [one for one in self.rows.diagnostics if isinstance(one, Diagnostic)]
        if span.rows == span.run_rows:  # else they are counted with those of all parts
            ends = [*without_repeats(ends)]
        self.rows.diagnostics = [*ends]
        return self.rows

    def _from_line(self, row: int, lines: range, step: int) -> int:
        """Follows lines, one from the other, the first from that of a row; the row at which the
        last one that is reached was come to."""
        for line in lines:
            found = self._onto(line, row, step)
            if found is None:
                self._explain(line, step)
                break
            row = found
        return row

    def _along(self, row: int, state: Floats, turn: Floats | None) -> None:
        """Follows the line of a row from there both ways."""
        first = row - row % self.width
        for step, last in ((-1, first), (1, first + self.width - 1)):
            followed = self.session.follow_rows(
                state, row, step, every_row=self.every_row, turn=turn, last=last
            )
            end = last + step
            part = self.rows.part(slice(row, end if end >= 0 else None, step))
            part.take(followed, 0)
            part.section *= step
            part.nodes += followed.steps
            explain_way(self.session, followed, part, self.every_row)
            self.rows.nodes = part.nodes
        if self.session.problem.assembly.straight:
            # sides are compared within a section: a line has its own
            self.rows.section[first : first + self.width] += _LINE_SECTIONS * first

    def _onto(self, line: int, near: int, step: int) -> int | None:
        """Follows a line from the row next to that of the line before which lies nearest to `near`
        and leads there; the row, None where none does."""
        for row in self._reached(line - step, near):
            to = int(row) + step * self.width
            inputs = np.ascontiguousarray(self.session.inputs.values[:, to])
            found = straight_to(self.session, self._place(int(row)), inputs)
            if found is not None:
                self._along(to, found.state, found.turn)
                return to
        return None

    def _reached(self, line: int, near: int) -> NDArray[np.intp]:
        """The rows of a line that are reached, in the order of their distance from one's column."""
        rows = np.arange(line * self.width, (line + 1) * self.width)
        rows = rows[self.rows.reached[rows]]
        return rows[np.argsort(np.abs(rows % self.width - near % self.width), kind="stable")]

    def _place(self, row: int) -> BranchPlace:
        inputs = np.ascontiguousarray(self.session.inputs.values[:, row])
        turn = np.ascontiguousarray(self.rows.turns[:, row])
        return BranchPlace(inputs, closed(self.session, self.rows, row), turn)

    def _explain(self, line: int, step: int) -> None:
        """Says why no row of a line is reached, and gives it and those behind it their status."""
        from mechkin_cli.sweep.branch_end import explain_end

        reached = np.sort(self._reached(line - step, 0))
        row = int(reached[-1 if step > 0 else 0])
        start = self._place(row)
        to = self.session.inputs.values[:, row + step * self.width]
        path = np.stack([start.inputs, to], axis=1)
        followed = self.session.follow(path, start.state, every_row=True)
        rest = self.rows.part(slice(row, None, step))
        values = np.ascontiguousarray(self.session.inputs.values[:, rest.numbers])
        explain_end(self.session, values, followed, rest)


def explain_way(session: Session, followed: Followed, rows: SweepRows, every_row: bool) -> None:
    """Goes on where the inputs turn back at a dead centre or a branch point; says which branch
    points were passed, at which places the inputs turn back, and what ended the branch, if it
    ended. `rows` are in the order in which they were followed."""
    turning = _turning(session, int(rows.numbers[0]), int(rows.numbers[-1]))
    if not (turning.size or followed.crossings or followed.end != TrackEnd.FINISHED):
        return
    from mechkin_cli.sweep import branch_end

    values = np.ascontiguousarray(session.inputs.values[:, rows.numbers])
    touched: list[SingularPlace] = []
    passed: list[tuple[int, Floats]] = []
    first, way = 0, followed
    onward: Followed | None = followed
    while onward is not None:
        way = onward
        within = turning[(turning > first) & (turning < first + way.reached - 1)]
        ends = [
            way._replace(
                reached=row + 1 - first, end=TrackEnd.STALLED, inputs=values[:, row], ending=None
            )
            for row in unclear_rows(session, rows, within)
        ]
        ends += [way] if way.end != TrackEnd.FINISHED else []
        tried = (retraced(session, rows, end, first, every_row=every_row) for end in ends)
        found = next((one for one in tried if one is not None), None)
        if found is None:
            break
        place, onward, behind = found
        touched.append(place)
        # a branch point at which the inputs turn back is not passed
        passed += [
            (first + row, inputs)
            for row, inputs in way.crossings
            if first + row < behind and not place.is_at(inputs)
        ]
        first = behind
    if first < rows.numbers.size:
        passed += [(first + row, inputs) for row, inputs in way.crossings]
    rows.diagnostics += branch_end.retraced_notes(session, rows, touched)
    if passed:
        rows.diagnostics.append(branch_end.crossing_note(session, rows, passed))
    rest = rows.part(slice(first, None))
    if way.end != TrackEnd.FINISHED and not rest.reached.all():
        path = np.ascontiguousarray(values[:, first:])
        branch_end.explain_end(session, path, way, rest)


@remembered
def _turning(session: Session, first: int, last: int) -> NDArray[np.intp]:
    """Of the rows from one to another the numbers of those at which the inputs turn back, counted
    from the first."""
    step = 1 if last >= first else -1
    values = session.inputs.values[:, first : last + 1] if step > 0 else _back(session, first, last)
    if all(_goes_one_way(value) for value in values):
        return np.empty(0, np.intp)
    moved = np.flatnonzero((values[:, 1:] != values[:, :-1]).any(axis=0))
    along = np.zeros(max(moved.size - 1, 0))
    for value in values:
        way = value[moved + 1] - value[moved]
        along = along + way[1:] * way[:-1]
    return moved[1:][along < 0.0]


def _back(session: Session, first: int, last: int) -> Floats:
    return session.inputs.values[:, np.arange(first, last - 1, -1)]


def _goes_one_way(values: Floats) -> bool:
    """Whether no value is on the other side of the one before it than some other is."""
    _, _, most, least = _kernel.extremes(values[1:] - values[:-1])
    return most <= 0.0 or least >= 0.0


def _first_row(session: Session, start: AssemblyStart, every_row: bool) -> Floats | None:
    """The states of the first row where all rows are followed from it: where it is the start, and
    where a way of whole turns leads back to it, so that one turn serves them all."""
    if start.row == 0 or start.state is None:
        return start.state
    if start.turn is not None or session.route is not None:
        return None
    if not np.ptp(session.inputs.whole, axis=1).any():
        return None
    back = session.follow_rows(start.state, start.row, -1, every_row=every_row)
    return back.guess[:, -1] if back.end == TrackEnd.FINISHED else None


def count_from_first(session: Session, rows: SweepRows) -> None:
    """Turns count from the first row, whose angles lie in (-180, 180] degrees."""
    first = int(rows.reached.argmax())
    if rows.reached[first]:
        rows.turns -= turns_before(session, rows, first)[:, None]


def turns_before(session: Session, rows: SweepRows, first: int) -> Floats:
    """What counts too much of turns (turn slots,), if they are to count from the row `first`, whose
    angles lie in (-180, 180] degrees."""
    off = np.zeros(rows.turns.shape[0])
    # half a turn is +180, whichever side of it rounding has
    for state, slot in session.structure.tree_slots.items():
        below = rows.states[state, first] <= tolerances.HALF_TURN_SIDE - pi
        off[slot] = rows.turns[slot, first] - (1.0 if below else 0.0)
    for (_, freedom), slot in session.structure.closing_slots.items():
        if freedom != ORIENTATION:
            beyond = rows.turns[slot, first] - pi - tolerances.HALF_TURN_SIDE
            off[slot] = float(np.ceil(beyond / (2.0 * pi))) * (2.0 * pi)
    return off


# `follow:` - the loops that a run follows, where the file does not want all of them.
#
# Without it every loop is followed and the verdict covers the whole mechanism. With it the loops
# that no quantity asked for depends on, and that no joint listed lies in, are left out with their
# links (format 1, `follow`). Forces depend on every loop.


def followed_session(session: Session, wanted: Iterable[Wanted]) -> Session:
    """The session of the loops that are followed; the same one if that is all of them."""
    problem, wanted = session.problem, list(wanted)
    if problem.follow is None or needs_all_links(problem.mechanism, wanted):
        return session
    needed = _needed_blocks(problem, session.graph, wanted)
    left_out = tuple(b for b in range(len(session.graph.blocks)) if b not in needed)
    return _without_blocks(session, left_out) if left_out else session


@remembered
def _without_blocks(session: Session, left_out: tuple[int, ...]) -> Session:
    return session.derived(lambda whole: _part(whole.problem, whole.graph, left_out))


def _part(problem: Problem, graph: SolverGraph, left_out: Sequence[int]) -> Problem:
    mechanism = _without(problem.mechanism, graph, left_out)
    note = _note(graph, left_out)
    near = {k: v for k, v in problem.assembly.near.items() if k in mechanism.coordinates}
    return replace(
        problem,
        mechanism=mechanism,
        held=tuple(one for one in problem.held if one.is_in(mechanism)),
        assembly=replace(problem.assembly, near=near),
        diagnostics=(*problem.diagnostics, note),
    )


def _needed_blocks(problem: Problem, graph: SolverGraph, wanted: list[Wanted]) -> set[int]:
    """Blocks that place something asked for, and those that they depend on."""
    owner = {f: b for b, block in enumerate(graph.blocks) for f in block.unknowns}
    carrier = {edge.child: k for k, edge in enumerate(graph.edges)}
    hangs = _hanging_blocks(graph)

    def blocks_of(link: str) -> set[int]:
        found = set()
        while link != GROUND_NAME:
            k = carrier[link]
            edge = graph.edges[k]
            found |= {owner[k, f] for f in range(edge.freedoms) if (k, f) in owner}
            if edge.hung:
                found.add(hangs[link])
            link = edge.parent
        return found

    links = {link for quantity in wanted for link in _links_of(problem.mechanism, quantity)}
    needed = {b for link in links for b in blocks_of(link)}
    for b, block in enumerate(graph.blocks):
        joints = {graph.edges[k].joint.name for k in graph.passed(block)}
        joints |= {graph.closings[c].name for c in block.closings}
        if joints & set(problem.follow or ()):
            needed.add(b)
    front = list(needed)
    for b in front:
        for c in graph.blocks[b].closings:
            placed = graph.closings[c].placed
            more = {b for link in placed for b in blocks_of(link)} - needed
            needed |= more
            front += more
    return needed


def _hanging_blocks(graph: SolverGraph) -> dict[str, int]:
    """The block whose closings place each link that hangs between two points."""
    return {
        link: b
        for b, block in enumerate(graph.blocks)
        for c in block.closings
        for link in graph.closings[c].links
    }


def _links_of(mechanism: Mechanism, quantity: Wanted) -> tuple[str, ...]:
    if quantity.owner in mechanism.joints:
        joint = mechanism.joints[quantity.owner]
        return (joint.first, joint.second)
    for named in (mechanism.points, mechanism.directions):
        if quantity.owner in named:
            return (named[quantity.owner].link,)
    return (quantity.owner,) if quantity.owner in mechanism.links else ()


def _without(mechanism: Mechanism, graph: SolverGraph, left_out: Sequence[int]) -> Mechanism:
    """The mechanism without some blocks' cut joints and what their unknowns carry."""
    unknown = {k for b in left_out for k, _ in graph.blocks[b].unknowns}
    gone_joints = {graph.closings[c].name for b in left_out for c in graph.blocks[b].closings}
    gone_links: set[str] = set()
    hangs, gone_blocks = _hanging_blocks(graph), set(left_out)
    for k, edge in enumerate(graph.edges):
        unhung = edge.hung and hangs[edge.child] in gone_blocks
        if k in unknown or unhung or edge.parent in gone_links:
            gone_links.add(edge.child)
            gone_joints.add(edge.joint.name)
    return Mechanism(
        mechanism.name,
        {name: link for name, link in mechanism.links.items() if name not in gone_links},
        {name: joint for name, joint in mechanism.joints.items() if name not in gone_joints},
        {name: at for name, at in mechanism.points.items() if at.link not in gone_links},
        {name: at for name, at in mechanism.directions.items() if at.link not in gone_links},
        (),
        mechanism.gravity,
        datum=mechanism.datum,
        couplings={n: c for n, c in mechanism.couplings.items() if n not in gone_joints},
    )


def _note(graph: SolverGraph, left_out: Sequence[int]) -> Diagnostic:
    names = []
    for b in left_out:
        for c in graph.blocks[b].closings:
            loop = [graph.edges[k].joint.name for k, _ in graph.loops[c]]
            names.append(", ".join(sorted({*loop, graph.closings[c].name})))
    loops = "the loop" if len(names) == 1 else "the loops"
    left = "is left out" if len(names) == 1 else "are left out"
    return Diagnostic(
        "not-followed",
        "note",
        f"{loops} through {' and '.join(names)} {left}: follow: lists none of its joints and no "
        "column reads them",
        hint="remove follow: for a verdict on the whole mechanism",
    )
