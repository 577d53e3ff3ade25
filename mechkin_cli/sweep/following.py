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
from mechkin_cli.plan import TrackEnd, needs_all_links
from mechkin_cli.record import replace
from mechkin_cli.session import ORIENTATION, turn_count
from mechkin_cli.structure import SolverGraph
from mechkin_cli.sweep.rows import SweepRows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.session import Followed, Session
    from mechkin_cli.show import Floats
    from mechkin_cli.sweep.retracing import Touched


def follow_rows(session: Session, start: AssemblyStart, *, every_row: bool = False) -> SweepRows:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    count = session.inputs.values.shape[1]
    if start.state is None:
        rows = SweepRows.without_guesses(session.layout.states, turn_count(session.plan), count)
        rows.status[:] = start.status
        return rows
    first = _first_row(session, start, every_row)
    if first is not None:
        followed = session.follow_rows(first, every_row=every_row)
        rows = SweepRows.followed(followed)
        explain_way(session, followed, rows, every_row)
    else:
        rows = SweepRows.without_guesses(session.layout.states, turn_count(session.plan), count)
        for step in (-1, 1):
            followed = session.follow_rows(start.state, start.row, step, every_row=every_row)
            part = rows.part(slice(start.row, None, step))
            part.take(followed, 0)
            part.section *= step
            explain_way(session, followed, part, every_row)
            rows.nodes += part.nodes + followed.steps
    count_from_first(session, rows)
    return rows


def explain_way(session: Session, followed: Followed, rows: SweepRows, every_row: bool) -> None:
    """Goes on where the inputs turn back at a dead centre or a branch point; says which branch
    points were passed, at which places the inputs turn back, and what ended the branch, if it
    ended. `rows` are in the order in which they were followed."""
    values = np.ascontiguousarray(session.inputs.values[:, rows.numbers])
    turning = _turning(values)
    if not (turning.size or followed.crossings or followed.end != TrackEnd.FINISHED):
        return
    from mechkin_cli.sweep import branch_end
    from mechkin_cli.sweep.retracing import retraced, unclear_rows

    touched: list[Touched] = []
    passed: list[Floats] = []
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
            inputs
            for row, inputs in way.crossings
            if first + row < behind and not place.is_at(inputs)
        ]
        first = behind
    if first < rows.numbers.size:
        passed += [inputs for _, inputs in way.crossings]
    rows.diagnostics += branch_end.retraced_notes(session, touched)
    if passed:
        rows.diagnostics.append(branch_end.crossing_note(session, passed))
    rest = rows.part(slice(first, None))
    if way.end != TrackEnd.FINISHED and not rest.reached.all():
        path = np.ascontiguousarray(values[:, first:])
        branch_end.explain_end(session, path, way, rest)


def _turning(values: Floats) -> NDArray[np.intp]:
    """The numbers of the rows at which the inputs (inputs, rows) turn back."""
    moved = np.flatnonzero((values[:, 1:] != values[:, :-1]).any(axis=0))
    along = np.zeros(max(moved.size - 1, 0))
    for value in values:
        way = value[moved + 1] - value[moved]
        along = along + way[1:] * way[:-1]
    return moved[1:][along < 0.0]


def _first_row(session: Session, start: AssemblyStart, every_row: bool) -> Floats | None:
    """The states of the first row where all rows are followed from it: where it is the start, and
    where a way of whole turns leads back to it, so that one turn serves them all."""
    if start.row == 0 or start.state is None:
        return start.state
    if session.route is not None or not np.ptp(session.inputs.whole, axis=1).any():
        return None
    back = session.follow_rows(start.state, start.row, -1, every_row=every_row)
    return back.guess[:, -1] if back.end == TrackEnd.FINISHED else None


def count_from_first(session: Session, rows: SweepRows) -> None:
    """Turns count from the first row, whose angles lie in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    # half a turn is +180, whichever side of it rounding has
    for state, slot in session.structure.tree_slots.items():
        below = rows.states[state, first] <= tolerances.HALF_TURN_SIDE - pi
        turns = rows.turns[slot, first] - (1.0 if below else 0.0)
        if turns:
            rows.turns[slot] -= turns
    for (_, freedom), slot in session.structure.closing_slots.items():
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
