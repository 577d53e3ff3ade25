"""The joint types as the kernel's joint table knows them, by letter."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache


@dataclass(frozen=True, slots=True)
class JointType:
    """Constants of a joint type.

    `coordinates` are the names that users write (`theta`, `s`); `equations` is the number of
    closing equations (6 - freedoms), 0 for a type that closes no loop; `slides` tells for each
    freedom whether it is a length.
    """

    letter: str
    code: int
    freedoms: int
    states: int
    equations: int
    slides: tuple[bool, ...]
    coordinates: tuple[str, ...]


@cache
def joint_types() -> dict[str, JointType]:
    """The table, by letter."""
    from mechkin_cli.kernel import _kernel

    table = {}
    for row in _kernel.joint_table():
        names = tuple(name for name in ("theta", "s") if row[name])
        slides = tuple(bool(row["slides"] >> f & 1) for f in range(row["freedoms"]))
        table[row["letter"]] = JointType(
            row["letter"],
            row["code"],
            row["freedoms"],
            row["states"],
            row["equations"],
            slides,
            names,
        )
    return table
