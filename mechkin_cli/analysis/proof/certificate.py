"""What is proven of a sweep."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from mechkin_cli.proof import Proof

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.proof.dead_centre import DeadCentre
    from mechkin_cli.arrays import Bools
    from mechkin_cli.solver.proofs import Boxes

Why = Literal["no position", "box", "branch"]
"""Why nothing is proven of a row: it has no position; no box about its position could be proven;
its box is proven, but not that it lies on the branch of the rows before."""


@dataclass(frozen=True, slots=True, eq=False)
class Gap:
    """Rows next to each other (counted from 0, both included) of which nothing is proven."""

    first: int
    last: int
    why: Why


@dataclass(frozen=True, slots=True, eq=False)
class Certificate:
    """Proofs of the rows of a sweep.

    Attributes:
        boxes: of all rows; those without a position have none.
        solved: rows that have a position (rows,).
        joined: whether each row is joined to the next by tubes (rows - 1,).
        tubes: how many tubes there are.
        anchor: the first row whose box is proven, whose branch all others are held against.
        of_text: whether it is proven of the numbers that the file's text says; else of the doubles
            that the kernel holds.
        dead_centres: those at which ways along the rows end.
    """

    boxes: Boxes
    solved: Bools
    joined: Bools
    tubes: int
    anchor: int
    of_text: bool
    dead_centres: tuple[DeadCentre, ...] = ()

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.solved.size

    @property
    def status(self) -> NDArray[np.int8]:
        """Codes of `Proof` (rows,)."""
        exact = np.where(self.boxes.beyond > 0.0, Proof.proven_to_closure, Proof.proven)
        found: NDArray[np.int8] = np.where(self.on_branch, exact, Proof.not_proven).astype(np.int8)
        return found

    @property
    def on_branch(self) -> Bools:
        """Rows whose boxes are proven and joined without a gap to the first that is."""
        together = np.concatenate([[True], self.joined])
        together[: self.anchor + 1] = True
        joined: Bools = np.logical_and.accumulate(together) & self.boxes.proven
        return joined

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
            Gap(int(first), int(end) - 1, words[reason[first] - 1])
            for first, end in zip(edges, ends, strict=True)
            if reason[first]
        )
