"""An independent oracle for the tests: spatial mechanisms at 60 digits.

It shares nothing with the package: its own reader, the closure as written with poses by matrices,
rates by truncated Taylor series in time, forces by free-body equations of every link. Nothing here
uses twists, screws or virtual power.

All values are in the base units of `Mechanism.units` (coherent; see `oracle.units`), angles in
radians, vectors in ground axes. `mp.dps` (60) sets the digits of everything computed afterwards.

`solve` closes loops of R, P, C, H and S along a tree of joint coordinates; `assemble` takes all
joints and structures, with six unknowns per link. The two share only vectors and series.
"""

from oracle.assembly import assemble, assemble_rows, condition_of
from oracle.dead_centre import fold
from oracle.document import document, to_text
from oracle.forces import Reactions, newton_euler
from oracle.kinematics import Solution, condition, solve, sweep
from oracle.mechanism import Mechanism
from oracle.numerics import UnsolvableError, mp
from oracle.random_mechanisms import random_loop
from oracle.random_structures import SHAPES, random_structure
from oracle.reader import read
from oracle.transforms import (
    beside_itself,
    in_other_units,
    mirrored,
    moved,
    renamed,
    reordered,
    rotation_matrix,
    scaled,
    swapped_links,
    with_links,
)

__all__ = [
    "SHAPES",
    "Mechanism",
    "Reactions",
    "Solution",
    "UnsolvableError",
    "assemble",
    "assemble_rows",
    "beside_itself",
    "condition",
    "condition_of",
    "document",
    "fold",
    "in_other_units",
    "mirrored",
    "moved",
    "mp",
    "newton_euler",
    "random_loop",
    "random_structure",
    "read",
    "renamed",
    "reordered",
    "rotation_matrix",
    "scaled",
    "solve",
    "swapped_links",
    "sweep",
    "to_text",
    "with_links",
]
