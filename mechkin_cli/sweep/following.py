"""The rows of a sweep followed along the inputs from the first assembly, and why they end."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import GROUND_NAME, Mechanism, Problem, Wanted
from mechkin_cli.memo import remembered
from mechkin_cli.plan import PassageEnd, TrackEnd, needs_all_links
from mechkin_cli.record import replace
from mechkin_cli.session import ORIENTATION, turn_count
from mechkin_cli.structure import SolverGraph
from mechkin_cli.sweep.rows import SweepRows

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.session import Followed, Session
    from mechkin_cli.show import Floats


Touched = tuple[int, PassageEnd]
"""A row at which the inputs turn back, and what they come to there."""


def follow_rows(session: Session, start: AssemblyStart, *, every_row: bool = False) -> SweepRows:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    values = session.inputs.values
    count = values.shape[1]
    if start.state is None:
        rows = SweepRows.without_guesses(session.layout.states, turn_count(session.plan), count)
        rows.status[:] = start.status
        return rows
    first = _first_row(session, start, every_row)
    if first is not None:
        followed, touched = _follow_and_retrace(session, first, 0, 1, every_row)
        rows = SweepRows.followed(followed)
        _explain(session, values, followed, rows, touched)
    else:
        rows = SweepRows.without_guesses(session.layout.states, turn_count(session.plan), count)
        for step in (-1, 1):
            onward = slice(start.row, None, step)
            followed, touched = _follow_and_retrace(
                session, start.state, start.row, step, every_row
            )
            part = rows.part(onward)
            part.take(followed, 0)
            part.section *= step
            rows.nodes += followed.steps
            path = np.ascontiguousarray(values[:, onward])
            _explain(session, path, followed, part, touched)
    _count_from_first(session, rows)
    return rows


def _follow_and_retrace(
    session: Session, state: Floats, row: int, step: int, every_row: bool
) -> tuple[Followed, list[Touched]]:
    """The rows from a row on, or with step -1 back from it, and the singular places at which the
    inputs turn back there: behind them the branch is retraced."""
    followed = session.follow_rows(state, row, step, every_row=every_row)
    touched: list[Touched] = []
    if session.route is not None:
        return followed, touched
    onward = slice(row, None, step)
    values, inputs = session.inputs.values[:, onward], session.inputs
    reduced, whole = inputs.reduced[:, onward], inputs.whole[:, onward]
    while followed.end != TrackEnd.FINISHED and 2 <= followed.reached < values.shape[1]:
        turn = followed.reached - 1
        before = _turned_back(values, turn)
        if before is None:
            break
        guess = np.ascontiguousarray(followed.guess[:, before, None])
        closed = session.close(np.ascontiguousarray(reduced[:, before, None]), guess)
        if not closed.good[0]:
            break
        start = np.ascontiguousarray(closed.states[:, 0])
        kind = _singular_place(session, reduced[:, [before, turn]], start)
        if kind is None:
            break
        rest = [before, *range(turn + 1, values.shape[1])]
        turns = None if followed.turns is None else followed.turns[:, before].copy()
        again = session.follow(
            np.ascontiguousarray(reduced[:, rest]),
            start,
            every_row=every_row,
            turns=True,
            turn=turns,
            whole=np.ascontiguousarray(whole[:, rest]),
        )
        if again.reached < 2:
            break
        followed = _joined(followed, again, turn)
        touched.append((row + step * turn, kind))
    return followed, touched


def _singular_place(session: Session, way: Floats, start: Floats) -> PassageEnd | None:
    """Whether a way (inputs, 2) from the states (states,) at its first place comes to a dead centre
    or to a branch point at its second, as far as following shows that goes on; None: to neither."""
    came = way[:, 1] - way[:, 0]
    ahead = came / float(np.abs(came).max())
    far, near = tolerances.BEFORE_DEAD_CENTRE
    beyond = np.stack([way[:, 0], way[:, 1] + far * ahead], axis=1)
    followed = session.follow(beyond, start, every_row=True)
    places = [] if followed.ending is None else [(followed.ending.kind, followed.ending.inputs)]
    places += [(PassageEnd.BRANCH_POINT, inputs) for _, inputs in followed.crossings]
    for kind, inputs in places:
        named = kind in (PassageEnd.DEAD_CENTRE, PassageEnd.BRANCH_POINT)
        if named and float(np.abs(inputs - way[:, 1]).max()) <= near:
            return kind
    return None


def _turned_back(values: Floats, turn: int) -> int | None:
    """The last row before `turn` with other inputs, if the inputs (inputs, rows) go back from
    `turn` the way they came from there; else None."""
    other = np.flatnonzero((values[:, :turn] != values[:, turn, None]).any(axis=0))
    if not other.size:
        return None
    before = int(other[-1])
    came, goes = values[:, turn] - values[:, before], values[:, turn + 1] - values[:, turn]
    farthest = int(np.argmax(np.abs(came)))
    part = -float(goes[farthest] / came[farthest])
    aside = float(np.abs(goes + part * came).max())
    goes_back = part > 0.0 and aside <= tolerances.SAME_LINE * float(np.abs(goes).max())
    return before if goes_back else None


def _joined(followed: Followed, again: Followed, turn: int) -> Followed:
    """What was followed up to the row `turn`, and then from the row before it back."""
    for name in ("guess", "turns"):
        array, more = getattr(followed, name), getattr(again, name)
        if array is not None and more is not None:
            array[:, turn + 1 :] = more[:, 1:]
    followed.limit[turn + 1 :] = again.limit[1:]
    # a branch point at which the inputs turn back is not passed
    passed = [(number, inputs) for number, inputs in followed.crossings if number < turn]
    passed += [(number + turn, inputs) for number, inputs in again.crossings]
    return again._replace(
        guess=followed.guess,
        limit=followed.limit,
        turns=followed.turns,
        reached=turn + again.reached,
        steps=followed.steps + again.steps,
        crossings=tuple(passed),
    )


def _first_row(session: Session, start: AssemblyStart, every_row: bool) -> Floats | None:
    """The states of the first row where all rows are followed from it: where it is the start, and
    where a way of whole turns leads back to it, so that one turn serves them all."""
    if start.row == 0 or start.state is None:
        return start.state
    if session.route is not None or not np.ptp(session.inputs.whole, axis=1).any():
        return None
    back = session.follow_rows(start.state, start.row, -1, every_row=every_row)
    return back.guess[:, -1] if back.end == TrackEnd.FINISHED else None


def _explain(
    session: Session, path: Floats, followed: Followed, rows: SweepRows, touched: Sequence[Touched]
) -> None:
    """Says which branch points were passed, at which places the inputs turn back (`touched`), and
    what ended the branch, if it ended."""
    if not (followed.crossings or touched or followed.end != TrackEnd.FINISHED):
        return
    from mechkin_cli.sweep import branch_end

    rows.diagnostics += branch_end.retraced_notes(session, touched)
    if followed.crossings:
        rows.diagnostics.append(branch_end.crossing_note(session, followed))
    if followed.end != TrackEnd.FINISHED and not rows.reached.all():
        branch_end.explain_end(session, path, followed, rows)


def _count_from_first(session: Session, rows: SweepRows) -> None:
    """Turns count from the first row, whose angles lie in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    # half a turn is +180, whichever side of it rounding has
    for state, slot in session.turn_slots.tree.items():
        below = rows.states[state, first] <= tolerances.HALF_TURN_SIDE - pi
        turns = rows.turns[slot, first] - (1.0 if below else 0.0)
        if turns:
            rows.turns[slot] -= turns
    for (_, freedom), slot in session.turn_slots.closing.items():
        if freedom != ORIENTATION:
            beyond = rows.turns[slot, first] - pi - tolerances.HALF_TURN_SIDE
            turns = float(np.ceil(beyond / (2.0 * pi)))
            if turns:
                rows.turns[slot] -= turns * (2.0 * pi)


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
        joints = {
            graph.edges[k].joint.name for c in block.closings for k, _ in graph.closings[c].loop
        }
        joints |= {graph.closings[c].name for c in block.closings}
        if joints & set(problem.follow or ()):
            needed.add(b)
    front = list(needed)
    for b in front:
        for c in graph.blocks[b].closings:
            placed = graph.closings[c].constraint.placed
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
        for link in graph.closings[c].constraint.links
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
    )


def _note(graph: SolverGraph, left_out: Sequence[int]) -> Diagnostic:
    names = []
    for b in left_out:
        for c in graph.blocks[b].closings:
            closing = graph.closings[c]
            loop = [graph.edges[k].joint.name for k, _ in closing.loop]
            names.append(", ".join(sorted({*loop, closing.name})))
    loops = "the loop" if len(names) == 1 else "the loops"
    left = "is left out" if len(names) == 1 else "are left out"
    return Diagnostic(
        "not-followed",
        "note",
        f"{loops} through {' and '.join(names)} {left}: follow: lists none of its joints and no "
        "column reads them",
        hint="remove follow: for a verdict on the whole mechanism",
    )
