"""A mechanism as arrays: links, and every joint as relations of `oracle.dynamics.rows`.

Points of a link are kept from its mass centre, of a link without mass from the mean of its joint
points. `Drawn.limits` and `Drawn.coordinates` name what is held and what is counted, each a sum of
relations with factors (a thread holds s - lead theta / turn).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from oracle.dynamics.rows import Array, Relations
from oracle.mechanism import Joint, Mechanism

Sum = list[tuple[int, float]]
"""Numbers of relations, with factors."""


@dataclass
class Drawn:
    """All that is constant of a mechanism."""

    mechanism: Mechanism
    names: list[str] = field(default_factory=list)
    """The moving links; ground follows them."""
    mass: Array = field(default_factory=lambda: np.zeros(0))
    inertia: Array = field(default_factory=lambda: np.zeros(0))
    centre: Array = field(default_factory=lambda: np.zeros(0))
    relations: Relations = field(default_factory=Relations)
    limits: dict[str, list[Sum]] = field(default_factory=dict)
    """By joint."""
    coordinates: dict[str, Sum] = field(default_factory=dict)
    """By name, `J.theta`."""
    size: float = 1.0

    def link(self, name: str) -> int:
        return len(self.names) if name == "ground" else self.names.index(name)

    def matrix(self, sums: list[Sum]) -> Array:
        """(sums, relations): what turns relations into sums of them."""
        found = np.zeros((len(sums), self.relations.count))
        for row, terms in zip(found, sums, strict=True):
            for k, factor in terms:
                row[k] += factor
        return found


def draw(mechanism: Mechanism) -> Drawn:
    """The arrays of a mechanism."""
    drawn = Drawn(mechanism, names=list(mechanism.links), size=float(mechanism.size))
    links = mechanism.links.values()
    drawn.mass = np.array([float(link.mass) for link in links] + [0.0])
    tensors = [np.array(link.inertia, dtype=float) for link in links]
    drawn.inertia = np.array([*tensors, np.zeros((3, 3))])
    drawn.centre = np.array([*(_centre(mechanism, name) for name in drawn.names), np.zeros(3)])
    found: dict[str, tuple[list[Any], dict[str, Any]]] = {
        name: _Writer(drawn, joint).write() for name, joint in mechanism.joints.items()
    }
    offsets = {
        "angle": 0,
        "gap": len(drawn.relations.angle),
        "turn": len(drawn.relations.angle) + len(drawn.relations.gap),
    }

    def numbered(terms: list[tuple[str, int, float]]) -> Sum:
        return [(offsets[kind] + k, factor) for kind, k, factor in terms]

    for name, (limits, coordinates) in found.items():
        drawn.limits[name] = [numbered(terms) for terms in limits]
        for coordinate, terms in coordinates.items():
            drawn.coordinates[f"{name}.{coordinate}"] = numbered(terms)
    drawn.relations.freeze()
    return drawn


def _centre(mechanism: Mechanism, name: str) -> Array:
    link = mechanism.links[name]
    if link.mass:
        return np.array(link.mass_centre, dtype=float)
    places = [
        joint.points[side]
        for joint in mechanism.joints.values()
        for side, owner in enumerate((joint.first, joint.second))
        if owner == name and joint.type != "W"
    ]
    return np.mean(np.array(places, dtype=float), axis=0) if places else np.zeros(3)


class _Writer:
    """Writes one joint's relations."""

    def __init__(self, drawn: Drawn, joint: Joint) -> None:
        self.relations, self.joint = drawn.relations, joint
        self.i, self.j = drawn.link(joint.first), drawn.link(joint.second)
        points = [np.array(p, dtype=float) for p in joint.points]
        self.p = points[0] - drawn.centre[self.i]
        self.q = points[1] - drawn.centre[self.j]
        self.zero = np.array(joint.zero, dtype=float)
        axes = joint.axes or ([0, 0, 1], [0, 0, 1])
        self.a, self.b = (np.array(axis, dtype=float) for axis in axes)
        self.e = _square_to(self.a)
        self.g = np.cross(self.a, self.e)

    def write(self) -> tuple[list[Any], dict[str, Any]]:
        """Sums that stay zero, and coordinates, in terms (kind, number, factor)."""
        kind = self.joint.type
        along = self._gap_on(self.i, self.a) if kind in "RPCHE" else []
        lines = [*self._gap_off_axis(), *self._parallel()] if kind in ("R", "C", "H") else []
        match kind:
            case "R":
                return [*lines, along], {"theta": self._theta()}
            case "C":
                return lines, {"theta": self._theta(), "s": along}
            case "H":
                theta = self._theta()
                lead = float(self.joint.lead) / (2 * np.pi)
                advance = [(k, n, -lead * f) for k, n, f in theta]
                return [*lines, [*along, *advance]], {"theta": theta, "s": along}
            case "P":
                return [*self._gap_off_axis(), *self._locked()], {"s": along}
            case "S":
                return self._together(), {}
            case "W":
                return [*self._together(), *self._locked()], {}
            case "U":
                return self._universal()
            case "E":
                x = np.array(self.joint.x, dtype=float)
                across = {"x": x, "y": np.cross(self.a, x)}
                shifts = {name: self._gap_on(self.i, u) for name, u in across.items()}
                return [along, *self._parallel()], {**shifts, "theta": self._theta()}
            case "Sp":
                return [self._gap_on(self.j, self.b)], {}
            case "Sg":
                e = _square_to(self.b)
                sides = [self._gap_on(self.j, u) for u in (e, np.cross(self.b, e))]
                back = [(k, n, -f) for k, n, f in self._gap_on(self.j, self.b)]
                return sides, {"s": back}
        raise NotImplementedError(kind)

    def _gap_on(self, carrier: int, direction: Array) -> Any:
        self.relations.gap.append((self.i, self.j, carrier, self.p, self.q, direction))
        return [("gap", len(self.relations.gap) - 1, 1.0)]

    def _together(self) -> list[Any]:
        return [self._gap_on(self.i, u) for u in (self.a, self.e, self.g)]

    def _gap_off_axis(self) -> list[Any]:
        return [self._gap_on(self.i, u) for u in (self.e, self.g)]

    def _angle(self, u: Array, v: Array, constant: float = 0.0) -> Any:
        self.relations.angle.append((self.i, self.j, u, v, constant))
        return [("angle", len(self.relations.angle) - 1, 1.0)]

    def _parallel(self) -> list[Any]:
        return [self._angle(u, self.b) for u in (self.e, self.g)]

    def _locked(self) -> list[Any]:
        """No turn: three pairs of directions that stay square, as the second link has them."""
        back = self.zero.T
        pairs = ((self.e, self.a), (self.g, self.a), (self.e, self.g))
        return [self._angle(u, back @ v) for u, v in pairs]

    def _theta(self) -> Any:
        pointer = self.zero.T @ self.e
        self.relations.turn.append(
            (self.i, self.j, self.a, 1.0, self.b, 0.0, self.e, self.g, pointer, True)
        )
        return [("turn", len(self.relations.turn) - 1, 1.0)]

    def _universal(self) -> tuple[list[Any], dict[str, Any]]:
        a, b = self.a, self.b
        c = float(a @ b)
        square = 1 - c * c
        n = np.cross(a, b) / np.sqrt(square)
        upright = [self._angle(a, b, c)]
        # W = theta1' a + theta2' b is resolved along the two axes
        for p, q, cosine, pointer, on_second in (
            (1.0, -c, (b - c * a) / np.sqrt(square), b, True),
            (-c, 1.0, (a - c * b) / np.sqrt(square), a, False),
        ):
            turn = (self.i, self.j, a, p / square, b, q / square, cosine, n, pointer, on_second)
            self.relations.turn.append(turn)
        last = len(self.relations.turn) - 1
        turns = {"theta1": [("turn", last - 1, 1.0)], "theta2": [("turn", last, 1.0)]}
        return [*self._together(), *upright], turns


def _square_to(axis: Array) -> Array:
    found = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    return np.asarray(found / np.linalg.norm(found))
