"""Single loops of any joints as products of exponentials: places by Newton steps with the
pseudo-inverse, so that idle freedoms stay where they are.

A joint is a row of turns, slides and screws, each one about a line as drawn. The loop is
exp(q1 X1) exp(q2 X2) ... = 1, its Jacobian's columns are the lines where they have come to.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CLOSED = 1e-12
RANK = 1e-7


@dataclass(frozen=True)
class Motion:
    """A turn about u through p, with an advance (length per rad), or a slide along u; `name` is the
    coordinate in a file, "" where it has none that can be compared."""

    name: str
    u: Array
    p: Array
    slides: bool = False
    advance: float = 0.0

    @property
    def screw(self) -> Array:
        if self.slides:
            return np.concatenate([np.zeros(3), self.u])
        return np.concatenate([self.u, np.cross(self.p, self.u) + self.advance * self.u])

    def moved(self, q: float) -> Array:
        """The displacement (4, 4)."""
        out = np.eye(4)
        if self.slides:
            out[:3, 3] = q * self.u
            return out
        k = cross_matrix(self.u)
        out[:3, :3] += np.sin(q) * k + (1 - np.cos(q)) * k @ k
        out[:3, 3] = self.p - out[:3, :3] @ self.p + q * self.advance * self.u
        return out


@dataclass
class Joint:
    """Its letter, keys of the file, and motions; a reversed one has its links the other way
    around."""

    letter: str
    keys: dict[str, Array | float]
    motions: list[Motion]
    reversed: bool = field(default=False)

    def line(self, name: str, one: str, two: str) -> str:
        links = f"{two}, {one}" if self.reversed else f"{one}, {two}"
        keys = ", ".join(f"{key}: {written(value)}" for key, value in self.keys.items())
        return f"  {name}: {{type: {self.letter}, links: [{links}], {keys}}}\n"


def written(value: Array | float) -> str:
    if isinstance(value, float):
        return repr(value)
    return "[" + ", ".join(repr(float(c)) for c in value) + "]"


def cross_matrix(v: Array) -> Array:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def jacobian(motions: list[tuple[Motion, int]], q: Array) -> tuple[Array, Array]:
    """The loop's displacement (4, 4), and lines where they have come to (6, coordinates)."""
    here, columns = np.eye(4), []
    for (motion, sign), value in zip(motions, q, strict=True):
        turn, shift = here[:3, :3], here[:3, 3]
        angular = turn @ motion.screw[:3]
        linear = turn @ motion.screw[3:] + np.cross(shift, angular)
        columns.append(sign * np.concatenate([angular, linear]))
        here = here @ motion.moved(sign * value)
    return here, np.array(columns).T


def closed(motions: list[tuple[Motion, int]], q: Array) -> tuple[Array, Array] | None:
    """Coordinates with the first one as it is, and the lines; None where Newton fails."""
    q = q.copy()
    for _ in range(30):
        here, lines = jacobian(motions, q)
        skew = (here[:3, :3] - here[:3, :3].T) / 2
        error = np.concatenate([[skew[2, 1], skew[0, 2], skew[1, 0]], here[:3, 3]])
        if np.abs(error).max() < CLOSED / 100:
            break
        step = np.linalg.lstsq(lines[:, 1:], -error, rcond=1e-9)[0]
        if np.abs(step).max() > 0.2:
            return None
        q[1:] += step
    return (q, lines) if np.abs(error).max() < CLOSED else None


def determined(lines: Array) -> tuple[int, float, set[int]]:
    """Rank and least singular value of all columns but the first, and which of these coordinates
    the first one decides."""
    _, values, rows = np.linalg.svd(lines[:, 1:])
    rank = int((values > RANK).sum())
    free = np.abs(rows[rank:]).max(axis=0, initial=0.0)
    return rank, float(values[min(rank, len(values)) - 1]), set(np.flatnonzero(free < 1e-9) + 1)
