"""The joint types as the kernel's joint table knows them, by letter.

A pair is a chain of elementary displacements from its first link to its second (`parts`): U and Ss
are R R, E is P P R, Sp is S P P, Sg is S P, Sc is P R R, Cp is R R P P. Freedoms count along that
chain.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

TREE_LETTERS = "RPHCSWL"
"""Elementary displacements in the order of the kernel's codes; L hangs a leg between two points."""

FREE = "F"
"""The pair without constraints by which the solver hangs a body that only legs hold."""


class TreeType(NamedTuple):
    """An elementary displacement: `slides` tells for each freedom whether it is a length."""

    code: int
    freedoms: int
    states: int
    slides: tuple[bool, ...]


class JointType(NamedTuple):
    """Constants of a joint type.

    `coordinates` are the names that users write (`theta`, `s`, ...) with their freedom;
    `equations` is the number of closing equations (6 - freedoms), 0 for a type that closes no loop.
    """

    letter: str
    code: int
    parts: tuple[str, ...]
    freedoms: int
    equations: int
    slides: tuple[bool, ...]
    freedom_of: dict[str, int]

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return tuple(self.freedom_of)


@cache
def tree_types() -> dict[str, TreeType]:
    """The elementary displacements, by letter."""
    from mechkin_cli.kernel import _kernel

    table = {}
    for letter, row in zip(TREE_LETTERS, _kernel.tree_table(), strict=True):
        slides = tuple(bool(row["slides"] >> f & 1) for f in range(row["freedoms"]))
        table[letter] = TreeType(row["code"], row["freedoms"], row["states"], slides)
    return table


@cache
def joint_types() -> dict[str, JointType]:
    """The joint table, by letter."""
    from mechkin_cli.kernel import _kernel

    table = {}
    for row in _kernel.joint_table():
        parts = tuple(row["parts"])
        slides = tuple(slide for part in parts for slide in tree_types()[part].slides)
        names = {name: f for f, name in enumerate(row["coordinates"].split()) if name != "-"}
        if row["letter"] == "H":
            names["s"] = 0  # theta and s of a helical joint are one freedom
        table[row["letter"]] = JointType(
            row["letter"], row["code"], parts, len(slides), row["equations"], slides, names
        )
    slides = (True, True, True, False, False, False)
    table[FREE] = JointType(FREE, -1, tuple("PPPS"), 6, 0, slides, {"x": 0, "y": 1, "z": 2})
    return table
