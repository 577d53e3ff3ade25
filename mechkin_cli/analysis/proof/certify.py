"""Proves the rows of a sweep: a box about each, and tubes from each to the next."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.proof.bridge import bridge
from mechkin_cli.analysis.proof.certificate import Certificate
from mechkin_cli.analysis.proof.dead_centre import DeadCentre, prove_dead_centre
from mechkin_cli.solver.proofs import Enclosed, Nodes, prove_boxes, prove_tubes

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.solver.branch_limit import EndOfRows
    from mechkin_cli.solver.session import Session


def certify(
    session: Session, states: Floats, solved: Bools, ends: Sequence[EndOfRows] = ()
) -> Certificate:
    """Proofs of all rows of a sweep.

    Args:
        session: the mechanism, driven along the rows.
        states: of the rows in doubles (states, rows).
        solved: which rows have a position (rows,).
        ends: the dead centres at which ways along the rows end.
    """
    inputs = session.inputs
    nodes = Nodes.of(session, inputs.values, inputs.reduced, states)
    enclosed = session.once("enclosed", lambda: Enclosed.of(session))
    boxes = prove_boxes(enclosed, nodes)
    proven = boxes.proven & solved
    boxes = boxes._replace(proven=proven)
    joined, count = np.zeros(max(solved.size - 1, 0), dtype=bool), 0
    for rows in _stretches(proven):
        tubes = prove_tubes(enclosed, nodes.part(rows), boxes.part(rows))
        joined[rows.start : rows.stop - 1] = tubes.joined
        count += tubes.number
    for row in np.flatnonzero(proven[:-1] & proven[1:] & ~joined):
        found = bridge(enclosed, nodes.part(slice(row, row + 2)))
        joined[row] = found > 0
        count += found
    anchor = int(proven.argmax()) if proven.any() else 0
    certificate = Certificate(boxes, solved, joined, count, anchor, enclosed.of_text)
    dead_centres = tuple(_ended(enclosed, nodes, certificate, end) for end in ends)
    return replace(certificate, dead_centres=dead_centres)


def _ended(
    enclosed: Enclosed, nodes: Nodes, certificate: Certificate, end: EndOfRows
) -> DeadCentre:
    """What is proven of a dead centre behind a row, which the branch leads to if it leads to the
    row."""
    row = slice(end.row, end.row + 1)
    found = prove_dead_centre(enclosed, nodes.part(row), certificate.boxes.part(row), end)
    if found.why is None and not certificate.on_branch[end.row]:
        return replace(found, why="branch")
    return found


def _stretches(proven: Bools) -> list[slice]:
    """Rows next to each other, two at least, that are all proven."""
    edges = np.flatnonzero(np.diff(proven.astype(np.int8), prepend=0, append=0))
    pairs = zip(edges[0::2], edges[1::2], strict=True)
    return [slice(int(a), int(b)) for a, b in pairs if b - a > 1]
