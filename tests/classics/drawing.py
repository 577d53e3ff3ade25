"""Linkages as drawings: assembled places of points and axes, and the text of format 1 for them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

GROUND = "ground"
Z = (0.0, 0.0, 1.0)


class Classic(NamedTuple):
    """A linkage of known mobility: `dimensions` of the components of motion that meet at the
    drawing, largest first, and the freedom of `first_order` there; both count `idle` freedoms."""

    name: str
    text: str
    dimensions: tuple[int, ...]
    first_order: int
    idle: int = 0


class Drawn:
    """A drawing that grows joint by joint."""

    def __init__(self) -> None:
        self.joints: list[str] = []
        self.links: dict[str, None] = {}

    def add(self, letter: str, first: str, second: str, point, **vectors: object) -> None:
        """A joint; vectors are axis, axis2, normal, x, groove; numbers are lead."""
        keys = {"type": letter, "links": f"[{first}, {second}]", "point": numbers(point)}
        for key, value in vectors.items():
            keys[key] = repr(float(value)) if key == "lead" else numbers(value)  # type: ignore
        words = ", ".join(f"{key}: {value}" for key, value in keys.items())
        self.joints.append(f"J{len(self.joints) + 1}: {{{words}}}")
        self.links.update({link: None for link in (first, second) if link != GROUND})

    @property
    def text(self) -> str:
        """The file."""
        links = ", ".join(f"{link}: {{}}" for link in self.links)
        body = "".join(f"  {joint}\n" for joint in self.joints)
        return f"format: 1\nname: classic\nlinks: {{{links}}}\njoints:\n{body}"


def numbers(vector: Iterable[float]) -> str:
    """A vector with all digits."""
    return "[" + ", ".join(repr(float(c)) for c in vector) + "]"


def ring(
    letters: str, points: Sequence, axes: Sequence, leads: Mapping[int, float] | None = None
) -> str:
    """A single loop; joint k joins link k to link k + 1, ground being 0 and the last."""
    drawn, count = Drawn(), len(letters)
    names = [GROUND, *(f"L{k}" for k in range(1, count)), GROUND]
    for k, letter in enumerate(letters):
        vectors = {} if letter == "S" else {"axis": axes[k]}
        if letter == "H":
            vectors["lead"] = (leads or {})[k]
        drawn.add(letter, names[k], names[k + 1], points[k], **vectors)
    return drawn.text


def planar(pins: Mapping[str, Sequence[float]], bars: Iterable[str]) -> str:
    """Planar linkage of links given by their pins, as 'AB' or 'ABC'; the first is ground. Where
    many links meet they are hinged one to the next."""
    drawn = Drawn()
    bodies = [(GROUND if k == 0 else f"L{k}", bar) for k, bar in enumerate(bars)]
    for pin, place in pins.items():
        here = [name for name, bar in bodies if pin in bar]
        for one, two in pairwise(here):
            drawn.add("R", one, two, (*place, 0.0), axis=Z)
    return drawn.text


def spatial(points: Mapping[str, Sequence[float]], bars: Iterable[str]) -> str:
    """Bodies that share points at spheres; the first is ground. Bodies of two points spin."""
    drawn = Drawn()
    bodies = [(GROUND if k == 0 else f"L{k}", bar) for k, bar in enumerate(bars)]
    for point, place in points.items():
        here = [name for name, bar in bodies if point in bar]
        for one, two in pairwise(here):
            drawn.add("S", one, two, place)
    return drawn.text


def platform(base: Sequence, top: Sequence, *, spin: bool = False) -> str:
    """A body on legs of fixed length, S-S if they may `spin`, else U-S, from base to top points."""
    drawn = Drawn()
    for k, (foot, head) in enumerate(zip(base, top, strict=True)):
        leg = f"leg{k + 1}"
        if spin:
            drawn.add("S", GROUND, leg, foot)
        else:
            one, two = square_to(np.subtract(head, foot))
            drawn.add("U", GROUND, leg, foot, axis=one, axis2=two)
        drawn.add("S", leg, "top", head)
    return drawn.text


def square_to(vector: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Two unit vectors square to one and to each other."""
    along = np.asarray(vector, dtype=float) / np.linalg.norm(vector)
    one = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    one /= np.linalg.norm(one)
    return one, np.cross(along, one)


def rotation(axis: Sequence[float], angle: float) -> np.ndarray:
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def circle(angles: Iterable[float], radius: float = 1.0, height: float = 0.0) -> np.ndarray:
    """Points of a circle about z."""
    return np.array([[radius * np.cos(a), radius * np.sin(a), height] for a in angles])
