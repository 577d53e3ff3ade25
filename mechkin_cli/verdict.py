"""Verdicts on the rows of a table: fixed enumerations whose members say what they mean.

The codes are stored as int8 arrays, one entry per row. A row without solution keeps its input
values and its status; all its other cells stay empty.
"""

from __future__ import annotations

from enum import IntEnum
from functools import cache
from typing import TYPE_CHECKING, Final

from mechkin_cli.tolerances.results import (
    CONDITION_NEAR_SINGULAR,
    CONDITION_RANK_UNCLEAR,
    CONDITION_RATES_UNCLEAR,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.show import Bools, Floats


class Status(IntEnum):
    """Outcome of one row; the integer value is the code that the arrays hold.

    Attributes:
        has_solution: the row has a position; single cells of it may still be missing.
        has_rates: its rates and accelerations are finite numbers.
        has_forces: so are its reactions and efforts.
        ends_run: the run goes no further in this direction: rows beyond have no solution either.
        sentence: one sentence for the reader of the row.
    """

    # code, what a row has or that the run ends with it, sentence
    ok = (
        0,
        "position, rates, forces",
        "solved; the position is right to eight digits or more.",
    )
    near_singular = (
        1,
        "position, rates, forces",
        ("solved, but close to a singular position: fewer digits of rates and loads are reliable."),
    )
    beyond_dead_centre = (
        2,
        "ends",
        "this branch ends at a dead centre before this row.",
    )
    branch_lost = (
        3,
        "ends",
        (
            "the branch could not be followed to this row without doubt; no neighbour is given "
            "instead."
        ),
    )
    not_converged = (
        4,
        "",
        "the position iteration did not reach its residual limit.",
    )
    not_assembled = (
        5,
        "ends",
        "no start of the first row led to an assembled position.",
    )
    rank_unclear = (
        6,
        "position",
        "the rank of the constraints could not be decided, so no reactions are given.",
    )
    friction_undecided = (
        7,
        "position, rates",
        (
            "the friction of a joint has no direction, or not one value alone; what depends on "
            "it is empty."
        ),
    )
    singular_inertia = (
        8,
        "ends",
        "the response ended before this row: a freedom has no inertia.",
    )
    step_limit = (
        9,
        "ends",
        (
            "the response ended before this row: its steps became too short, or too many, or none "
            "goes on from there."
        ),
    )
    dead_centre = (
        10,
        "position",
        (
            "stands at a dead centre: rates and loads that grow without bound towards it are "
            "infinite, the others are empty."
        ),
    )
    unsupported = (
        11,
        "position, rates",
        (
            "the loads push along a motion that the constraints do not stop to first order, so no "
            "finite reactions hold them."
        ),
    )
    beyond_limit = (
        12,
        "position, rates, forces",
        "solved, but a coordinate is beyond its limit: the mechanism does not come here.",
    )
    slack = (
        13,
        "position, rates, forces",
        "solved as if a belt, chain or cable pushed, or stuck to a pulley that it leaves.",
    )
    fleet_angle = (
        14,
        "position, rates, forces",
        "solved as if a cable ran in the plane of a pulley that it leaves at a fleet angle.",
    )

    no_equilibrium = (
        15,
        "ends",
        "no place was found at which the loads balance.",
    )
    snapped_through = (
        16,
        "ends",
        "the branch of equilibria turns back before this row: the mechanism snaps through.",
    )

    has_solution: bool
    has_rates: bool
    has_forces: bool
    ends_run: bool
    sentence: str

    def __new__(cls, code: int, has: str = "", sentence: str = "") -> Status:
        """`has` names what a row of this status has, and whether the run `ends` with it."""
        status = int.__new__(cls, code)
        status._value_ = code
        status.has_solution, status.has_rates = "position" in has, "rates" in has
        status.has_forces, status.ends_run = "forces" in has, "ends" in has
        status.sentence = sentence
        return status

    @property
    def label(self) -> str:
        """The name that files and messages print, such as `near-singular`."""
        return self.name.replace("_", "-")


def are(codes: NDArray[np.int8], status: Status) -> Bools:
    """Which of many rows have a status, the same shape as the codes. Numpy compares with a number
    in a tenth of the time that it takes with a member of an enumeration."""
    found: Bools = codes == int(status)
    return found


def are_ok(codes: NDArray[np.int8]) -> bool:
    """Whether all of many rows are `ok`: no code is another one than zero, which numpy counts
    fastest."""
    import numpy as np

    return not np.count_nonzero(codes)


def has_solution(codes: NDArray[np.int8]) -> Bools:
    """`Status.has_solution` of many rows, the same shape as the codes."""
    import numpy as np

    if are_ok(codes):  # as most; to look each up takes twenty times as long
        return np.full(codes.shape, Status.ok.has_solution)
    return _marked("has_solution")[codes]


def has_rates(codes: NDArray[np.int8]) -> Bools:
    """`Status.has_rates` of many rows, the same shape as the codes."""
    return _marked("has_rates")[codes]


def has_forces(codes: NDArray[np.int8]) -> Bools:
    """`Status.has_forces` of many rows, the same shape as the codes."""
    return _marked("has_forces")[codes]


@cache
def _marked(name: str) -> Bools:
    """What every status has of a mark, by its code."""
    import numpy as np

    return np.array([getattr(status, name) for status in Status], dtype=bool)


def labels(codes: NDArray[np.int8]) -> NDArray[np.str_]:
    """The label of every code, the same shape."""
    import numpy as np

    words: NDArray[np.str_] = np.array([status.label for status in Status])[codes]
    return words


CONDITION_LIMITS = {
    Status.near_singular: CONDITION_NEAR_SINGULAR,
    Status.rank_unclear: CONDITION_RANK_UNCLEAR,
}
"""The condition of a row's loop closure above which it has a status, by rising limits."""

CLEAR_CONDITION = CONDITION_RATES_UNCLEAR
"""The condition of a row's loop closure up to which its rates are significant by it alone."""


def by_condition(condition: Floats) -> NDArray[np.int8]:
    """The status that a row's condition alone gives it, codes of the same shape; a condition that
    could not be computed (nan) is above every limit."""
    import numpy as np

    codes = np.full(condition.shape, int(Status.ok), dtype=np.int8)
    for status, limit in CONDITION_LIMITS.items():
        codes[~(condition <= limit)] = int(status)
    return codes


def rates_are_clear(condition: Floats | float) -> Bools:
    """Whether the condition alone guarantees significant rates; where it does not, the row is
    looked at again in double-double."""
    import numpy as np

    return np.asarray(condition) <= CLEAR_CONDITION


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

__version__ = "1.0.0rc1"
"""The version of the package; its metadata are built from this line."""


def versions() -> dict[str, object]:
    """Program and format as the first two keys of a JSON object."""
    return {"mechkin": __version__, "format": FORMAT}
