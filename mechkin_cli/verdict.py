"""Verdict on one row of a table: a fixed enumeration whose members carry what the user reads.

The codes are stored as int8 arrays, one entry per row. A row without solution keeps its input
values and its status; all its other cells stay empty.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools


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


# What is proven of one row of a table: a fixed enumeration whose members carry what the user
# reads.


class Proof(IntEnum):
    """What `--certify` found of one row; the integer value is the code that the arrays hold."""

    not_proven = 0
    proven_to_closure = 1
    proven = 2

    @property
    def label(self) -> str:
        """The name that files and messages print, such as `proven to closure`."""
        return self.name.replace("_", " ")

    @property
    def sentence(self) -> str:
        """One sentence for the reader of the row."""
        return _PROOF_SENTENCES[self]


_PROOF_SENTENCES = {
    Proof.not_proven: "nothing is proven of this row.",
    Proof.proven_to_closure: (
        "as many closing equations as there are unknowns have exactly one solution in a small box "
        "about the position, and the others are below a tiny bound there; the position continues "
        "that of the rows before."
    ),
    Proof.proven: (
        "there is exactly one position in a small box about the one given, and it continues that "
        "of the rows before."
    ),
}


# The runs of a file: the sweep along the inputs of its motion, and its responses by name.

SWEEP: Final = "sweep"
"""Name of the run along the inputs of `motion:`; no response may have it."""


# Which mechkin this is, and which format of files it reads: what every JSON output begins with.

FORMAT = 1
"""The version of the file format, as files say it in `format:`."""

UNKNOWN = "(source folder, not installed)"


def version() -> str:
    """The version of the installed package."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("mechkin")
    except PackageNotFoundError:
        return UNKNOWN


def versions() -> dict[str, object]:
    """Program and format as the first two keys of a JSON object."""
    return {"mechkin": version(), "format": FORMAT}
