"""Proves the rows of a sweep: a box about each, and tubes from each to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.proof.bridge import bridge
from mechkin_cli.analysis.proof.certificate import Certificate
from mechkin_cli.solver.proofs import Enclosed, Nodes, prove_boxes, prove_tubes

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.solver.session import Session


def certify(session: Session, states: Floats, solved: Bools) -> Certificate:
    """Proofs of all rows of a sweep.

    Args:
        session: the mechanism, driven along the rows.
        states: of the rows in doubles (states, rows).
        solved: which rows have a position (rows,).
    """
    inputs = session.inputs
    nodes = Nodes(inputs.values, inputs.reduced, states)
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
    return Certificate(boxes, solved, joined, count, anchor, enclosed.of_text)


def _stretches(proven: Bools) -> list[slice]:
    """Rows next to each other, two at least, that are all proven."""
    edges = np.flatnonzero(np.diff(proven.astype(np.int8), prepend=0, append=0))
    pairs = zip(edges[0::2], edges[1::2], strict=True)
    return [slice(int(a), int(b)) for a, b in pairs if b - a > 1]
