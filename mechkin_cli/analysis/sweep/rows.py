"""The rows of a sweep: states, and what is known of each row."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.assembly.off_fold import Before
    from mechkin_cli.arrays import Bools, Floats
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.solver.branch_limit import EndOfRows
    from mechkin_cli.solver.follow import Followed


def sections(found: Followed, rows: int) -> NDArray[np.int64]:
    """The number of branch points that a way passed before each row (rows,)."""
    if not found.crossings:
        return np.zeros(rows, dtype=np.int64)
    passed = [crossing.row for crossing in found.crossings]
    return np.searchsorted(np.sort(np.array(passed)), np.arange(rows), side="right")


@dataclass
class Rows:
    """States (states, rows), guesses until they are closed, and what is known about rows that have
    none; `limit` is the largest correction that a guess may still need, `numbers` counts the rows
    from 0 as the file does, `nodes` the steps with which they were followed. `turns` (turn slots,
    rows) are angles and quaternions of closing joints as following carried them along
    (`solver.closing_turns`). `section` (rows,) tells rows apart between which a branch point was
    passed; numbers say nothing but that. `ends` are the dead centres beyond which rows are missing,
    `dead_centres` the rows that stand at one, twice where either of two branches may be meant.
    """

    states: Floats
    limit: Floats
    reached: Bools
    status: NDArray[np.int8]
    nodes: int
    diagnostics: list[Diagnostic]
    numbers: NDArray[np.int64]
    turns: Floats
    section: NDArray[np.int64]
    ends: list[EndOfRows]
    dead_centres: list[Before] = field(default_factory=list)

    @classmethod
    def without_guesses(cls, states: int, turns: int, rows: int) -> Rows:
        """Rows of which nothing is known yet; none is reached."""
        return cls(
            states=np.zeros((states, rows)),
            limit=np.zeros(rows),
            reached=np.zeros(rows, dtype=bool),
            status=np.full(rows, int(Status.ok), dtype=np.int8),
            nodes=0,
            diagnostics=[],
            numbers=np.arange(rows),
            turns=np.full((turns, rows), np.nan),
            section=np.zeros(rows, dtype=np.int64),
            ends=[],
        )

    @classmethod
    def followed(cls, found: Followed) -> Rows:
        """The rows of one way from the first, whose arrays become theirs."""
        count = found.limit.size
        turns = np.empty((0, count)) if found.turns is None else found.turns
        return cls(
            states=found.guess,
            limit=found.limit,
            reached=np.arange(count) < found.reached,
            status=np.zeros(count, dtype=np.int8),
            nodes=found.steps,
            diagnostics=[],
            numbers=np.arange(count),
            turns=turns,
            section=sections(found, count),
            ends=[],
        )

    def take(self, found: Followed, first: int) -> None:
        """Takes what a way found from its row `first` on."""
        known = slice(first, found.reached)
        self.states[:, first:] = found.guess[:, first:]
        self.limit[first:] = found.limit[first:]
        if found.turns is not None:
            self.turns[:, known] = found.turns[:, known]
        self.reached[first:] = np.arange(first, self.reached.size) < found.reached
        self.section[first:] = sections(found, self.reached.size)[first:]

    def part(self, rows: slice) -> Rows:
        """Some of the rows, in the slice's order: views of the same arrays."""
        arrays = (self.states[:, rows], self.limit[rows], self.reached[rows], self.status[rows])
        more = (self.nodes, self.diagnostics, self.numbers[rows], self.turns[:, rows])
        return Rows(*arrays, *more, self.section[rows], self.ends)

    @property
    def has_failed(self) -> bool:
        """Whether some row did not close."""
        return bool((self.status == Status.not_converged).any())
