"""Verdict on one row of a table: a fixed enumeration whose members carry what the user reads.

The codes are stored as int8 arrays, one entry per row. A row without solution keeps its input
values and its status; all its other cells stay empty.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Bools


class Status(IntEnum):
    """Outcome of one row; the integer value is the code that the arrays hold."""

    ok = 0
    near_singular = 1
    beyond_dead_centre = 2
    branch_lost = 3
    not_converged = 4
    not_assembled = 5
    rank_unclear = 6
    friction_undecided = 7
    singular_inertia = 8
    step_limit = 9
    dead_centre = 10

    @property
    def label(self) -> str:
        """The name that files and messages print, such as `near-singular`."""
        return self.name.replace("_", "-")

    @property
    def sentence(self) -> str:
        """One sentence for the reader of the row."""
        return _SENTENCES[self]

    @property
    def has_solution(self) -> bool:
        """Whether the row has a position; single cells of it may still be missing."""
        return self in _SOLVED


_SOLVED = frozenset(
    {
        Status.ok,
        Status.near_singular,
        Status.rank_unclear,
        Status.friction_undecided,
        Status.dead_centre,
    }
)

_SENTENCES = {
    Status.ok: "solved; the position is right to nine digits or more.",
    Status.near_singular: (
        "solved, but close to a singular position: fewer digits of rates and loads are reliable."
    ),
    Status.beyond_dead_centre: "this branch ends at a dead centre before this row.",
    Status.branch_lost: (
        "the branch could not be followed to this row without doubt; no neighbour is given instead."
    ),
    Status.not_converged: "the position iteration did not reach its residual limit.",
    Status.not_assembled: "no start of the first row led to an assembled position.",
    Status.rank_unclear: (
        "the rank of the constraints could not be decided, so no reactions are given."
    ),
    Status.friction_undecided: (
        "the friction of a joint has no direction, or not one value alone; what depends on it is "
        "empty."
    ),
    Status.singular_inertia: (
        "the response ended before this row: a freedom has no inertia that could be moved."
    ),
    Status.step_limit: (
        "the response ended before this row: its steps became too short, or too many."
    ),
    Status.dead_centre: (
        "stands at a dead centre: rates and loads that grow without bound towards it are infinite, "
        "the others are empty."
    ),
}


def has_solution(codes: NDArray[np.int8]) -> Bools:
    """`Status.has_solution` of many rows, the same shape as the codes."""
    import numpy as np

    return np.isin(codes, [int(status) for status in _SOLVED])
