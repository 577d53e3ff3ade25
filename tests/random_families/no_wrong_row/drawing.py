"""The text of a mechanism and its linkage, grown together; numbers are written as they are."""

from __future__ import annotations

import random
from copy import copy
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray
from random_families.no_wrong_row.bodies import Body, Floats, Point
from random_families.no_wrong_row.linkage import Linkage
from random_families.no_wrong_row.node import Node

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
    """Bodies, links and joints; `merged` are groups of bodies that one block solves, `marks` the
    entries of points; links are massless but for `heavy` ones."""

    rng: random.Random
    bodies: list[Body | Node] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    joints: list[str] = field(default_factory=list)
    columns: list[Column] = field(default_factory=list)
    inputs: dict[str, str] = field(default_factory=dict)
    merged: list[tuple[str, ...]] = field(default_factory=list)
    points: list[Floats] = field(default_factory=list)
    marks: list[str] = field(default_factory=list)
    heavy: set[str] = field(default_factory=set)
    families: list[str] = field(default_factory=list)
    link_of: dict[str, str] = field(default_factory=lambda: {"ground": "ground"})

    def state(self) -> tuple[Any, ...]:
        """What `restore` brings back."""
        return tuple(copy(getattr(self, f.name)) for f in fields(self) if f.name != "rng")

    def restore(self, state: tuple[Any, ...]) -> None:
        names = [f.name for f in fields(self) if f.name != "rng"]
        for name, value in zip(names, state, strict=True):
            setattr(self, name, value)

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

    def linkage(self, sides: dict[str, int] | None = None) -> Linkage:
        """The drawn assembly, or the one with other sides."""
        found = Linkage(list(self.bodies), max(self.size, 1e-3))
        found.side.update(sides or {})
        return found

    @property
    def driven(self) -> list[Body | Node]:
        return [body for body in self.bodies if body.drive is not None]

    def position(self, point: Point) -> Vector:
        return np.array(point.base) + np.array(point.offset)

    def shuffled(self) -> tuple[list[str], list[str]]:
        """Links and joints in a random order."""
        return self.rng.sample(self.links, len(self.links)), self.rng.sample(
            self.joints, len(self.joints)
        )
