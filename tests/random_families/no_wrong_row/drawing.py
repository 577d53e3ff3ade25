"""The text of a mechanism and its linkage, grown together; numbers are written as they are."""

from __future__ import annotations

import random
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from random_families.no_wrong_row.linkage import Body, Floats, Linkage, Point

Vector = NDArray[np.float64]


def floats(v: Vector) -> Floats:
    return float(v[0]), float(v[1]), float(v[2])


def text(v: Floats) -> str:
    return "[" + ", ".join(repr(c + 0.0) for c in v) + "]"


@dataclass(frozen=True)
class Column:
    """A coordinate of the file, the body that it belongs to, and its sign there."""

    name: str
    body: str
    angle: bool
    sign: int = 1


@dataclass
class Drawing:
    """Bodies, links and joints; `merged` are groups of bodies that one block solves."""

    rng: random.Random
    bodies: list[Body] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    joints: list[str] = field(default_factory=list)
    columns: list[Column] = field(default_factory=list)
    inputs: dict[str, str] = field(default_factory=dict)
    merged: list[tuple[str, ...]] = field(default_factory=list)
    points: list[Floats] = field(default_factory=list)
    families: list[str] = field(default_factory=list)
    link_of: dict[str, str] = field(default_factory=lambda: {"ground": "ground"})

    def link(self, name: str) -> str:
        self.links.append(name)
        return name

    def joint(
        self, name: str, kind: str, one: str, two: str, point: Floats, more: str = ""
    ) -> None:
        self.points.append(point)
        self.joints.append(
            f"{name}: {{type: {kind}, links: [{one}, {two}], point: {text(point)}{more}}}"
        )

    @property
    def size(self) -> float:
        """The diagonal of the box of the joint points."""
        return float(np.linalg.norm(np.ptp(np.array(self.points), axis=0)))

    def linkage(self) -> Linkage:
        return Linkage(list(self.bodies), max(self.size, 1e-3))

    def position(self, point: Point) -> Vector:
        return np.array(point.base) + np.array(point.offset)

    def shuffled(self) -> tuple[list[str], list[str]]:
        """Links and joints in a random order."""
        return self.rng.sample(self.links, len(self.links)), self.rng.sample(
            self.joints, len(self.joints)
        )
