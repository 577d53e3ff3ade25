"""Proves the rows of a sweep: a box about each, and tubes from each to the next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli.proofs.boxes import Boxes, Enclosed, Nodes, enclosed_of, prove_boxes, prove_tubes
from mechkin_cli.proofs.dead_centre import DeadCentreProof, bridge, prove_dead_centre
from mechkin_cli.record import dataclass, replace
from mechkin_cli.verdict import Proof

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.session import EndOfRows, Session
    from mechkin_cli.show import Bools, Floats

Why = Literal["no position", "box", "branch"]
"""Why nothing is proven of a row: it has no position; no box about its position could be proven;
its box is proven, but not that it lies on the branch of the rows before."""


Gap = tuple[int, int, Why]
"""The first and the last row (counted from 0) of a stretch of which nothing is proven, and why."""


@dataclass(frozen=True, slots=True, eq=False)
class SweepProofs:
    """Proofs of the rows of a sweep.

    Attributes:
        boxes: of all rows; those without a position have none.
        solved: rows that have a position (rows,).
        joined: whether each row is joined to the next by tubes (rows - 1,).
        tubes: how many tubes there are.
        anchor: the first row whose box is proven; the branch of all others is compared with its.
        of_text: whether it is proven of the numbers of the file's text; else of the kernel's
            doubles.
        dead_centres: those at which paths along the rows end.
    """

    boxes: Boxes
    solved: Bools
    joined: Bools
    tubes: int
    anchor: int
    of_text: bool
    dead_centres: tuple[DeadCentreProof, ...] = ()

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.solved.size

    @property
    def status(self) -> NDArray[np.int8]:
        """Codes of `Proof` (rows,)."""
        exact = np.where(self.boxes.beyond > 0.0, Proof.proven_to_closure, Proof.proven)
        return np.asarray(np.where(self.on_branch, exact, Proof.not_proven), dtype=np.int8)

    @property
    def on_branch(self) -> Bools:
        """Rows whose boxes are proven and joined without a gap to the first that is."""
        together = np.concatenate([[True], self.joined])
        together[: self.anchor + 1] = True
        return np.asarray(np.logical_and.accumulate(together) & self.boxes.proven)

    @property
    def is_complete(self) -> bool:
        """Whether every row is proven, or proven to closure: the sweep lies on one branch."""
        return bool(self.on_branch.all())

    @property
    def gaps(self) -> tuple[Gap, ...]:
        """Where nothing is proven."""
        reason = np.where(self.on_branch, 0, np.where(~self.solved, 1, 2 + self.boxes.proven))
        words: tuple[Why, ...] = ("no position", "box", "branch")
        edges = np.flatnonzero(np.diff(reason, prepend=-1))
        ends = [*edges[1:], reason.size]
        return tuple(
            (int(first), int(end) - 1, words[reason[first] - 1])
            for first, end in zip(edges, ends, strict=True)
            if reason[first]
        )


def certify(
    session: Session, states: Floats, solved: Bools, ends: Sequence[EndOfRows] = ()
) -> SweepProofs:
    """Proofs of all rows of a sweep.

    Args:
        session: the mechanism, driven along the rows.
        states: of the rows in doubles (states, rows).
        solved: which rows have a position (rows,).
        ends: the dead centres at which paths along the rows end.
    """
    inputs = session.inputs
    nodes = Nodes.of(session, inputs.values, inputs.reduced, states)
    enclosed = enclosed_of(session)
    boxes = prove_boxes(enclosed, nodes)
    proven = boxes.proven & solved
    boxes = boxes._replace(proven=proven)
    joined, count = np.zeros(max(solved.size - 1, 0), dtype=bool), 0
    for rows in _stretches(proven):
        joined[rows.start : rows.stop - 1], tubes = prove_tubes(
            enclosed, nodes.part(rows), boxes.part(rows)
        )
        count += tubes
    for row in np.flatnonzero(proven[:-1] & proven[1:] & ~joined):
        tubes = bridge(enclosed, nodes.part(slice(row, row + 2)))
        joined[row] = tubes > 0
        count += tubes
    anchor = int(proven.argmax()) if proven.any() else 0
    certificate = SweepProofs(boxes, solved, joined, count, anchor, enclosed.of_text)
    dead_centres = tuple(_ended(enclosed, nodes, certificate, end) for end in ends)
    return replace(certificate, dead_centres=dead_centres)


def _ended(
    enclosed: Enclosed, nodes: Nodes, certificate: SweepProofs, end: EndOfRows
) -> DeadCentreProof:
    """What is proven of a dead centre behind a row, which the branch leads to if it leads to the
    row."""
    row = slice(end.row, end.row + 1)
    proof = prove_dead_centre(enclosed, nodes.part(row), certificate.boxes.part(row), end)
    lost = proof.why is None and not certificate.on_branch[end.row]
    return replace(proof, why="branch") if lost else proof


def _stretches(proven: Bools) -> list[slice]:
    """Rows next to each other, two at least, that are all proven."""
    edges = np.flatnonzero(np.diff(proven.astype(np.int8), prepend=0, append=0))
    pairs = zip(edges[0::2], edges[1::2], strict=True)
    return [slice(int(a), int(b)) for a, b in pairs if b - a > 1]
