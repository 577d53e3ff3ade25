"""A mechanism as plain data: numbers in the base of `units`, vectors in the home drawing's axes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from oracle.numerics import Number, mp
from oracle.units import Units

COORDINATES: dict[str, tuple[str, ...]] = {
    "R": ("theta",),
    "P": ("s",),
    "C": ("theta", "s"),
    "H": ("theta", "s"),
    "S": (),
    "Sp": (),
    "Sg": ("s",),
    "U": ("theta1", "theta2"),
    "E": ("x", "y", "theta"),
    "W": (),
}
FREEDOMS = dict(zip(COORDINATES, (1, 1, 2, 1, 3, 5, 4, 2, 3, 0), strict=True))


@dataclass(frozen=True)
class Link:
    mass: Number
    mass_centre: list[Number]
    inertia: list[list[Number]]
    """About the mass centre."""


@dataclass(frozen=True)
class Joint:
    """Motion of link `second` against link `first`, about and along the axis on the first link.

    Sp and Sg: of the sphere on link `first` in the plane or the groove of link `second`.
    """

    type: str
    first: str
    second: str
    points: tuple[list[Number], list[Number]]
    """Of the first and of the second link."""
    axes: tuple[list[Number], list[Number]] | None
    """Unit vectors on the first and on the second link: the axis, the normal of Sp and E, the
    groove of Sg, for U `axis` and `axis2`; None for S and W."""
    zero: list[list[Number]]
    """The rotation that carries the second link's drawing into the first one's at coordinate 0."""
    lead: Number | None
    """Length per turn of an H, right-handed positive."""
    x: list[Number] | None = None
    """Unit vector on the first link along which the coordinate x of an E counts."""

    @property
    def coordinates(self) -> tuple[str, ...]:
        return COORDINATES[self.type]


@dataclass(frozen=True)
class Load:
    """`gravity` (vector), `force` or `torque` on a link (vector) or on a joint (value).

    Components and values are numbers, or functions of the quantities (`Scope.law`).
    """

    type: str
    link: str | None = None
    joint: str | None = None
    point: list[Number] | None = None
    vector: list[Any] | None = None
    turns_with_link: bool = False
    value: Any = None


@dataclass(frozen=True)
class Input:
    values: list[Number]
    rate: Number
    acceleration: Number
    jerk: Number


@dataclass(frozen=True)
class Mechanism:
    units: Units
    links: dict[str, Link]
    """The moving links."""
    joints: dict[str, Joint]
    points: dict[str, tuple[str, list[Number]]]
    """Name: (link, place in the home drawing)."""
    directions: dict[str, tuple[str, list[Number]]]
    loads: list[Load]
    inputs: dict[str, Input]
    near: dict[str, Number]

    @property
    def rows(self) -> int:
        return max((len(i.values) for i in self.inputs.values()), default=0)

    def row(self, index: int) -> dict[str, tuple[Number, ...]]:
        """Input coordinate: (value, rate, acceleration, jerk), as `solve` takes them."""
        return {
            name: (i.values[index if len(i.values) > 1 else 0], i.rate, i.acceleration, i.jerk)
            for name, i in self.inputs.items()
        }

    @property
    def size(self) -> Number:
        """The largest absolute coordinate of a joint point in the home drawing, or 1 where all are
        zero, or as good as zero beside it."""
        places = [p for j in self.joints.values() if j.type != "W" for p in j.points]
        largest = max(abs(x) for p in places for x in p)
        one = self.units.of("number")
        return largest if largest > mp.mpf("1e-18") * one else one
